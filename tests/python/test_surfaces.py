#!/usr/bin/env python3
"""Containers that stand in no file: arrays, and what is like a mesh of trimesh, meshio or PyVista."""

import unittest
from types import SimpleNamespace

import numpy as np
from support import HELIX, InFolder, cube

import bernal

VERTICES, TRIANGLES, SQUARES = cube()


def scene_of(mesh, **keys):
    return bernal.Scene(bernal.Mesh(mesh, unit="mm"), **{"diameters": 2, "unit": "mm", "count": 10, **keys})


class Surfaces(InFolder):
    def test_whatever_is_like_a_mesh_is_a_container(self):
        flat = np.concatenate([[4, *square] for square in SQUARES])
        meshes = {
            "arrays": (np.array(VERTICES), np.array(TRIANGLES)),
            "lists": (VERTICES, SQUARES),
            "trimesh": SimpleNamespace(vertices=np.array(VERTICES), faces=np.array(TRIANGLES)),
            "meshio": SimpleNamespace(
                points=np.array(VERTICES), cells_dict={"line": np.array([[0, 1]]), "quad": np.array(SQUARES)}
            ),
            "PyVista": SimpleNamespace(points=np.array(VERTICES, dtype=np.float32), faces=flat),
            "PyVista's regular faces": SimpleNamespace(points=np.array(VERTICES), faces=np.array(SQUARES)),
        }
        for name, mesh in meshes.items():
            with self.subTest(name):
                found = bernal.inspect(mesh, unit="mm")
                self.assertTrue(found)
                self.assertEqual((found.volume, found.faces, found.unit), (1000, 12, "mm"))
                packing = bernal.pack(scene_of(mesh))
                self.assertTrue(bernal.verify(packing))
                self.assertEqual(packing.volume, 1000)

    def test_the_doubles_are_kept(self):
        rng = np.random.default_rng(3)
        turned = np.array(VERTICES) @ np.linalg.qr(rng.normal(size=(3, 3)))[0] + rng.normal(size=3) * 1e3
        packing = bernal.pack(scene_of((turned, TRIANGLES), diameters=1, count=1))
        vertices, triangles = packing.walls
        self.assertEqual({tuple(v) for v in vertices}, {tuple(v) for v in turned})
        self.assertEqual(triangles.shape, (12, 3))

    def test_the_result_stands_for_itself(self):
        scene = scene_of((VERTICES, TRIANGLES))
        same, other = scene_of((np.array(VERTICES), SQUARES)), scene_of((VERTICES, TRIANGLES))
        self.assertEqual(scene.container.file, other.container.file)
        self.assertNotEqual(scene.container.file, same.container.file)
        bernal.pack(scene).write("out")
        scene.write("scene.toml")
        for text in ((self.folder / "out" / "scene.toml").read_text(), (self.folder / "scene.toml").read_text()):
            self.assertIn('file = "surface-', text)
        self.assertTrue(bernal.verify("out"))
        self.assertEqual(bernal.pack("scene.toml").hash, bernal.read("out").hash)
        self.assertEqual(bernal.pack("out/scene.toml").hash, bernal.read("out").hash)

    def test_files_are_named_by_paths_too(self):
        self.assertEqual(bernal.inspect(HELIX).faces, bernal.inspect(bernal.Mesh(HELIX), unit="mm").faces)
        found = bernal.inspect(bernal.Mesh(HELIX, unit="mm"), radius=1)
        self.assertEqual(len(found.chambers["list"]), 1)
        hollow = scene_of(HELIX, diameters=10).replace(container=bernal.Mesh(HELIX, obstacles=[(VERTICES, TRIANGLES)]))
        self.assertEqual(repr(hollow.container.obstacles), "[<surface of 8 vertices and 12 faces>]")

    def test_two_obstacles_are_no_mesh(self):
        arrays = (np.array(VERTICES), np.array(TRIANGLES))
        mesh = SimpleNamespace(vertices=arrays[0], faces=arrays[1])
        for two in ([(VERTICES, TRIANGLES)] * 2, [arrays] * 2, (arrays, arrays), [mesh, arrays], [mesh] * 2):
            self.assertEqual(len(bernal.Mesh(HELIX, obstacles=two).obstacles), 2)

    def test_obstacles_are_containers_themselves(self):
        ball = bernal.Sphere(3, center=[0, 0, 5])
        column = bernal.Cylinder(10, 20, obstacles=[ball, (np.array(VERTICES) / 2 + [0, 0, 12], TRIANGLES)])
        packing = bernal.pack(scene_of(HELIX).replace(container=column))
        self.assertAlmostEqual(packing.volume, np.pi * (100 * 20 - 4 / 3 * 27) - 125, delta=2)
        self.assertGreaterEqual(np.linalg.norm(packing.centers - [0, 0, 5], axis=1).min(), 3 + 1)
        self.assertEqual(column.obstacles[0], ball)
        packing.write("out")
        again = bernal.read("out").scene.container
        self.assertEqual([type(each) for each in again.obstacles], [bernal.Sphere, bernal.Mesh])
        self.assertEqual(again.obstacles[0].radius, 3)
        self.assertTrue(bernal.verify("out"))

    def test_imported_packings_lie_in_them(self):
        scene = scene_of((VERTICES, TRIANGLES), count=None)
        packing = bernal.from_arrays([[5, 5, 5]], 5, unit="mm", container=scene.container)
        self.assertTrue(bernal.verify(packing))
        self.assertEqual(packing.scene.container.file, scene.container.file)
        self.assertTrue(bernal.verify(bernal.pack(packing.scene.replace(diameters=2, count=10))))

    def test_an_open_surface_is_told_what_helps(self):
        found = bernal.inspect((VERTICES, SQUARES[1:]), places="bad.ply")
        self.assertFalse(found)
        self.assertEqual(found.container_lines, ['cap = "z = 0"'])
        capped = bernal.Mesh((VERTICES, SQUARES[1:]), unit="mm", cap="z = 0")
        self.assertTrue(bernal.verify(bernal.pack(scene_of(HELIX).replace(container=capped))))
        self.assertTrue((self.folder / "bad.ply").exists())
        error = self.refuses(bernal.InputError, "4 open edges", lambda: bernal.pack(scene_of((VERTICES, SQUARES[1:]))))
        self.assertIsNone(error.file)  # whose name means nothing to anybody

    def test_what_is_none_is_refused_with_the_reason(self):
        tetra = SimpleNamespace(points=VERTICES, cells_dict={"tetra": np.array([[0, 1, 2, 4]])})
        for mesh, message in (
            (tetra, "extract its surface"),
            ((VERTICES, []), "no faces"),
            ((VERTICES, [(0, 1, 8)]), "vertices 0 to 7"),
            ((VERTICES, np.zeros((1, 3))), "integers"),
            (([(0, 0)], [(0, 0, 0)]), "shape (V, 3)"),
            (([(0, 0, np.nan)] * 3, [(0, 1, 2)]), "not finite"),
            (3, "neither a file nor a mesh"),
            ((VERTICES, [(0.5, 1, 2)]), "integers"),
            ((VERTICES, ["012"]), "integers"),
            ((VERTICES, None), "integers"),
            ((VERTICES, [0, 1, 2]), "integers"),
            ((np.array(VERTICES) + 1j, TRIANGLES), "not an array of complex128"),
            ((np.array(VERTICES).astype(str), TRIANGLES), "numbers of shape (V, 3)"),
            ((np.ma.masked_equal(VERTICES, 0.0), TRIANGLES), "masked"),
            ((VERTICES, np.ma.masked_equal(TRIANGLES, 3)), "masked"),
            (([(0, 0, 0), (1, 0)], TRIANGLES), "one length"),
            ((iter(VERTICES), TRIANGLES), "not list_iterator"),
            (SimpleNamespace(points=VERTICES, faces=np.array([3, 0, 1, 2, -1])), "at 4 there is -1"),
            (SimpleNamespace(points=VERTICES, faces=np.array([0, 3, 0, 1, 2])), "at 0 there is 0"),
            ("", "give its name"),
            ("a\0b", "give its name"),
        ):
            self.refuses(bernal.InputError, message, lambda mesh=mesh: scene_of(mesh))


if __name__ == "__main__":
    unittest.main()
