#!/usr/bin/env python3
"""Packings: arrays without copies, proof, measurements, files."""

import copy
import gc
import json
import pickle
import subprocess
import unittest
import warnings

import numpy as np
from support import COMMAND, DATA, HELIX, InFolder, small

import bernal


def address(array):
    return array.__array_interface__["data"][0]


class Arrays(InFolder):
    def test_a_million_spheres_are_looked_at_where_they_stand(self):
        scene = bernal.Scene(bernal.Box([125] * 3), diameters=1, count=10**6, stages=bernal.Insert(layout="lattice"))
        packing = bernal.pack(scene)
        self.assertEqual(len(packing), 10**6)
        own = packing._core.columns()  # made anew by the library each time
        views = [packing.x, packing.y, packing.z, packing.radii]
        for view, again in zip(views, own):
            self.assertIsNot(view, again)
            self.assertEqual(address(view), address(again))
            self.assertIs(view.base, packing._core)
            self.assertFalse(view.flags.writeable)
            self.assertFalse(view.flags.owndata)
            self.assertEqual((view.shape, view.dtype), ((10**6,), np.float64))
        self.assertEqual([address(c) for c in packing.columns], [address(c) for c in views[:3]])
        z, total = packing.z, packing.z.sum()
        del packing, own, views, view, again
        gc.collect()
        self.assertEqual(z.sum(), total)  # the view keeps alive what it looks at
        with self.assertRaises(ValueError):
            z[0] = 1
        with self.assertRaises(ValueError):
            z.setflags(write=True)

    def test_a_matrix_is_a_copy_that_is_kept(self):
        packing = bernal.pack(small())
        self.assertEqual(packing.centers.shape, (300, 3))
        self.assertTrue((packing.centers[:, 1] == packing.y).all())
        self.assertIs(packing.centers, packing.centers)
        self.assertFalse(np.shares_memory(packing.centers, packing.x))
        self.assertTrue((packing.diameters == 2 * packing.radii).all())

    def test_other_dimensions(self):
        discs = bernal.pack(bernal.Scene(bernal.Box([10, 10]), diameters=1, count=40))
        self.assertEqual((discs.dimension, len(discs.columns), discs.bounds.shape), (2, 2, (2, 2)))
        self.refuses(AttributeError, "no z", lambda: discs.z)
        self.assertTrue(bernal.verify(discs))
        self.assertIn("<svg", str(discs.picture))
        self.refuses(bernal.InputError, "three dimensions", discs.section)
        five = bernal.pack(
            bernal.Scene(bernal.Periodic(dimension=5), diameters=1, count=100, stages=bernal.Relax(alpha=2))
        )
        self.assertEqual(five.centers.shape, (100, 5))
        self.assertTrue(bernal.verify(five))
        self.assertEqual(str(five.picture), "")
        self.assertNotIn("<img", five._repr_html_())
        self.refuses(bernal.InputError, "dimensions", five.view)

    def test_few_spheres(self):
        one = bernal.pack(bernal.Scene(bernal.Sphere(2), radii=1, count=1))
        self.assertEqual(len(one), 1)
        self.assertTrue(bernal.verify(one))
        self.assertIn("1 sphere in", repr(one))
        bernal.measure(one)
        one._repr_html_()
        two = bernal.from_arrays([[0, 0, 0], [1.5, 0, 0]], 1, unit="mm")
        proof = bernal.verify(two, list=None)
        self.assertFalse(proof)
        self.assertEqual(proof.overlaps[0].pair, [0, 1])
        self.assertAlmostEqual(proof.overlaps[0].ratio, 0.25)


class Layers(InFolder):
    def test_cells_of_wanted_volumes_have_weights(self):
        wanted = bernal.Lognormal(median=1, sigma=0.3, basis="number")
        packing = bernal.pack(bernal.Scene(bernal.Periodic(), count=100, cells={"diameter": wanted}))
        self.assertEqual(packing.outcome, "converged")
        self.assertEqual((packing.weights.shape, packing.weights.dtype), ((100,), np.float64))
        self.assertFalse(packing.weights.flags.writeable)
        self.assertAlmostEqual(packing.weights.mean(), (packing.radii**2).mean())
        self.assertEqual(packing.scene.cells["diameter"].sigma, 0.3)
        self.assertTrue((pickle.loads(pickle.dumps(packing)).weights == packing.weights).all())
        packing.write(self.folder / "out")
        self.assertTrue((np.load(self.folder / "out" / "weights.npy") == packing.weights).all())
        self.assertTrue((bernal.read(self.folder / "out").weights == packing.weights).all())
        self.assertEqual(bernal.pack(small()).weights.size, 0)

    def test_layers_are_arrays_one_of_each(self):
        layers = [{"name": "core", "material": "glass", "material_density": 2500}, {"name": "coat", "thickness": 0.05}]
        packing = bernal.pack(small(layers=layers))
        core, coat = packing.layers
        self.assertEqual([core["name"], core["material"], coat["material"]], ["core", "glass", "coat"])
        self.assertEqual([core["material_density"], coat["material_density"]], [2500, None])
        self.assertTrue((core["spheres"] == np.arange(300)).all())
        self.assertTrue((coat["outer"] == packing.radii).all())
        self.assertTrue((core["outer"] == coat["inner"]).all())
        np.testing.assert_allclose(coat["outer"] - coat["inner"], 0.05, rtol=1e-12)
        self.assertFalse(core["outer"].flags.writeable)
        packing.write("out")
        again = bernal.read("out")
        self.assertTrue((again.layers[0]["outer"] == core["outer"]).all())
        self.assertEqual(again.scene.layers[1]["thickness"], 0.05)
        self.assertEqual(pickle.loads(pickle.dumps(packing)).layers[1]["name"], "coat")

    def test_a_packing_without_layers_has_none(self):
        self.assertEqual(bernal.pack(small()).layers, [])

    def test_drawn_thicknesses_and_layers_of_classes(self):
        drawn = {"distribution": "normal", "mean": 0.05, "sd": 0.01, "max": 0.08}
        sizes = bernal.Classes([1, 2], [1, 1], layers=[[], [{"name": "core"}, {"name": "coat", "thickness": drawn}]])
        core, coat = bernal.pack(small(diameters=sizes)).layers
        self.assertTrue((coat["outer"] == 1).all())
        self.assertGreater(np.ptp(coat["inner"]), 0.01)
        self.refuses(bernal.InputError, "\"sdd\"", lambda: bernal.pack(small(layers=[{"name": "a", "sdd": 1}])))


class Runs(InFolder):
    def test_the_command_packs_the_same(self):
        small().write("scene.toml")
        subprocess.run([COMMAND, "pack", "scene.toml", "-o", "out", "--quiet"], check=True)
        read, own = bernal.read("out"), bernal.pack("scene.toml", threads=1)
        self.assertEqual(own.hash, read.hash)
        self.assertNotEqual(bernal.pack("scene.toml", seed=2).hash, own.hash)
        self.assertEqual(read.scene.diameters.median, 1)

    def test_what_is_known_of_a_run(self):
        packing = bernal.pack(small(), seed=3)
        self.assertEqual((packing.outcome, packing.seed, packing.unit), ("converged", 3, "mm"))
        volume = 4 / 3 * np.pi * (packing.radii**3).sum()
        self.assertAlmostEqual(packing.packing_fraction, volume / packing.volume, 12)
        self.assertAlmostEqual(packing.volume, np.prod(packing.bounds[1] - packing.bounds[0]))
        self.assertEqual(packing.history[-1].spheres, 300)
        self.assertIn("relaxation", [effect.name for effect in packing.effects])
        page = packing._repr_html_()
        self.assertIn("packing fraction", page)
        self.assertIn("data:image/svg+xml;base64,", page)
        self.assertIn("<svg", str(packing.section("z = 1")))
        view = packing.view(height=300)
        self.assertIn("<html", view.page)
        self.assertIn("&lt;html", view._repr_html_())
        self.assertNotIn("<html", view._repr_html_())
        self.assertIn("height:300px", view._repr_html_())
        self.refuses(bernal.InputError, "plane", lambda: packing.section("nowhere"))

    def test_no_place_left_is_an_outcome_that_is_seen(self):
        scene = bernal.Scene(bernal.Box([4, 4, 4]), diameters=1, count=500, stages=bernal.Insert())
        with self.assertWarns(bernal.NotReached) as warned:
            packing = bernal.pack(scene)
        self.assertEqual(packing.outcome, "full")
        self.assertTrue(bernal.verify(packing))
        self.assertIn(packing.reason, str(warned.warning))
        self.assertIn(f"full: {packing.reason}", repr(packing))
        self.assertIn("color:#b87400", packing._repr_html_())
        self.assertTrue(issubclass(bernal.Stopped, bernal.NotReached))

    def test_a_perfect_end_warns_of_nothing(self):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            packing = bernal.pack(small())
        self.assertTrue(repr(packing).endswith(", converged>"))
        self.assertNotIn("#b87400", packing._repr_html_())

    def test_discs_are_called_so(self):
        packing = bernal.pack(bernal.Scene(bernal.Box([20, 20]), diameters=1, count=50, stages=bernal.Insert()))
        self.assertIn("50 discs", repr(packing))
        self.assertIn(">discs<", packing._repr_html_())

    def test_a_mesh_is_packed_without_a_scene(self):
        hopper = DATA / "meshes" / "hopper.stl"
        packing = bernal.pack(hopper, unit="m", diameters=bernal.Lognormal(0.12, 0.1), count=50)
        self.assertEqual((len(packing), packing.unit), (50, "m"))
        self.assertTrue(bernal.verify(packing))
        again = bernal.pack(bernal.Scene(bernal.Mesh(hopper), unit="m", diameters=bernal.Lognormal(0.12, 0.1), count=50))
        self.assertEqual(again.hash, packing.hash)
        plan = bernal.explain(str(hopper), file_unit="m", unit="mm", radius=60, fill=True)
        self.assertEqual(plan.unit, "mm")
        self.assertAlmostEqual(bernal.explain(hopper, unit="m", diameter=0.12).expected.count, plan.expected.count, 3)
        self.refuses(bernal.InputError, "is a mesh, not a scene", lambda: bernal.explain(hopper))
        self.refuses(bernal.InputError, "does not say its unit", lambda: bernal.pack(hopper, diameters=1))
        self.refuses(bernal.InputError, 'no "cout"; did you mean "count"', lambda: bernal.pack(hopper, unit="m", radii=1, cout=3))
        self.refuses(bernal.KeywordError, "leave out count", lambda: bernal.pack(small(), count=3))

    def test_files_hold_the_packing(self):
        packing = bernal.pack(small(outputs=["yade"]))
        written = packing.write("out")
        self.assertTrue(written.certificate)
        self.assertLessEqual(
            {"spheres.csv", "scene.toml", "report.html", "packing.svg"}, {f.name for f in written.files}
        )
        self.assertEqual(len(written.notes), 1)
        self.assertEqual(bernal.read("out").hash, packing.hash)
        self.assertEqual(bernal.verify("out").spheres, 300)
        self.assertTrue(bernal.verify("out", exact=True, threads=1))
        (self.folder / "file").write_text("")
        error = self.refuses(bernal.WriteError, "file", lambda: packing.write("file/out"))
        self.assertIsInstance(error, OSError)
        self.refuses(bernal.InputError, "no folder", lambda: bernal.read("nowhere"))

    def test_measurements_hold_arrays(self):
        measured = bernal.measure(bernal.pack(small()), gap=0.01)
        self.assertEqual(measured.contact_gap, 0.01)
        self.assertEqual(measured.g_r.r.shape, measured.g_r.g.shape)
        self.assertIsInstance(measured.g_r.g, np.ndarray)
        self.assertIsNone(measured.walls)
        cells = measured.per_sphere.cell_volume
        self.assertEqual((cells.shape, measured.per_sphere.neighbours.shape), ((300,), (300,)))
        self.assertAlmostEqual(cells.sum() / bernal.pack(small()).volume, 1, 9)
        vessel = bernal.measure(bernal.pack(bernal.Scene(bernal.Cylinder(3, 6), diameters=1, count=40)))
        self.assertEqual(set(vessel.per_sphere.chamber), {0})
        self.assertEqual(measured["phi"], measured.phi)
        self.refuses(AttributeError, 'did you mean "rattlers"?', lambda: measured.ratlers)
        self.refuses(bernal.InputError, "gap", lambda: bernal.measure(bernal.pack(small()), gap=2))

    def test_contacts_by_gap(self):
        packing = bernal.pack(small())
        few, many = packing.coordination([0.001, 0.01])
        self.assertLess(few, many)
        self.assertEqual(packing.coordination([0.002])[0], bernal.measure(packing).coordination)
        self.refuses(bernal.InputError, "from 0 to 1", lambda: packing.coordination([2]))

    def test_contacts_one_by_one(self):
        packing = bernal.pack(small())
        contacts, measured = packing.contacts(0.01), bernal.measure(packing, gap=0.01)
        self.assertEqual(len(contacts.i), measured.contacts)
        self.assertEqual((contacts.normal.shape, contacts.place.shape), ((len(contacts.i), 3), (len(contacts.i), 3)))
        np.testing.assert_allclose(np.linalg.norm(contacts.normal, axis=1), 1)
        ends = np.bincount(contacts.i, minlength=300) + np.bincount(contacts.j, minlength=300)
        np.testing.assert_array_equal(ends, measured.per_sphere.coordination)
        self.assertAlmostEqual(ends.mean(), measured.coordination, 12)
        fabric = np.einsum("ca,cb->ab", contacts.normal, contacts.normal) / len(contacts.i)
        np.testing.assert_allclose(fabric, np.array(measured.fabric), atol=1e-12)
        apart = packing.centers[contacts.j] - packing.centers[contacts.i]
        size = packing.bounds[1] - packing.bounds[0]
        apart -= size * np.round(apart / size)
        gaps = np.linalg.norm(apart, axis=1) - packing.radii[contacts.i] - packing.radii[contacts.j]
        np.testing.assert_allclose(contacts.gap, gaps, atol=1e-12)
        vessel = bernal.pack(bernal.Scene(bernal.Cylinder(3, 6), diameters=1, count=40))
        walls = vessel.contacts(0.02)
        self.assertEqual(np.sum(walls.j == -1), bernal.measure(vessel, gap=0.02).wall_contacts)
        self.refuses(bernal.InputError, "from 0 to 1", lambda: packing.contacts(2))

    def test_exports_and_imports(self):
        packing = bernal.pack(small())
        bernal.export(packing, "lammps", "bed.data", unit="m", density=1000)
        written = bernal.export(packing, bernal.Output("extxyz"))
        self.assertEqual([file.name for file in written.files], ["extxyz.xyz"])
        self.assertIn("300 spheres", written.note)
        again = bernal.import_("extxyz.xyz", unit="mm")
        self.assertEqual(again.outcome, "imported")
        self.assertTrue((again.centers == packing.centers).all())
        self.assertIn("spheres", again.notes)
        again.write("again")
        self.assertEqual(bernal.read("again").outcome, "imported")
        (self.folder / "table.csv").write_text("x,y,z,r\n0,0,0,1\n")
        self.refuses(bernal.InputError, "unit", lambda: bernal.import_("table.csv"))
        self.refuses(bernal.InputError, "no such file", lambda: bernal.import_("nowhere.csv"))
        self.refuses(bernal.KeywordError, "resolution", lambda: bernal.export(packing, "lammps", "x", resolution=3))

    def test_arrays_become_packings(self):
        rng = np.random.default_rng(1)
        centers, radii = rng.random((50, 3)) * [3, 4, 5], rng.random(50) / 10
        packing = bernal.from_arrays(centers, radii, unit="um", box=[3, 4, 5], periodic="xyz")
        self.assertTrue((packing.centers == centers).all() and (packing.radii == radii).all())
        self.assertEqual((packing.unit, packing.bounds[1].tolist()), ("um", [3, 4, 5]))
        self.refuses(bernal.InputError, "shape (N, D)", lambda: bernal.from_arrays(centers, [1, 2], unit="mm"))
        vessel = bernal.from_arrays([[0.0, 0.0, 1.0]], 1, unit="mm", container=bernal.Cylinder(1, 2))
        self.assertTrue(bernal.verify(vessel))
        self.assertFalse(
            bernal.verify(bernal.from_arrays([[0.1, 0, 1]], 1, unit="mm", container=bernal.Cylinder(1, 2)))
        )

    def test_a_packing_is_where_another_begins(self):
        first = bernal.pack(bernal.Scene(bernal.Cylinder(3, 6), diameters=1, unit="mm", count=40))
        second = bernal.pack(
            bernal.Scene(bernal.Cylinder(3, 6), diameters=1, unit="mm", start=first, stages=bernal.Insert())
        )
        self.assertGreaterEqual(len(second), 40)
        self.assertTrue((second.centers[:40] == first.centers).all())
        second.write("out")
        self.assertTrue((self.folder / "out").is_dir() and bernal.verify("out"))


class Refusals(InFolder):
    def test_arguments_of_another_kind_are_refused_in_one_line(self):
        p, at = bernal.pack(small(count=5)), [[1.0, 1, 1]]
        for message, call in {
            "threads is a whole number": lambda: bernal.pack(small(), threads=None),
            "at most 1024": lambda: bernal.pack(small(), threads=2**63 - 1),
            "list is a whole number": lambda: bernal.verify(p, list=1.5),
            "radius is a finite number": lambda: bernal.inspect(HELIX, radius="a"),
            "gap is a finite number": lambda: bernal.measure(p, gap="a"),
            "the folder is a path": lambda: p.write(""),
            "give its name": lambda: bernal.read("a\0b"),
            "box is a list of numbers": lambda: bernal.from_arrays(at, 1, unit="mm", box=5),
            "give box too, such as box=[10,10,10]": lambda: bernal.from_arrays(at, 1, unit="mm", periodic="x"),
            "not finite": lambda: bernal.from_arrays([[1, 1, np.nan]], 1, unit="mm"),
            "not exact as doubles": lambda: bernal.from_arrays(np.array([[2**53 + 1, 1, 1]], np.uint64), 1, unit="mm"),
            "beyond 2^53": lambda: bernal.from_arrays(np.array([[-(2**60), 1, 1]]), 1, unit="mm"),
            "progress is True, False, None": lambda: bernal.pack(small(), progress=5),
            "not (3,)": lambda: bernal.from_arrays([1, 2, 3], 1, unit="mm"),
            "masked": lambda: bernal.from_arrays(np.ma.masked_equal(at, 1), 1, unit="mm"),
            "not an array of complex128": lambda: bernal.from_arrays(at, 1j, unit="mm"),
        }.items():
            with self.subTest(message):
                said = str(self.refuses(bernal.InputError, message, call))
                self.assertNotIn("--", said)
                self.assertNotIn("\n", said)

    def test_each_front_end_has_its_own_words_for_options(self):
        (self.folder / "table.csv").write_text("x,y,z\n0,0,0\n")
        (self.folder / "rows.csv").write_text("1,2,3,4\n")
        for words, keys, command, python in (
            ([], {}, "give --diameter or --radius, or", "give diameter or radius, or"),
            (["--radius", "1"], {"radius": 1}, "such as --unit mm", "such as unit='mm'"),
            (["--radius", "1", "--unit", "mm", "--periodic", "xyz"], {"radius": 1, "unit": "mm", "periodic": "xyz"},
             "give --box too, such as --box 10,10,10", "give box too, such as box=[10,10,10]"),
            (["--frame", "2"], {"frame": 2}, "takes no --frame; these do", "takes no frame; these do"),
            (["--frame", "2"], {"frame": 2}, "--from says which", "format says which"),
        ):  # fmt: skip
            done = subprocess.run([COMMAND, "import", "table.csv", "-o", "out", *words], capture_output=True, text=True)
            self.assertIn(command, done.stderr)
            self.refuses(bernal.InputError, python, lambda: bernal.import_("table.csv", **keys))
        done = subprocess.run([COMMAND, "import", "rows.csv", "-o", "out"], capture_output=True, text=True)
        self.assertIn("such as --columns x,y,z,r (r radius", done.stderr)
        self.refuses(bernal.InputError, "such as columns='x,y,z,r' (r radius", lambda: bernal.import_("rows.csv"))
        notes = bernal.import_("table.csv", radius=1, unit="mm").notes
        self.assertIn("; box or container says another", notes.domain)
        bernal.pack(small(count=5)).write("out")
        self.refuses(bernal.WriteError, "give another file", lambda: bernal.export("out", "lammps", "out/packing.svg"))
        done = subprocess.run([COMMAND, "export", "out", "--to", "lammps", "-o", "out/packing.svg"],
                              capture_output=True, text=True)  # fmt: skip
        self.assertIn("give another name with -o", done.stderr)

    def test_packings_do_not_change(self):
        packing = bernal.pack(small(count=5))
        self.refuses(ValueError, "WRITEABLE", lambda: packing.centers.setflags(write=True))
        self.assertIsInstance(packing.centers.base, bytes)

    def test_keys_win_over_methods_of_dictionaries(self):
        plan = bernal.explain(small())
        self.assertEqual(plan.items, plan["items"])
        self.assertEqual(json.loads(json.dumps(plan))["items"], plan.items)
        self.assertEqual(pickle.loads(pickle.dumps(plan)), plan)
        self.assertEqual(str(copy.copy(plan)), plan.words)
        self.assertEqual(len(bernal.design.best(1, 9).values), 3)


class Sizes(InFolder):
    def test_predictions_are_those_of_the_command(self):
        self.assertAlmostEqual(bernal.predict(bernal.Lognormal(1, 0.5, basis="volume")).phi, 0.7073, 4)
        self.assertAlmostEqual(float(bernal.predict(3)), 0.6435, 3)
        self.assertEqual(bernal.predict(small()).phi, bernal.predict(bernal.Lognormal(1, 0.2)).phi)
        self.refuses(
            bernal.InputError, "three dimensions", lambda: bernal.predict(bernal.Scene(bernal.Box([1, 1]), radii=0.1))
        )
        self.refuses(bernal.InputError, "positive", lambda: bernal.predict(-1))

    def test_designs(self):
        best = bernal.design.maximise([1, 5])
        self.assertAlmostEqual(best.shares[0], 0.208, 3)
        self.assertAlmostEqual(bernal.predict(best.diameters).phi, best.phi, 6)
        wide = bernal.design.maximise([1, bernal.Lognormal(8, 0.2, basis="volume")], rods=2000)
        self.assertIsInstance(wide.diameters, bernal.Mixture)
        self.assertAlmostEqual(bernal.predict(wide.diameters, rods=2000).phi, wide.phi, 5)
        found = bernal.design.target(0.7)
        self.assertAlmostEqual(found.parameter, 0.4619, 4)
        self.assertAlmostEqual(bernal.predict(found.diameters).phi, 0.7, 6)
        none = bernal.design.target(0.9, lambda t: bernal.Uniform(1, 1 + t, basis="volume"), 0.1, 2)
        self.assertFalse(none.found)
        self.assertLess(none.reachable[1], 0.9)
        three = bernal.design.best(1, 10, 3, rods=2000)
        self.assertEqual((three["values"][0], three["values"][-1]), (1, 10))
        self.assertAlmostEqual(bernal.predict(three.diameters, rods=2000).phi, three.phi, 5)
        self.assertGreater(bernal.design.relative_viscosity(0.3, 0.64), 2)

    def test_errors_of_a_family_come_through(self):
        self.refuses(ZeroDivisionError, "", lambda: bernal.design.target(0.7, lambda t: 1 / 0))
        self.refuses(bernal.InputError, "between 0 and 1", lambda: bernal.design.target(2))
        self.refuses(bernal.InputError, "", lambda: bernal.design.maximise([1]))


if __name__ == "__main__":
    unittest.main()
