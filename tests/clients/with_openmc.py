#!/usr/bin/python3
"""OpenMC's Python API reads our geometry and finds materials in it: tests/clients/with_openmc.py [BERNAL]

Debian has no OpenMC; https://docs.openmc.org says how to install it. Takes a minute.
"""
import warnings

from client import *

openmc = need_module("openmc", "see https://docs.openmc.org")
np = need_module("numpy", "python3-numpy")

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tracer"))
from readers import read_openmc  # noqa: E402

LAYERS = """layers = [{ name = "kernel", share = 0.3 }, { name = "buffer" }, { name = "shell", thickness = 0.05 }]
"""
warnings.simplefilter("ignore", openmc.IDWarning)  # two geometries in one process
POINTS = 3000


def work(folder):
    for name, scene in (("periodic", PERIODIC), ("cylinder", CYLINDER)):
        result = Result(folder / name, scene + LAYERS)
        model = result.export("openmc", "model")
        materials = openmc.Materials.from_xml(model / "materials.xml")
        geometry = openmc.Geometry.from_xml(model / "geometry.xml", materials)
        spheres = np.array(result.spheres)
        lower, upper = spheres[:, :3].min(axis=0) / 10, spheres[:, :3].max(axis=0) / 10  # cm
        points = lower + np.random.default_rng(1).random((POINTS, 3)) * (upper - lower)
        traced, found = read_openmc(model).at(points)
        wrong = met = 0
        for point, k in zip(points, found):
            path = geometry.find(point)
            if not path or k < 0 or traced[k] == "outside":
                continue
            met += 1
            wrong += path[-1].fill.name != traced[k]
        expect(wrong == 0 and met > POINTS / 2, f"{name}: OpenMC finds what the tracer does at {met} points")


in_folder(work)
