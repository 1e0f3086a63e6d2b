#!/usr/bin/env python3
"""Packings, and what is said of them, in other processes: pickles and copies."""

import copy
import json
import multiprocessing
import os
import pickle
import unittest
from pathlib import Path
from unittest import mock

import numpy as np
from support import HELIX, InFolder, cube, small

import bernal

VERTICES, TRIANGLES, SQUARES = cube()
KNOWN = (
    "unit", "dimension", "volume", "packing_fraction", "outcome", "reason", "seed", "seconds", "size_scale", "hash",
    "history", "effects", "notes",
)  # fmt: skip


def pickled(value):
    return pickle.loads(pickle.dumps(value))


def of(container, **keys):
    return bernal.Scene(container, **{"diameters": 1, "unit": "mm", "count": 20, **keys})


def packings():
    """One of each kind of domain and origin."""
    scenes = {
        "periodic": small(),
        "four dimensions": of(bernal.Periodic(dimension=4), count=50),
        "box": of(bernal.Box([4, 4, 4])),
        "discs": of(bernal.Polygon([[0, 0], [9, 0], [0, 9]]), count=10),
        "cylinder": of(bernal.Cylinder(2, 4), gap=0.01, outputs=["yade"]),
        "sphere": of(bernal.Sphere(3)),
        "file": of(bernal.Mesh(HELIX, unit="mm"), diameters=5, count=5),
        "arrays in inches": of(bernal.Mesh((np.array(VERTICES) / 20, SQUARES), unit="in")),
        "obstacles": of(bernal.Mesh((VERTICES, SQUARES), unit="mm", obstacles=[(np.array(VERTICES) / 4 + 3, SQUARES)])),
    }
    scenes["obstacles in a cylinder"] = of(
        bernal.Cylinder(3, 6, obstacles=[bernal.Sphere(1), (np.array(VERTICES) / 10 + [0.2, 0.3, 4], SQUARES)])
    )
    all_of = {name: bernal.pack(scene, seed=3) for name, scene in scenes.items()}
    all_of["a start"] = bernal.pack(of(bernal.Cylinder(2, 4), start=all_of["cylinder"], gap=0.01, count=22))
    all_of["imported"] = bernal.from_arrays(np.random.default_rng(1).random((9, 3)), 0.01, unit="m", box=[1, 1, 1])
    return all_of


def proven(packing):
    """What the certificate says, but how long that took."""
    return {key: value for key, value in bernal.verify(packing).items() if key != "seconds"}


def files_in(folder):
    """By name; of reports without the memory and the time that it took to write them."""
    all_of = {file.name: file.read_bytes() for file in Path(folder).rglob("*")}
    report = json.loads(all_of.pop("report.json"))
    for key in ("peak_memory_bytes", "seal"):
        del report[key]
    del report["certificate"]["seconds"], report["files"]["report.html"], all_of["report.html"]
    return {**all_of, "report.json": report}


class Pickles(InFolder):
    def test_they_hold_all_of_a_packing(self):
        for name, packing in packings().items():
            with self.subTest(name):
                again = pickled(packing)
                for column, other in zip((*packing.columns, packing.radii), (*again.columns, again.radii)):
                    self.assertEqual(column.tobytes(), other.tobytes())
                    self.assertFalse(other.flags.writeable)
                for key in KNOWN:
                    self.assertEqual(repr(getattr(again, key)), repr(getattr(packing, key)), key)
                self.assertEqual(again.bounds.tolist(), packing.bounds.tolist())
                for one, other in zip(packing.walls or (), again.walls or ()):
                    self.assertEqual(one.tobytes(), other.tobytes())
                self.assertEqual(again.scene.toml, packing.scene.toml)
                self.assertEqual(proven(again), proven(packing))
                self.assertEqual(repr(again), repr(packing))

    def test_they_write_the_same_files(self):
        for name, packing in packings().items():
            with self.subTest(name):
                packing.write("out")
                first = files_in("out")
                pickled(packing).write("out")
                self.assertEqual(files_in("out"), first)
                self.assertEqual(bernal.read("out").hash, packing.hash)

    def test_they_are_of_one_packings_number(self):
        packing = bernal.pack(small(count=5))
        number, bytes_of = bernal.packings_number.to_bytes(4, "little"), pickle.dumps(packing)
        program = f"bernal {packing.program}".encode()
        self.assertIn(program + number, bytes_of)
        bytes_of = bytes_of.replace(program + number, program + (7).to_bytes(4, "little"))
        self.refuses(bernal.InputError, "write it to a folder", lambda: pickle.loads(bytes_of))

    def test_processes_send_scenes_and_packings_to_each_other(self):
        first = bernal.pack(of(bernal.Cylinder(2, 4)))
        scenes = [
            of(bernal.Mesh((VERTICES, SQUARES), unit="mm")),
            of(bernal.Cylinder(2, 4), start=first, count=22, stages=bernal.Insert()),
        ]
        with multiprocessing.get_context("spawn").Pool(2) as pool:
            made = pool.map(bernal.pack, scenes)
            proofs = pool.map(bernal.verify, made)
        self.assertEqual([packing.hash for packing in made], [bernal.pack(scene).hash for scene in scenes])
        self.assertTrue(all(proofs))
        self.assertTrue((made[1].centers[:20] == first.centers).all())

    def test_nothing_is_left_in_the_folder_of_temporary_files(self):
        # One of its own, as other tests write to the shared one meanwhile.
        with mock.patch.dict(os.environ, TMPDIR=str(self.folder)):
            first = bernal.pack(of(bernal.Mesh((VERTICES, SQUARES), unit="mm")))
            bernal.pack(first.scene.replace(start=first, count=22))
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_copies_of_what_does_not_change_are_the_same(self):
        packing = bernal.pack(small(count=5))
        self.assertIs(copy.copy(packing), packing)
        self.assertIs(copy.deepcopy([packing])[0], packing)

    def test_answers_pickle_and_copy(self):
        packing = bernal.pack(small())
        proof, measured = bernal.verify(packing), bernal.measure(packing)
        for again in (pickled(proof), copy.copy(proof), copy.deepcopy(proof)):
            self.assertEqual((again, type(again), bool(again)), (proof, bernal.Certificate, True))
        for again in (pickled(measured), copy.copy(measured), copy.deepcopy(measured)):
            self.assertEqual((repr(again), type(again)), (repr(measured), bernal.Measurements))
            self.assertTrue((again.g_r.g == measured.g_r.g).all())
        written = packing.write("out")
        self.assertEqual(pickled(written), written)
        self.assertEqual(str(pickled(packing.picture)), str(packing.picture))


if __name__ == "__main__":
    unittest.main()
