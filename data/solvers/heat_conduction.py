#!/usr/bin/python3
"""Effective conductivity of a periodic composite, by FEniCS, on a periodic mesh in Gmsh's format.

    data/solvers/heat_conduction.py MESH.msh [--ratio 10] [--degree 1] [--json]

The mesh fills one period, a box: `bernal mesh RESULT --to gmsh --regions all`, or what the script of `bernal export --to
gmsh` makes. Its physical volumes are the matrix, of conductivity 1, and spheres, of conductivity `ratio`: every volume
whose name is neither "fluid" nor "matrix". The temperature is E·x + w with a unit gradient E along each axis in
turn and w periodic: nodes of opposite faces, which the mesh matches, are one unknown. The effective conductivity is the
mean of k |E + grad w|² and is, on any mesh, an upper bound of the exact one of that mesh's geometry. Beside it stand
Maxwell's value and the bounds of Hashin and Shtrikman at the volume fraction of the mesh.

Debian: python3-dolfinx python3-gmsh python3-scipy.
"""
import argparse
import json
import logging
import sys

import gmsh
import numpy
import scipy.sparse
import scipy.sparse.linalg
import ufl
from dolfinx import fem
from dolfinx.io import gmshio
from mpi4py import MPI


MATRIX = ("fluid", "matrix")
logging.getLogger().setLevel(logging.WARNING)  # FEniCS tells of every form that it compiles


def read(file, ratio):
    """The mesh, and the conductivity of its cells."""
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.open(file)
    names = {tag: gmsh.model.getPhysicalName(3, tag) for dimension, tag in gmsh.model.getPhysicalGroups(3)}
    if not any(name in MATRIX for name in names.values()) or len(names) < 2:
        sys.exit(f"{file}: has no physical volume \"fluid\" or \"matrix\" beside those of spheres, but {list(names.values())}")
    mesh, cells, _ = gmshio.model_to_mesh(gmsh.model, MPI.COMM_SELF, 0, gdim=3)
    gmsh.finalize()
    conductivity = fem.Function(fem.FunctionSpace(mesh, ("DG", 0)))
    conductivity.x.array[cells.indices] = [1 if names[tag] in MATRIX else ratio for tag in cells.values]
    return mesh, conductivity


def periodic_unknowns(places):
    """For each node the number of its unknown; the number of unknowns; and how far matched nodes lie apart."""
    lower, upper = places.min(axis=0), places.max(axis=0)
    edges = upper - lower
    reduced = places.copy()
    for k in range(3):
        reduced[places[:, k] > upper[k] - 1e-7 * edges[k], k] -= edges[k]
    _, groups = numpy.unique(numpy.round(reduced / (1e-6 * edges.max())), axis=0, return_inverse=True)
    groups = groups.ravel()
    # A node on the lower face without a partner on the upper one would be an unknown of its own there.
    for k in range(3):
        on_lower = numpy.unique(groups[places[:, k] < lower[k] + 1e-7 * edges[k]])
        on_upper = numpy.unique(groups[places[:, k] > upper[k] - 1e-7 * edges[k]])
        if not numpy.array_equal(on_lower, on_upper):
            sys.exit(f"the nodes of opposite faces do not match along axis {k}")
    return groups, groups.max() + 1, edges


def integral(form):
    return fem.assemble_scalar(fem.form(form))


def solve(mesh, conductivity, degree):
    """The effective conductivity along each axis."""
    space = fem.FunctionSpace(mesh, ("CG", degree))
    groups, count, edges = periodic_unknowns(space.tabulate_dof_coordinates())
    u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
    matrix = fem.petsc.assemble_matrix(fem.form(conductivity * ufl.inner(ufl.grad(u), ufl.grad(v)) * ufl.dx))
    matrix.assemble()
    rows, columns, values = matrix.getValuesCSR()
    full = scipy.sparse.csr_matrix((values, columns, rows))
    fold = scipy.sparse.csr_matrix((numpy.ones(len(groups)), (numpy.arange(len(groups)), groups)), shape=(len(groups), count))
    folded = (fold.T @ full @ fold).tocsr()
    scale = scipy.sparse.diags(1 / folded.diagonal())
    volume = edges.prod()
    effective = []
    for k in range(3):
        gradient = ufl.as_vector([1.0 if j == k else 0.0 for j in range(3)])
        load = fem.petsc.assemble_vector(fem.form(-conductivity * ufl.inner(gradient, ufl.grad(v)) * ufl.dx)).array
        load = fold.T @ load
        load -= load.mean()  # a constant is free
        w, failed = scipy.sparse.linalg.cg(folded, load, tol=1e-8, maxiter=10000, M=scale)
        if failed:
            sys.exit("conjugate gradients did not converge")
        effective.append((integral(conductivity * ufl.dx(mesh)) - load @ w) / volume)
    return effective


def maxwell(ratio, phi):
    beta = (ratio - 1) / (ratio + 2)
    return (1 + 2 * beta * phi) / (1 - beta * phi)


def bounds(ratio, phi):
    """Of Hashin and Shtrikman; the lower one is Maxwell's value where spheres conduct better."""
    one, other = maxwell(ratio, phi), ratio * maxwell(1 / ratio, 1 - phi)
    return min(one, other), max(one, other)


def main():
    words = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    words.add_argument("mesh")
    words.add_argument("--ratio", type=float, default=10, help="conductivity of the spheres over that of the matrix")
    words.add_argument("--degree", type=int, default=1, help="of the elements")
    words.add_argument("--json", action="store_true")
    asked = words.parse_args()
    mesh, conductivity = read(asked.mesh, asked.ratio)
    spheres = ufl.conditional(ufl.gt(abs(conductivity - 1), 1e-12), 1.0, 0.0)
    phi = integral(spheres * ufl.dx(mesh)) / integral(1.0 * ufl.dx(mesh)) if asked.ratio != 1 else None
    effective = solve(mesh, conductivity, asked.degree)
    said = {"cells": mesh.topology.index_map(3).size_local, "phi": phi, "ratio": asked.ratio, "conductivity": effective,
            "maxwell": maxwell(asked.ratio, phi), "bounds": bounds(asked.ratio, phi)}
    if asked.json:
        print(json.dumps(said))
        return
    print(f"mesh          {said['cells']:,} tetrahedra, volume fraction of spheres {phi:.5f}")
    print(f"conductivity  {effective[0]:.4f}  {effective[1]:.4f}  {effective[2]:.4f} along x, y, z, mean {numpy.mean(effective):.4f}"
          f" (matrix 1, spheres {asked.ratio:g})")
    print(f"Maxwell       {said['maxwell']:.4f}; Hashin-Shtrikman {said['bounds'][0]:.4f} to {said['bounds'][1]:.4f}")


if __name__ == "__main__":
    main()
