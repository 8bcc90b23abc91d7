#!/bin/sh
# long_run.sh PROGRAM [FRAMES]: plays the dance without pictures for so many frames (300,000 by default: 83 minutes of
# 60 a second, over and over) and watches the memory. Fails where the program does, where it holds more than 8 MiB more
# at the end than after a tenth of the frames, where it diverges, and where a figure of the run is no number.
set -eu
program=$1
frames=${2:-300000}
scene=$(cd "$(dirname "$0")/../../assets/scenes" && pwd)/dance.json
most_growth=8192 # KiB
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

"$program" play "$scene" --headless --no-pictures --frames "$frames" --json "$folder/run.json" \
  > "$folder/out" 2> "$folder/progress" &
run=$!
trap 'kill "$run" 2>/dev/null || :; rm -rf "$folder"' EXIT INT TERM
# Frames done and KiB resident, once a second; the program's own progress ("  12/240") tells how far it is.
while kill -0 "$run" 2>/dev/null; do
  resident=$(sed -n 's/^VmRSS:[^0-9]*\([0-9]*\).*/\1/p' "/proc/$run/status" 2>/dev/null) || :
  done=$(tr '\r' '\n' < "$folder/progress" | sed -n "s:.* \([0-9][0-9]*\)/$frames .*:\1:p" | tail -n 1)
  [ -z "$resident" ] || echo "${done:-0} $resident" >> "$folder/memory"
  sleep 1
done
status=0
wait "$run" || status=$?
trap 'rm -rf "$folder"' EXIT
if [ "$status" -ne 0 ]; then
  echo "the program ended with $status:"
  tail -n 5 "$folder/progress"
  exit 1
fi

python3 - "$folder" "$frames" "$most_growth" <<'END'
import json, math, sys
folder, frames, most_growth = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
memory = [tuple(map(int, line.split())) for line in open(f"{folder}/memory")]
late = [kib for done, kib in memory if done >= frames // 10]
if len(late) < 2:
    sys.exit("too few frames to see memory grow: it took less than two seconds after the first tenth")
middle = [kib for done, kib in memory if done >= frames // 2] or late[-1:]
print(f"resident KiB: {memory[0][1]} at the start, {late[0]} after a tenth, {middle[0]} in the middle, "
      f"{late[-1]} at the end, {max(late)} at the most since the first tenth")

wrong = []
def look(place, value):
    if isinstance(value, dict):
        for key, inner in value.items():
            look(f"{place}/{key}", inner)
    elif isinstance(value, list):
        for k, inner in enumerate(value):
            look(f"{place}/{k}", inner)
    elif value is None or (isinstance(value, float) and not math.isfinite(value)):
        wrong.append(f"{place} is no number")
run = json.load(open(f"{folder}/run.json"))
look("", run)
if run["frames"] != frames:
    wrong.append(f"{run['frames']} frames were played")
if run["diverged"]:
    wrong.append("it diverged: " + run.get("failure", ""))
if max(late) - late[0] > most_growth:
    wrong.append(f"memory grew by {max(late) - late[0]} KiB after the first tenth; at most {most_growth} is allowed")
print(f"{run['frames']} frames, {run['recoveries']} recoveries, {run['teleports']} jumps, "
      f"{run['substeps']['frames_split']} frames in more substeps, longer {run['longer_pct']} %, "
      f"penetration {run['penetration_mm']}, ms {run['ms_per_frame']['total']}, hash {run['state_hash']}")
sys.exit("\n".join(wrong))
END
