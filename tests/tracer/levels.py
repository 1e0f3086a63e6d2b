#!/usr/bin/python3
"""Packs, exports for programs of particle transport, and compares the volumes that the tracer finds in the files with closed
forms: tests/tracer/levels.py [BERNAL]. Debian: python3-numpy.
"""
import json
import subprocess
import sys
import tempfile
from pathlib import Path

try:
    import numpy as np
except ImportError:
    print("skipped: Python's numpy is not installed (apt-get install python3-numpy)")
    sys.exit(77)

from geometry import volumes
from readers import READERS

BERNAL = str(Path(sys.argv[1] if len(sys.argv) > 1 else "build/release/bernal").resolve())

PARTICLES = """unit = "mm"
[container]
kind = "cylinder"
radius = 4
height = 12
base = [1, 2, 3]
[spheres]
packing_fraction = 0.35
radius = 0.455
layers = [
  { name = "kernel", radius = 0.25 },
  { name = "buffer", thickness = 0.09 },
  { name = "IPyC", thickness = 0.04 },
  { name = "SiC", thickness = 0.035 },
  { name = "OPyC" },
]
"""
SHELLS = """unit = "um"
[container]
kind = "periodic"
[spheres]
count = 2000
packing_fraction = 0.5
diameter = { distribution = "lognormal", median = 100, sigma = 0.3 }
layers = [{ name = "core", share = 0.5 }, { name = "shell" }, { name = "skin", thickness = 2 }]
"""
NAMES = {"openmc": "model", "serpent": "core.inp", "scone": "core", "mcnp": "core.mcnp"}
failures = 0


def expect(holds, what):
    global failures
    failures += not holds
    print("ok    " if holds else "FAILED", what, flush=True)


def run(*words, folder):
    done = subprocess.run([BERNAL, *map(str, words)], cwd=folder, capture_output=True, text=True, timeout=600)
    if done.returncode:
        sys.exit(f"bernal {' '.join(map(str, words))} ended with {done.returncode}\n{done.stderr}")
    return done.stdout


def balls(radii):
    return 4 / 3 * np.pi * np.sum(radii**3)


def of_particles(r):
    ends = [np.zeros_like(r), *(np.full_like(r, end) for end in (0.25, 0.34, 0.38, 0.415)), r]
    names = ("kernel", "buffer", "IPyC", "SiC", "OPyC")
    return {name: balls(outer) - balls(inner) for name, inner, outer in zip(names, ends, ends[1:])}


def of_shells(r):
    core, skin = np.cbrt(0.5) * r, r - 2
    return {"core": balls(core), "shell": balls(skin) - balls(core), "skin": balls(r) - balls(skin)}


def spheres_of(file):
    lines = Path(file).read_text().splitlines()
    return np.array([[float(n) for n in line.split(",")[:4]] for line in lines if line[0] in "-.0123456789"])


def compare(folder, scene, closed, to_cm, bounds, whole, formats, count=500_000):
    folder.mkdir()
    (folder / "scene.toml").write_text(scene)
    run("pack", "scene.toml", "-o", "out", "--quiet", folder=folder)
    spheres = spheres_of(folder / "out/spheres.csv")
    report = json.loads((folder / "out/report.json").read_text())
    known = {name: volume * to_cm**3 for name, volume in closed(spheres[:, 3]).items()}
    known["background"] = whole(report) * to_cm**3 - sum(known.values())
    for form in formats:
        run("export", "out", "--to", form, "-o", NAMES[form], folder=folder)
        geometry = READERS[form](folder / NAMES[form])
        lower, upper = (np.array(end) * to_cm for end in bounds(report))
        found = volumes(geometry, lower, upper, count)
        found.pop("outside", None)
        expect(geometry.unclear == 0, f"{form}: every point lies in one cell")
        expect(set(found) == set(known), f"{form}: materials {sorted(found)}")
        for name, volume in known.items():
            traced, error = found.get(name, (0, 0))
            deviation = abs(traced - volume)
            expect(deviation <= max(4 * error, 1e-9 * volume) and error < 0.02 * volume,
                   f"{form}: {name} {traced:.6g} cm3, {deviation / volume:.1e} from the closed form, standard error "
                   f"{error / volume:.1e}")
        # and back, to the rounding of the conversion to cm
        file = NAMES[form] + ("/geometry.xml" if form == "openmc" else "")
        run("import", file, "-o", f"{form}_again", "--quiet", folder=folder)
        again = spheres_of(folder / f"{form}_again/spheres.csv")
        expect(again.shape == spheres.shape and np.allclose(again, spheres * to_cm, rtol=1e-15, atol=1e-15 * upper.max()),
               f"{form}: {len(again)} spheres come back")


def work(folder):
    compare(folder / "particles", PARTICLES, of_particles, 0.1, lambda report: ((-3, -2, 3), (5, 6, 15)),
            lambda report: np.pi * 4**2 * 12, ("openmc", "serpent", "scone", "mcnp"))
    compare(folder / "shells", SHELLS, of_shells, 1e-4, lambda report: ((0, 0, 0), report["box"]["edges"]),
            lambda report: np.prod(report["box"]["edges"]), ("openmc", "serpent"))
    sys.exit(1 if failures else 0)


with tempfile.TemporaryDirectory() as made:
    work(Path(made))
