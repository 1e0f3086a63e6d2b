#!/usr/bin/python3
"""Computes conductivities of composites with FEniCS, on meshes of bernal and of Gmsh: tests/clients/with_fenics.py [BERNAL]

One sphere in a cube that repeats itself is a simple cubic lattice, whose conductivity Rayleigh knew (Phil. Mag. 34
(1892) 481, with the sign that others have mended); a random composite lies between the bounds of Hashin and Shtrikman.

Debian: gmsh, python3-gmsh, python3-dolfinx, python3-scipy, tetgen. Takes two minutes.
"""
from client import *

need_module("gmsh", "python3-gmsh")
need_module("dolfinx", "python3-dolfinx")
need_module("scipy", "python3-scipy")
SOLVER = DATA / "solvers" / "heat_conduction.py"
LATTICE = """unit = "mm"
[container]
kind = "periodic"
size = [1, 1, 1]
[spheres]
count = 1
diameter = 0.8
"""


def solved(result, mesh, ratio):
    said = run("/usr/bin/python3", SOLVER, mesh, "--ratio", ratio, "--degree", 2, "--json", folder=result.folder)
    return json.loads(said[said.index("{"):said.rindex("}") + 1])


def conductivity(result, ratio, *options):
    result.export("gmsh", "composite.py", *options)
    run("/usr/bin/python3", "composite.py", folder=result.folder, seconds=1200)
    return solved(result, "composite.msh", ratio)


def rayleigh(ratio, phi):
    """To the octupole; what is left out is of the order phi^(14/3)."""
    return 1 - 3 * phi / ((2 + ratio) / (1 - ratio) + phi - 1.3047 * phi**(10 / 3) * (1 - ratio) / (ratio + 4 / 3))


def work(folder):
    ratio = 10
    lattice = Result(folder / "lattice", LATTICE)
    meshes = {"Gmsh": lambda: conductivity(lattice, ratio, "--mesh-size", "0.15")}
    if find_program("tetgen", "tetgen"):
        run(BERNAL, "mesh", "result", "--to", "gmsh", "-o", "own.msh", "--regions", "all", "--order", 2,
            folder=lattice.folder)
        meshes["bernal"] = lambda: solved(lattice, "own.msh", ratio)
    for mesher, made in meshes.items():
        said = made()
        known = rayleigh(ratio, said["phi"])
        expect(all(abs(k - known) < 2e-3 * known for k in said["conductivity"]),
               f"simple cubic lattice by {mesher}, volume fraction {said['phi']:.4f}: {said['conductivity'][0]:.4f}, Rayleigh {known:.4f}")

    composite = Result(folder / "composite", (DATA / "scenes" / "composite.toml").read_text())
    said = conductivity(composite, ratio, "--contact", "gap")
    lower, upper = said["bounds"]
    expect(abs(said["phi"] - composite.report["phi"]) < 0.02, f"volume fraction {said['phi']:.4f} of {composite.report['phi']:.4f}")
    expect(all(lower < k < upper for k in said["conductivity"]),
           f"random composite: {', '.join(f'{k:.3f}' for k in said['conductivity'])}; bounds {lower:.3f} to {upper:.3f}")


in_folder(work)
