#!/usr/bin/python3
"""Runs what stands in a page of the guide, block by block in a fresh folder, and holds what it prints against the page.

  tests/guide/guide.py COMMAND SOURCE PAGE.md           runs the blocks of a page, but for those that take minutes
  tests/guide/guide.py COMMAND SOURCE PAGE.md --slow    these as well
  tests/guide/guide.py COMMAND SOURCE PAGE.md --write   puts what is printed, and the pictures, into the page

In a page
  ```sh            is run by bash, with bernal on PATH and apps/, data/ and tests/ of the source at hand; words behind it:
                   exit=N it ends so; slow; needs=PROGRAM,… it is passed over where one is missing
  ```toml, ```csv, ```cmake, ```cpp  are written to the file that their first line names: # mine.toml, // mine.cpp
  ```python        is run after the Python blocks before it, in one process
  ```output        is what the block before it prints, on both streams; a line with … stands for any lines, … in a line
                   for anything, and times and sizes of memory are not compared
  <!-- picture: out/packing.svg --> before ![…](pictures/x.svg): that file, to the byte
"""

import argparse
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass, field

FENCE = re.compile(r"^```(\S*)(.*)$")
PICTURE = re.compile(r"^<!-- picture: (\S+) -->$")
SHOWN = re.compile(r"!\[[^\]]*\]\(([^)]+)\)")
VARYING = re.compile(r"\d[\d,.:]*(?:e[+-]?\d+)? ?(?:s|ms|µs|ns|min|h|kB|MB|GB|KiB|MiB|GiB)\b")

PYTHON_SESSION = """
import contextlib, io, json, sys, traceback
names = {"__name__": "__main__"}
for line in sys.stdin:
    out, failed = io.StringIO(), False
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(out):
        try:
            exec(compile(json.loads(line), "<block>", "exec"), names)
        except BaseException:
            failed = True
            traceback.print_exc()
    print(json.dumps([out.getvalue(), failed]), flush=True)
"""


@dataclass
class Block:
    language: str
    words: list
    first: int  # of its lines in the page
    lines: list = field(default_factory=list)

    def value(self, name, otherwise):
        return next((w.split("=", 1)[1] for w in self.words if w.startswith(name + "=")), otherwise)


def blocks_of(lines):
    blocks, open_block = [], None
    for number, line in enumerate(lines):
        fence = FENCE.match(line)
        if open_block is None and fence:
            open_block = Block(fence[1], fence[2].split(), number + 1)
        elif open_block is not None and line == "```":
            blocks.append(open_block)
            open_block = None
        elif open_block is not None:
            open_block.lines.append(line)
    if open_block is not None:
        raise SystemExit(f"line {open_block.first}: a block without an end")
    return blocks


PROGRESS = re.compile(r"^ {2,}\d+ s  \S")  # where no terminal is, every ten seconds


def masked(line):
    return VARYING.sub("#", line.rstrip())


def matches(shown, printed):
    """Whether lines are those that are shown, in which … stands for anything."""
    pattern = []
    for line in shown:
        if line.strip() == "…":
            pattern.append(r"(?:.*\n)*?")
        else:
            pattern.append(".*".join(re.escape(part) for part in masked(line).split("…")) + r"\n")
    return re.fullmatch("".join(pattern), "".join(masked(line) + "\n" for line in printed)) is not None


def kept_as_shown(shown, printed):
    """What is printed, with the places left out that the page leaves out."""
    if "…" not in "".join(shown):
        return printed
    kept, rest = [], list(printed)
    for index, line in enumerate(shown):
        if line.strip() == "…":
            kept.append(line)
            following = next((s for s in shown[index + 1:]), None)
            key = following.split("…")[0][:12] if following else None
            while rest and (key is None or not rest[0].startswith(key)):
                rest.pop(0)
        elif rest:
            new = rest.pop(0)
            kept.append(line if "…" in line and matches([line], [new]) else new)
    return kept


class Page:
    def __init__(self, command, source, file, slow, write):
        self.command, self.source, self.file, self.slow, self.write = command, source, file, slow, write
        self.lines = file.read_text().split("\n")
        self.problems, self.passed_over, self.replacements, self.session = [], [], [], None

    def problem(self, block, text):
        self.problems.append(f"{self.file}:{block.first}: {text}")

    def run(self, folder):
        for name in ("apps", "data", "tests"):
            (folder / name).symlink_to(self.source / name)
        environment = os.environ | {
            "PATH": f"{self.command.parent}:/usr/bin:{os.environ['PATH']}",  # Debian's before others
            "COLUMNS": "100",
            "PYTHONPATH": f"{self.command.parent}/python", "SOURCE_DATE_EPOCH": "0"}
        printed, before = None, None
        for block in blocks_of(self.lines):
            if block.language in ("sh", "python"):
                printed, before = self.run_block(block, folder, environment), block
            elif block.language == "output":
                if before is None:
                    self.problem(block, "nothing is run before this output")
                elif printed is not None:
                    self.compare(block, before, printed)
            elif block.language in ("toml", "csv", "cmake", "cpp"):
                self.write_file(block, folder)
            elif block.language not in ("text", "json"):
                self.problem(block, f"a block of \"{block.language}\" is not run; sh, toml, csv, cmake, cpp, python, output or text")
        self.compare_pictures(folder)
        if self.session:
            self.session.stdin.close()
            self.session.wait()

    def run_block(self, block, folder, environment):
        """What it prints; nothing where it is passed over."""
        needed = [name for name in block.value("needs", "").split(",") if name]
        if any(not self.has(name, environment) for name in needed) or ("slow" in block.words and not self.slow):
            self.passed_over.append(block)
            return None
        text = "\n".join(block.lines)
        if block.language == "python":
            return self.run_python(block, text, folder, environment)
        done = subprocess.run(["bash", "-euo", "pipefail", "-c", text], cwd=folder, env=environment, text=True,
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        if done.returncode != int(block.value("exit", "0")):
            self.problem(block, f"ended with {done.returncode}:\n{done.stdout}")
        return [line for line in done.stdout.splitlines() if not PROGRESS.match(line)]

    @staticmethod
    def has(name, environment):
        if name.startswith("python:"):
            return subprocess.run([sys.executable, "-c", f"import {name[7:]}"], env=environment,
                                  capture_output=True).returncode == 0
        return shutil.which(name, path=environment["PATH"]) is not None

    def run_python(self, block, text, folder, environment):
        if self.session is None:
            self.session = subprocess.Popen([sys.executable, "-c", PYTHON_SESSION], cwd=folder, env=environment,
                                            text=True, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self.session.stdin.write(json.dumps(text) + "\n")
        self.session.stdin.flush()
        printed, failed = json.loads(self.session.stdout.readline())
        if failed:
            self.problem(block, f"failed:\n{printed}")
        return printed.splitlines()

    def write_file(self, block, folder):
        name = re.sub("^(#|//) ", "", block.lines[0]) if block.lines else ""
        if not re.fullmatch(r"(\w+/)?[\w.-]+\.\w+", name):
            return self.problem(block, "the first line must name the file: # mine.toml")
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text("\n".join(block.lines) + "\n")

    def compare(self, block, before, printed):
        if matches(block.lines, printed):
            return
        if self.write:
            self.replacements.append((block, kept_as_shown(block.lines, printed)))
        else:
            self.problem(block, "the block before it prints\n" + "\n".join(printed))

    def compare_pictures(self, folder):
        for number, line in enumerate(self.lines):
            found = PICTURE.match(line)
            if not found:
                continue
            made = folder / found[1]
            shown = self.file.parent / SHOWN.search(self.lines[number + 1])[1]
            if not made.exists() and self.is_passed_over(pathlib.Path(found[1])):
                continue
            if self.write:
                shutil.copy(made, shown)
            elif not made.exists() or not shown.exists() or made.read_bytes() != shown.read_bytes():
                self.problems.append(f"{self.file}:{number + 1}: {shown} is not what is made here")

    def is_passed_over(self, made):
        """Whether a block that was passed over names the picture, or the folder in which it appears."""
        return any(str(made) in line or str(made.parent) in line
                   for block in self.passed_over for line in block.lines)

    def rewrite(self):
        for block, printed in reversed(self.replacements):
            self.lines[block.first:block.first + len(block.lines)] = printed
        if self.replacements:
            self.file.write_text("\n".join(self.lines))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command", type=lambda p: pathlib.Path(p).resolve())
    parser.add_argument("source", type=lambda p: pathlib.Path(p).resolve())
    parser.add_argument("pages", nargs="+", type=pathlib.Path)
    parser.add_argument("--slow", action="store_true")
    parser.add_argument("--write", action="store_true")
    call = parser.parse_args()
    failed = False
    for file in call.pages:
        page = Page(call.command, call.source, file, call.slow, call.write)
        with tempfile.TemporaryDirectory(prefix="bernal-guide-") as folder:
            page.run(pathlib.Path(folder))
        page.rewrite()
        print("\n".join(page.problems) or f"{file}: as it stands there" +
              (f"; {len(page.passed_over)} blocks passed over" if page.passed_over else ""))
        failed |= bool(page.problems)
    sys.exit(failed)


if __name__ == "__main__":
    main()
