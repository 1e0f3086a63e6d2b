"""What the tests of papers share."""

import csv
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(SOURCE / "data/papers")]

try:
    import matplotlib  # noqa: F401
except ImportError:
    print("skipped: matplotlib is not installed, see cmake/papers-packages.txt")
    raise SystemExit(0) from None


def reproduce(*words, **keys):
    return subprocess.run([SOURCE / "apps/reproduce", *map(str, words)], capture_output=True, text=True, **keys)


class Paper(unittest.TestCase):
    """Runs scripts into a folder of its own."""

    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="bernal-test-"))
        self.addCleanup(shutil.rmtree, self.folder)

    def made(self, name, *words, page=None):
        """Runs it, and returns its page."""
        ended = reproduce(name, "-o", self.folder, *words)
        self.assertEqual(ended.returncode, 0, ended.stderr)
        written = [Path(line) for line in ended.stdout.splitlines()]
        self.assertEqual(set(written), set(self.folder.iterdir()))
        self.page = (self.folder / f"{page or name}.md").read_text()
        linked = set(re.findall(r"\]\(([^)]+)\)", self.page))
        self.assertTrue(linked)
        self.assertLessEqual(linked, {file.name for file in written})
        for file in written:
            text = file.read_text()
            self.assertNotIn("nan", re.findall(r"[a-z]+", text) if file.suffix != ".svg" else (), file)
            if file.suffix == ".svg":
                self.assertIn("<svg ", text, file)
                self.assertTrue(text.endswith("</svg>\n"), file)
        return self.page

    def row(self, beginning):
        """The cells of the row of a table in the page that begins so."""
        line = next((line for line in self.page.splitlines() if line.startswith(f"| {beginning}")), None)
        self.assertIsNotNone(line, beginning)
        return [cell.strip() for cell in line.strip("|").split("|")]

    def lines(self, name):
        with open(self.folder / name) as file:
            return list(csv.DictReader(file))
