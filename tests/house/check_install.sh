#!/bin/sh
# Installs the build in $1 into a folder of its own and builds and runs tests/house/consumer against it.
set -eu
build=$1
consumer=$(cd "$(dirname "$0")/consumer" && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cmake --install "$build" --prefix "$folder/installed" > "$folder/log" || { cat "$folder/log"; exit 1; }
cmake -G Ninja -S "$consumer" -B "$folder/consumer" -DCMAKE_PREFIX_PATH="$folder/installed" -DCMAKE_BUILD_TYPE=Debug
cmake --build "$folder/consumer"
"$folder/consumer/consumer"
"$folder/installed/bin/tutu" --version
