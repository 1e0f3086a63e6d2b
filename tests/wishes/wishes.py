#!/usr/bin/python3
"""The wishes of tests/wishes/wishes.toml, each run as it is said there.

  tests/wishes/wishes.py COMMAND [NUMBER…]    all, or these, counted from 1

Python wishes need the module bernal on PYTHONPATH; without it they are passed over, and said to be.
"""

import importlib.util
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import tomllib
import unittest

HERE = pathlib.Path(__file__).resolve().parent
BERNAL = pathlib.Path(sys.argv[1]).resolve()
WISHES = tomllib.loads((HERE / "wishes.toml").read_text())["wish"]
KEYS = {"says", "scene", "packs", "shell", "python", "expects", "not_yet", "files"}


def run(folder, *command, **more):
    """What a command prints, on both streams, and how it ends."""
    path = f"{BERNAL.parent}{os.pathsep}{os.environ['PATH']}"
    done = subprocess.run(command, cwd=folder, env=os.environ | {"PATH": path}, text=True, timeout=120,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, **more)
    return done.stdout, done.returncode


def calls_of(wish, folder):
    """The commands by which it is said, one after the other."""
    if "scene" in wish:
        (folder / "scene.toml").write_text(wish["scene"])
        yield (BERNAL, "explain", "scene.toml")
    if wish.get("packs"):
        yield (BERNAL, "pack", "scene.toml", "-o", "packed")
        yield (BERNAL, "verify", "packed")
    if "shell" in wish:
        yield ("bash", "-ec", wish["shell"])
    if "python" in wish:
        yield (sys.executable, "-B", "-c", "import bernal\n" + wish["python"])


def said(wish):
    """All that its calls print, and whether every one of them ends well; what follows a failure does not run."""
    printed = ""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        shutil.copytree(HERE / "parts", folder, dirs_exist_ok=True)
        for file, text in wish.get("files", {}).items():
            (folder / file).write_text(text)
        for call in calls_of(wish, folder):
            out, code = run(folder, *call)
            printed += out
            if code != 0:
                return printed, False
    return printed, True


class Wishes(unittest.TestCase):
    def test_table(self):
        for wish in WISHES:
            self.assertLessEqual(wish.keys(), KEYS, wish)
            has_call = any(key in wish for key in ("scene", "shell", "python"))
            self.assertTrue(has_call or "not_yet" in wish, wish)
        self.assertEqual(len({wish["says"] for wish in WISHES}), len(WISHES))


def check(wish):
    def test(self):
        if "python" in wish and not importlib.util.find_spec("bernal"):
            self.skipTest("no Python module")
        if wish.keys() <= {"says", "not_yet"}:
            return
        printed, is_well = said(wish)
        if "not_yet" in wish:
            self.assertFalse(is_well, "this can be said now: take its not_yet out of wishes.toml")
            self.assertIn(wish["not_yet"], printed)
            return
        self.assertTrue(is_well, printed)
        for text in wish.get("expects", []):
            self.assertIn(text, printed)
    test.__doc__ = wish["says"]
    return test


for number, wish in enumerate(WISHES, 1):
    setattr(Wishes, f"test_{number:02}", check(wish))

if __name__ == "__main__":
    open_ones = [f"{n:3}. {wish['says']}: {wish['not_yet']}" for n, wish in enumerate(WISHES, 1) if "not_yet" in wish]
    print(f"{len(WISHES) - len(open_ones)} of {len(WISHES)} wishes can be said. Not yet:", *open_ones, sep="\n")
    wanted = [f"Wishes.test_{int(number):02}" for number in sys.argv[2:]]
    unittest.main(argv=sys.argv[:1] + wanted, verbosity=2)
