#!/usr/bin/python3
"""ASE reads our extended XYZ, as OVITO does: tests/clients/with_ase.py [BERNAL]

Debian: python3-ase. Takes two seconds.
"""
from client import *

need_module("ase", "python3-ase")
from ase.io import read


def work(folder):
    for name, scene in (("periodic", PERIODIC), ("cylinder", CYLINDER)):
        result = Result(folder / name, scene)
        atoms = read(result.export("extxyz", "packing.xyz"), format="extxyz")
        spheres = [(*place, radius) for place, radius in zip(atoms.get_positions(), atoms.arrays["radius"])]
        expect(same_spheres(spheres, result.spheres), f"{name}: places and radii in mm")
        expect(all(atoms.pbc) == (name == "periodic") == any(atoms.pbc), f"{name}: periods")
        if name == "periodic":
            expect(all(atoms.cell.lengths() == result.edges()), "periodic: edges")


in_folder(work)
