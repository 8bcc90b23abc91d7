"""Instructions that the frames of a few scenes take, counted by valgrind, against those that are recorded.

    python3 tests/instructions/instructions.py check RUN_FRAMES [RECORD]
    python3 tests/instructions/instructions.py record RUN_FRAMES [RECORD]
    python3 tests/instructions/instructions.py --self-test

RUN_FRAMES is the built program (build/release/tests/instructions/run_frames). `check` prints a table and fails where a
scene takes more than 1 % more instructions than RECORD (recorded.json beside this file) says; 1 % fewer are told.
Milliseconds are those of an ordinary run of the same program and only inform. `record` builds RUN_FRAMES anew, counts
every scene twice and writes RECORD, with the commit: what is not committed is refused.

Exit status: 0 within 1 %; 1 beyond, or a scene that only one side has; 2 what could not be read or run; 77 skipped:
no valgrind, no such target of the processor, sanitizers, or another build than the recorded one. Then figures are not
comparable: the table is printed all the same.
"""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

MOST_MORE = 1  # percent
MOST_APART = 1e-4  # of two counts of one program
SKIPPED = 77
SECONDS = 1800  # of one scene under valgrind
COUNTED = "tutu_counted_frames"  # of run_frames
ORDINARY_RUNS = 3  # the fastest is told
RECORD = pathlib.Path(__file__).resolve().parent / "recorded.json"
BUILD_KEYS = ("compiler", "type", "flags", "libraries", "target", "valgrind")


class Wrong(Exception):
    """What could not be read or run, in one line."""


class Skipped(Exception):
    """Why nothing can be counted here."""


# ---- records

def checked_record(text, name):
    """The record in `text`: {"commit", "build": {KEY: text}, "scenes": {NAME: {"frames", "instructions", "hash"}}}."""
    def expect(fits, place, found, expected):
        if not fits:
            raise Wrong(f"{name}: {place}: {json.dumps(found)[:60]}, expected {expected}")

    try:
        record = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise Wrong(f"{name}: not JSON: {error}") from None
    expect(isinstance(record, dict), "the file", record, "an object")
    expect(isinstance(record.get("commit"), str), "commit", record.get("commit"), "a commit")
    build, scenes = record.get("build"), record.get("scenes")
    expect(isinstance(build, dict), "build", build, "an object")
    for key in BUILD_KEYS:
        expect(isinstance(build.get(key), str), f"build/{key}", build.get(key), "a text")
    expect(isinstance(scenes, dict) and scenes, "scenes", scenes, "an object of scenes")
    for scene, figures in scenes.items():
        expect(isinstance(figures, dict), f"scenes/{scene}", figures, "an object")
        for key in ("frames", "instructions"):
            value = figures.get(key)
            expect(type(value) is int and value > 0, f"scenes/{scene}/{key}", value, "a whole number above 0")
        expect(isinstance(figures.get("hash"), str), f"scenes/{scene}/hash", figures.get("hash"), "a text")
    return record


def read_record(file):
    try:
        return checked_record(file.read_text(encoding="utf-8"), file)
    except (OSError, UnicodeDecodeError) as error:
        raise Wrong(f"{file}: {getattr(error, 'strerror', None) or 'not UTF-8'}") from None


# ---- running and counting

def run(words, environment=None, folder=None, seconds=SECONDS):
    """What it prints; what it says of 77 becomes Skipped."""
    try:
        told = subprocess.run(words, capture_output=True, text=True, errors="replace", timeout=seconds, check=False,
                              env=environment, cwd=folder)
    except OSError as error:
        raise Wrong(f"{words[0]}: {error.strerror}") from None
    except subprocess.TimeoutExpired:
        raise Wrong(f"{' '.join(map(str, words))}: not done after {seconds} s") from None
    said = [line for line in told.stderr.splitlines() if line.strip()]
    if told.returncode == SKIPPED:
        raise Skipped(next((line for line in said if not line.startswith("==")), f"{words[0]} skips"))
    if told.returncode:
        raise Wrong(f"{' '.join(map(str, words))}: exit status {told.returncode}: {(said or ['nothing said'])[-1]}")
    return told.stdout


def parsed(program, text):
    try:
        return json.loads(text)
    except ValueError:
        raise Wrong(f"{program}: no JSON: {text[:60]!r}") from None


def count(valgrind, program, scene):
    """Frames, hash of the end, and the instructions of one scene."""
    with tempfile.TemporaryDirectory() as folder:
        # Nothing of the caller's environment: neither his options of valgrind nor the size of it, which moves the stack.
        out = pathlib.Path(folder) / "out"
        told = parsed(program, run(
            [valgrind, "--tool=callgrind", f"--toggle-collect={COUNTED}", f"--callgrind-out-file={out}.%p", program, scene],
            environment={"PATH": os.defpath, "LC_ALL": "C", "HOME": folder}, folder=folder))
        # A file of each process: the importer's own, which reads the character, collects nothing.
        totals = [int(figure) for file in pathlib.Path(folder).glob("out.*")
                  for figure in re.findall(r"^(?:totals|summary): (\d+)", file.read_text(errors="replace"), re.M)]
    if not max(totals, default=0):
        raise Wrong(f"{program} {scene}: valgrind counted nothing in {COUNTED}")
    return {"frames": told["frames"], "instructions": max(totals), "hash": told["hash"]}


def measure(program, times=1):
    """A record of what the program takes now, without a commit; and milliseconds a frame of ordinary runs."""
    valgrind = shutil.which("valgrind")
    if not valgrind:
        raise Skipped("valgrind is not installed")
    about = parsed(program, run([program]))
    if "-fsanitize" in about["build"]["flags"]:
        raise Skipped("valgrind runs no program with sanitizers")
    build = {**about["build"], "valgrind": run([valgrind, "--version"]).strip()}
    scenes, ms = {}, {}
    for scene in about["scenes"]:
        counts = [count(valgrind, program, scene) for _ in range(times)]
        least, most = (f(one["instructions"] for one in counts) for f in (min, max))
        if most - least > MOST_APART * least:
            raise Wrong(f"{scene}: {least} instructions in one run, {most} in the next")
        scenes[scene] = counts[0]
        told = [parsed(program, run([program, scene])) for _ in range(ORDINARY_RUNS)]
        ms[scene] = min(one["ms"] for one in told)
        if told[0]["hash"] != counts[0]["hash"]:
            raise Wrong(f"{scene}: other bits under valgrind than without: {counts[0]['hash']}, {told[0]['hash']}")
        if times > 1:
            print(f"{scene}: {', '.join(str(one['instructions']) for one in counts)}", flush=True)
    return {"build": build, "scenes": scenes}, ms


# ---- the gate

def compared(recorded, now, ms):
    """Lines of a table and of what there is to say, and the exit status."""
    width = max(map(len, [*recorded["scenes"], *now["scenes"], "scene"]))
    lines = [f"{'scene':{width}}  {'recorded':>15}  {'now':>15}  {'ratio':>7}  {'ms':>8}  bits"]
    faults, remarks = [], []
    for scene in {**recorded["scenes"], **now["scenes"]}:
        old, new = recorded["scenes"].get(scene), now["scenes"].get(scene)
        if not old or not new:
            faults.append(f"{scene}: {'no longer run' if old else 'not recorded'}")
            continue
        before, after = old["instructions"], new["instructions"]
        time = f"{ms[scene]:8.3f}" if scene in ms else f"{'':8}"
        lines.append(f"{scene:{width}}  {before:15,}  {after:15,}  {after / before:7.4f}  {time}  "
                     f"{'same' if old['hash'] == new['hash'] else 'others'}")
        if old["frames"] != new["frames"]:
            faults.append(f"{scene}: {new['frames']} frames, recorded are {old['frames']}")
        elif 100 * after > (100 + MOST_MORE) * before:
            faults.append(f"{scene}: {100 * (after / before - 1):.2f} % more instructions, at most {MOST_MORE} % is let pass")
        elif 100 * after < (100 - MOST_MORE) * before:
            remarks.append(f"{scene}: {100 * (1 - after / before):.2f} % fewer instructions: record them anew")
    others = [key for key in BUILD_KEYS if recorded["build"][key] != now["build"][key]]
    lines += [f"recorded at {recorded['commit']}", *remarks, *faults]
    if others:
        lines += [f"{key}: {now['build'][key]}, recorded with {recorded['build'][key]}" for key in others]
        lines.append("another build: the figures are not comparable, and only inform")
        faults = [fault for fault in faults if "more instructions" not in fault]
    return lines, 1 if faults else SKIPPED if others else 0


def check(program, file):
    recorded = read_record(file)
    now, ms = measure(program)
    lines, status = compared(recorded, now, ms)
    print(*lines, sep="\n")
    return status


def record(program, file):
    here = pathlib.Path(__file__).resolve().parent
    changed = [line for line in run(["git", "-C", here, "status", "--porcelain"]).splitlines()
               if not line.endswith("tests/instructions/recorded.json")]
    if changed:
        raise Wrong(f"not committed: {changed[0][3:]}: figures are recorded of a commit")
    tree = next((folder for folder in program.parents if (folder / "CMakeCache.txt").is_file()), None)
    if not tree:
        raise Wrong(f"{program}: in no build tree")
    run(["cmake", "--build", tree, "--target", "run_frames"], seconds=4 * SECONDS)
    now, _ = measure(program, times=2)
    now = {"commit": run(["git", "-C", here, "rev-parse", "HEAD"]).strip(), **now}
    file.write_text(json.dumps(now, indent=2) + "\n", encoding="utf-8")
    print(f"wrote {file}")
    return 0


# ---- the gate, checked

PROGRAM = """\
#!/bin/sh
[ $# -gt 0 ] || { echo '{"build": %s, "scenes": ["a"]}'; exit 0; }
echo '{"frames": 60, "ms": 2.5, "hash": "00ff"}'
"""
VALGRIND = """\
#!/bin/sh
[ "$1" != --version ] || { echo valgrind-3; exit 0; }
for word; do case "$word" in --callgrind-out-file=*) out=${word#*=}; out=${out%%%%.%%p} ;; esac; done
printf 'events: Ir\\ntotals: 0\\n' > "$out.1"
printf 'events: Ir\\nsummary: %d\\n' > "$out.2"
echo '{"frames": 60, "ms": 99, "hash": "%s"}'
"""


def self_test():
    """Shows that the gate sees what it should, on made-up records and with a made-up program and valgrind."""
    wrong = []

    def expect(what, found, expected):
        if found != expected:
            wrong.append(f"{what}:\n  found    {found}\n  expected {expected}")

    def made_up(**scenes):
        return {"commit": "c0ffee", "build": {key: f"{key}-3" for key in BUILD_KEYS},
                "scenes": {name: {"frames": 60, "instructions": count, "hash": "00ff"} for name, count in scenes.items()}}

    def status_of(now, recorded=made_up(a=1000000)):
        lines, status = compared(recorded, now, {})
        return status, [line for line in lines[1:] if line[:2] in ("a:", "b:")]

    expect("the same", status_of(made_up(a=1000000)), (0, []))
    expect("0.5 % more", status_of(made_up(a=1005000)), (0, []))
    expect("1 % more", status_of(made_up(a=1010000)), (0, []))
    expect("a little beyond", status_of(made_up(a=1010001))[0], 1)
    expect("1.5 % more", status_of(made_up(a=1015000)),
           (1, ["a: 1.50 % more instructions, at most 1 % is let pass"]))
    expect("1.5 % fewer", status_of(made_up(a=985000)), (0, ["a: 1.50 % fewer instructions: record them anew"]))
    expect("0.5 % fewer", status_of(made_up(a=995000)), (0, []))
    expect("a scene that is gone", status_of(made_up(b=1), made_up(a=1, b=1)), (1, ["a: no longer run"]))
    expect("a new scene", status_of(made_up(a=1000000, b=1)), (1, ["b: not recorded"]))
    shorter = made_up(a=500000)
    shorter["scenes"]["a"]["frames"] = 30
    expect("fewer frames", status_of(shorter), (1, ["a: 30 frames, recorded are 60"]))
    for key in BUILD_KEYS:
        other = made_up(a=2000000)
        other["build"][key] = "another"
        expect(f"another {key}", status_of(other)[0], SKIPPED)
        del other["scenes"]["a"]
        expect(f"another {key} and no scene", status_of(other)[0], 1)

    def message(call, *arguments):
        try:
            return call(*arguments)
        except (Wrong, Skipped) as error:
            return str(error)

    good = json.dumps(made_up(a=5))
    expect("a good record", message(checked_record, good, "r"), made_up(a=5))
    for text, said in ((good[:-9], "r: not JSON: "), ("", "r: not JSON: "), ("[" * 100000, "r: not JSON: "),
                       ("[]", "r: the file: [], expected an object"),
                       ("{}", "r: commit: null, expected a commit"),
                       (good.replace('"flags-3"', "3"), "r: build/flags: 3, expected a text"),
                       (good.replace('"scenes": {', '"scenes": {}, "x": {'), "r: scenes: {}, expected an object of scenes"),
                       *((good.replace(": 5", f": {bad}"), f"r: scenes/a/instructions: {bad}, expected a whole number above 0")
                         for bad in ("0", "-5", "5.5", "true", "NaN", '"5"', "null"))):
        found = message(checked_record, text, "r")
        expect(f"a record {text[:40]}", (str(found)[:len(said)], str(found).count("\n")), (said, 0))

    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        program, valgrind, file = folder / "program", folder / "valgrind", folder / "r.json"
        path = os.environ.get("PATH", os.defpath)

        def gate(instructions, flags="flags-3", bits="00ff", find=f"{folder}:{path}"):
            build = {**made_up()["build"], "flags": flags}
            for script, text in ((program, PROGRAM % json.dumps(build)), (valgrind, VALGRIND % (instructions, bits))):
                script.write_text(text, encoding="utf-8")
                script.chmod(0o755)
            os.environ["PATH"] = find
            try:
                return main(["check", str(program), str(file)])
            finally:
                os.environ["PATH"] = path

        expect("no record", message(read_record, file), f"{file}: No such file or directory")
        expect("its status", gate(5), 2)
        file.write_bytes(b"\xff\xfe")
        expect("no text", message(read_record, file), f"{file}: not UTF-8")
        file.write_text(json.dumps(made_up(a=1000000)), encoding="utf-8")
        expect("the whole gate at 0.5 %", gate(1005000), 0)
        expect("the whole gate at 1.5 %", gate(1015000), 1)
        expect("nothing counted", gate(0), 2)
        expect("other bits under valgrind", gate(1000000, bits="0000"), 2)
        expect("other flags", gate(1015000, flags="-O0"), SKIPPED)
        expect("sanitizers", gate(1000000, flags="-fsanitize=address"), SKIPPED)
        (folder / "none").mkdir()
        expect("no valgrind", gate(1000000, find=str(folder / "none")), SKIPPED)
        program.write_text("#!/bin/sh\necho run_frames: no AVX2 >&2\nexit 77\n", encoding="utf-8")
        expect("no target", message(run, [program]), "run_frames: no AVX2")
        program.write_text("#!/bin/sh\necho broken >&2\nexit 1\n", encoding="utf-8")
        expect("a program that fails", message(run, [program]), f"{program}: exit status 1: broken")
        expect("no program", message(run, [folder / "gone"]), f"{folder / 'gone'}: No such file or directory")
    print(*wrong, "the gate fails its own test" if wrong else "the gate sees what it should", sep="\n")
    return int(bool(wrong))


def main(arguments):
    if arguments == ["--self-test"]:
        return self_test()
    if len(arguments) not in (2, 3) or arguments[0] not in ("check", "record"):
        print(__doc__, file=sys.stderr)
        return 2
    program = pathlib.Path(arguments[1]).resolve()
    file = pathlib.Path(arguments[2]) if len(arguments) == 3 else RECORD
    try:
        return {"check": check, "record": record}[arguments[0]](program, file)
    except Skipped as reason:
        print(f"skipped: {reason}")
        return SKIPPED
    except Wrong as error:
        print(f"instructions.py: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
