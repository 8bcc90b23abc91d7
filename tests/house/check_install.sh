#!/bin/sh
# Installs the build in $1 into a folder of its own, builds tests/house/consumer against it, and plays the dance there: the
# garments must come to be, to the bit, where the installed program has them.
set -eu
build=$1
consumer=$(cd "$(dirname "$0")/consumer" && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cmake --install "$build" --prefix "$folder/installed" > "$folder/log" || { cat "$folder/log"; exit 1; }
cmake -G Ninja -S "$consumer" -B "$folder/consumer" -DCMAKE_PREFIX_PATH="$folder/installed" -DCMAKE_BUILD_TYPE=Debug
cmake --build "$folder/consumer"
scene=$folder/installed/share/tutu/assets/scenes/dance.json
"$folder/consumer/consumer" "$scene" 120 | tee "$folder/consumed"
"$folder/installed/bin/tutu" play "$scene" --headless --no-pictures --frames 120 > "$folder/played" 2> "$folder/log" ||
  { cat "$folder/log"; exit 1; }
ours=$(grep '^state hash' "$folder/consumed")
grep -q "$ours" "$folder/played" || { echo "expected, of the program:"; cat "$folder/played"; exit 1; }
"$folder/consumer/consumer" "$folder/none.json" 2> "$folder/refused" && exit 1
grep -q none.json "$folder/refused"
"$folder/installed/bin/tutu" --version
