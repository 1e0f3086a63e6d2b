#!/usr/bin/python3
"""The schema of scenes against the reader: what one refuses of names, types and ranges the other refuses too."""

import json
import pathlib
import subprocess
import sys
import tempfile
import tomllib
import unittest
from concurrent.futures import ThreadPoolExecutor

import jsonschema

from values import bad_values, good_values, some, tables_of

BERNAL, SOURCE = (pathlib.Path(path).resolve() for path in sys.argv[1:3])


def printed(*arguments):
    return subprocess.run([BERNAL, *arguments], check=True, capture_output=True, text=True).stdout


SCHEMA = json.loads(printed("keys", "--schema"))
VALIDATOR = jsonschema.Draft202012Validator(SCHEMA)
TABLES = list(tables_of(json.loads(printed("keys", "--json"))))


def accepted(scene):
    """By the schema."""
    return VALIDATOR.is_valid(tomllib.loads(scene))


class Reader:
    """Asks `bernal explain` for many scenes at a time."""

    def __enter__(self):
        self.folder = tempfile.TemporaryDirectory()
        self.pool = ThreadPoolExecutor(4)
        return self

    def __exit__(self, *_):
        self.pool.shutdown()
        self.folder.cleanup()

    def refusals(self, scenes):
        """Of each scene the line with which it is refused; empty where it is read."""
        def ask(numbered):
            file = pathlib.Path(self.folder.name) / f"{numbered[0]}.toml"
            file.write_text(numbered[1])
            answer = subprocess.run([BERNAL, "explain", file], capture_output=True, text=True)
            return answer.stderr.strip() if answer.returncode == 2 else ""
        return list(self.pool.map(ask, enumerate(scenes)))


class Scenes(unittest.TestCase):
    def test_schema_is_one(self):
        jsonschema.Draft202012Validator.check_schema(SCHEMA)

    def test_file_is_what_the_command_prints(self):
        file = SOURCE / "data/schemas/scene.schema.json"
        self.assertEqual(json.loads(file.read_text()), SCHEMA,
                         f"run: bernal keys --schema > {file}")

    def test_scenes_of_the_project_validate(self):
        files = sorted(SOURCE.glob("data/scenes/*.toml")) + sorted(SOURCE.glob("tests/golden/*.toml"))
        self.assertGreater(len(files), 90)
        for file in files:
            errors = [e.message for e in VALIDATOR.iter_errors(tomllib.loads(file.read_text()))]
            self.assertEqual(errors, [], file.name)

    def test_bad_values_are_refused_by_both(self):
        cases, seen, kinds = [], set(), {}
        for table in TABLES:
            for name, key in table.keys.items():
                if table.group == "output" and name in seen:  # formats share their keys
                    continue
                seen |= {name} if table.group == "output" else set()
                for value in bad_values(key, kinds):
                    lines = table.needed(table.index_with(name), name)
                    lines[name] = value
                    cases.append((table, name, table.scene(lines)))
        self.assertGreater(len(cases), 250)
        with Reader() as reader:
            for (table, name, scene), refusal in zip(cases, reader.refusals([c[2] for c in cases])):
                with self.subTest(scene=scene):
                    self.assertIn(name if table.group != "diameter" else "diameter", refusal)
                    self.assertFalse(accepted(scene), refusal)

    def test_good_values_are_accepted_by_both(self):
        cases, seen, kinds = [], set(), {}
        for table in TABLES:
            for name, key in table.keys.items():
                if table.group == "output" and name in seen:
                    continue
                seen |= {name} if table.group == "output" else set()
                for value in some(good_values(key), kinds, key["type"]):
                    lines = table.needed(table.index_with(name), name)
                    lines[name] = value
                    cases.append((name, table.scene(lines)))
        self.assertGreater(len(cases), 150)
        with Reader() as reader:
            for (name, scene), refusal in zip(cases, reader.refusals([c[1] for c in cases])):
                with self.subTest(scene=scene):
                    # It may be refused for what it means, not for what it is.
                    self.assertNotRegex(refusal, f'"{name}" in .* (must be |is not )[^,]*, not ')
                    self.assertTrue(accepted(scene), refusal)

    def test_names_and_choices_are_refused_by_both(self):
        cases = []
        for table in TABLES:
            needed = table.needed()
            cases.append(table.scene(needed | {"nonsense": "1"}))
            for choice in table.choices:
                both = {key for one in choice for key in one}
                if both in [set(one) for one in choice] or len(both) < 2:
                    continue
                cases.append(table.scene(needed | {
                    key: good_values(table.keys[key])[0] for key in both if key in table.keys}))
        cases += BAD_SCENES
        with Reader() as reader:
            for scene, refusal in zip(cases, reader.refusals(cases)):
                with self.subTest(scene=scene):
                    self.assertNotEqual(refusal, "", "the reader takes it")
                    self.assertFalse(accepted(scene), refusal)

    def test_what_is_missing_is_missed_by_both(self):
        cases = []
        for table in TABLES:
            if table.group == "zone":  # a zone without a place is a layer, where the scene says that spheres settle
                continue
            needed = table.needed()
            cases += [table.scene({k: v for k, v in needed.items() if k != name}) for name in needed]
        self.assertGreater(len(cases), 20)
        with Reader() as reader:
            for scene, refusal in zip(cases, reader.refusals(cases)):
                with self.subTest(scene=scene):
                    self.assertEqual(accepted(scene), refusal == "", refusal)

    def test_what_a_run_writes_validates(self):
        with tempfile.TemporaryDirectory() as folder:
            for name in ("box_two_classes", "discs_in_polygon", "outputs", "start_from_file", "fly_five_dimensions"):
                out = pathlib.Path(folder) / name
                subprocess.run([BERNAL, "pack", SOURCE / f"data/scenes/{name}.toml", "-o", out],
                               capture_output=True, check=False)
                VALIDATOR.validate(tomllib.loads((out / "scene.toml").read_text()))

    def test_values_that_only_the_meaning_forbids_are_left_to_the_reader(self):
        """What the schema cannot say: kept here, so that a reader that becomes milder is noticed."""
        scenes = [SPHERE + '[spheres]\nradius = { distribution = "uniform", min = 2, max = 1 }\n',
                  SPHERE + '[spheres]\ndiameter = { distribution = "percentiles", d50 = 1 }\n']
        with Reader() as reader:
            for scene, refusal, why in zip(scenes, reader.refusals(scenes), ("below", "two percentiles")):
                self.assertIn(why, refusal)
                self.assertTrue(accepted(scene))

    def test_what_lies_inside_of_spheres_needs_no_container(self):
        self.assertTrue(accepted("[spheres]\ncount = 9\nradius = 1\n"))
        self.assertFalse(accepted("[spheres]\ncount = 9\nradius = 1\nsead = 3\n"))


SPHERE = 'container = { kind = "sphere", radius = 9 }\n'
# Of tests/unit/bad_scene_test.cpp what is wrong by a name, a type or a choice.
BAD_SCENES = [
    *(SPHERE + f"[spheres]\nradius = 1\nlayers = [{layer}]\n" for layer in (
        "{}", '{ name = "a", share = 1 }', '{ name = "a", sd = 1 }', '{ name = "a", thickness = { mean = 1 } }',
        '{ name = "a", share = 0.5, thickness = 1 }', '{ name = "a", material_density = 0 }')),
    "sead = 3\n", "[sphere]\nradius = 1\n", '[container]\nkind = "box"\n\n[periodic]\n',
    SPHERE + "[spheres]\ndiametre = 1\n", SPHERE + "[spheres]\nqqqqqqqq = 1\n",
    '[container]\nkind = "cylindre"\n[spheres]\nradius = 1\n',
    '[container]\nkind = "sphere"\nradius = 1\n', "[container]\nradius = 1\n[spheres]\nradius = 1\n",
    SPHERE + "[spheres]\ncount = 3\n", SPHERE + "[spheres]\nradius = 1\ndiameter = 1\n",
    SPHERE + "[spheres]\ncount = 3\nfill = true\nradius = 1\n",
    '[container]\nkind = "mesh"\nfile = "a.stl"\n[spheres]\nradius = 1\n',
    SPHERE + "[spheres]\nradius = 1\n[[stage]]\nrounds = 1\n",
    SPHERE + '[spheres]\nradius = 1\n[stage]\ndo = "relax"\n', SPHERE + "stage = []\n[spheres]\nradius = 1\n",
    SPHERE + "spheres = 3\n", "container = 3\n[spheres]\nradius = 1\n",
    SPHERE + '[spheres]\nradius = { distribution = "lognormal", d43 = 2, d32 = 1 }\n',
    SPHERE + '[spheres]\nradius = { distribution = "rosin_rammler", d63 = 1, n = 2, min = 0.1 }\n',
    SPHERE + '[spheres]\nradius = { distribution = "mixture", of = [1, { distribution = "lognormal", d43 = 2, '
             'd32 = 1 }], shares = [1, 1] }\n',
    SPHERE + '[spheres]\nradius = { distribution = "percentiles", d10 = 1, d90 = 2 }\n',
    SPHERE + '[spheres]\nradius = { distribution = "histogram", edges = [1, 2], counts = [1], masses = [1] }\n',
    SPHERE + '[spheres]\nradius = { distribution = "list", values = [1], file = "a.csv" }\n',
    SPHERE + '[spheres]\nradius = { median = 1 }\n',
    SPHERE + '[spheres]\ndiameter = { distribution = "lognormal" }\n',
    SPHERE + '[spheres]\ndiameter = { distribution = "lognormal", d43 = 1 }\n',
    '[container]\nkind = "periodic"\nsize = [1, 2, 3]\nedge = 2\n[spheres]\nradius = 0.1\n',
    'unit = "furlong"\n' + SPHERE + "[spheres]\nradius = 1\n",
    SPHERE + '[spheres]\nradius = 1\n[[output]]\nformat = "nonsense"\n',
]

if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
