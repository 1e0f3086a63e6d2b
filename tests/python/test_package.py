#!/usr/bin/env python3
"""What stands around the module: stubs, docstrings, the example notebook, the version."""

import ast
import importlib.util
import inspect
import json
import os
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

from support import COMMAND, DATA, InFolder, small

import bernal
from bernal import _classes

FOLDER = Path(bernal.__file__).parent


def names_of(arguments):
    return [a.arg for a in (*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs) if a.arg != "self"]


class WithoutNumPy(InFolder):
    def test_one_line_says_what_is_missing(self):
        tried = subprocess.run(
            [sys.executable, "-c", "import sys; sys.modules['numpy'] = None; import bernal"],
            capture_output=True, text=True, env={**os.environ, "PYTHONPATH": str(FOLDER.parent)},
        )  # fmt: skip
        self.assertNotEqual(tried.returncode, 0)
        self.assertIn("ModuleNotFoundError: bernal needs NumPy", tried.stderr.splitlines()[-1])
        self.assertEqual(tried.stderr.count("Error: "), 1, tried.stderr)  # none behind another


class Stubs(InFolder):
    def setUp(self):
        super().setUp()
        self.tree = ast.parse((FOLDER / "__init__.pyi").read_text())
        self.defined = {node.name: node for node in self.tree.body if hasattr(node, "name")}

    def test_they_name_all_that_there_is(self):
        self.assertEqual(set(self.defined) | {"design"}, set(bernal.__all__))
        self.assertTrue((FOLDER / "py.typed").exists())

    def test_functions_take_what_the_stubs_say(self):
        functions = [name for name in bernal.__all__ if inspect.isfunction(getattr(bernal, name))]
        self.assertGreaterEqual(len(functions), 10)
        for name in functions:
            signature = inspect.signature(getattr(bernal, name))
            given = [p.name for p in signature.parameters.values() if p.kind is not p.VAR_KEYWORD]
            self.assertEqual(names_of(self.defined[name].args), given)

    def test_classes_take_what_the_stubs_say(self):
        for name, kind in {**_classes.CLASSES, "Scene": bernal.Scene}.items():
            init = next(n for n in self.defined[name].body if getattr(n, "name", "") == "__init__")
            self.assertEqual(names_of(init.args), list(inspect.signature(kind).parameters), name)

    @unittest.skipUnless(importlib.util.find_spec("mypy"), "mypy is not installed")
    def test_a_type_checker_finds_mistakes_and_nothing_else(self):
        (self.folder / "use.py").write_text(
            "import bernal\n"
            'part = bernal.Mesh("part.stl", unit="mm")\n'
            'scene = bernal.Scene(part, diameters=bernal.Lognormal(2, 0.3), unit="mm", stages=bernal.Relax(alpha=17))\n'
            "packing = bernal.pack(scene, progress=lambda activity, fraction, detail: None)\n"
            "total: float = packing.radii.sum() + bernal.design.target(0.7).phi\n"
            "bernal.Relax(alhpa=3)\n"
            'bernal.Scene(part, diameters=1, unit="parsec")\n'
            'bernal.Output("lammps", resolution=3)\n'
        )
        paths = {"MYPYPATH": str(FOLDER.parent), "MYPY_CACHE_DIR": str(self.folder / "cache")}
        checked = subprocess.run(
            [sys.executable, "-m", "mypy", "--strict", "use.py"],
            env={**os.environ, **paths},
            capture_output=True,
            text=True,
        )
        errors = [line.split(":")[1] for line in checked.stdout.splitlines() if ": error:" in line]
        self.assertEqual(errors, ["6", "7", "8"], checked.stdout)


class Docstrings(unittest.TestCase):
    def test_everything_says_what_it_is(self):
        for name in bernal.__all__:
            of = getattr(bernal, name)
            self.assertTrue(of.__doc__, name)
            for member, value in vars(of).items() if inspect.isclass(of) else ():
                if not member.startswith("_") and (isinstance(value, property) or inspect.isfunction(value)):
                    self.assertTrue((value.fget if isinstance(value, property) else value).__doc__, f"{name}.{member}")


class Notebook(InFolder):
    def test_its_cells_run_as_a_script(self):
        (self.folder / "notebooks").mkdir()
        shutil.copytree(DATA / "meshes", self.folder / "meshes")
        os.chdir("notebooks")
        notebook = json.loads((DATA / "notebooks" / "first_packing.ipynb").read_text())
        cells = ["".join(cell["source"]) for cell in notebook["cells"] if cell["cell_type"] == "code"]
        self.assertGreater(len(cells), 8)
        known, shown = {}, []
        for cell in cells:  # as a notebook does, which shows the value of a last expression
            tree = ast.parse(cell)
            last = tree.body.pop() if isinstance(tree.body[-1], ast.Expr) else None
            exec(compile(tree, "cell", "exec"), known)
            value = eval(compile(ast.Expression(last.value), "cell", "eval"), known) if last else None
            if value is not None:
                shown.append(value)
        packing = known["packing"]
        self.assertTrue(9_000 < len(packing) < 11_000)
        self.assertEqual([type(value).__name__ for value in shown], ["str", "Plan", "Packing", "Picture", "View"])
        self.assertIn("<img", packing._repr_html_())
        self.assertIn("<pre>", shown[1]._repr_html_())
        self.assertTrue(Path("first_packing/report.html").exists())
        self.assertIn("atoms", Path("first_packing.data").read_text()[:2000])


class Version(unittest.TestCase):
    def test_it_is_that_of_the_command(self):
        said = subprocess.run([COMMAND, "--version"], capture_output=True, text=True, check=True).stdout
        program = f"{bernal.__version__} (packings {bernal.packings_number}, commit {bernal.commit})"
        self.assertEqual(said, f"bernal {program}\n")
        self.assertEqual(bernal.pack(small(count=5)).program, program)


if __name__ == "__main__":
    unittest.main()
