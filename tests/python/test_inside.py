#!/usr/bin/env python3
"""Packings inside of spheres: their arrays, their files, pickles, and what they are flattened."""

import pickle
import unittest

import numpy as np
from support import InFolder

import bernal

INNER = 'unit = "mm"\n[spheres]\ncount = 40\nradius = 1.5\n[[stage]]\ndo = "insert"\n'
LAYERS = [{"name": "fuel", "radius": 2.5}, {"name": "shell"}]


def turned(points, quaternion):
    """By the matrix of a unit quaternion."""
    w, x, y, z = quaternion
    matrix = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )
    return points @ matrix.T


class Inside(InFolder):
    def packed(self):
        (self.folder / "inner.toml").write_text(INNER)
        return bernal.pack(
            bernal.Scene(
                bernal.Box([20, 20, 20]), unit="cm", count=10, radii=3, layers=LAYERS,
                inside={"scene": "inner.toml", "layer": "fuel", "templates": 2},
            )
        )  # fmt: skip

    def test_templates_are_packings_and_the_rest_arrays(self):
        packing = self.packed()
        (inside,) = packing.inside
        self.assertEqual((inside["class"], inside["layer"]), ("spheres", "fuel"))
        self.assertEqual([len(each) for each in inside["templates"]], [40, 40])
        self.assertEqual([each.unit for each in inside["templates"]], ["mm", "mm"])
        self.assertEqual(inside["spheres"].tolist(), list(range(10)))
        self.assertLess(inside["which"].max(), 2)
        np.testing.assert_allclose(np.linalg.norm(inside["rotations"], axis=1), 1, atol=1e-15)
        self.assertEqual([level["spheres"] for level in packing.levels], [10, 400])
        with self.assertRaises(ValueError):
            inside["which"][0] = 1

    def test_what_is_verified_is_said_of_all_levels_and_their_layers(self):
        packing = self.packed()
        packing.write("out")
        proof = bernal.verify(packing)
        self.assertTrue(proof)
        self.assertIn("So are all levels", proof.statement)
        self.assertIn("The 20 layers of the scene fit", proof.statement)
        self.assertEqual([level["packings"] for level in proof.levels], [2])
        of_folder = bernal.verify("out")
        self.assertTrue(of_folder)
        self.assertIn("layers.csv has the 20 layers", of_folder.statement)
        (self.folder / "out/layers.csv").unlink()
        without = bernal.verify("out")
        self.assertFalse(without)
        self.assertIn("layers.csv is missing", without.statement)

    def test_folders_and_pickles_hold_them(self):
        packing = self.packed()
        packing.write("out")
        for again in (bernal.read("out"), pickle.loads(pickle.dumps(packing))):
            for key in ("spheres", "which", "rotations"):
                np.testing.assert_array_equal(again.inside[0][key], packing.inside[0][key])
            for one, other in zip(again.inside[0]["templates"], packing.inside[0]["templates"]):
                np.testing.assert_array_equal(one.centers, other.centers)

    def test_flattened_they_stand_where_the_rotations_put_them(self):
        packing = self.packed()
        bernal.export(packing, "flat", "flat.csv")
        flat = np.loadtxt("flat.csv", delimiter=",", skiprows=2)
        inside = packing.inside[0]
        self.assertEqual(flat.shape, (400, 5))
        for sphere, which, rotation in zip(inside["spheres"], inside["which"], inside["rotations"]):
            within = inside["templates"][which]
            places = packing.centers[sphere] + turned(within.centers / 10, rotation)
            rows = flat[flat[:, 4] == sphere]
            np.testing.assert_allclose(rows[:, :3], places, atol=1e-13)
            np.testing.assert_allclose(rows[:, 3], within.radii / 10, rtol=1e-15)

    def test_a_packing_without_has_none(self):
        packing = bernal.pack(bernal.Scene(bernal.Box([4, 4, 4]), unit="mm", count=5, radii=0.5))
        self.assertEqual(packing.inside, [])
        self.assertEqual(len(packing.levels), 1)


if __name__ == "__main__":
    unittest.main()
