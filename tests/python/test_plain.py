#!/usr/bin/env python3
"""Measurements against plain counts and integrals: contacts of packings that others published, of the core and of a slab,
and the porosity of a column from its side, its floor and its lid."""

import os
import unittest
from pathlib import Path

import numpy as np
import plain
from support import SOURCE, InFolder

import bernal

PUBLISHED = SOURCE / "tests" / "published"


def baranau():
    rows = np.fromfile(PUBLISHED / "baranau_10000.xyzd", "<f8").reshape(-1, 4)
    edges = np.full(3, 20.0823593086113)
    return bernal.from_arrays(rows[:, :3], rows[:, 3] / 2, unit="mm", box=edges, periodic="xyz"), edges


def cardinal():
    vessel = bernal.Cylinder(6.6, 18, base=[0, 0, -9])
    return bernal.from_arrays(np.loadtxt(PUBLISHED / "cardinal_67.txt"), 1.5, unit="cm", container=vessel)


class Contacts(InFolder):
    def expect_contacts(self, packing, edges=None, column=None, ratios=(0.002, 0.02, 0.1)):
        """Each pair of the list is one that is found by looking at all of them, and there are as many."""
        wide = plain.touching_pairs(packing.centers, packing.radii, max(ratios), edges)
        sums = packing.radii[wide[0]] + packing.radii[wide[1]]
        found = []
        for ratio in ratios:
            near = wide[2] < (1 + ratio) * sums
            contacts = packing.contacts(ratio)
            pairs = contacts.j >= 0
            np.testing.assert_array_equal(contacts.i[pairs], wide[0][near])
            np.testing.assert_array_equal(contacts.j[pairs], wide[1][near])
            np.testing.assert_allclose(contacts.gap[pairs], wide[2][near] - sums[near], atol=1e-12 * packing.radii.max())
            if column:
                gaps = column - np.hypot(packing.x, packing.y) - packing.radii
                np.testing.assert_array_equal(contacts.i[~pairs], np.nonzero(gaps < ratio * packing.radii)[0])
            found.append(2 * near.sum() / len(packing))
        np.testing.assert_allclose(packing.coordination(ratios), found, rtol=1e-12)
        return found

    def test_of_a_packing_by_lubachevsky_and_stillinger(self):
        packing, edges = baranau()
        found = self.expect_contacts(packing, edges=edges)
        self.assertGreater(found[0], 6.1)  # without rattlers, its author counts 6.20 where spheres swell by 0.2 %

    def test_of_a_pebble_bed(self):
        packing = cardinal()
        found = self.expect_contacts(packing, column=6.6)
        self.assertGreater(found[0], 2)
        self.assertGreater(bernal.measure(packing).wall_contacts, 20)

    def test_of_ball_bearings(self):
        file = Path(os.environ.get("BERNAL_PUBLISHED", "")) / "FinneyPack4021.txt"
        if not file.is_file():
            self.skipTest("FinneyPack4021.txt is not in the folder that BERNAL_PUBLISHED names")
        centers = np.loadtxt(file)[:, 1:]
        packing = bernal.from_arrays(centers, 1, unit="mm")
        self.expect_contacts(packing)
        # In the middle, so that each has all its neighbours; measured distances scatter about contact.
        middle = np.linalg.norm(centers - centers.mean(axis=0), axis=1) < 13
        counts = [
            plain.coordination(plain.touching_pairs(centers, packing.radii, ratio), middle)
            for ratio in (0.01, 0.02, 0.05, 0.1, 0.2)
        ]
        np.testing.assert_allclose(counts, [6.28, 6.85, 7.90, 9.02, 10.51], atol=0.03)

    def test_of_the_core_and_of_a_slab(self):
        packing = bernal.pack(
            bernal.Scene(bernal.Cylinder(5, 10), diameters=bernal.Uniform(0.8, 1.2), unit="mm", stages=bernal.Relax())
        )
        measured = bernal.measure(packing, gap=0.01, slab="z = 2..4.5 mm")
        from_wall = np.minimum(5 - np.hypot(packing.x, packing.y), np.minimum(packing.z, 10 - packing.z))
        core = from_wall >= 3 * packing.diameters.mean()
        slab = (packing.z >= 2) & (packing.z <= 4.5)
        for counted, some in ((core, measured.core_contacts), (slab, measured.slab.contacts)):
            self.assertEqual(some.spheres, counted.sum())
            self.assertEqual(len(some.by_gap), 10)
            for at in some.by_gap:
                pairs = plain.touching_pairs(packing.centers, packing.radii, at.contact_gap)
                self.assertAlmostEqual(at.coordination, plain.coordination(pairs, counted), 12)
            self.assertEqual(some.by_gap[-1].contact_gap, 0.01)
        self.assertGreater(measured.core_contacts.coordination, measured.coordination)
        filled = plain.volume_of_slices(packing.z, packing.radii, np.array([2, 4.5]))
        self.assertAlmostEqual(measured.slab.phi, filled[0] / (np.pi * 25 * 2.5), 9)


class Profiles(InFolder):
    def expect_layers(self, profile, exact, thickness):
        """Within the errors that are said."""
        layers = [layer for layer in profile.layers if abs(layer.to - layer["from"] - thickness) < 1e-9]
        sampled = np.array([layer.porosity for layer in layers])
        errors = np.array([layer.error for layer in layers])
        differences = sampled - exact[: len(layers)]
        self.assertGreater(len(layers), 20)
        self.assertLess(np.abs(differences / errors).max(), 4)
        self.assertLess(np.sqrt(np.mean((differences / errors) ** 2)), 1.2)
        self.assertLess(errors[:10].max(), 0.02)

    def test_of_a_column_of_equal_spheres(self):
        radius, height = 4, 14
        packing = bernal.pack(
            bernal.Scene(bernal.Cylinder(radius, height), diameters=1, unit="mm", stages=bernal.Relax())
        )
        measured = bernal.measure(packing)
        column = measured.column
        slices = plain.volume_of_slices(packing.z, packing.radii, np.linspace(0, height, 141))
        along = np.array([layer.porosity for layer in column.along])
        np.testing.assert_allclose(along, 1 - slices / (np.pi * radius**2 * 0.1), atol=1e-9)
        for minimum, exact in ((column.floor_minimum, along), (column.lid_minimum, along[::-1])):
            np.testing.assert_allclose((minimum.porosity, minimum.z), plain.first_minimum(exact, 0.1, 1), rtol=1e-6)
        self.assertEqual((column.side["from"], column.side.to), (3, height - 3))
        exact = plain.side_profile(packing.centers, packing.radii, radius, 0.1, 3.9, 3, height - 3)
        self.expect_layers(column.side.profile, exact, 0.1)
        least, where = plain.first_minimum(exact, 0.1, 1)
        self.assertAlmostEqual(column.side.profile.first_minimum.porosity, least, delta=0.01)  # layers err by 0.003
        self.assertAlmostEqual(column.side.profile.first_minimum.z, where, delta=0.01)
        self.assertTrue(0.15 < least < 0.35 and 0.45 < where < 0.6)
        # The layers and the rest add up to the whole between the ends.
        whole = plain.volume_of_slices(packing.z, packing.radii, np.array([3, height - 3]))[0]
        shells = plain.volume_in_shells(
            np.hypot(packing.x, packing.y), packing.z, packing.radii, np.array([0, 2, radius]), 3, height - 3
        )
        self.assertAlmostEqual(shells.sum() / whole, 1, delta=2e-5)  # the shells are by Gauss's rule

    def test_of_a_slab(self):
        packing = bernal.pack(bernal.Scene(bernal.Cylinder(4, 10), diameters=1, unit="mm", stages=bernal.Relax()))
        column = bernal.measure(packing, slab="z = 2..5").column
        exact = plain.side_profile(packing.centers, packing.radii, 4, 0.1, 3.9, 2, 5)
        self.expect_layers(column.side.profile, exact, 0.1)
        slices = plain.volume_of_slices(packing.x, packing.radii, np.linspace(-1, 1, 21))
        across = bernal.measure(packing, slab="x = -1..1").column
        edge = np.linspace(-1, 1, 21)
        room = np.diff(edge * np.sqrt(16 - edge**2) + 16 * np.arcsin(edge / 4)) * 10
        np.testing.assert_allclose([layer.porosity for layer in across.along], 1 - slices / room, atol=1e-4)
        self.assertIsNone(across.side)
        self.refuses(bernal.InputError, "is no slab", lambda: bernal.measure(packing, slab="between"))
        self.refuses(bernal.InputError, "holds nothing", lambda: bernal.measure(packing, slab="z > 10"))


if __name__ == "__main__":
    unittest.main()
