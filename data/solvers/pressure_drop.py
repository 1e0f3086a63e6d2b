#!/usr/bin/python3
"""Pressure drop of flow through a packed bed, by OpenFOAM's simpleFoam, beside correlations.

    data/solvers/pressure_drop.py RESULT [--reynolds 1 100] [--case FOLDER] [--json] [-- OPTIONS]

RESULT is what `bernal pack` wrote: a cylinder, with floor and lid or periodic, or a box that is periodic along all axes.
`bernal mesh` meshes the space between the spheres, with the OPTIONS; a mesh that the script has made before of the same spheres
with the same OPTIONS is taken again. The flow is laminar, incompressible and steady, and fluid sticks to spheres, bridges and walls.

A cylinder with floor and lid gets free space in place of what it had: --before and --behind diameters long, in front of the
first sphere and after the last along the axis. Fluid enters at the floor with the uniform velocity U, and leaves at the lid.
The gradient is that between two planes across the axis, --ends diameters from the ends of the bed: the difference of the
mean pressures in the slabs of one diameter about them, over the distance of the planes. The porosity is that of the window
between the planes, which begins and ends as gradually as the slabs.

Along the period of a column, or --along of a box, a uniform force drives the fluid; its size is the gradient of the pressure.
U is the flux through the end of the period over its whole area.

Printed is f = (dp/dL) d / (rho U^2) at Re = U d / nu, with the porosity e and d = 6 times volume over surface of what the
fluid flows around, both as the mesh has them, and beside it, with A = 1 + 2 / (3 (D/d) (1 - e)), which is 1 without walls:
  Ergun (1952)                 150 (1 - e)^2 / (e^3 Re) + 1.75 (1 - e) / e^3
  Eisfeld & Schnitzlein (2001) 154 A^2 (1 - e)^2 / (e^3 Re) + A (1 - e) / (B e^3), B = (1.15 (d/D)^2 + 0.87)^2
The second holds for spheres at D/d above 1.6 and Re of 0.01 to 17,600; the first knows no walls.

Exit codes: 0; 2 bad input; 3 where simpleFoam diverged or did not converge. What it printed is in log.simpleFoam of the case.

Debian: tetgen openfoam python3-numpy.
"""
import argparse
import hashlib
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
laplacianSchemes { default Gauss linear limited corrected 0.5; }
interpolationSchemes { default linear; }
snGradSchemes { default limited corrected 0.5; }
"""
SOLUTION = """solvers
{
    p { solver GAMG; smoother GaussSeidel; tolerance 1e-9; relTol 0.1; }
    U { solver smoothSolver; smoother symGaussSeidel; tolerance 1e-10; relTol 0.1; }
}
SIMPLE { consistent yes; nNonOrthogonalCorrectors 0; pRefCell 0; pRefValue 0; }
relaxationFactors { fields { p %g; } equations { U %g; } }
"""
RELAXATION = (0.8, 0.8), (0.3, 0.6)  # of p and U; the second where the first diverges
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
EVERY = 25  # iterations between two looks at the gradient


def stop(why, code=2):
    print(f"pressure_drop.py: {why}", file=sys.stderr)
    sys.exit(code)


class Diverged(Exception):
    pass


def vector(values):
    return "(" + " ".join(f"{value:.17g}" for value in values) + ")"


class Bed:
    """The spheres, and the part of the domain that the flow takes."""

    def __init__(self, folder, along):
        self.folder = folder
        for name in ("spheres.csv", "scene.toml", "report.json"):
            if not (folder / name).exists():
                stop(f"{folder} has no {name}; give the folder that bernal pack wrote")
        lines = (folder / "spheres.csv").read_text().splitlines()
        rows = [line.split(",")[:4] for line in lines if line[0] in "-.0123456789"]
        self.spheres = numpy.array(rows, dtype=float)
        self.scene = (folder / "scene.toml").read_text()
        container = tomllib.loads(self.scene)["container"]
        report = json.loads((folder / "report.json").read_text())
        self.flows_in = False
        if container["kind"] == "cylinder":
            self.width = 2 * container["radius"]
            self.axis = numpy.array(container["axis"], dtype=float)
            self.axis /= numpy.linalg.norm(self.axis)
            self.base = numpy.array(container["base"], dtype=float)
            self.area, self.length = math.pi * container["radius"] ** 2, container["height"]
            self.flows_in = not container["periodic"]
            self.end = "z_upper"
        elif container["kind"] == "periodic" and not container.get("walls") and len(report["box"]["edges"]) == 3:
            edges = report["box"]["edges"]
            k = "xyz".index(along)
            self.width, self.axis = math.inf, numpy.eye(3)[k]
            self.length, self.area = edges[k], math.prod(edges) / edges[k]
            self.end = f"{along}_upper"
        else:
            stop("the bed has to lie in a cylinder, or in a box that is periodic along all axes")

    def give_free_space(self, before, behind, ends, folder, bernal):
        """Puts the spheres into a cylinder that begins and ends so many diameters away from them; sets the window."""
        heights, radii = (self.spheres[:, :3] - self.base) @ self.axis, self.spheres[:, 3]
        diameter = 2 * (radii**3).sum() / (radii**2).sum()
        low, high = (heights - radii).min(), (heights + radii).max()
        first, last = low - before * diameter, high + behind * diameter
        self.window = low + ends * diameter - first, high - ends * diameter - first
        self.slab = diameter
        if self.window[1] - self.window[0] < diameter or ends < 0.5:
            stop(f"the bed is {(high - low) / diameter:.2f} diameters long; less than one is left between its --ends")
        self.base, self.length = self.base + first * self.axis, last - first
        place = re.sub(r"(?m)^base = .*$", f"base = {[float(x) for x in self.base]}", self.scene)
        place = re.sub(r"(?m)^height = .*$", f"height = {float(self.length)!r}", place, count=1)
        (folder / "longer.toml").write_text(place)
        run(bernal, "import", self.folder / "spheres.csv", "--container", "longer.toml", "-o", "longer", "--no-view",
            "--quiet", folder=folder)
        self.folder = folder / "longer"


def list_of(file, columns):
    """The numbers of a list of OpenFOAM's, in rows: of a mesh, or of the inside of a field."""
    text = file.read_text()
    begin = text.index("\n(\n", text.index("}")) + 3
    numbers = text[begin:text.index("\n)", begin)].translate(str.maketrans("()", "  "))
    return numpy.array(numbers.split(), dtype=float).reshape(-1, columns)


class Case:
    def __init__(self, folder, bed):
        self.folder, self.bed = folder, bed
        mesh = folder / "constant" / "polyMesh"
        boundary = (mesh / "boundary").read_text()
        self.patches = dict(re.findall(r"(\w+)\s*\{\s*type\s+(\w+);", boundary[boundary.index("("):]))
        ranges = {name: slice(int(first), int(first) + int(count)) for name, count, first
                  in re.findall(r"(\w+)\s*\{[^}]*nFaces\s+(\d+);\s*startFace\s+(\d+);", boundary)}
        points = list_of(mesh / "points", 3)
        faces = points[list_of(mesh / "faces", 4)[:, 1:].astype(int)]
        owner, neighbour = (list_of(mesh / name, 1)[:, 0].astype(int) for name in ("owner", "neighbour"))
        reach = numpy.ptp(points @ bed.axis)
        if abs(reach / bed.length - 1) > 1e-6:
            stop(f"the mesh in {folder} is {reach:.6g} long and not {bed.length:.6g}; take it away, or name another --case")
        middles = faces.mean(axis=1)
        areas = numpy.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0]) / 2
        fluxes = (middles * areas).sum(axis=1) / 3
        self.cells = max(owner.max(), neighbour.max()) + 1
        inside = slice(len(neighbour))

        def sums(outward, values):
            """Over the four faces of each tetrahedron."""
            return (numpy.bincount(owner, values, self.cells)
                    + outward * numpy.bincount(neighbour, values[inside], self.cells))

        self.volumes = sums(-1, fluxes)
        sizes = numpy.linalg.norm(areas, axis=1)
        surface = sum(sizes[part].sum() for name, part in ranges.items() if name.startswith("surface_of_"))
        solid = bed.area * bed.length - self.volumes.sum()
        self.diameter = 6 * solid / surface
        self.porosity = 1 - solid / (bed.area * bed.length)
        if bed.flows_in:
            heights = sums(1, (middles - bed.base) @ bed.axis) / 4
            low, high = ((heights - plane) / bed.slab + 0.5 for plane in bed.window)
            self.slabs = [numpy.where((share > 0) & (share < 1), self.volumes, 0) for share in (low, high)]
            through = numpy.clip(low, 0, 1) - numpy.clip(high, 0, 1)
            self.apart = bed.window[1] - bed.window[0]
            self.porosity = (self.volumes * through).sum() / (bed.area * self.apart)
            self.inlet = bed.area / sizes[ranges["floor"]].sum()  # a polygon stands for the circle

    def write(self, name, kind, text):
        file = self.folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(HEAD.format(kind=kind, name=file.name) + text)

    def write_fields(self, relaxation):
        for old in self.folder.glob("[1-9]*"):
            shutil.rmtree(old)
        start = vector(self.bed.axis / self.porosity)  # U = 1 in the unit of length
        ends = {}
        if self.bed.flows_in:  # what flows back through the lid would grow without bounds if its velocity were that inside
            ends = {"floor": (f"type fixedValue; value uniform {vector(self.bed.axis * self.inlet)};", "type zeroGradient;"),
                    "lid": ("type inletOutlet; inletValue uniform (0 0 0); value uniform (0 0 0);",
                            "type fixedValue; value uniform 0;")}
        of_velocity, of_pressure = "", ""
        for name, kind in self.patches.items():
            u, p = ("type cyclic;",) * 2 if kind == "cyclic" else ends.get(name, ("type noSlip;", "type zeroGradient;"))
            of_velocity += f"    {name} {{ {u} }}\n"
            of_pressure += f"    {name} {{ {p} }}\n"
        self.write("0/U", "volVectorField", f"dimensions [0 1 -1 0 0 0 0];\ninternalField uniform {start};\n"
                   f"boundaryField\n{{\n{of_velocity}}}\n")
        self.write("0/p", "volScalarField", "dimensions [0 2 -2 0 0 0 0];\ninternalField uniform 0;\n"
                   f"boundaryField\n{{\n{of_pressure}}}\n")
        self.write("constant/turbulenceProperties", "dictionary", "simulationType laminar;\n")
        self.write("system/fvSchemes", "dictionary", SCHEMES)
        self.write("system/fvSolution", "dictionary", SOLUTION % relaxation)

    def gradient(self, said, time):
        """Of the pressure at a superficial velocity of 1, and that velocity as it came out."""
        folder = self.folder / str(time)
        if self.bed.flows_in:
            pressure = list_of(folder / "p", 1)[:, 0]
            before, behind = ((slab * pressure).sum() / slab.sum() for slab in self.slabs)
            return (before - behind) / self.apart, 1
        through = (folder / "phi").read_text()
        through = re.search(rf"\n    {self.bed.end}\n[^}}]*?\n\(\n([^)]*)\n\)", through)[1]
        velocity = abs(sum(map(float, through.split()))) / self.bed.area
        return float(re.findall(r"pressure gradient = (\S+)", said)[-1]), velocity

    def solve(self, reynolds, begin, most, tolerance):
        """f, Re of the velocity that came out, how much the last iterations changed f, and their number."""
        self.write("constant/transportProperties", "dictionary",
                   f"transportModel Newtonian;\nnu {self.diameter / reynolds:.17g};\n")
        last, change = None, math.inf
        for time in range(begin + EVERY, begin + most + 1, EVERY):
            if not self.bed.flows_in:
                self.write("constant/fvOptions", "dictionary", FORCE.format(velocity=vector(self.bed.axis / self.porosity)))
            self.write("system/controlDict", "dictionary", CONTROL.format(end=time, every=EVERY))
            said = run("simpleFoam", folder=self.folder, log=self.folder / "log.simpleFoam")
            drop, velocity = self.gradient(said, time) if said else (math.nan, 1)
            drop *= self.diameter / velocity**2
            if not 0 < drop < 1e9 * (1 + 1 / reynolds):
                raise Diverged(f"simpleFoam diverged at Re = {reynolds:g}, within {time} iterations")
            change = abs(drop / last - 1) if last else math.inf
            print(f"Re = {reynolds:g}, {time - begin} iterations: f = {drop:.5g}", file=sys.stderr, flush=True)
            last = drop
            if change < tolerance:
                break
        return last, velocity * reynolds, change, time


def run(*command, folder, log=None):
    """What the command prints; where it fails the end, or, with a log, nothing."""
    environment = dict(os.environ, PWD=str(folder))
    if Path("/usr/share/openfoam/etc").is_dir():  # Debian leaves it to its users to say where it is
        environment.setdefault("WM_PROJECT_DIR", "/usr/share/openfoam")
    done = subprocess.run([str(word) for word in command], cwd=folder, env=environment, capture_output=True, text=True)
    if log:
        with open(log, "a") as file:
            file.write(done.stdout + done.stderr)
        return "" if done.returncode else done.stdout
    if done.returncode:
        stop(f"{' '.join(str(word) for word in command[:2])} ended with {done.returncode}: {(done.stdout + done.stderr)[-1000:]}")
    return done.stdout


def make_mesh(bed, options, folder, bernal):
    """In the case, unless it has the one of these spheres and options."""
    if any(option.split("=")[0] == "--regions" for option in options):
        stop("the flow takes the fluid alone: leave out --regions")
    made = hashlib.sha256((bed.folder / "spheres.csv").read_bytes() + (bed.folder / "scene.toml").read_bytes()
                          + repr(options).encode()).hexdigest()
    mark, mesh = folder / "mesh_of.sha256", folder / "constant" / "polyMesh"
    if mesh.exists():
        if not mark.exists():
            stop(f"{folder} has a mesh that this script has not made; name another --case")
        if mark.read_text() == made:
            print(f"the mesh in {folder} is of these spheres and options, and taken again", file=sys.stderr)
            return
        shutil.rmtree(mesh)
    run(bernal, "mesh", bed.folder, "--to", "openfoam", "-o", "bed.foam", "--quiet", *options, folder=folder)
    mark.write_text(made)


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
    words.add_argument("--before", type=float, default=1, help="diameters that are free before a bed with an inlet")
    words.add_argument("--behind", type=float, default=2, help="and behind it")
    words.add_argument("--ends", type=float, default=1.5, help="diameters of such a bed that do not count, at either end")
    words.add_argument("--most", type=int, default=1000, help="iterations for each Re at most")
    words.add_argument("--tolerance", type=float, default=2e-3, help="ends where 25 iterations change the gradient by less")
    words.add_argument("--bernal", default="bernal", help="the command")
    words.add_argument("--json", action="store_true")
    given = sys.argv[1:]
    split = given.index("--") if "--" in given else len(given)
    asked = words.parse_args(given[:split])
    if not all(0 < reynolds < math.inf for reynolds in asked.reynolds):
        words.error("Reynolds numbers are above 0")
    for program in (asked.bernal, "simpleFoam"):
        if not shutil.which(program):
            stop(f"{program} is not installed")
    bernal = Path(shutil.which(asked.bernal)).resolve()
    bed = Bed(asked.result.resolve(), asked.along)
    folder = asked.case or asked.result.with_name(asked.result.name + "_flow")
    folder = folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    if bed.flows_in:
        bed.give_free_space(asked.before, asked.behind, asked.ends, folder, bernal)
    make_mesh(bed, given[split + 1:], folder, bernal)
    case = Case(folder, bed)
    (folder / "log.simpleFoam").unlink(missing_ok=True)
    ratio = bed.width / case.diameter
    said = {"cells": int(case.cells), "spheres": len(bed.spheres), "porosity": case.porosity, "diameter": case.diameter,
            "width_over_diameter": ratio if math.isfinite(ratio) else None, "flows": []}
    if bed.flows_in:
        said["window"] = case.apart / case.diameter
    if not asked.json:
        walls = f"D/d = {ratio:.4g}" if math.isfinite(ratio) else "no walls"
        window = f" in a window of {said['window']:.3g} d" if bed.flows_in else ""
        print(f"bed           {len(bed.spheres):,} spheres, {walls}, porosity {case.porosity:.4f} of the mesh{window}, "
              f"d = {case.diameter:.5g}, {case.cells:,} tetrahedra", flush=True)
    flows = []
    for relaxation in RELAXATION:
        try:
            case.write_fields(relaxation)
            begin, flows = 0, []
            for reynolds in sorted(asked.reynolds):
                flows.append(case.solve(reynolds, begin, asked.most, asked.tolerance))
                begin = flows[-1][-1]
            break
        except Diverged as why:
            if relaxation == RELAXATION[-1]:
                stop(f"{why}: see {folder / 'log.simpleFoam'}; a smaller --mesh-size or --neck-size helps, and a smaller Re", 3)
            print(f"{why}; again, with less of each step", file=sys.stderr, flush=True)
    for drop, reynolds, change, _ in flows:
        of = {"Re": reynolds, "f": drop, "change": change, "ergun": ergun(case.porosity, reynolds),
              "eisfeld_schnitzlein": eisfeld_schnitzlein(case.porosity, reynolds, ratio)}
        said["flows"].append(of)
        if asked.json:
            continue
        print(f"Re = {reynolds:<8.4g} f = {drop:.5g}; Ergun {of['ergun']:.5g} ({drop / of['ergun'] - 1:+.1%} from it), "
              f"Eisfeld & Schnitzlein {of['eisfeld_schnitzlein']:.5g} ({drop / of['eisfeld_schnitzlein'] - 1:+.1%})"
              + ("" if change < asked.tolerance else f"; not converged, it still changes by {change:.2%}: raise --most"))
    if asked.json:
        print(json.dumps(said))
    sys.exit(0 if all(change < asked.tolerance for _, _, change, _ in flows) else 3)


if __name__ == "__main__":
    main()
