#!/usr/bin/env python3
"""What the pages of papers claim, held against print: minutes. The published loop with 10,000 spheres, a minute and a
half each, is left to apps/reproduce; tests/validation/relax_table2_test.cpp has it with 1,000."""

import math
import shutil
import unittest

from support import Paper


class Han2005(Paper):
    def test_is_reached_and_its_parts_buy_packing_fraction(self):
        """26,787 spheres at 52.89 %, and what local directions and shaking buy."""
        self.made("han2005", "--spheres", 26_787)
        lines = self.lines("han2005.csv")
        printed = [line for line in lines if line["group"] == "as printed"]
        self.assertEqual([line["spheres"] for line in printed], ["26787", "26787"])
        for line in printed:
            # Uniform radii are drawn evenly: their volume is right to one sphere in some thousands.
            self.assertAlmostEqual(float(line["phi"]), 0.5289, delta=5e-4)
        phi = {line["protocol"]: float(line["phi"]) for line in lines if line["group"] == "protocols"}
        one = phi["one direction, refilling"]
        self.assertGreater(phi["local directions, refilling"], one + 0.02)
        self.assertGreater(phi["one direction, shaking, refilling"], one + 0.02)
        self.assertGreater(phi["local directions, shaking, refilling"], phi["local directions, refilling"])
        for name in ("equal spheres", "radii from 1 to 2"):
            self.assertEqual(self.row(f"{name}: packing fraction")[5], "yes")


class Farr2013(Paper):
    def test_growth_is_as_dense_as_printed(self):
        """The rows of table 2: looser than print by three of its errors they may not be."""
        self.made("farr2013", "--only", "table2", page="table2")
        lines = self.lines("table2.csv")
        self.assertEqual([int(line["spheres_grown"]) for line in lines], [1024] + 5 * [2048])
        for line in lines:
            self.assertGreater(float(line["phi_grown"]), float(line["phi_kts"]) - 0.003)
            self.assertLess(float(line["phi_grown"]), float(line["phi_kts"]) + 0.012)

    @unittest.skipUnless(shutil.which("lmp"), "LAMMPS is not installed")
    def test_soft_particles(self):
        self.made("farr2013", "--only", "fig2soft", "--soft", 200, page="fig2soft")
        for line in self.lines("fig2soft.csv"):
            # 200 spheres, which wide sizes fill unevenly, end within 0.03 of the rod model of theirs.
            self.assertAlmostEqual(float(line["phi"]), float(line["phi_rods_of_them"]), delta=0.03, msg=line)

    def test_three_sizes_pack_as_densely_as_the_rod_model_says(self):
        """Figure 6 claims what no packing was made for. Four of its points are packed, one with all three sizes."""
        self.made("farr2013", "--only", "fig6", "--pack", page="fig6")
        lines = self.lines("fig6.csv")
        model = [line for line in lines if line["source"] == "rods"]
        two_sizes = {}  # the densest of D1 and D3 alone, by D3 / D1, from the first row
        compared = 0
        for line in model:
            second, third, phi = (float(line[key]) for key in ("d2_over_d1", "d3_over_d2", "phi"))
            ratio = round(1e4 * math.log(second * third))
            if third == 1:
                two_sizes[ratio] = phi
            # The digits of the ratios are seven, so that equal ones may round apart.
            for k in (ratio - 1, ratio, ratio + 1):
                if k in two_sizes:
                    compared += 1
                    self.assertGreater(phi, two_sizes[k] - 1e-4, line)
        self.assertGreater(compared, len(model) / 3)
        self.assertGreater(float(model[-1]["phi"]), 0.9)  # the last point of the grid, 1 : 10 : 100
        packed = [line for line in lines if line["source"] == "relax"]
        three = 0
        for line in packed:
            # Where three sizes are in it `relax` stays below the model: 0.025 at 1 : 3 : 9, less the slower it is.
            has_three = min(float(line[f"share_{k}"]) for k in (1, 2, 3)) > 0
            three += has_three
            phi = float(line["phi"])
            self.assertAlmostEqual(phi, float(line["phi_rods"]), delta=0.03 if has_three else 0.01, msg=line)
            self.assertGreater(phi, 0.67)  # denser than any of the three sizes alone
        self.assertEqual((len(packed), three), (4, 1))


class Zhao2007(Paper):
    def test_periods_and_the_missing_factor(self):
        """The published loop, 1,000 spheres: a fixed short period costs packing fraction, and the sizes that the
        printed formula draws pack less densely than those that it is said to draw."""
        self.made("zhao2007", "--spheres", 1000)
        phi = {(line["sizes"], line["period"]): float(line["phi"]) for line in self.lines("zhao2007.csv")
               if [line[key] for key in ("loop", "spheres", "phi0", "seed")] == ["reference", "1000", "0.86", "1"]}  # fmt: skip
        self.assertGreater(phi["equal", "adaptive"], phi["equal", "20"] + 0.005)
        # 0.6645 and 0.6545 with 10,000 spheres; one packing of 1,000 scatters by 0.002 and is 0.002 looser.
        self.assertAlmostEqual(phi["lognormal 0.3", "adaptive"], 0.6645, delta=0.009)
        self.assertAlmostEqual(phi["lognormal 0.212", "adaptive"], 0.6545, delta=0.009)
        self.assertGreater(phi["lognormal 0.3", "adaptive"], phi["lognormal 0.212", "adaptive"])


if __name__ == "__main__":
    unittest.main()
