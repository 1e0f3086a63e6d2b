#!/usr/bin/env python3
"""Meshes of packings: the keys and the bytes of the command's."""

import shutil
import subprocess
import unittest

import numpy as np
from support import COMMAND, InFolder

import bernal


class Meshes(InFolder):
    def test_meshes_are_those_of_the_command(self):
        with self.subTest("keys"):
            said = subprocess.run([COMMAND, "mesh", "--help"], capture_output=True, text=True, check=True).stdout
            for name, _ in bernal._core.mesh_keys():
                self.assertIn(f"--{name.replace('_', '-')} ", said)
                self.assertIn(f"\n{name} : ", bernal.Packing.mesh.__doc__.replace("        ", ""))
        packing = bernal.from_arrays([[1, 1, 1], [2, 1, 1]], 0.5, unit="mm", box=[3, 2, 2])
        self.refuses(bernal.InputError, 'did you mean "mesh_size"', lambda: packing.mesh("vtu", "a.vtu", mesh_sise=1))
        self.refuses(
            bernal.InputError, "mesh_size takes a number from", lambda: packing.mesh("vtu", "a.vtu", mesh_size=5)
        )
        self.refuses(bernal.InputError, "contact takes bridge", lambda: packing.mesh("vtu", "a.vtu", contact="glue"))
        self.refuses(bernal.InputError, "vtu", lambda: packing.mesh("vtk", "a.vtk"))
        if not shutil.which("tetgen"):
            self.skipTest("tetgen is not installed")
        made = packing.mesh("vtu", "a.vtu", mesh_size=np.float64(0.4), regions="all", order=1)
        self.assertEqual([file.name for file in made.files], ["a.vtu"])
        self.assertTrue(made.files[0].exists())
        self.assertEqual((made.spheres, made.necks, made.unit), (2, 1, "mm"))
        self.assertGreaterEqual(made.least_sicn, made.promised_sicn)
        self.assertEqual({group.name for group in made.groups}, {"fluid", "spheres", "bridges"})
        self.assertAlmostEqual(made.meshed_porosity, made.porosity, delta=0.02)
        packing.write("out")
        subprocess.run(
            [COMMAND, "mesh", "out", "--to", "vtu", "-o", "b.vtu", "--mesh-size", "0.4", "--regions", "all", "--quiet"],
            check=True,
        )
        self.assertEqual((self.folder / "a.vtu").read_bytes(), (self.folder / "b.vtu").read_bytes())


if __name__ == "__main__":
    unittest.main()
