"""What the documents name exists: links and anchors, paths of the checkout, commands and their options.

    python3 tests/house/check_docs.py CHECKOUT [PROGRAM]
    python3 tests/house/check_docs.py --self-test

Looked at are all *.md of the checkout but those in build/ and .git/. CHANGELOG.md speaks of the past: only its links count.
With PROGRAM (a built tutu) options are looked up in `PROGRAM SUBCOMMAND --help`; without it only subcommands are, in
src/commands. Prints a line a fault and one of counts; the exit status is 1 with a fault, or when nothing was checked.
"""
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile
import urllib.parse

MOST_README_LINES = 200
SKIPPED_FOLDERS = {"build", ".git"}
PATH_STARTS = ("rig/", "proxies/", "cloth/", "src/", "tests/", "assets/", "cmake/")
ROOT_FILES = {"bootstrap", "./bootstrap", "CMakeLists.txt", ".ci/run"}
PROGRAMS = {"tutu", "build/release/tutu", "tutu-cell", "build/release/tutu-cell"}
OWN_OF_BOOTSTRAP = {"test"}  # what it takes besides the subcommands of the program

LINK = re.compile(r"\]\(\s*(?:<([^>]*)>|([^()\s]*))(?:\s+\"[^\"]*\")?\s*\)")
REFERENCE = re.compile(r"^ {0,3}\[[^\]]+\]:\s*(\S+)", re.M)
TAG = re.compile(r"<(?:img|a)\b[^>]*?\b(?:src|href)=[\"']([^\"']*)[\"']")
SPAN = re.compile(r"(?<!`)(`+)(?!`)((?:[^\n]|\n(?!\s*\n))+?)(?<!`)\1(?!`)")
FENCE = re.compile(r"^ {0,3}(```+|~~~+)")
HEADING = re.compile(r"^ {0,3}#{1,6}\s+(.*?)(?:\s+#+)?\s*$")
OPTION = re.compile(r"^(--?[A-Za-z][\w-]*)(?:=.*)?$", re.S)
PLACEHOLDER = re.compile(r"<[^>]*>|(?<![A-Za-z])(?!README|CHANGELOG|LICENSE)[A-Z][A-Z_]+(?![A-Za-z])|…|\.\.\.")


class Document:
    """A Markdown file taken apart: `prose` has the text with all code blanked out, line for line."""

    def __init__(self, file):
        self.file = file
        self.lines = file.read_text(encoding="utf-8").splitlines()
        self.headings = []  # the anchors
        self.blocks = []  # (line, text): lines of code blocks, those that end in a backslash joined
        self.spans = []  # (line, text): what stands in backticks
        outside = self._split_off_blocks()
        text = "\n".join(outside)

        def blank(match):
            self.spans.append((text.count("\n", 0, match.start()) + 1, " ".join(match[2].split())))
            return re.sub(r"[^\n]", " ", match[0])

        self.prose = SPAN.sub(blank, text)

    def _split_off_blocks(self):
        """The lines without code blocks; these, and the headings, are kept."""
        outside, seen = [], {}
        fence, indented, begun = "", False, None
        for number, line in enumerate(self.lines, 1):
            mark = FENCE.match(line)
            blank_before = number == 1 or not self.lines[number - 2].strip()
            indented = not fence and bool(re.match(r"(?: {4}|\t)\s*\S", line)) and (indented or blank_before)
            is_code = indented or bool(fence and not mark)
            if is_code:
                first, before = begun or (number, "")
                begun = (first, (before + " " + line.strip().removesuffix("\\")).strip())
            if begun and not (is_code and line.endswith("\\")):
                self.blocks.append(begun)
                begun = None
            if mark and not (fence and not mark[1].startswith(fence)):
                fence = "" if fence else mark[1]
            heading = None if is_code or mark else HEADING.match(line)
            if heading:
                slug = slug_of(heading[1])
                seen[slug] = seen.get(slug, -1) + 1
                self.headings.append(f"{slug}-{seen[slug]}" if seen[slug] else slug)
            outside.append("" if is_code or mark else line)
        self.blocks += [begun] if begun else []
        return outside

    def links(self):
        for pattern in (LINK, REFERENCE, TAG):
            for match in pattern.finditer(self.prose):
                target = next((group for group in match.groups() if group is not None), "")
                yield self.prose.count("\n", 0, match.start()) + 1, target

    def code(self):
        return sorted(self.blocks + self.spans)


def slug_of(heading):
    """The anchor of a heading, as GitHub makes it."""
    heading = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", heading)
    return re.sub(r"[^\w\- ]", "", heading.lower()).strip().replace(" ", "-")


def words_of(text):
    """The words of a command line; a comment behind it is left out."""
    try:
        return shlex.split(text, comments=True)
    except ValueError:  # a quotation mark that is not closed
        return re.sub(r"(^|\s)#.*", "", text).split()


class Program:
    """The subcommands and options of a built program; without one, the subcommands that the sources have."""

    def __init__(self, checkout, program):
        self.program = program
        self.helps = {}
        sources = sorted((checkout / "src" / "commands").glob("*.cpp"))
        self.subcommands = {name for file in sources
                            for name in re.findall(r"add_subcommand\(\s*\"([\w-]+)\"", file.read_text(encoding="utf-8"))}
        if program:
            listed = self._say([]).partition("Subcommands:")[2]
            self.subcommands = set(re.findall(r"^  ([\w-]+)", listed, re.M))

    def _say(self, words):
        told = subprocess.run([self.program, *words, "--help"], capture_output=True, text=True, timeout=120, check=False)
        if told.returncode:
            raise RuntimeError(f"{' '.join([str(self.program), *words])} --help: exit status {told.returncode}")
        return told.stdout

    def options(self, subcommand):
        """Those of a subcommand ("": of the program itself); None when nobody can tell."""
        if not self.program:
            return None
        if subcommand not in self.helps:
            text = self._say([subcommand] if subcommand else [])
            self.helps[subcommand] = set(re.findall(r"(?<![\w-])--?[A-Za-z][\w-]*", text))
        return self.helps[subcommand]

    def all_options(self):
        return set().union(*(self.options(name) for name in ["", *self.subcommands]))


class Checker:
    def __init__(self, checkout, program=None):
        self.checkout = checkout.resolve()
        self.program = Program(self.checkout, program)
        self.documents = {}
        self.faults = []
        self.links = self.paths = self.commands = 0

    def fault(self, document, line, message):
        self.faults.append(f"{document.file.relative_to(self.checkout)}:{line}: {message}")

    def document(self, file):
        if file not in self.documents:
            self.documents[file] = Document(file)
        return self.documents[file]

    def run(self):
        for folder, folders, files in os.walk(self.checkout):
            folders[:] = sorted(set(folders) - SKIPPED_FOLDERS)
            for name in sorted(files):
                if name.endswith(".md"):
                    self.check(self.document(pathlib.Path(folder) / name))

    def check(self, document):
        for line, target in document.links():
            self.check_link(document, line, target)
        if document.file.name == "CHANGELOG.md":
            return
        for line, text in document.code():
            words = words_of(text)
            self.check_paths(document, line, words)
            self.check_command(document, line, words)
        if document.file == self.checkout / "README.md" and len(document.lines) > MOST_README_LINES:
            self.fault(document, MOST_README_LINES + 1, f"{len(document.lines)} lines, at most {MOST_README_LINES}")

    def check_link(self, document, line, target):
        if re.match(r"[a-z][a-z0-9+.-]*:", target, re.I):
            return
        self.links += 1
        name, _, anchor = target.partition("#")
        file = (document.file.parent / urllib.parse.unquote(name)).resolve() if name else document.file
        if not target:
            self.fault(document, line, "a link to nowhere")
        elif not file.is_relative_to(self.checkout):
            self.fault(document, line, f"{target} is outside of the checkout")
        elif not file.exists():
            self.fault(document, line, f"no file {target}")
        elif anchor and (file.suffix != ".md" or anchor not in self.document(file).headings):
            self.fault(document, line, f"no heading #{anchor} in {name or document.file.name}")

    def check_paths(self, document, line, words):
        for word in words:
            word = re.sub(r":\d+$", "", word.strip("()[]\"'").rstrip(".,;:"))
            if not word.startswith(PATH_STARTS) and word not in ROOT_FILES:
                continue
            self.paths += 1
            missing = [path for path in braces_opened(word) if not self.exists(path)]
            if missing:
                self.fault(document, line, f"no path {', '.join(missing)}")

    def exists(self, path):
        if (self.checkout / path).exists():
            return True
        pattern = PLACEHOLDER.sub("*", path)
        return bool(re.search(r"[*?\[]", pattern)) and any(self.checkout.glob(pattern))

    def check_command(self, document, line, words):
        while words and re.match(r"[A-Za-z_]\w*=", words[0]):  # a variable of the environment
            words = words[1:]
        if not words:
            return
        if OPTION.match(words[0]) and len(words) == 1:
            self.check_lone_option(document, line, OPTION.match(words[0])[1])
            return
        if words[0] not in PROGRAMS | {"./bootstrap"} or len(words) == 1:
            return
        subcommand, rest = words[1], words[2:]
        if OPTION.match(subcommand):
            subcommand, rest = "", words[1:]
        elif PLACEHOLDER.fullmatch(subcommand.strip("[]")):
            return
        elif not re.fullmatch(r"[a-z][\w-]*", subcommand):  # a version number, a word of a sentence
            return
        self.commands += 1
        if words[0] == "./bootstrap" and subcommand in OWN_OF_BOOTSTRAP:
            return
        if subcommand and subcommand not in self.program.subcommands:
            self.fault(document, line, f"no command {words[0]} {subcommand}")
            return
        known = self.program.options(subcommand)
        for match in filter(None, (OPTION.match(word.strip("[]()")) for word in rest)):
            if known is not None and match[1] not in known:
                self.fault(document, line, f"{' '.join(words[:2])} has no option {match[1]}")

    def check_lone_option(self, document, line, option):
        """One that stands by itself in backticks is one of some subcommand."""
        if not option.startswith("--") or not self.program.program:
            return
        self.commands += 1
        if option not in self.program.all_options():
            self.fault(document, line, f"no command has an option {option}")

    def counts(self):
        return f"{self.links} links, {self.paths} paths, {self.commands} commands checked"

    def status(self):
        return int(bool(self.faults) or self.links + self.paths + self.commands == 0)


def braces_opened(path):
    """a.{h,cpp} -> a.h, a.cpp"""
    match = re.search(r"\{([^{}]*,[^{}]*)\}", path)
    if not match:
        return [path]
    return [one for part in match[1].split(",")
            for one in braces_opened(path[:match.start()] + part + path[match.end():])]


# ---- the check, checked

GOOD = """\
# A title

See [the rig](rig/README.md#the-end-of-it), [below](#a-title-1), ![](assets/a.png) and [outside](https://example.org/x).

    build/release/tutu play --at 0,120 \\
      --size 8x8 -o assets                # not --here
    ./bootstrap test
    ./bootstrap play --at 3

`tutu play --why skirt:1@2`, `tutu --version`, `tutu SUBCOMMAND`, `tutu` and `--size`; `rig/skin.{h,cpp}`, `rig/*.h`,
`rig/NAME.h`, `rig/`, `bootstrap`, `rig/skin.h:12`. A span may
go `tutu play
--at 1` on.

```
tutu play --at 4
```

# A title
"""

# Line by line what is wrong with it, and what is said of that.
BAD = """\
# Bad
[a](none.md)
![a](assets/none.png)
[a](rig/README.md#none)
[a](#none)
[a](/etc/passwd)
[a]()
<img src="assets/gone.png">
`rig/gone.h`
`rig/skin.{h,hpp}`
`gone/NAME.h`, `rig/gone/NAME.h`
`tests/*.none`
`tutu stray`
`tutu play --stray`
`--alone`
`tutu --stray`
`build/release/tutu stray --at 1`

    tutu play --at 1 \\
      --lost 2
    ./bootstrap stray
    X=1 tutu play --astray=1
    assets/lost.json

[a]: rig/lost.md
"""
BAD_FAULTS = {
    2: ["no file none.md"],
    3: ["no file assets/none.png"],
    4: ["no heading #none in rig/README.md"],
    5: ["no heading #none in README.md"],
    6: ["/etc/passwd is outside of the checkout"],
    7: ["a link to nowhere"],
    8: ["no file assets/gone.png"],
    9: ["no path rig/gone.h"],
    10: ["no path rig/skin.hpp"],
    11: ["no path rig/gone/NAME.h"],
    12: ["no path tests/*.none"],
    13: ["no command tutu stray"],
    14: ["tutu play has no option --stray"],
    15: ["no command has an option --alone"],
    16: ["tutu --stray has no option --stray"],
    17: ["no command build/release/tutu stray"],
    19: ["tutu play has no option --lost"],
    21: ["no command ./bootstrap stray"],
    22: ["tutu play has no option --astray"],
    23: ["no path assets/lost.json"],
    25: ["no file rig/lost.md"],
}
PROGRAM = """\
#!/bin/sh
case "$1" in
  play) echo "Usage: tutu play
  -h,--help
  --at INT
  --size TEXT
  --why TEXT
  -o,--out TEXT" ;;
  *) echo "Options:
  -h,--help
  --version

Subcommands:
  play                        Play it" ;;
esac
"""


def self_test():
    """Shows that each fault is seen, and that what is right is let through."""
    wrong = []

    def expect(what, found, expected):
        if found != expected:
            wrong.append(f"{what}:\n  found    {found}\n  expected {expected}")

    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder).resolve()
        files = {"README.md": GOOD, "CHANGELOG.md": "`tutu past --gone` in `rig/past.h`\n", "assets/a.png": "",
                 "rig/README.md": "# The *end* of `it`\n", "rig/skin.h": "", "rig/skin.cpp": "", "bootstrap": "",
                 "build/x.md": "[a](none)\n", "tutu": PROGRAM,
                 "src/commands/play.cpp": 'app.add_subcommand("play", "Play it");\n'}
        for name, text in files.items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(text, encoding="utf-8")
        (root / "tutu").chmod(0o755)

        def faults_of(readme, program=root / "tutu", changes=files["CHANGELOG.md"]):
            (root / "README.md").write_text(readme, encoding="utf-8")
            (root / "CHANGELOG.md").write_text(changes, encoding="utf-8")
            checker = Checker(root, program)
            checker.run()
            return checker

        good = faults_of(GOOD)
        expect("a good document", good.faults, [])
        expect("its counts", good.counts(), "3 links, 8 paths, 8 commands checked")
        expect("its status", good.status(), 0)
        bad = faults_of(BAD)
        expect("a bad document", sorted(bad.faults),
               sorted(f"README.md:{line}: {text}" for line, texts in BAD_FAULTS.items() for text in texts))
        expect("its status", bad.status(), 1)
        expect("without a program", faults_of("`tutu play --stray`\n`tutu stray`\n", None).faults,
               ["README.md:2: no command tutu stray"])
        expect("a link in the changes", faults_of("", changes="[a](gone.md)\n").faults,
               ["CHANGELOG.md:1: no file gone.md"])
        expect("a long README", faults_of("[a](#)\n" * (MOST_README_LINES + 1)).faults,
               [f"README.md:201: {MOST_README_LINES + 1} lines, at most {MOST_README_LINES}"])
        expect("one that is just not too long", faults_of("[a](#)\n" * MOST_README_LINES).faults, [])
        (root / "rig" / "README.md").unlink()
        expect("nothing to check", faults_of("Words.\n").status(), 1)
    print(*wrong, "the check fails its own test" if wrong else "the check sees what it should", sep="\n")
    return int(bool(wrong))


def main(arguments):
    if arguments == ["--self-test"]:
        return self_test()
    if len(arguments) not in (1, 2) or not pathlib.Path(arguments[0]).is_dir():
        print(__doc__, file=sys.stderr)
        return 2
    if len(arguments) == 2 and not os.access(arguments[1], os.X_OK):
        print(f"check_docs.py: no program {arguments[1]}", file=sys.stderr)
        return 2
    try:
        checker = Checker(pathlib.Path(arguments[0]), *(pathlib.Path(program).resolve() for program in arguments[1:]))
        checker.run()
    except (OSError, RuntimeError, subprocess.TimeoutExpired) as error:
        print(f"check_docs.py: {error}", file=sys.stderr)
        return 2
    print(*checker.faults, checker.counts(), sep="\n")
    return checker.status()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
