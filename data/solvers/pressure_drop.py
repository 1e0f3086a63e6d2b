#!/usr/bin/python3
"""Pressure drop of flow through a packed bed, by OpenFOAM's simpleFoam, beside correlations.

    data/solvers/pressure_drop.py RESULT [--reynolds 1 100] [--case FOLDER] [--json] [-- OPTIONS]

RESULT is what `bernal pack` wrote: a column, a cylinder with periodic = true, or a box that is periodic along all axes, so
that there is no inlet and no outlet whose influence would have to be taken off. `bernal mesh` meshes
the space between the spheres, with the OPTIONS; a mesh that stands in the case already is taken as it is. The flow is
laminar, incompressible and steady, and fluid sticks to spheres, bridges and walls.

A uniform force drives the fluid at the superficial velocity U along the period of the column, or --along of the box; its
size is the gradient of the pressure.

Printed is f = (dp/dL) d / (rho U^2) at Re = U d / nu, where d is the diameter with the spheres' ratio of volume to
surface, and beside it, with the porosity e of the mesh and A = 1 + 2 / (3 (D/d) (1 - e)), which is 1 without walls:
  Ergun (1952)                 150 (1 - e)^2 / (e^3 Re) + 1.75 (1 - e) / e^3
  Eisfeld & Schnitzlein (2001) 154 A^2 (1 - e)^2 / (e^3 Re) + A (1 - e) / (B e^3), B = (1.15 (d/D)^2 + 0.87)^2
The second holds for spheres at D/d above 1.6 and Re of 0.01 to 17,600; the first knows no walls.

Debian: tetgen openfoam python3-numpy.
"""
import argparse
import json
import math
import os
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy

HEAD = 'FoamFile {{ version 2.0; format ascii; class {kind}; object {name}; }}\n'
CONTROL = """application simpleFoam;
startFrom latestTime; stopAt endTime; endTime {end}; deltaT 1;
writeControl timeStep; writeInterval {every}; purgeWrite 2; writePrecision 12; writeFormat ascii;
"""
SCHEMES = """ddtSchemes { default steadyState; }
gradSchemes { default Gauss pointLinear; }
divSchemes { default none; div(phi,U) bounded Gauss linearUpwind grad(U); div((nuEff*dev2(T(grad(U))))) Gauss linear; }
laplacianSchemes { default Gauss linear corrected; }
interpolationSchemes { default linear; }
snGradSchemes { default corrected; }
"""
SOLUTION = """solvers
{
    p { solver GAMG; smoother GaussSeidel; tolerance 1e-9; relTol 0.05; }
    U { solver smoothSolver; smoother symGaussSeidel; tolerance 1e-10; relTol 0.1; }
}
SIMPLE { consistent yes; nNonOrthogonalCorrectors 1; pRefCell 0; pRefValue 0; }
relaxationFactors { fields { p 0.8; } equations { U 0.8; } }
"""
FORCE = """drive
{{
    type meanVelocityForce;
    active yes;
    selectionMode all;
    fields (U);
    Ubar {velocity};
    relaxation 0.5;
}}
"""


def stop(why):
    sys.exit(f"pressure_drop.py: {why}")


def vector(values):
    return "(" + " ".join(f"{value:.17g}" for value in values) + ")"


class Bed:
    """The spheres, and the part of the domain that the flow takes."""

    def __init__(self, folder, along):
        lines = (folder / "spheres.csv").read_text().splitlines()
        rows = [line.split(",")[:4] for line in lines if line[0] in "-.0123456789"]
        self.spheres = numpy.array(rows, dtype=float)
        radii = self.spheres[:, 3]
        self.diameter = 2 * (radii**3).sum() / (radii**2).sum()
        container = tomllib.loads((folder / "scene.toml").read_text())["container"]
        report = json.loads((folder / "report.json").read_text())
        if container["kind"] == "cylinder":
            self.width = 2 * container["radius"]
            self.axis = numpy.array(container.get("axis", [0, 0, 1]), dtype=float)
            self.axis /= numpy.linalg.norm(self.axis)
            self.area, self.length = math.pi * container["radius"] ** 2, container["height"]
            if not container.get("periodic", False):
                stop("the column has a floor and a lid; write periodic = true into [container], and pack it again")
        elif container["kind"] == "periodic" and not container.get("walls") and len(report["box"]["edges"]) == 3:
            edges = report["box"]["edges"]
            k = "xyz".index(along)
            self.width, self.axis = math.inf, numpy.eye(3)[k]
            self.length, self.area = edges[k], math.prod(edges) / edges[k]
        else:
            stop("the bed has to lie in a periodic cylinder, or in a box that is periodic along all axes")


def list_of(file, columns):
    """The numbers of a list of OpenFOAM's, in rows."""
    text = file.read_text()
    begin = text.index("\n(\n", text.index("}")) + 3
    numbers = text[begin:text.rindex("\n)")].translate(str.maketrans("()", "  "))
    return numpy.array(numbers.split(), dtype=float).reshape(-1, columns)


class Case:
    def __init__(self, folder, bed):
        self.folder, self.bed = folder, bed
        mesh = folder / "constant" / "polyMesh"
        boundary = (mesh / "boundary").read_text()
        self.patches = dict(re.findall(r"(\w+)\s*\{\s*type\s+(\w+);", boundary[boundary.index("("):]))
        points = list_of(mesh / "points", 3)
        faces = points[list_of(mesh / "faces", 4)[:, 1:].astype(int)]
        owner, neighbour = (list_of(mesh / name, 1)[:, 0].astype(int) for name in ("owner", "neighbour"))
        middles = faces.mean(axis=1)
        areas = numpy.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0]) / 2
        fluxes = (middles * areas).sum(axis=1) / 3
        self.cells = max(owner.max(), neighbour.max()) + 1
        volume = fluxes.sum() - fluxes[:len(neighbour)].sum()  # what flows out of one cell flows into another
        self.porosity = volume / (bed.area * bed.length)

    def write(self, name, kind, text):
        file = self.folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(HEAD.format(kind=kind, name=file.name) + text)

    def write_fields(self):
        of_velocity, of_pressure = "", ""
        for name, kind in self.patches.items():
            is_end = kind == "cyclic"
            u, p = ("type cyclic;", "type cyclic;") if is_end else ("type noSlip;", "type zeroGradient;")
            of_velocity += f"    {name} {{ {u} }}\n"
            of_pressure += f"    {name} {{ {p} }}\n"
        start = vector(self.bed.axis / self.porosity)  # U = 1 in the unit of length
        self.write("0/U", "volVectorField", f"dimensions [0 1 -1 0 0 0 0];\ninternalField uniform {start};\n"
                   f"boundaryField\n{{\n{of_velocity}}}\n")
        self.write("0/p", "volScalarField", "dimensions [0 2 -2 0 0 0 0];\ninternalField uniform 0;\n"
                   f"boundaryField\n{{\n{of_pressure}}}\n")
        self.write("constant/turbulenceProperties", "dictionary", "simulationType laminar;\n")
        self.write("system/fvSchemes", "dictionary", SCHEMES)
        self.write("system/fvSolution", "dictionary", SOLUTION)
        self.write("constant/fvOptions", "dictionary", FORCE.format(velocity=start))

    def solve(self, reynolds, begin, every, most, tolerance):
        """The dimensionless gradient, how much the last iterations changed it, and their number."""
        viscosity = self.bed.diameter / reynolds
        self.write("constant/transportProperties", "dictionary", f"transportModel Newtonian;\nnu {viscosity:.17g};\n")
        last, change = None, math.inf
        for time in range(begin + every, begin + most + 1, every):
            self.write("system/controlDict", "dictionary", CONTROL.format(end=time, every=every))
            said = run("simpleFoam", folder=self.folder)
            drop = float(re.findall(r"pressure gradient = (\S+)", said)[-1]) * self.bed.diameter
            change = abs(drop / last - 1) if last else math.inf
            last = drop
            if change < tolerance:
                break
        return last, change, time


def run(*command, folder):
    environment = dict(os.environ, PWD=str(folder))
    if Path("/usr/share/openfoam/etc").is_dir():  # Debian leaves it to its users to say where it is
        environment.setdefault("WM_PROJECT_DIR", "/usr/share/openfoam")
    done = subprocess.run([str(word) for word in command], cwd=folder, env=environment, capture_output=True, text=True)
    if done.returncode:
        stop(f"{command[0]} ended with {done.returncode}\n{(done.stdout + done.stderr)[-2000:]}")
    return done.stdout


def ergun(porosity, reynolds):
    solid = 1 - porosity
    return (150 * solid / reynolds + 1.75) * solid / porosity**3


def eisfeld_schnitzlein(porosity, reynolds, ratio):
    """ratio: D/d, infinite without walls."""
    solid = 1 - porosity
    a, b = 1 + 2 / (3 * ratio * solid), (1.15 / ratio**2 + 0.87) ** 2
    return (154 * a * a * solid / reynolds + a / b) * solid / porosity**3


def main():
    words = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    words.add_argument("result", type=Path, help="what bernal pack wrote")
    words.add_argument("--reynolds", type=float, nargs="+", default=[1, 100], help="U d / nu")
    words.add_argument("--case", type=Path, help="folder of OpenFOAM's case; RESULT_flow if absent")
    words.add_argument("--along", choices="xyz", default="z", help="of a periodic box")
    words.add_argument("--most", type=int, default=1000, help="iterations for each Re at most")
    words.add_argument("--tolerance", type=float, default=2e-3, help="ends where 50 iterations change the gradient by less")
    words.add_argument("--bernal", default="bernal", help="the command")
    words.add_argument("--json", action="store_true")
    given = sys.argv[1:]
    split = given.index("--") if "--" in given else len(given)
    asked = words.parse_args(given[:split])
    for program in (asked.bernal, "simpleFoam"):
        if not shutil.which(program):
            stop(f"{program} is not installed")
    bed = Bed(asked.result, asked.along)
    folder = asked.case or asked.result.with_name(asked.result.name + "_flow")
    folder = folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    if not (folder / "constant" / "polyMesh").exists():
        run(Path(shutil.which(asked.bernal)).resolve(), "mesh", asked.result.resolve(), "--to", "openfoam", "-o", "bed.foam",
            "--quiet", *given[split + 1:], folder=folder)
    case = Case(folder, bed)
    for old in [*folder.glob("[1-9]*")]:
        shutil.rmtree(old)
    case.write_fields()
    ratio = bed.width / bed.diameter
    said = {"cells": case.cells, "spheres": len(bed.spheres), "porosity": case.porosity,
            "width_over_diameter": ratio if math.isfinite(ratio) else None, "flows": []}
    if not asked.json:
        walls = f"D/d = {ratio:.4g}" if math.isfinite(ratio) else "no walls"
        print(f"bed           {len(bed.spheres):,} spheres, {walls}, porosity {case.porosity:.4f} of the mesh, "
              f"{case.cells:,} tetrahedra", flush=True)
    begin = 0
    for reynolds in sorted(asked.reynolds):
        drop, change, begin = case.solve(reynolds, begin, 50, asked.most, asked.tolerance)
        of = {"Re": reynolds, "f": drop, "change": change, "ergun": ergun(case.porosity, reynolds),
              "eisfeld_schnitzlein": eisfeld_schnitzlein(case.porosity, reynolds, ratio)}
        said["flows"].append(of)
        if asked.json:
            continue
        print(f"Re = {reynolds:<8g} f = {drop:.5g}; Ergun {of['ergun']:.5g} ({drop / of['ergun'] - 1:+.1%} from it), "
              f"Eisfeld & Schnitzlein {of['eisfeld_schnitzlein']:.5g} ({drop / of['eisfeld_schnitzlein'] - 1:+.1%})"
              + ("" if change < asked.tolerance else f"; not converged, it still changes by {change:.2%}"), flush=True)
    if asked.json:
        print(json.dumps(said, default=lambda number: number.item()))


if __name__ == "__main__":
    main()
