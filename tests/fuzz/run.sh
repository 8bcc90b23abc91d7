#!/usr/bin/env bash
# Fuzz targets under libFuzzer, one after the other, from their seeds:
#
#   tests/fuzz/run.sh [SECONDS [TARGET...]]     60 seconds each, all of them, when left out; 3600 for a long run
#
# Builds what is missing (preset "fuzz"; clang). Prints a line a target; exit status 1 when one found something: the
# input that did it stays in build/fuzz/findings, and `build/fuzz/tests/fuzz/fuzz_TARGET FILE` repeats it. With
# TUTU_FUZZ_CORPUS=FOLDER what was learned is kept in FOLDER/TARGET, and the next run begins with it.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
seconds=${1:-60}
shift || true
[[ $seconds =~ ^[1-9][0-9]*$ ]] || { echo "usage: run.sh [SECONDS [TARGET...]]" >&2; exit 2; }
targets=("$@")
[ ${#targets[@]} -gt 0 ] || targets=($(cd "$here/seeds" && ls))
for target in "${targets[@]}"; do
  [ -d "$here/seeds/$target" ] || { echo "run.sh: no target $target; one of: $(cd "$here/seeds" && echo *)" >&2; exit 2; }
done

build=$root/build/fuzz
(cd "$root" && { [ -f "$build/build.ninja" ] || cmake --preset fuzz; } && cmake --build --preset fuzz) >&2

memory=/dev/shm
[ -w $memory ] || memory=${TMPDIR:-/tmp}
scratch=$(mktemp -d "$memory/tutu-fuzz.XXXXXX")
trap 'rm -rf "$scratch"' EXIT
findings=$build/findings
mkdir -p "$findings"

# ASan keeps 256 MB of freed memory by default: too much of the limit.
export ASAN_OPTIONS=quarantine_size_mb=32:detect_leaks=1 UBSAN_OPTIONS=print_stacktrace=1
export TUTU_MEMORY_GIB=0.25
printf '%-14s %12s %8s %8s %9s\n' target executions cov ft findings
status=0
for target in "${targets[@]}"; do
  corpus=${TUTU_FUZZ_CORPUS:+$TUTU_FUZZ_CORPUS/$target}
  corpus=${corpus:-$scratch/corpus-$target}
  mkdir -p "$corpus" "$scratch/$target"
  before=$(find "$findings" -name "$target-*" | wc -l)
  log=$scratch/$target.log
  TMPDIR=$scratch/$target "$build/tests/fuzz/fuzz_$target" -max_total_time="$seconds" -rss_limit_mb=1024 -timeout=10 \
    -max_len=8192 -dict="$here/words.dict" -artifact_prefix="$findings/$target-" -print_final_stats=1 \
    "$corpus" "$here/seeds/$target" >"$log" 2>&1 || status=1
  rm -rf "${scratch:?}/$target"
  found=$(($(find "$findings" -name "$target-*" | wc -l) - before))
  executions=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log" | tail -1)
  cov=$(sed -n 's/.* cov: \([0-9]*\).*/\1/p' "$log" | tail -1)
  ft=$(sed -n 's/.* ft: \([0-9]*\).*/\1/p' "$log" | tail -1)
  printf '%-14s %12s %8s %8s %9s\n' "$target" "${executions:--}" "${cov:--}" "${ft:--}" "$found"
  if [ "$found" -gt 0 ]; then
    grep -E 'SUMMARY|runtime error|a promise is broken|what\(\)|Test unit written' "$log" | head -8 | sed 's/^/    /'
  elif [ -z "$executions" ]; then
    tail -5 "$log" | sed 's/^/    /'
  fi
done
exit $status
