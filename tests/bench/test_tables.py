#!/usr/bin/env python3
"""The commands that make the tables of what methods, effects and arithmetic cost, at their smallest size. Times are not
asserted."""

import csv
import math
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

try:
    import matplotlib  # noqa: F401
except ImportError:
    print("skipped: matplotlib is not installed, see cmake/papers-packages.txt")
    raise SystemExit(0) from None

HERE = Path(__file__).resolve().parent
ARITHMETIC = Path(os.environ["BERNAL_BUILD"]) / "bernal_arithmetic"
COMMAND = Path(os.environ["BERNAL_BUILD"]) / "bernal"


class Table(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="bernal-test-"))
        self.addCleanup(shutil.rmtree, self.folder)

    def made(self, name, *words):
        """Runs the command, and returns the lines of its CSV."""
        ended = subprocess.run([HERE / name, "-o", self.folder, *map(str, words)], capture_output=True, text=True)
        self.assertEqual(ended.returncode, 0, ended.stderr)
        for file in ended.stdout.split():
            self.assertEqual(Path(file).parent, self.folder)
        self.page = (self.folder / f"{name}.md").read_text()
        with open(self.folder / f"{name}.csv") as file:
            return list(csv.DictReader(file))


class Methods(Table):
    def test_every_method_has_an_upward_ladder_of_two_seeds(self):
        """More sweeps, slower growth, more refilling: what costs more time is there because it packs denser."""
        phi, seeds, core = {}, {}, []
        for line in self.made("methods", "--spheres", 100, "--sizes", "equal"):
            method = line["walls"], line["method"]
            self.assertNotEqual(line["outcome"], "cut_off", method)
            reached = float(line["packing_fraction"])
            self.assertLess(reached, math.pi / math.sqrt(18), "equal spheres are never denser")
            self.assertEqual(line["walls"] == "lids", line["core_packing_fraction"] != "", method)
            if line["walls"] == "lids":
                core.append(float(line["core_packing_fraction"]) - reached)
            seeds.setdefault(method, set()).add(line["seed"])
            values = phi.setdefault(method, {})
            values[float(line["value"])] = values.get(float(line["value"]), 0) + 0.5 * reached
        self.assertEqual(len(phi), 11, "with the filling by classes, which is for wide sizes, they are twelve")
        picture = (self.folder / "methods_equal.svg").read_text()
        for method, values in phi.items():
            self.assertGreaterEqual(len(values), 3, method)
            self.assertEqual(seeds[method], {"1", "2"}, method)
            self.assertIn(method[1], picture)
            first, last = values[min(values)], values[max(values)]
            if method[1] == "growth":  # where a smaller rate is the slower
                first, last = last, first
            self.assertGreater(last, first, method)
        self.assertGreater(sum(core) / len(core), 0, "the spheres beside the walls pack loosely")
        self.assertIn("Without walls: densest by", self.page)


class Effects(Table):
    def test_every_pair_is_there_with_its_ratio(self):
        lines = self.made("effects", "--spheres", 100)
        self.assertGreaterEqual(len(lines), 12)
        gain = {line["effect"]: float(line["gain"]) for line in lines}
        self.assertEqual(len(gain), len(lines), "no effect has two lines")
        picture = (self.folder / "effects.svg").read_text()
        for line in lines:
            self.assertGreater(float(line["seconds_with"]), 0, line)
            self.assertGreater(float(line["time_ratio"]), 0, line)
            self.assertNotEqual(line["with"], line["without"])
            self.assertIn(f"| {line['effect']} |", self.page)
            self.assertIn(line["effect"], picture)
        # What no seed can turn round, at any number of spheres.
        self.assertGreater(gain["refilling"], 0.05)
        self.assertLess(gain["side walls"], 0)
        self.assertLess(gain["a floor and a lid"], 0)
        self.assertRegex(self.page, r"contacts are closed to a gap ratio of 1e-0[6-9] instead of")


class Arithmetic(Table):
    def test_filtered_is_exact_and_errors_are_below_their_bounds(self):
        lines = self.made("arithmetic", "--decisions", 6000, "--largest", 100, "--diameter", 2,
                          "--program", ARITHMETIC, "--command", COMMAND)  # fmt: skip
        self.assertEqual(len({line["decision"] for line in lines}), 6)
        self.assertEqual({line["container"] for line in lines}, {"", "box", "cylinder", "sphere", "mesh 1e2", "cone", "tube",
                                                                "hopper"})
        wrong = 0
        for line in lines:
            self.assertGreaterEqual(int(line["decisions"]), 1 if line["decision"] == "certificate" else 40)
            self.assertGreater(float(line["ns"]), 0)
            if line["arithmetic"] == "filtered":
                self.assertEqual(line["differ_from_exact"], "0", line)
            if line["arithmetic"] == "double":
                wrong += int(line["differ_from_exact"])
            if line["worst_error"] and line["bound"]:
                self.assertLessEqual(float(line["worst_error"]), float(line["bound"]), line)
        self.assertGreater(wrong, 50, "near ties doubles err")
        self.assertIn("`filtered` differs from `exact` in 0,", self.page)
        self.assertIn("every error is within its bound", self.page)
        costs = self.page[self.page.index("## Whole packings"):]
        for shape in ("cylinder", "cone", "tube", "revolved", "extruded"):
            self.assertRegex(costs, rf"\| {shape} \|.* yes \|")

    def test_refuses_what_is_no_number(self):
        self.assertEqual(subprocess.run([ARITHMETIC, "many", "1"], capture_output=True).returncode, 2)


@unittest.skipUnless(shutil.which("tetgen"), "tetgen is not installed")
class Meshes(Table):
    def table_of(self, contact):
        words = ["--beads", "12", "--beds", "column5", "--contacts", contact, "--regions", "fluid", "-o", self.folder]
        subprocess.run([HERE / "meshes_table", COMMAND, *words], check=True, stderr=subprocess.DEVNULL)
        with open(self.folder / "meshes.csv") as file:
            return list(csv.DictReader(file))

    def test_rows_that_are_there_are_kept(self):
        (first,) = self.table_of("gap")
        self.assertEqual((first["beads"], first["in_bed"], first["failure"]), ("12", "12", ""))
        self.assertGreater(float(first["least_sicn"]), 0)
        self.assertGreater(int(first["memory_bytes"]), 10**6)
        self.assertLess(abs(float(first["porosity"]) - float(first["meshed_porosity"])), 0.02)
        second, kept = self.table_of("bridge")
        self.assertEqual((second["contact"], kept), ("bridge", first))
        self.assertEqual((self.folder / "meshes.md").read_text().count("\n| column"), 2)


class World(unittest.TestCase):
    def test_every_topic_but_what_may_not_be_handed_on_is_compared(self):
        ended = subprocess.run([sys.executable, HERE.parent / "validation/world", "--quick", "--bernal", COMMAND], capture_output=True, text=True)
        self.assertEqual(ended.returncode, 0, ended.stderr)
        lines = ended.stdout.splitlines()
        self.assertEqual({line.split(":")[0] for line in lines}, {"equal", "growth", "finney", "pebbles", "polydispersity", "exchange",
                                                                  "four sizes", "farr", "columns", "records"})
        self.assertIn("pebbles: overlapping pairs among 67 pebbles: 63, published 63, holds", lines)


class Records(Table):
    def table_of(self, *words):
        records = self.folder / "held.csv"
        records.write_text("ball,2,0.5\ncube,3,0.58578643762690\nsquare,4,0.25\n")
        subprocess.run([HERE / "records_table", "--bernal", COMMAND, "--records", records, "-o", self.folder, *words],
                       check=True, stdout=subprocess.DEVNULL)
        with open(self.folder / "records.csv") as file:
            return list(csv.DictReader(file))

    def test_rows_are_shares_of_the_records_and_are_kept(self):
        rows = self.table_of("--only", "ball", "--least", "2", "--most", "2")
        rows += self.table_of("--only", "cube", "--least", "3", "--most", "3")[1:]
        self.assertEqual(self.table_of("--only", "square", "--least", "3", "--most", "4")[:2], rows)
        for row in self.table_of("--page"):
            held = (row["container"], row["n"]) != ("square", "3")
            self.assertEqual((row["share"], row["counted"]), ("1.000000", "1") if held else ("", ""), row)
            self.assertEqual(row["play"], "1e-09", row)
        page = (self.folder / "records.md").read_text()
        self.assertIn("Missed: none.", page)
        self.assertIn("| Discs in a square | 4 to 4, 1 |", page)


if __name__ == "__main__":
    unittest.main()
