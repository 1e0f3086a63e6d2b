#!/usr/bin/python3
"""From a scene to a number, by OpenFOAM and CalculiX: tests/clients/with_solvers.py [BERNAL]

Runs the scripts of data/solvers that mesh a packing, solve and print. The drag on a simple cubic lattice of spheres is
that of Zick & Homsy (J. Fluid Mech. 115 (1982) 13); the pressure drop of a bed with an inlet and an outlet is near that of
Eisfeld & Schnitzlein (Chem. Eng. Sci. 56 (2001) 4321). The conductivity of the lattice is Rayleigh's (Phil. Mag. 34 (1892)
481, with the sign that others have mended), with coated spheres too, and that of a composite with an interphase lies between
the bounds of Hashin and Shtrikman.

Debian: tetgen openfoam calculix-ccx python3-numpy. Takes some minutes.
"""
import math
import subprocess

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
COATED = LATTICE + """layers = [ { name = "core" }, { name = "coating", thickness = 0.01861 } ]
"""
COMPOSITE = """unit = "um"
[container]
kind = "periodic"
edge = 40
[spheres]
packing_fraction = 0.35
radius = 6
gap = 0.6
layers = [ { name = "core" }, { name = "interphase", thickness = 0.3 } ]
"""
BED = """unit = "mm"
[container]
kind = "cylinder"
radius = 1.5
height = 6
[spheres]
count = 32
bed = "poured"
diameter = 1
"""
DRAG = 7.442  # force / (6 pi mu a U) at a volume fraction of 0.216


def solved(script, result, *words):
    said = run("/usr/bin/python3", DATA / "solvers" / script, "result", "--bernal", BERNAL, "--json", *words,
               folder=result.folder, seconds=1500)
    return json.loads(said[said.index("{"):said.rindex("}") + 1])


def equivalent(degree, core, shell, share):
    """The conductivity of a homogeneous sphere that answers a field of this degree as a coated one does; share: core's radius."""
    answer = degree * (core - shell) / (degree * core + (degree + 1) * shell) * share**(2 * degree + 1)
    return shell * (1 + (degree + 1) / degree * answer) / (1 - answer)


def rayleigh(phi, dipole, octupole):
    """Of a simple cubic lattice in a matrix of 1, to the octupole; the spheres' conductivity as each of the two sees it."""
    return 1 - 3 * phi / ((2 + dipole) / (1 - dipole) + phi
                          - 1.3047 * phi**(10 / 3) * (1 - octupole) / (octupole + 4 / 3))


def flow(lattice):
    radius, reynolds = 0.3722, 0.01
    said = solved("pressure_drop.py", lattice, "--reynolds", reynolds, "--", "--mesh-size", "0.2")
    # In a cube of edge 1 the force is the gradient, and mu = U d / Re.
    of = said["flows"][0]
    drag = of["f"] * of["Re"] / (6 * math.pi * radius * said["diameter"]**2)
    expect(abs(drag / DRAG - 1) < 0.02, f"simple cubic lattice: drag {drag:.3f}, Zick & Homsy {DRAG}")
    coarse = solved("pressure_drop.py", lattice, "--reynolds", reynolds, "--", "--mesh-size", "0.5")
    expect(coarse["cells"] < said["cells"], "a mesh with other options is not the one that stands in the case")


def flow_through(bed):
    said = solved("pressure_drop.py", bed, "--ends", "1", "--before", "0.5", "--behind", "1", "--",
                  "--contact", "gap", "--gap", "0.02", "--mesh-size", "0.5", "--gap-size", "12")
    for of in said["flows"]:
        ratio = of["f"] / of["eisfeld_schnitzlein"]
        expect(of["change"] < 2e-3 and abs(ratio - 1) < 0.3,  # the coarse mesh makes it a tenth too small
               f"poured bed, D/d {said['width_over_diameter']:.2f}, porosity {said['porosity']:.3f}, Re {of['Re']:g}: "
               f"{ratio:.3f} of Eisfeld & Schnitzlein, {of['f'] / of['ergun']:.3f} of Ergun")
    expect(said["flows"][0]["f"] > 1.1 * said["flows"][0]["ergun"], "walls slow creeping flow through narrow beds")


def refused(script, result, *words):
    done = subprocess.run(["/usr/bin/python3", DATA / "solvers" / script, "result", "--bernal", BERNAL, *words],
                          cwd=result.folder, capture_output=True, text=True)
    expect(done.returncode == 2 and done.stderr.count("\n") == 1, f"refused: {done.stderr.strip()}")


def heat(lattice, coated, composite):
    for wrong in ("layer_core", "layer_core=0", "layer_shell=2", "core=2"):
        refused("composite_conductivity.py", coated, "--conductivity", wrong)
    said = solved("composite_conductivity.py", lattice, "--", "--mesh-size", "0.2")
    phi = said["shares"]["spheres"]
    known = rayleigh(phi, 10, 10)
    expect(all(0 < k - known < 0.015 * known for k in said["conductivity"]),
           f"simple cubic lattice: conductivity {said['conductivity'][0]:.4f}, Rayleigh {known:.4f}")
    core, shell = 20, 0.1  # a coating that takes the core's effect away; without it the lattice has 1.73
    said = solved("composite_conductivity.py", coated, "--conductivity", f"layer_core={core}", f"layer_coating={shell}",
                  "--", "--mesh-size", "0.5", "--layer-size", "12", "--order", "2")
    known = rayleigh(4 / 3 * math.pi * 0.3722**3, *(equivalent(degree, core, shell, 0.95) for degree in (1, 3)))
    expect(all(abs(k / known - 1) < 0.001 for k in said["conductivity"]),
           f"lattice of coated spheres: conductivity {said['conductivity'][0]:.5f}, Rayleigh {known:.5f}")
    said = solved("composite_conductivity.py", composite, "--conductivity", "layer_core=20", "layer_interphase=0.1",
                  "--", "--mesh-size", "0.6", "--layer-size", "12")
    lower, upper = said["hashin_shtrikman"]
    expect(all(lower < k < upper for k in said["conductivity"]),
           f"composite with interphase: {', '.join(f'{k:.3f}' for k in said['conductivity'])}; "
           f"bounds {lower:.3f} to {upper:.3f}")


def work(folder):
    lattice = Result(folder / "lattice", LATTICE)
    if find_program("ccx", "calculix-ccx"):
        heat(lattice, Result(folder / "coated", COATED), Result(folder / "composite", COMPOSITE))
    if find_program("simpleFoam", "openfoam"):
        flow(lattice)
        flow_through(Result(folder / "bed", BED))


in_folder(work)
