#!/usr/bin/env python3
"""tests/everything with parts that only pretend: `everything_test.py SOURCE BUILD`."""
import importlib.machinery
import importlib.util
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from contextlib import redirect_stderr, redirect_stdout
from io import StringIO

SOURCE, BUILD = (pathlib.Path(argument) for argument in sys.argv[1:3])

sys.dont_write_bytecode = True
loader = importlib.machinery.SourceFileLoader("everything", str(SOURCE / "tests" / "everything"))
everything = importlib.util.module_from_spec(importlib.util.spec_from_loader("everything", loader))
sys.modules["everything"] = everything
loader.exec_module(everything)
Part = everything.Part


@unittest.skipUnless(shutil.which("git"), "git is not installed")
class OfATree(unittest.TestCase):
    """A tree of two files, and parts that count how often they were run, outside of it."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name, "tree")
        self.counts = pathlib.Path(folder.name, "counts")
        self.root.mkdir()
        self.git("init", "--quiet")
        self.commit(**{".gitignore": "/build/\n", "code": "1", "words": "1"})
        count = f"echo -n . >>{self.counts}-"
        self.parts = [
            Part("good", count + "good", "reads all"),
            Part("bad", count + "bad; echo '\t 12 - unit/That (Failed)'; exit 8", "fails"),
            Part("left", count + "left; echo [--install]; exit 77", "cannot be tried here"),
            *everything.pieces(2, Part("cut", count + "cut; echo", "reads code", ("code",))),
        ]

    def git(self, *arguments):
        subprocess.run(["git", "-C", self.root, "-c", "user.name=n", "-c", "user.email=e", *arguments], check=True,
                       stdout=subprocess.DEVNULL)

    def commit(self, **files):
        for name, text in files.items():
            (self.root / name).write_text(text)
        self.git("add", "--all")
        self.git("commit", "--quiet", "--message=change")

    def run_parts(self, *arguments):
        out, err = StringIO(), StringIO()
        with redirect_stdout(out), redirect_stderr(err):
            code = everything.main(list(arguments), self.parts, self.root)
        return code, out.getvalue(), err.getvalue()

    def ran(self, part):
        file = pathlib.Path(f"{self.counts}-{part}")
        return len(file.read_text()) if file.exists() else 0

    def test_a_part_that_fails_ends_nothing_and_each_has_its_row(self):
        code, out, _ = self.run_parts()
        self.assertEqual(code, 1)
        table = (self.root / "build/everything/table.md").read_text()
        self.assertTrue(out.endswith(table))
        for row in (r"good .* passed", r"bad .* failed with exit code 8; failed: unit/That", r"left .* skipped",
                    r"cut/1 .* passed", r"cut/2 .* passed"):
            self.assertRegex(table, rf"(?m)^\| {row} \|")
        log = self.root / "build/everything/logs/cut-2.log"
        self.assertEqual(log.read_text(), "-I 2,,2\n")
        log = self.root / "build/everything/logs/left.log"
        self.assertEqual(log.read_text(), "\n")
        self.run_parts("--install", "left")
        self.assertEqual(log.read_text(), "--install\n")

    def test_what_has_passed_stands_until_what_it_reads_is_changed(self):
        self.run_parts()
        self.run_parts()
        self.assertEqual([self.ran(part) for part in ("good", "bad", "left", "cut")], [1, 2, 2, 2])
        self.commit(words="2")
        self.run_parts("good", "cut")
        self.assertEqual((self.ran("good"), self.ran("cut")), (2, 2))
        self.commit(code="2")
        _, out, _ = self.run_parts("good")
        self.assertRegex(out, r"(?m)^\| cut/1 \| \| \| not run on this tree; passed at [0-9a-f]{8} \|")
        self.run_parts("cut")
        self.assertEqual((self.ran("good"), self.ran("cut")), (3, 4))
        self.commit(code="1", words="1")
        self.assertEqual(self.run_parts("good", "cut")[0], 0)  # known from before
        self.assertEqual((self.ran("good"), self.ran("cut")), (3, 4))
        self.run_parts("--again", "cut/2")
        self.assertEqual(self.ran("cut"), 5)

    def test_only_what_is_committed_counts(self):
        (self.root / "code").write_text("changed")
        code, _, err = self.run_parts("good")
        self.assertEqual((code, self.ran("good")), (2, 0))
        self.assertIn("not committed", err)
        self.commit()
        self.parts.append(Part("changes", "echo >>code", "changes what it reads"))
        code, out, _ = self.run_parts("changes")
        self.assertEqual(code, 1)
        self.assertIn("does not count", out)

    def test_lists_and_refuses(self):
        code, out, _ = self.run_parts("--list")
        self.assertEqual((code, len(out.splitlines()), self.ran("good")), (0, len(self.parts), 0))
        self.assertEqual(self.run_parts("godo")[0], 2)

    def test_names_tests_that_were_left_out(self):
        self.parts = [Part("some", "printf ' 1/2 Test #1: a/b ... Passed\\n\\t 2 - a/c (Skipped)\\n'", ""),
                      Part("none", "printf '\\t 1 - a/b (Skipped)\\n'", "")]
        self.assertEqual(self.run_parts()[0], 1)
        table = (self.root / "build/everything/table.md").read_text()
        self.assertIn("| passed; skipped: a/c |", table)
        self.assertIn("| skipped: a/b |", table)


@unittest.skipUnless((SOURCE / ".git").exists(), "no clone")
class OfThisTree(unittest.TestCase):
    def test_every_label_is_among_the_presets_tests_or_a_part(self):
        presets = json.loads((SOURCE / "CMakePresets.json").read_text())["testPresets"]
        left_out = next(preset for preset in presets if preset["name"] == "base")["filter"]["exclude"]["label"]
        tests = json.loads(subprocess.run(["ctest", "--test-dir", BUILD, "--show-only=json-v1"], check=True,
                                          capture_output=True, text=True).stdout)["tests"]
        labels = {label for test in tests for each in test.get("properties", []) if each["name"] == "LABELS"
                  for label in each["value"]}
        self.assertIn("slow", labels)
        in_parts = {label for part in everything.PARTS for label in part.labels}
        self.assertEqual({label for label in labels if re.search(left_out, label)}, in_parts)

    def test_every_script_that_users_start_is_in_a_part(self):
        files = subprocess.run(["git", "-C", SOURCE, "ls-files", "--stage", "apps/*", "cmake/*", "tests/*"], check=True,
                               capture_output=True, text=True).stdout
        scripts = {match[1] for match in re.finditer(
            r"^100755 .*\t((?:apps|cmake|tests)/[^/\n]+|tests/[^/\n]+/run)$", files, re.M)}
        commands = " ".join(part.command for part in everything.PARTS).split()
        elsewhere = {"apps/reproduce",                                        # tests/papers
                     "cmake/install-debian-packages", "cmake/package",        # tests/run
                     "cmake/release",                                         # tests/packages/run --release
                     "tests/everything"}
        self.assertEqual(scripts - set(commands) - elsewhere, set())
        self.assertEqual(elsewhere - scripts, set())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
