#!/usr/bin/python3
"""What runs of all kinds report, against data/schemas/report.schema.json, which takes no key that it does not name."""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

import jsonschema

BERNAL, SOURCE = (pathlib.Path(path).resolve() for path in sys.argv[1:3])
SCHEMA = json.loads((SOURCE / "data/schemas/report.schema.json").read_text())
MEASUREMENTS = {"$defs": SCHEMA["$defs"], "$ref": "#/$defs/measurements"}
CERTIFICATE = {"$defs": SCHEMA["$defs"], "$ref": "#/$defs/certificate"}

BOX = '[container]\nkind = "periodic"\n[spheres]\n'
COLUMN = '[container]\nkind = "cylinder"\nradius = 4\nheight = 9\n'
# How it ends, and the scene.
RUNS = {
    "periodic": ("converged", BOX + "count = 200\nradius = 1\n"),
    "lognormal": ("converged", BOX + 'count = 300\nradius = { distribution = "lognormal", median = 1, sigma = 0.3 }\n'),
    "classes": ("converged", '[container]\nkind = "box"\nsize = [9, 9, 9]\n[spheres]\ncount = 60\n'
                'diameter = { distribution = "classes", values = [1, 2], shares = [3, 1] }\n'),
    "cylinder": ("converged", COLUMN + "[spheres]\ncount = 40\nradius = 0.6\n"),
    "column": ("converged", COLUMN + "periodic = true\n[spheres]\ncount = 40\nradius = 0.6\n"),
    "mesh": ("converged", f'unit = "m"\n[container]\nkind = "mesh"\nfile = "{SOURCE}/data/meshes/hopper.stl"\nunit = "m"\n'
             '[spheres]\ncount = 50\nradius = 0.05\n'),
    "discs": ("converged", '[container]\nkind = "box"\nsize = [9, 9]\n[spheres]\ncount = 30\nradius = 0.5\n'),
    "five dimensions": ("converged", '[container]\nkind = "periodic"\ndimension = 5\nedge = 5\n[spheres]\ncount = 40\n'
                        'radius = 1\n[[stage]]\ndo = "fly"\n'),
    "gaps": ("converged", COLUMN + "[spheres]\ncount = 30\nradius = 0.5\ngap = 0.05\nwall_gap = 0.1\n"),
    "cells": ("converged", BOX + 'count = 60\ncells = { volume = { distribution = "uniform", min = 1, max = 2, basis = "number" } }\n'),
    "one sphere": ("converged", COLUMN + "[spheres]\ncount = 1\nradius = 1\n"),
    "between walls": ("converged", '[container]\nkind = "periodic"\nsize = [6, 6, 6]\nwalls = [2]\n[spheres]\ncount = 30\n'
                      'radius = 0.6\n[[stage]]\ndo = "fly"\n'),
    "full": ("full", COLUMN + "[spheres]\ncount = 900\nradius = 0.6\n"),
    "empty": ("full", COLUMN + "[spheres]\ncount = 3\nradius = 3\n[[stage]]\ndo = \"insert\"\nattempts = 1\npacking_fraction = 1e-9\n"),
    "limit": ("hit_limit", COLUMN + '[spheres]\ncount = 280\nradius = 0.6\n[[stage]]\ndo = "relax"\nsweeps = 1\n'),
    "polished": ("converged", BOX + 'count = 60\nradius = 1\n[[stage]]\ndo = "relax"\npolish = 1e-8\n'),
    "two outputs": ("converged", COLUMN + "[spheres]\ncount = 30\nradius = 0.6\n"
                    '[[output]]\nformat = "lammps"\n[[output]]\nformat = "extxyz"\n'),
}

IDLE_ENGINE = r"""#!/bin/bash
awk '/^[0-9]+ atoms/ { n = $1 }
     /[xyz]lo/ { box = box $1 " " $2 "\n" }
     /^Atoms/ { atoms = 1
                printf "ITEM: TIMESTEP\n1\nITEM: NUMBER OF ATOMS\n%d\nITEM: BOX BOUNDS pp pp pp\n%s", n, box
                print "ITEM: ATOMS id x y z radius" }
     atoms && NF == 7 { printf "%s %s %s %s %.17g\n", $1, $5, $6, $7, $3 / 2 }' spheres.data > places.dump
echo "bernal: all places are written" > log.lammps
"""


def keys_in(schema, path=""):
    """Every object of a schema that names its keys."""
    if isinstance(schema, dict):
        if "properties" in schema and schema.get("type") == "object":
            yield path, schema
        for key, value in schema.items():
            yield from keys_in(value, f"{path}/{key}")
    if isinstance(schema, list):
        for index, value in enumerate(schema):
            yield from keys_in(value, f"{path}/{index}")


class Reports(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def run_bernal(self, *arguments):
        return subprocess.run([BERNAL, *arguments], capture_output=True, text=True, cwd=self.folder)

    def check_result(self, name, outcome):
        report = json.loads((self.folder / name / "report.json").read_text())
        jsonschema.Draft202012Validator(SCHEMA).validate(report)
        self.assertEqual(report["outcome"], outcome, report["reason"])
        measured = self.run_bernal("measure", name, "--json")
        self.assertEqual(measured.returncode, 0, measured.stderr)
        jsonschema.Draft202012Validator(MEASUREMENTS).validate(json.loads(measured.stdout))
        if "container" in report and "periods" not in report["container"]:
            slab = self.run_bernal("measure", name, "--json", "--slab", "z > -1e9")
            jsonschema.Draft202012Validator(MEASUREMENTS).validate(json.loads(slab.stdout))
        verified = self.run_bernal("verify", name, "--json", "--list")
        jsonschema.Draft202012Validator(CERTIFICATE).validate(json.loads(verified.stdout))
        return report

    def test_schema_is_one_and_closed(self):
        jsonschema.Draft202012Validator.check_schema(SCHEMA)
        objects = list(keys_in(SCHEMA))
        self.assertGreater(len(objects), 30)
        for path, schema in objects:
            if path.endswith("files"):
                continue
            self.assertIs(schema.get("additionalProperties"), False, path)
            self.assertIn("required", schema, path)

    def test_a_key_more_or_less_is_refused(self):
        (self.folder / "s.toml").write_text(RUNS["cylinder"][1])
        self.run_bernal("pack", "s.toml", "-o", "strict")
        report = json.loads((self.folder / "strict/report.json").read_text())
        validator = jsonschema.Draft202012Validator(SCHEMA)
        self.assertTrue(validator.is_valid(report))
        for key in report:
            self.assertFalse(validator.is_valid({k: v for k, v in report.items() if k != key}), key)
        self.assertFalse(validator.is_valid(report | {"nonsense": 1}))
        for key in ("certificate", "walls", "backbone", "container", "chambers"):
            self.assertFalse(validator.is_valid(report | {key: report[key] | {"nonsense": 1}}), key)

    def test_runs(self):
        for name, (outcome, scene) in RUNS.items():
            with self.subTest(run=name):
                (self.folder / f"{name}.toml").write_text(scene)
                run = self.run_bernal("pack", f"{name}.toml", "-o", name, "--threads", "1")
                self.assertIn(run.returncode, (0, 3), run.stderr)
                self.check_result(name, outcome)

    def test_slabs(self):
        """An engine that leaves every sphere where it was put."""
        engine = self.folder / "engine"
        engine.write_text(IDLE_ENGINE)
        engine.chmod(0o755)
        (self.folder / "slabs.toml").write_text(
            '[container]\nkind = "periodic"\nsize = [4, 1, 1]\nscalable = true\n[spheres]\ncount = 400\nradius = 1\n'
            f'[engine]\nkind = "lammps"\nexecutable = "{engine}"\nslabs = 3\n')
        run = self.run_bernal("pack", "slabs.toml", "-o", "slabs")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("bernal measure", run.stderr)
        report = self.check_result("slabs", "converged")
        self.assertIn("3 slabs", report["not_measured"])

    def test_imported_with_overlaps(self):
        (self.folder / "theirs.csv").write_text("x,y,z,r\n0,0,0,1\n1,0,0,1\n5,5,5,1\n")
        done = self.run_bernal("import", "theirs.csv", "-o", "imported", "--box", "9,9,9", "--unit", "mm")
        self.assertEqual(done.returncode, 0, done.stderr)
        report = self.check_result("imported", "imported")
        self.assertFalse(report["certified"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
