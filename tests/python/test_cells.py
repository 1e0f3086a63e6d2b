#!/usr/bin/env python3
"""Cells of a packing as arrays: what NumPy makes of corners and faces is what bernal says of the cells."""

import unittest

import numpy as np
from support import small

import bernal


def polygons(cells):
    """Of each face the cells on both of its sides, the image of the second, and its corners in space."""
    moved = cells.corners[cells.face_corners] + cells.corner_images * cells.periods
    for f, (cell, beyond) in enumerate(cells.face_cells):
        yield cell, beyond, cells.face_images[f], moved[cells.first_corner[f] : cells.first_corner[f + 1]]


class Cells(unittest.TestCase):
    def check(self, packing):
        cells = packing.cells()
        volume = np.zeros(len(packing.radii))
        for cell, beyond, image, corners in polygons(cells):
            for i, sign, at in ((cell, 1, packing.centers[cell]), (beyond, -1, None)):
                if i < 0:
                    continue
                at = packing.centers[i] + image * cells.periods if at is None else at
                seen = corners - at
                for a, b in zip(seen[1:], seen[2:]):
                    volume[i] += sign * np.dot(seen[0], np.cross(a, b)) / 6
        np.testing.assert_allclose(volume, cells.volumes, rtol=1e-9)
        self.assertAlmostEqual(volume.sum() / packing.volume, 1, delta=1e-9)
        return cells

    def test_periodic(self):
        packing = bernal.pack(small())
        cells = self.check(packing)
        self.assertTrue((cells.face_walls == -1).all())
        # Each face is equally far, by power distance, from the spheres on both of its sides, and no other is nearer.
        for cell, beyond, image, corners in list(polygons(cells))[::50]:
            there = packing.centers[beyond] + image * cells.periods
            here = ((corners - packing.centers[cell]) ** 2).sum(axis=1) - packing.radii[cell] ** 2
            behind = ((corners - there) ** 2).sum(axis=1) - packing.radii[beyond] ** 2
            np.testing.assert_allclose(here, behind, atol=1e-9)
            for corner, power in zip(corners, here):
                gap = packing.centers - corner
                gap -= cells.periods * np.round(gap / cells.periods)
                self.assertGreater(((gap**2).sum(axis=1) - packing.radii**2).min(), power - 1e-9)

    def test_in_a_box(self):
        packing = bernal.pack(bernal.Scene(bernal.Box([8, 8, 8]), diameters=1, count=200, unit="mm"))
        cells = self.check(packing)
        self.assertTrue((cells.face_walls >= 0).any())
        self.assertTrue(((cells.face_walls >= 0) == (cells.face_cells[:, 1] < 0)).all())

    def test_walls_that_are_not_convex_are_refused(self):
        packing = bernal.pack(bernal.Scene(bernal.Tube(4, 2, 8), diameters=1, count=50, unit="mm"))
        with self.assertRaises(bernal.Error) as caught:
            packing.cells()
        self.assertIn("convex", str(caught.exception))


if __name__ == "__main__":
    unittest.main()
