#!/usr/bin/python3
"""From a scene to a number, by OpenFOAM and CalculiX: tests/clients/with_solvers.py [BERNAL]

Runs the scripts of data/solvers that mesh a packing, solve and print. The drag on a simple cubic lattice of spheres is
that of Zick & Homsy (J. Fluid Mech. 115 (1982) 13), its conductivity Rayleigh's (Phil. Mag. 34 (1892) 481, with the sign
that others have mended), and the conductivity of a composite lies between the bounds of Hashin and Shtrikman.

Debian: tetgen openfoam calculix-ccx python3-numpy. Takes some minutes.
"""
import math

from client import *

need_program("tetgen", "tetgen")
need_module("numpy", "python3-numpy")
LATTICE = """unit = "mm"
[container]
kind = "periodic"
size = [1, 1, 1]
[spheres]
count = 1
radius = 0.3722
"""
COMPOSITE = """unit = "um"
[container]
kind = "periodic"
edge = 40
[spheres]
packing_fraction = 0.35
radius = 6
gap = 0.6
"""
DRAG = 7.442  # force / (6 pi mu a U) at a volume fraction of 0.216


def solved(script, result, *words):
    said = run("/usr/bin/python3", DATA / "solvers" / script, "result", "--bernal", BERNAL, "--json", *words,
               folder=result.folder, seconds=1500)
    return json.loads(said[said.index("{"):said.rindex("}") + 1])


def rayleigh(ratio, phi):
    """To the octupole."""
    return 1 - 3 * phi / ((2 + ratio) / (1 - ratio) + phi - 1.3047 * phi**(10 / 3) * (1 - ratio) / (ratio + 4 / 3))


def flow(lattice):
    radius, reynolds = 0.3722, 0.01
    said = solved("pressure_drop.py", lattice, "--reynolds", reynolds, "--", "--mesh-size", "0.2")
    # In a cube of edge 1 the force is the gradient, and mu = U d / Re.
    drag = said["flows"][0]["f"] * reynolds / (6 * math.pi * radius * (2 * radius)**2)
    expect(abs(drag / DRAG - 1) < 0.02, f"simple cubic lattice: drag {drag:.3f}, Zick & Homsy {DRAG}")


def heat(lattice, composite):
    said = solved("composite_conductivity.py", lattice, "--", "--mesh-size", "0.2")
    known = rayleigh(10, said["shares"]["spheres"])
    expect(all(0 < k - known < 0.015 * known for k in said["conductivity"]),
           f"simple cubic lattice: conductivity {said['conductivity'][0]:.4f}, Rayleigh {known:.4f}")
    said = solved("composite_conductivity.py", composite, "--conductivity", "spheres=20")
    lower, upper = said["hashin_shtrikman"]
    expect(all(lower < k < upper for k in said["conductivity"]),
           f"composite: {', '.join(f'{k:.3f}' for k in said['conductivity'])}; bounds {lower:.3f} to {upper:.3f}")


def work(folder):
    lattice = Result(folder / "lattice", LATTICE)
    if find_program("ccx", "calculix-ccx"):
        heat(lattice, Result(folder / "composite", COMPOSITE))
    if find_program("simpleFoam", "openfoam"):
        flow(lattice)


in_folder(work)
