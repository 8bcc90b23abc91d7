#!/usr/bin/env python3
"""Whole-program mutants: shipped files with something wrong in one of them, through the program as a user runs it.

    tests/fuzz/mutants.py PROGRAM ASSETS [COUNT [SEED]] [--only N] [--jobs 2] [--keep FOLDER]

Each mutant is one file of a copy of ASSETS (and of Debian's assimp-testmodels, where they are) changed in one way, and
one command that reads it. Good ends are the exit statuses 0, 1 and 2, the last with a message. Everything else is
kept, with how to repeat it, and makes the exit status 1: a signal, a time-out, another status, silence, a message that
is only a library's own, a file that a name has made as a command. The same SEED makes the same mutants; --only N runs
one of them again."""

import argparse
import concurrent.futures
import json
import os
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections import Counter
from pathlib import Path

SECONDS = 60
ADDRESS_SPACE = 4 << 30
MODELS = Path("/usr/share/assimp/models")
TRAP = "tutu-was-here"  # what shell text in names would make

# --- what is mutated, and who reads it --------------------------------------------------------------------------------

# In SCENE commands {} is the scene; where the mutated file is named itself, {file}.
PLAY = ["play", "{}", "--headless", "--no-pictures", "--frames", "2"]
DRAPE = ["drape", "{}", "--seconds", "0.1", "-o", "out.drape.json"]
VALIDATE = ["validate", "{}", "--every", "200"]
INSPECT = ["inspect", "{file}"]
INSPECT_JSON = ["inspect", "{file}", "--json", "out.json"]


def cases(folder):
    """(file that is mutated, scene, commands) of the files in `folder`, as set_up() left it."""
    scene_commands = [PLAY, DRAPE, VALIDATE]
    of = [
        ("scenes/dance.json", "scenes/dance.json", scene_commands),
        ("scenes/walk.json", "scenes/walk.json", scene_commands),
        ("scenes/mocap.json", "scenes/mocap.json", scene_commands),
        ("scenes/epileptic.json", "scenes/epileptic.json", scene_commands),
        ("scenes/mesh.json", "scenes/mesh.json", scene_commands),
        ("scenes/texts.json", "scenes/texts.json", [DRAPE, VALIDATE]),
        ("scenes/dance.drape.json", "scenes/dance.json", [PLAY]),
        ("garments/skirt.json", "scenes/walk.json", [PLAY, DRAPE]),
        ("garments/top.json", "scenes/walk.json", [PLAY, DRAPE]),
        ("garments/epileptic-skirt.json", "scenes/epileptic.json", [DRAPE]),
        ("garments/mesh.json", "scenes/mesh.json", [DRAPE]),
        ("garments/sheet.obj", "scenes/mesh.json", [DRAPE]),
        ("fabrics/denim.json", "scenes/mesh.json", [DRAPE]),
        ("proxies/dancer.json", "scenes/dance.json", [DRAPE, VALIDATE]),
        ("proxies/dancer-no-hands.json", "scenes/mocap.json", [DRAPE, VALIDATE]),
        ("proxies/epileptic.json", "scenes/epileptic.json", [DRAPE, VALIDATE]),
        ("poses/dance.json", "scenes/dance.json", [DRAPE, VALIDATE]),
        ("poses/walk.json", "scenes/walk.json", [DRAPE, VALIDATE]),
        ("poses/t.txt", "scenes/texts.json", [DRAPE, VALIDATE]),
        ("poses/q.txt", "scenes/texts.json", [DRAPE, VALIDATE]),
        ("poses/k.txt", "scenes/texts.json", [DRAPE, VALIDATE]),
        ("characters/dancer.dae", "scenes/dance.json", [INSPECT, INSPECT_JSON, DRAPE]),
        ("limits/dancer.json", None, [["pose", "characters/dancer.dae", "--motion", "poses/walk.json", "--limits",
                                       "{file}"]]),
        ("models/take.bvh", "scenes/mocap.json", [DRAPE, VALIDATE]),
        ("models/epileptic.x", "scenes/epileptic.json", [INSPECT, DRAPE]),
    ]
    of += [(str(file.relative_to(folder)), None, [INSPECT, INSPECT_JSON])
           for file in sorted((folder / "models").glob("character-*"))]
    return [case for case in of if (folder / case[0]).exists()]


def set_up(folder, assets):
    """A copy of the assets, and what they do not show: a mesh garment of a named fabric, three texts, models."""
    for name in ("characters", "fabrics", "garments", "limits", "poses", "proxies", "scenes"):
        shutil.copytree(assets / name, folder / name)
    (folder / "models").mkdir()

    def take(source, name):
        if not (MODELS / source).exists():
            return False
        shutil.copyfile(MODELS / source, folder / "models" / name)
        return True

    def change(name, edit):
        value = json.loads((folder / name).read_text())
        edit(value)
        (folder / name).write_text(json.dumps(value))

    if take("BVH/01_01.bvh", "take.bvh"):
        change("scenes/mocap.json", lambda scene: scene["motion"].update(bvh="../models/take.bvh", to=1))
    else:
        (folder / "scenes/mocap.json").unlink()
    if take("X/BCN_Epileptic.X", "epileptic.x"):
        change("scenes/epileptic.json", lambda scene: scene.update(character="../models/epileptic.x"))
    else:
        (folder / "scenes/epileptic.json").unlink()
    for k, source in enumerate(["glTF2/simple_skin/simple_skin.gltf", "glTF2/glTF-Sample-Models/RiggedFigure.glb",
                                "FBX/animation_with_skeleton.fbx", "FBX/huesitos.fbx", "Collada/duck.dae",
                                "Collada/human.zae", "X/Testwuson.X", "glTF/TwoBoxes/TwoBoxes.gltf"]):
        take(source, f"character-{k}{Path(source).suffix}")

    sheet = [f"v {0.02 * i - 0.1} 1.0 {0.02 * j - 0.1}" for i in range(11) for j in range(11)]
    for i in range(10):
        for j in range(10):
            a = 11 * i + j + 1
            sheet += [f"f {a} {a + 1} {a + 11}", f"f {a + 1} {a + 12} {a + 11}"]
    (folder / "garments/sheet.obj").write_text("\n".join(sheet) + "\n")
    (folder / "garments/mesh.json").write_text(json.dumps({
        "name": "sheet", "shape": {"mesh": {"file": "sheet.obj", "scale": 1.5}}, "fabric": {"base": "denim", "drag": 2},
        "attachments": [{"joint": "Spine", "above": 1.4, "within": {"centre": [0, 1.5, 0], "radius": 0.05}}]}))
    (folder / "scenes/mesh.json").write_text(json.dumps({
        "character": "../characters/dancer.dae", "motion": "../poses/walk.json", "proxies": "../proxies/dancer.json",
        "garments": [{"file": "../garments/mesh.json", "scale": 1.0, "offset": [0, 0.1, 0]}]}))

    # Two joints of the dancer, two poses.
    (folder / "poses/t.txt").write_text("0 0.9465 0 0 0.12 0\n0 0.94 0 0 0.12 0\n")
    (folder / "poses/q.txt").write_text("0 0 0 1 0 0 0 1\n0 0 0 1 0 0.6 0 0.8\n")
    (folder / "poses/k.txt").write_text("0 0.5\n")
    (folder / "poses/j.txt").write_text("0 -1 Hips\n1 0 Spine\n")
    (folder / "scenes/texts.json").write_text(json.dumps({
        "character": "../characters/dancer.dae", "proxies": "../proxies/dancer-hand.json",
        "motion": {"texts": {"translations": "../poses/t.txt", "rotations": "../poses/q.txt", "times": "../poses/k.txt",
                             "joints": "../poses/j.txt"}}, "garments": ["../garments/top.json"]}))


# --- mutations --------------------------------------------------------------------------------------------------------

SHELL = [f"$(touch {TRAP})", f"`touch {TRAP}`", f"'; touch {TRAP}; '", f'"; touch {TRAP}; "', f"a\n!touch {TRAP}\n",
         f"a\nsystem 'touch {TRAP}'\n", f"| touch {TRAP}", f"&& touch {TRAP} #", "%s%n%n", "..", "../../x", "-o", "*",
         "a,b\"c", "<!--<script>", "\u202e\u0000x", "\x1b[2J", "\x7f\x80"]
NUMBERS = ["1e9", "-1e9", "1e308", "-1e308", "1e400", "0", "-0.0", "-1", "1e-320", "5e-324", "1e-9", "2147483647",
           "2147483648", "-2147483649", "4294967296", "18446744073709551616", "999999999", "4096", "4097", "100", "NaN",
           "Infinity", "-inf", "0x10", "1e", "0.1.2", "3"]
VALUES = NUMBERS + ["true", "false", "null", '""', "[]", "{}", "[[]]", '{"a": 1}', '"x"', '"' + 70000 * "n" + '"',
                    '"' + 300 * "n" + '"', '"\\u0000\\n\\u001b[2J\\r\\t"', '"\\ud800"', '"\x01"', '"\xff"', "[1, 2]",
                    "[1e9, 1e9, 1e9]", "[0, 0, 0]", "[0, 0, 0, 0]", "[" + 5000 * "0, " + "0]", 70 * "[" + 70 * "]"]


def places(value, path=()):
    """Of every value within, the keys that lead to it."""
    yield path
    if isinstance(value, dict):
        for key, item in value.items():
            yield from places(item, path + (key,))
    elif isinstance(value, list):
        for index, item in enumerate(value):
            yield from places(item, path + (index,))


def mutate_json(text, rng):
    """One value of the file another one: by its place, so that small parts of it are met as often as long lists."""
    root = json.loads(text)
    all_places = list(places(root))
    depth = rng.choice(sorted({len(p) for p in all_places}))
    path = rng.choice([p for p in all_places if len(p) == depth])
    mark = "\u0001here\u0001"
    if not path:
        return rng.choice(VALUES)
    parent = root
    for step in path[:-1]:
        parent = parent[step]
    kind = rng.choice(["value", "value", "value", "value", "shell", "gone", "key", "twice", "near"])
    old = parent[path[-1]]
    replacement = rng.choice(VALUES)
    if kind == "gone":
        del parent[path[-1]]
        return json.dumps(root)
    if kind == "key" and isinstance(parent, dict):
        parent[rng.choice(SHELL + ["", "x", 70000 * "k", "name", "comment"])] = parent.pop(path[-1])
        return json.dumps(root)
    if kind == "twice":
        if isinstance(parent, list):
            parent[path[-1]:path[-1]] = [old] * rng.choice([1, 2, 300])
            return json.dumps(root)
        parent[path[-1]] = mark
        key = json.dumps(path[-1])
        return json.dumps(root).replace(json.dumps(mark), f"{json.dumps(old)}, {key}: {json.dumps(old)}")
    if kind == "shell":
        replacement = json.dumps(rng.choice(SHELL))
    elif kind == "near" and isinstance(old, (int, float)) and not isinstance(old, bool):
        replacement = repr(rng.choice([old * 10, old * 1e3, -old, old + 1, old - 1, old * 1e-6, 1.0 * old + 0.5]))
    parent[path[-1]] = mark
    return json.dumps(root).replace(json.dumps(mark), replacement)


def mutate_number(data, rng):
    """A number of a text another one."""
    numbers = list(re.finditer(rb"(?<![\w.])-?\d+\.?\d*(e-?\d+)?(?![\w.])", data))
    if not numbers:
        return data[: len(data) // 2]
    at = rng.choice(numbers)
    return data[: at.start()] + rng.choice(NUMBERS).encode() + data[at.end():]


def mutate_bytes(data, rng):
    size = len(data)
    at = rng.randrange(size + 1)
    end = min(size, at + rng.choice([1, 2, 7, 64, 1000, 20000]))
    kind = rng.choice(["flip", "flip", "flip", "delete", "twice", "cut", "insert", "swap", "empty"])
    if kind == "flip":
        out = bytearray(data)
        for _ in range(rng.choice([1, 1, 2, 5, 16])):
            if out:
                out[rng.randrange(len(out))] ^= 1 << rng.randrange(8)
        return bytes(out)
    if kind == "delete":
        return data[:at] + data[end:]
    if kind == "twice":
        return data[:end] + data[at:end] * rng.choice([1, 2, 50]) + data[end:]
    if kind == "cut":
        return data[:at]
    if kind == "insert":
        return data[:at] + rng.randbytes(rng.choice([1, 4, 100])) + data[at:]
    if kind == "swap":
        return data[end:] + data[at:end] + data[:at]
    return rng.choice([b"", b" ", b"\n", b"\0", b"{", b"\xef\xbb\xbf" + data, b"\xff\xfe" + data])


def mutated(name, data, rng):
    if name.endswith(".json"):
        if rng.random() < 0.7:
            return mutate_json(data.decode(), rng).encode("utf-8", "surrogatepass")
    elif rng.random() < 0.4:
        return mutate_number(data, rng)
    return mutate_bytes(data, rng)


# --- one run ----------------------------------------------------------------------------------------------------------

def bound():
    resource.setrlimit(resource.RLIMIT_AS, (ADDRESS_SPACE, ADDRESS_SPACE))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


# What a library says when nobody has said it better.
RAW = re.compile(r"^tutu: (std::|basic_string|vector|map::|stoi|bad |filesystem error|\[json|cannot create)", re.M)


class Shelf:
    """A copy of the files, for one run at a time; each run leaves it as it was."""

    def __init__(self, top, number, assets):
        self.folder = top / f"shelf-{number}"
        self.folder.mkdir()
        set_up(self.folder, assets)
        self.files = {p: p.stat().st_mtime_ns for p in self.folder.rglob("*") if p.is_file()}
        self.pristine = top / f"pristine-{number}"
        shutil.copytree(self.folder, self.pristine)

    def restore(self):
        for path in list(self.folder.rglob("*")):
            if (path.is_file() or path.is_symlink()) and path not in self.files:
                path.unlink()
        for path, time_then in self.files.items():
            if not path.is_file() or path.stat().st_mtime_ns != time_then:
                shutil.copyfile(self.pristine / path.relative_to(self.folder), path)
                os.utime(path, ns=(time_then, time_then))


class Mutant:
    """Number `n` of `seed`: what it is, then what came of it."""

    def __init__(self, shelf, program, seed, n):
        rng = random.Random(f"{seed}:{n}")
        self.n = n
        self.shelf = shelf
        self.name, scene, commands = rng.choice(cases(shelf.folder))
        file = shelf.folder / self.name
        file.write_bytes(mutated(self.name, file.read_bytes(), rng))
        target, self.renamed = self.name, None
        if scene == self.name or scene is None:
            if rng.random() < 0.1:  # the file itself is called something
                text = rng.choice([s for s in SHELL if "/" not in s and "\0" not in s and s != ".."])
                target = str(Path(self.name).parent / (text + Path(self.name).suffix))
                file.rename(shelf.folder / target)
                self.renamed = target
        command = [part.replace("{file}", target).replace("{}", target if scene == self.name else scene or "")
                   for part in rng.choice(commands)]
        self.command = [str(program)] + command
        self.changed = target

    def run(self):
        env = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
        start = time.monotonic()
        process = subprocess.Popen(self.command, cwd=self.shelf.folder, env=env, stdin=subprocess.DEVNULL,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True,
                                   preexec_fn=bound)
        timed_out = False
        try:
            _, err = process.communicate(timeout=SECONDS)
        except subprocess.TimeoutExpired:
            timed_out = True
            os.killpg(process.pid, signal.SIGKILL)
            _, err = process.communicate()
        self.seconds = time.monotonic() - start
        self.stderr = err.decode("utf-8", "replace")
        status = process.returncode
        self.status = "time-out" if timed_out else f"signal {-status}" if status < 0 else str(status)
        self.trouble = None
        if self.status not in ("0", "1", "2"):
            self.trouble = self.status
        elif self.status == "2" and not self.stderr.strip():
            self.trouble = "status 2 without a message"
        elif RAW.search(self.stderr):
            self.trouble = "a library's own message"
        elif any(p.name.startswith(TRAP) for p in self.shelf.folder.rglob("*")):
            self.trouble = "a name was run as a command"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=Path)
    parser.add_argument("assets", type=Path)
    parser.add_argument("count", type=int, nargs="?", default=2000)
    parser.add_argument("seed", type=int, nargs="?", default=1)
    parser.add_argument("--only", type=int, help="this mutant alone, with all it prints")
    parser.add_argument("--jobs", type=int, default=2, help="side by side")
    parser.add_argument("--keep", type=Path, default=Path("mutants"), help="folder for what went wrong")
    options = parser.parse_args()
    program, assets = options.program.resolve(), options.assets.resolve()
    numbers = [options.only] if options.only is not None else range(options.count)
    memory = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
    with tempfile.TemporaryDirectory(prefix="tutu-mutants-", dir=memory) as top:
        shelves = [Shelf(Path(top), k, assets) for k in range(max(1, options.jobs))]
        lock = threading.Lock()
        statuses, troubles, slowest = Counter(), [], 0.0

        def one(n):
            nonlocal slowest
            with lock:
                shelf = shelves.pop()
            try:
                mutant = Mutant(shelf, program, options.seed, n)
                mutant.run()
                with lock:
                    statuses[mutant.status] += 1
                    slowest = max(slowest, mutant.seconds)
                    if mutant.trouble:
                        troubles.append(mutant.trouble)
                        kept = options.keep / f"mutant-{options.seed}-{n}"
                        kept.mkdir(parents=True, exist_ok=True)
                        shutil.copyfile(shelf.folder / mutant.changed, kept / Path(mutant.name).name)
                        (kept / "told.txt").write_text(mutant.stderr)
                        print(f"mutant {n}: {mutant.trouble} after {mutant.seconds:.1f} s: {mutant.name} in "
                              f"{' '.join(map(repr, mutant.command[1:]))}\n  {mutant.stderr.strip()[-300:]}\n"
                              f"  again: {sys.argv[0]} {options.program} {options.assets} 1 {options.seed} --only {n}",
                              flush=True)
                    if options.only is not None:
                        print(mutant.command, mutant.status, mutant.stderr, sep="\n")
                    done = sum(statuses.values())
                    if done % 100 == 0:
                        print(f"{done} of {len(numbers)}: {dict(statuses)}, slowest {slowest:.1f} s", file=sys.stderr,
                              flush=True)
            finally:
                shelf.restore()
                with lock:
                    shelves.append(shelf)

        with concurrent.futures.ThreadPoolExecutor(max(1, options.jobs)) as pool:
            for future in [pool.submit(one, n) for n in numbers]:
                future.result()
    print(f"{sum(statuses.values())} mutants of seed {options.seed}: "
          + ", ".join(f"{count} x {status}" for status, count in sorted(statuses.items()))
          + f"; slowest {slowest:.1f} s; {len(troubles)} troubles")
    return 1 if troubles else 0


if __name__ == "__main__":
    sys.exit(main())
