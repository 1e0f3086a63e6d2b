#!/usr/bin/env python3
"""Published papers, made again by small packings; what they show is held against print in slow_papers.py."""

import math
import os
import signal
import subprocess
import tomllib
import unittest
from pathlib import Path

import numpy as np
from support import SOURCE, Paper, reproduce

import common
import farr2013
import farr2013_rods
import zhao2007


class Pages(unittest.TestCase):
    def test_tables_are_markdown(self):
        self.assertEqual(common.table(["a", "b"], [[1, 2], [3, ""]]), "| a | b |\n| --- | ---: |\n| 1 | 2 |\n| 3 |  |\n")

    def test_scatter_is_that_of_one_packing(self):
        self.assertEqual(common.scatter([1, 2, 6], 1), "3.0 ± 2.6")
        self.assertEqual(common.scatter([0.5], 3), "0.500")

    def test_exponent_of_a_power_law(self):
        xs = np.array([1.0, 3, 10, 200])
        ys = 0.7 * xs**1.24
        exponent, error = common.power_law(xs, ys)
        self.assertAlmostEqual(exponent, 1.24, 12)
        self.assertLess(error, 1e-7)
        ys[-1] *= 2
        self.assertGreater(common.power_law(xs, ys)[1], 0.03)
        self.assertAlmostEqual(common.power_law([1, 10], [2, 20])[0], 1, 12)

    def test_a_claim_holds_within_its_tolerance(self):
        self.assertTrue(common.Claim("a", 0.646, 0.6505, 0.005).holds)
        self.assertFalse(common.Claim("a", 0.646, 0.6515, 0.005).holds)
        self.assertEqual(common.Claim("a", 0.646, 0.6515, 0.005).row(), ["a", "0.6460", "0.6515", "+0.0055", "0.005", "no"])


class Zhao2007(Paper):
    def test_has_the_sizes_of_the_scenes(self):
        scene = tomllib.loads((SOURCE / "data/scenes/relax_arbitrary.toml").read_text())
        table = next(value for value in scene["spheres"].values() if isinstance(value, dict))
        points = {key: table[key] for key in ("x", "density")}
        self.assertEqual(points, {"x": zhao2007.ARBITRARY.x, "density": zhao2007.ARBITRARY.density})
        self.assertAlmostEqual(zhao2007.DRAWN_SIGMA, 0.3 / math.sqrt(2), 15)

    def test_puts_printed_and_own_values_side_by_side(self):
        self.made("zhao2007", "--spheres", 100)
        for sizes, phi, coordination in (("equal", "0.646", "5.72"), ("radii 1 and 0.5", "0.665", "5.24"),
                                         ("lognormal 0.3", "0.644", "5.64"), ("arbitrary", "0.692", "4.24")):  # fmt: skip
            for loop in ("published", "fast"):
                row = self.row(f"{sizes} | {loop}")
                self.assertEqual((len(row), row[5], row[8]), (10, phi, coordination))
                # A hundred spheres scatter by 0.01, and a small box costs as much; the arbitrary ones more.
                self.assertAlmostEqual(float(row[4]), float(phi), delta=0.06, msg=sizes)
                claim = self.row(f"{sizes}, {loop} loop, 100 spheres: packing fraction")
                self.assertEqual(float(claim[1]), float(phi))
                self.assertEqual(claim[2], row[4])
        self.assertEqual(len(self.row("lognormal 0.212 | published")), 10)
        # Sizes drawn by the formula as printed are not those that it is said to draw.
        self.assertGreater(float(self.row("by the printed formula | sigma 0.3 ")[2]), 0.05)
        self.assertLess(float(self.row("by the printed formula | sigma 0.3/")[2]), 0.02)
        self.assertLess(float(self.row("lognormal, drawn here")[2]), 0.02)
        self.assertLess(float(self.row("arbitrary, drawn here")[2]), 0.02)


class Han2005(Paper):
    def test_puts_printed_and_own_values_side_by_side(self):
        self.made("han2005", "--spheres", 200)
        self.assertEqual(self.row("printed |"), ["printed", "26787", "0.5289", "181"])
        phi, bed = (lambda protocol, k=k: float(self.row(protocol + " |")[k]) for k in (2, 3))
        self.assertGreater(bed("compression along one direction"), bed("insertion at random") + 0.1)
        self.assertEqual(phi("compression along one direction"), phi("insertion at random"))
        self.assertGreater(phi("local directions, shaking, refilling"), phi("the same, and shaking") + 0.1)
        self.assertEqual(float(self.row("equal spheres: packing fraction")[1]), 0.5289)


class Farr2013(Paper):
    def test_puts_printed_and_own_values_side_by_side(self):
        self.made("farr2013", "--spheres", 200, "--points", 3)
        # The printed digits come out with the erfc that the published program uses.
        table = self.lines("table1.csv")
        self.assertEqual(len(table), 6)
        for line in table:
            self.assertAlmostEqual(float(line["phi_with_published_erfc"]), float(line["phi_published"]), delta=1e-9)
            self.assertAlmostEqual(float(line["phi"]), float(line["phi_published"]), delta=1.3e-5)
            claim = self.row(f"table 1: sigma {line['sigma']}, {line['rods']} rods")
            self.assertEqual(claim[5], "yes")
        for line in self.lines("fig1.csv"):
            self.assertLess(abs(float(line["fit_minus_rods"])), 3e-4)
            if float(line["sigma"]) == 0.5:
                self.assertAlmostEqual(float(line["phi_rods"]), 0.7072627, delta=2e-7)
        mixtures = self.lines("table2.csv")
        self.assertEqual(len(mixtures), 6)
        for line in mixtures:
            self.assertAlmostEqual(float(line["phi_rods"]), float(line["phi_rods_published"]), delta=5e-4)
        phi = [float(line["phi"]) for line in self.lines("fig6.csv")]
        self.assertEqual(len(phi), 9)
        self.assertGreater(phi[-1], 0.9)  # the last point of the grid, 1 : 10 : 100
        self.assertIn("so it is", self.page)  # figure 5: the lowest packing fraction is not at equal means

    def test_rods_are_those_of_the_library(self):
        # One size: chords of a sphere, P(L < l) = l², by the library's own model to 1e-6.
        lengths = np.sqrt((16000 - np.arange(16000) - 0.5) / 16000)
        self.assertAlmostEqual(farr2013_rods.covered(lengths.tolist()), farr2013.bernal.predict(1.0).phi, 6)
        self.assertGreater(farr2013_rods.covered(lengths.tolist(), 0.7), farr2013_rods.covered(lengths.tolist()))

    def test_packings_of_a_part(self):
        self.made("farr2013", "--spheres", 200, "--pack", "--only", "fig2", page="fig2")
        rods = farr2013.bernal.predict(farr2013.lognormal(0.3)).phi
        self.assertAlmostEqual(float(self.row("KTS, printed | 0.30")[4]), rods, delta=1e-4)
        self.assertEqual(self.row("relax, here | 0.30")[2], "200")


class Command(Paper):
    def refuses(self, *words, naming):
        ended = reproduce(*words)
        self.assertEqual(ended.returncode, 2, ended)
        self.assertIn(naming, ended.stderr)
        self.assertEqual(ended.stdout, "")
        self.assertNotIn("Traceback", ended.stderr)

    def test_refuses_absurd_input(self):
        self.refuses(naming="there are")
        self.refuses("fig7", "-o", self.folder, naming="zhao2007 han2005 farr2013")
        self.refuses("han2005", naming="--output")
        self.refuses("han2005", "-o", self.folder, "--pack", naming="--pack")
        self.refuses("zhao2007", "-o", self.folder, "--spheres", "99", naming="--spheres")
        self.refuses("farr2013", "-o", self.folder, "--only", "fig7", naming="--only")
        self.refuses("han2005", "-o", "/proc/none", naming="/proc/none")
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_stops_with_nothing_written(self):
        script = subprocess.Popen(
            [SOURCE / "apps/reproduce", "zhao2007", "-o", self.folder], stderr=subprocess.PIPE, stdout=subprocess.PIPE,
            text=True, start_new_session=True,
        )  # fmt: skip
        while not list(self.folder.glob(".paper-*")):
            self.assertIsNone(script.poll())
        packing = lambda: any(  # noqa: E731  # the processes that pack have begun
            b"spawn_main" in (Path(f"/proc/{each}") / "cmdline").read_bytes()
            for each in Path(f"/proc/{script.pid}/task/{script.pid}/children").read_text().split()
        )
        while not packing():
            self.assertIsNone(script.poll())
        os.killpg(script.pid, signal.SIGINT)  # as a terminal does
        out, err = script.communicate(timeout=60)
        self.assertEqual((script.returncode, out), (3, ""), err)
        self.assertIn("nothing is written", err)
        self.assertEqual(list(self.folder.iterdir()), [])


if __name__ == "__main__":
    unittest.main()
