"""bernal packs spheres into real shapes and proves that nothing overlaps.

    import bernal

    scene = bernal.Scene(bernal.Mesh("part.stl", unit="mm"), diameters=bernal.Lognormal(2, 0.3), unit="mm")
    packing = bernal.pack(scene)
    assert bernal.verify(packing)
    packing.x, packing.radii        # NumPy arrays, without a copy
    packing.write("part")           # spheres.csv, report.html, …
    bernal.export(packing, "lammps", "part.data", unit="m")

Bad input raises `bernal.Error`, with one line that names the remedy. Lengths are in the scene's unit.
"""

from __future__ import annotations

try:
    import numpy as _numpy
except ModuleNotFoundError:
    raise ModuleNotFoundError(
        "bernal needs NumPy, which is not installed here; install it, such as with pip install numpy", name="numpy"
    ) from None
del _numpy

from . import _core, design
from ._classes import CLASSES, Container, Engine, Output, Sizes, Stage
from ._errors import EngineError, Error, InputError, KeywordError, WriteError
from ._jobs import NotReached, Stopped
from ._packing import Packing
from ._pictures import Picture, View
from ._records import Certificate, Inspection, Measurements, Plan, Prediction, Record, Written
from ._scene import Scene
from ._work import explain, export, from_arrays, import_, inspect, measure, pack, predict, read, verify

__version__ = str(_core.version)
commit = str(_core.commit)
packings_number = int(_core.packings_number)

__all__ = [
    "Scene", "pack", "explain", "verify", "measure", "export", "read", "import_", "from_arrays", "inspect", "predict",
    "design", "Packing", "Picture", "View", "Container", "Sizes", "Stage", "Engine", "Output", *CLASSES,
    "Record", "Plan", "Certificate", "Measurements", "Inspection", "Prediction", "Written",
    "Error", "InputError", "KeywordError", "WriteError", "EngineError", "NotReached", "Stopped",
]  # fmt: skip

globals().update(CLASSES)

for _name in __all__:  # where users find them, and not where they stand
    if isinstance(globals()[_name], type):
        globals()[_name].__module__ = "bernal"
del _name
