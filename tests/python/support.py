"""What the tests of the Python module share."""

import os
import shutil
import tempfile
import unittest
from pathlib import Path

import bernal

SOURCE = Path(__file__).resolve().parents[2]
DATA = SOURCE / "data"
HELIX = DATA / "meshes" / "lib3mf_helix.stl"
COMMAND = os.environ.get("BERNAL_COMMAND", "")


class InFolder(unittest.TestCase):
    """Runs each test in a folder of its own."""

    def setUp(self):
        self.before = os.getcwd()
        self.folder = Path(tempfile.mkdtemp(prefix="bernal-test-"))
        os.chdir(self.folder)

    def tearDown(self):
        os.chdir(self.before)
        shutil.rmtree(self.folder)

    def refuses(self, kind, message, call):
        """The call raises this and says that."""
        with self.assertRaises(kind) as caught:
            call()
        self.assertIn(message, str(caught.exception))
        return caught.exception


def small(**keys):
    """A scene that packs in no time."""
    asked = {"diameters": bernal.Lognormal(1, 0.2), "count": 300, "unit": "mm", "stages": bernal.Relax(alpha=2)}
    return bernal.Scene(bernal.Periodic(), **{**asked, **keys})


def cube(edge=10.0):
    """Vertices and faces, of three corners each, seen from outside."""
    corners = [(x, y, z) for z in (0, edge) for y in (0, edge) for x in (0, edge)]
    squares = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return corners, [face for a, b, c, d in squares for face in ((a, b, c), (a, c, d))], squares
