#!/usr/bin/python3
"""Effective conductivity of a packing of spheres in a matrix, by CalculiX, beside bounds.

    data/solvers/composite_conductivity.py RESULT [--conductivity NAME=K …] [--case FOLDER] [--json] [-- OPTIONS]

RESULT is what `bernal pack` wrote, in a box that is periodic along all axes. `bernal mesh` meshes spheres, bridges and
what is between them, with the OPTIONS; a mesh that the script has made before of the same spheres with the same OPTIONS is taken again. Each region of the mesh
has its conductivity: 1 for "fluid", which is the matrix, and 10 for others, "spheres", "bridges" and layers of spheres by
their names, unless --conductivity names them.

The temperature is the sum of a unit gradient along x, y or z in turn and of a field that repeats itself: temperatures of
opposite faces differ by the period where they face along that axis, and are equal elsewhere. The effective conductivity
is the mean heat flux over the mesh. It is an upper bound of the exact one for the geometry of the mesh.

Printed beside it, at the volume fractions of the mesh, with the least and largest conductivity k- and k+:
  Wiener (1912)             1 / sum(phi / k)  to  sum(phi k), for any arrangement
  Hashin & Shtrikman (1962) 1 / sum(phi / (k + 2 k-)) - 2 k-  to the same with k+, for isotropic ones

Debian: tetgen calculix-ccx python3-numpy.
"""
import argparse
import hashlib
import json
import math
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy

AXES = "xyz"


def stop(why):
    print(f"composite_conductivity.py: {why}", file=sys.stderr)
    sys.exit(2)


def layer_names(value, is_layer=False):
    """Of all layers that a scene names, of classes and zones too."""
    if isinstance(value, list):
        return set().union(*(layer_names(part, is_layer) for part in value))
    if not isinstance(value, dict):
        return set()
    if is_layer:
        return {value.get("name")}
    return set().union(*(layer_names(part, key == "layers") for key, part in value.items()))


def asked_conductivities(pairs, scene):
    """By region; refuses, before anything is meshed, what no mesh of the scene can have."""
    layers, asked = layer_names(scene), {}
    for pair in pairs:
        name, _, value = pair.partition("=")
        try:
            asked[name] = float(value)
        except ValueError:
            stop(f"--conductivity {pair}: NAME=K with a number K is needed")
        if not 0 < asked[name] < math.inf:
            stop(f"--conductivity {pair}: a conductivity has to be positive")
        if name.startswith("layer_") and name[6:] not in layers:
            stop(f"the scene names no layer \"{name[6:]}\"" + (f", but {', '.join(sorted(layers))}" if layers else ""))
        if not name.startswith(("fluid", "spheres", "bridges", "layer_")):
            stop(f"\"{name}\" is no region: fluid, spheres, bridges, layer_NAME")
    return asked


class Mesh:
    """Nodes, and the tetrahedra of each region, of an .inp of bernal's."""

    def __init__(self, file):
        nodes, self.regions, rows = [], {}, None
        for line in file.read_text().splitlines():
            if line.startswith("*"):
                rows = None
                if line.startswith("*NODE"):
                    rows = nodes
                elif line.startswith("*ELEMENT"):
                    rows = self.regions.setdefault(re.search(r"ELSET=(\S+)", line)[1], [])
            elif rows is not None:
                rows.append(line)
        nodes = numpy.array([row.split(",") for row in nodes], dtype=float)
        self.nodes = nodes[:, 1:]
        self.regions = {name: numpy.array([row.split(",") for row in rows], dtype=int)
                        for name, rows in self.regions.items()}

    def weights(self, region):
        """Of the points at which CalculiX prints: the volume in one, or by the Jacobian in the four of second order."""
        elements = self.regions[region]
        corners = self.nodes[elements[:, 1:] - 1]
        if elements.shape[1] == 5:
            return abs(numpy.linalg.det(corners[:, 1:] - corners[:, :1]))[:, None] / 6
        far, near = 0.25 + 0.15 * math.sqrt(5), 0.25 - 0.05 * math.sqrt(5)
        weights = numpy.empty((len(elements), 4))
        for k in range(4):
            share = numpy.full(4, near)  # barycentric coordinates
            share[k] = far
            slopes = numpy.zeros((10, 4))
            for i in range(4):
                slopes[i, i] = 4 * share[i] - 1
            for m, (i, j) in enumerate(((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))):
                slopes[4 + m, i], slopes[4 + m, j] = 4 * share[j], 4 * share[i]
            along = slopes[:, 1:] - slopes[:, :1]  # by the second, third and fourth, the first making up for them
            weights[:, k] = abs(numpy.linalg.det(numpy.einsum("enx,na->exa", corners, along))) / 24
        return weights

    def count(self):
        return sum(len(elements) for elements in self.regions.values())


def write_job(folder, name, mesh, conductivity, edges):
    """Heat conduction, three steps, one for each axis."""
    lines = [f"*INCLUDE, INPUT={name}.inp", f"*INCLUDE, INPUT={name}_periodic.inc"]
    for region, value in conductivity.items():
        lines += [f"*MATERIAL, NAME=of_{region}", "*CONDUCTIVITY", f"{value:.15g}",
                  f"*SOLID SECTION, ELSET={region}, MATERIAL=of_{region}"]
    # One node holds still what is free: the level of temperatures. It has to be no image, for these are given already.
    images = {int(row.split(",")[0]) for row in re.findall(r"\*EQUATION\n\d+\n(.*)",
                                                           (folder / f"{name}_periodic.inc").read_text())}
    held = next(node for node in range(1, len(mesh.nodes) + 1) if node not in images)
    for k in range(3):
        lines += ["*STEP", "*HEAT TRANSFER, STEADY STATE", "*BOUNDARY", f"{held}, 11, 11, 0"]
        lines += [f"{AXES[j]}_period, 11, 11, {edges[j] if j == k else 0:.15g}" for j in range(3)]
        for region in mesh.regions:
            lines += [f"*EL PRINT, ELSET={region}", "HFL"]
        lines += ["*END STEP"]
    (folder / "conduction.inp").write_text("\n".join(lines) + "\n")


def mean_fluxes(file, mesh):
    """The mean heat flux of each step, a row each, from the flux at points of every tetrahedron."""
    weights = {}
    for name, elements in mesh.regions.items():
        weights.update(zip(elements[:, 0], mesh.weights(name)))
    steps = {}  # by time: the integral of the flux, and the volume
    with open(file) as lines:
        time = None
        for line in lines:
            words = line.split()
            if "time" in words:
                time = words[-1]
                steps.setdefault(time, numpy.zeros(4))
            elif len(words) == 5 and time is not None:
                weight = weights[int(words[0])][int(words[1]) - 1]
                steps[time] += weight * numpy.array([*words[2:], 1], dtype=float)
    return numpy.array([steps[time][:3] / steps[time][3] for time in sorted(steps, key=float)])


def wiener(shares, values):
    return 1 / (shares / values).sum(), (shares * values).sum()


def hashin_shtrikman(shares, values):
    return tuple(1 / (shares / (values + 2 * k)).sum() - 2 * k for k in (values.min(), values.max()))


def run(*command, folder):
    done = subprocess.run([str(word) for word in command], cwd=folder, capture_output=True, text=True)
    if done.returncode:
        stop(f"{command[0]} ended with {done.returncode}\n{(done.stdout + done.stderr)[-2000:]}")
    return done.stdout


def main():
    words = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    words.add_argument("result", type=Path, help="what bernal pack wrote")
    words.add_argument("--conductivity", nargs="+", default=[], metavar="NAME=K", help="of regions; fluid=1, others 10")
    words.add_argument("--case", type=Path, help="folder of CalculiX's files; RESULT_heat if absent")
    words.add_argument("--bernal", default="bernal", help="the command")
    words.add_argument("--json", action="store_true")
    given = sys.argv[1:]
    split = given.index("--") if "--" in given else len(given)
    asked = words.parse_args(given[:split])
    for program in (asked.bernal, "ccx"):
        if not shutil.which(program):
            stop(f"{program} is not installed")
    for name in ("spheres.csv", "scene.toml", "report.json"):
        if not (asked.result / name).exists():
            stop(f"{asked.result} has no {name}; give the folder that bernal pack wrote")
    wanted = asked_conductivities(asked.conductivity, tomllib.loads((asked.result / "scene.toml").read_text()))
    report = json.loads((asked.result / "report.json").read_text())
    edges = report.get("box", {}).get("edges", [])
    folder = asked.case or asked.result.with_name(asked.result.name + "_heat")
    folder.mkdir(parents=True, exist_ok=True)
    made = hashlib.sha256(b"".join((asked.result / name).read_bytes() for name in ("spheres.csv", "scene.toml"))
                          + repr(given[split + 1:]).encode()).hexdigest()
    mark = folder / "mesh_of.sha256"
    if mark.exists() and mark.read_text() == made:
        print(f"the mesh in {folder} is of these spheres and options, and taken again", file=sys.stderr)
    else:
        run(Path(shutil.which(asked.bernal)).resolve(), "mesh", asked.result.resolve(), "--to", "abaqus", "-o", "packing.inp",
            "--regions", "all", "--quiet", *given[split + 1:], folder=folder)
        mark.write_text(made)
    if len(edges) != 3 or not (folder / "packing_periodic.inc").exists():
        stop("the packing has to lie in a box that is periodic along all axes")
    mesh = Mesh(folder / "packing.inp")
    conductivity = {name: 1.0 if name == "fluid" else 10.0 for name in mesh.regions}
    for name, value in wanted.items():
        if name not in conductivity:
            stop(f"the mesh has no region \"{name}\", but {', '.join(conductivity)}")
        conductivity[name] = value
    write_job(folder, "packing", mesh, conductivity, edges)
    run("ccx", "conduction", folder=folder)
    fluxes = mean_fluxes(folder / "conduction.dat", mesh)
    if fluxes.shape != (3, 3):
        stop(f"CalculiX solved {len(fluxes)} steps of three; see {folder / 'conduction.sta'}")
    effective = -numpy.diag(fluxes)
    volumes = {name: mesh.weights(name).sum() for name in mesh.regions}
    shares = numpy.array(list(volumes.values())) / sum(volumes.values())
    values = numpy.array([conductivity[name] for name in volumes])
    said = {"cells": mesh.count(), "shares": dict(zip(volumes, shares)), "conductivities": conductivity,
            "conductivity": list(effective), "wiener": wiener(shares, values),
            "hashin_shtrikman": hashin_shtrikman(shares, values)}
    if asked.json:
        print(json.dumps(said))
        return
    print(f"mesh                {said['cells']:,} tetrahedra: "
          + ", ".join(f"{name} {share:.4f} of {conductivity[name]:g}" for name, share in said["shares"].items()))
    print("conductivity        {:.4f}  {:.4f}  {:.4f} along x, y, z, mean {:.4f}".format(*effective, effective.mean()))
    print("Wiener              {:.4f} to {:.4f}".format(*said["wiener"]))
    print("Hashin & Shtrikman  {:.4f} to {:.4f}".format(*said["hashin_shtrikman"]))


if __name__ == "__main__":
    main()
