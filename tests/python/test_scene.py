#!/usr/bin/env python3
"""Scenes and the classes that they are made of."""

import copy
import json
import os
import pickle
import subprocess
import unittest

import numpy as np
from support import COMMAND, DATA, HELIX, InFolder, small

import bernal
from bernal import _classes


class Classes(InFolder):
    def test_there_is_a_class_for_every_table_of_the_command(self):
        groups = json.loads(subprocess.run([COMMAND, "keys", "--json"], capture_output=True, check=True).stdout)[
            "groups"
        ]
        tables = {group["name"]: [table["name"] for table in group["tables"]] for group in groups}
        for group, base in (("container", bernal.Container), ("diameter", bernal.Sizes), ("stage", bernal.Stage)):
            named = [name for name in bernal.__all__ if isinstance(getattr(bernal, name), type)]
            made = [getattr(bernal, name) for name in named if base in getattr(bernal, name).__bases__]
            self.assertEqual([each._table["name"] for each in made], tables[group])
        for name in tables["output"]:
            self.assertEqual(bernal.Output(name).format, name)

    def test_what_every_table_needs_goes_by_position(self):
        self.assertEqual(bernal.Lognormal(2, 0.3), bernal.Lognormal(median=2, sigma=0.3))
        self.assertEqual(bernal.Cylinder(5, 20), bernal.Cylinder(height=20, radius=5))
        self.assertEqual(bernal.Periodic([1, 2, 3]).size, [1, 2, 3])
        self.assertEqual(bernal.Polygon([(0, 0), (1, 0), (0, 1)]).vertices, [[0, 0], [1, 0], [0, 1]])
        self.refuses(TypeError, "takes nothing by position", lambda: bernal.Relax(17))
        self.assertEqual(bernal.Sieve([1, 2], [0, 100]).passing, [0, 100])
        self.refuses(TypeError, "takes median, sigma by position", lambda: bernal.Lognormal(1, 2, 3))
        self.refuses(TypeError, "twice", lambda: bernal.Lognormal(1, median=2))

    def test_an_unknown_keyword_says_what_was_meant(self):
        error = self.refuses(bernal.KeywordError, 'did you mean "alpha"?', lambda: bernal.Relax(alhpa=17))
        self.assertIsInstance(error, TypeError)
        self.assertIsInstance(error, ValueError)
        self.refuses(bernal.Error, 'did you mean "diameters"?', lambda: small(diameter=1))
        self.refuses(bernal.Error, 'did you mean "lammps"?', lambda: bernal.Output("lamps"))
        self.refuses(bernal.Error, 'did you mean "density"?', lambda: bernal.Output("lammps", densty=1))
        self.refuses(AttributeError, 'did you mean "alpha"?', lambda: bernal.Relax().alhpa)

    def test_attributes_are_what_was_said_or_goes_without(self):
        self.assertEqual(bernal.Relax(alpha=3).alpha, 3)
        self.assertEqual(bernal.Relax().alpha, 17)
        self.assertIsNone(bernal.Lognormal(1, 1).d43)
        self.assertEqual(repr(bernal.Lognormal(2, 0.3, min=1)), "Lognormal(median=2, sigma=0.3, min=1)")
        with self.assertRaises(AttributeError):
            bernal.Relax().alpha = 3
        self.assertEqual(bernal.Relax(alpha=3).replace(beta=2), bernal.Relax(alpha=3, beta=2))

    def test_equal_ones_have_one_hash(self):
        for one, other in (
            (bernal.Lognormal(1, 0.3), bernal.Lognormal(1.0, 0.3)),
            (bernal.Lognormal(1, 0.3, min=1), bernal.Lognormal(min=1, median=1, sigma=0.3)),
            (bernal.Box([1, 2, 3]), bernal.Box((1.0, 2.0, 3.0))),
        ):
            self.assertEqual((one, hash(one)), (other, hash(other)))

    def test_files_may_begin_with_a_mark_of_their_encoding(self):
        (self.folder / "scene.toml").write_text(small().toml, "utf-8-sig")
        self.assertEqual(bernal.Scene.read("scene.toml"), small())

    def test_counts_that_nothing_holds_are_refused(self):
        for count in (1e300, 10**30, 10**400):
            self.refuses(bernal.InputError, "from 1 to 2147483647", lambda count=count: small(count=count))

    def test_docstrings_say_defaults_and_ranges(self):
        self.assertIn("alpha : a number above 0 and of at most 1000000, default 17", bernal.Relax.__doc__)
        self.assertIn("(vertices, faces)", bernal.Mesh.__doc__)
        self.assertIn("Give alpha or period, or none of them.", bernal.Relax.__doc__)
        self.assertIn("Give median and sigma and basis or mean and sd and basis or d43 and d32.", bernal.Lognormal.__doc__)
        self.assertIn("overlap : ", bernal.Scene.__doc__)
        for kind in _classes.CLASSES.values():
            for key in kind._table["keys"]:
                self.assertIn(f"\n{key['name']} : ", kind.__doc__)

    def test_arrays_and_numbers_of_numpy_are_taken(self):
        sizes = bernal.Classes(np.array([1.0, 2.0]), shares=(np.float32(1), np.int64(3)))
        self.assertEqual(sizes, bernal.Classes([1.0, 2.0], [1.0, 3]))
        self.assertEqual(small(count=np.int32(5)).count, 5)
        self.assertEqual(small(count=1e3).count, 1000)
        self.refuses(bernal.InputError, "must be a whole number", lambda: small(count=2.5))
        self.refuses(bernal.InputError, "numbers, text, flags", lambda: bernal.Relax(alpha=object()))

    def test_an_array_of_diameters_is_packed_each_exactly_once(self):
        diameters = np.random.default_rng(3).lognormal(0, 0.3, 1200)
        scene = bernal.Scene(bernal.Periodic(), diameters=bernal.List(diameters))
        packing = bernal.pack(scene)
        np.testing.assert_array_equal(np.sort(2 * packing.radii), np.sort(diameters))
        packing.write("out")
        again = bernal.Scene.read("out/scene.toml")
        np.testing.assert_array_equal(again.diameters.values, diameters)
        np.save("diameters.npy", diameters)
        self.assertEqual(scene.replace(diameters=bernal.List(file="diameters.npy")).toml, scene.toml)
        self.refuses(bernal.InputError, 'draw = "resample"', lambda: scene.replace(count=7))

    def test_copies_and_pickles_are_equal(self):
        for each in (
            bernal.Lognormal(2, 0.3),
            bernal.Output("lammps", unit="mm"),
            small(),
            bernal.Error("bad_mesh", "x", "f", 2),
        ):
            for again in (copy.deepcopy(each), pickle.loads(pickle.dumps(each))):
                self.assertEqual(repr(again), repr(each))


class Scenes(InFolder):
    def test_the_toml_reads_back_as_the_same_scene(self):
        mixture = bernal.Mixture([1, bernal.Lognormal(2, 0.3)], [20, 80], basis="volume")
        scene = bernal.Scene(
            bernal.Mesh(HELIX, unit="mm", repair=["holes"], cap="z = 50"), radii=mixture, unit="mm", seed=7, count=50,
            gap=0.1, walls="exact", stages=[bernal.Insert(), bernal.Compress(direction=[0, 0, -1])],
            outputs=["yade", bernal.Output("lammps", unit="m", file="bed.data")],
        )  # fmt: skip
        scene.write("scene.toml")
        again = bernal.Scene.read("scene.toml")
        self.assertEqual(again.toml, scene.toml)
        self.assertEqual(
            again.radii, mixture.replace(of=[bernal.Constant(1), bernal.Lognormal(2, 0.3, basis="number")])
        )
        self.assertEqual([type(stage).__name__ for stage in again.stages], ["Insert", "Compress"])
        self.assertEqual(again.outputs[1].file, "bed.data")
        self.assertEqual((again.unit, again.seed, again.gap, again.walls), ("mm", 7, 0.1, "exact"))
        self.assertEqual(again.replace().toml, scene.toml)

    def test_every_example_is_read_as_objects_and_means_the_same(self):
        scenes = sorted((DATA / "scenes").glob("*.toml"))
        self.assertGreater(len(scenes), 20)
        for file in scenes:
            with self.subTest(file.name):
                scene = bernal.Scene.read(file)
                self.assertEqual(scene.replace().toml, scene.toml)

    def test_units_are_needed_as_the_command_needs_them(self):
        self.refuses(bernal.InputError, "needs a unit", lambda: bernal.Scene(bernal.Mesh(HELIX), diameters=2))
        self.refuses(bernal.InputError, '"parsec"', lambda: small(unit="parsec"))

    def test_errors_are_the_ones_of_the_command_without_lines_that_nobody_sees(self):
        error = self.refuses(
            bernal.InputError, '"diameter" in [spheres] must be a positive', lambda: small(diameters=-1)
        )
        self.assertEqual((error.code, error.file, error.line), ("bad_scene", None, None))
        self.assertEqual(str(error), error.message)
        self.refuses(bernal.InputError, "exclude each other", lambda: small(radii=1))
        self.refuses(bernal.InputError, "exactly one of", lambda: small(diameters=None))
        self.refuses(bernal.InputError, "does not fit", lambda: bernal.explain(bernal.Scene(bernal.Sphere(1), radii=2)))
        self.refuses(bernal.InputError, "needs a container", lambda: bernal.Scene("part.stl", diameters=1))
        self.refuses(bernal.InputError, "such as Relax()", lambda: small(stages="relax"))
        self.refuses(
            bernal.InputError, "no valid text", lambda: bernal.Scene(bernal.Mesh("\udcff.stl"), diameters=1, unit="m")
        )

    def test_errors_in_files_name_the_line(self):
        (self.folder / "bad.toml").write_text('unit = "mm"\n[container]\nkind = "sphere"\nradios = 3\n')
        error = self.refuses(bernal.InputError, 'did you mean "radius"?', lambda: bernal.Scene.read("bad.toml"))
        self.assertEqual((error.file, error.line), (str(self.folder / "bad.toml"), 4))
        self.assertTrue(str(error).startswith(f"{self.folder}/bad.toml:4: "))
        self.refuses(bernal.InputError, "no such scene file", lambda: bernal.pack("nowhere.toml"))

    def test_relative_names_stay_what_they_were(self):
        (self.folder / "part.stl").write_bytes(HELIX.read_bytes())
        scene = bernal.Scene(bernal.Mesh("part.stl", unit="mm"), diameters=5, unit="mm")
        (self.folder / "elsewhere").mkdir()
        os.chdir("elsewhere")
        self.assertIn(f'file = "{self.folder}/part.stl"', scene.toml)
        self.assertIn(f'file = "{self.folder}/part.stl"', scene.replace(seed=3).toml)
        scene.write("scene.toml")
        self.assertIn('file = "../part.stl"', (self.folder / "elsewhere" / "scene.toml").read_text())
        self.assertEqual(bernal.Scene.read("scene.toml").container.file, f"{self.folder}/part.stl")

    def test_explain_says_what_the_command_says(self):
        small().write("scene.toml")
        plan = bernal.explain("scene.toml")
        said = subprocess.run([COMMAND, "explain", "scene.toml"], capture_output=True, check=True, text=True).stdout
        self.assertEqual(str(plan), said)
        self.assertEqual(plan.expected.count, 300)
        self.assertIn("relaxation", [item.name for item in plan["items"]])


if __name__ == "__main__":
    unittest.main()
