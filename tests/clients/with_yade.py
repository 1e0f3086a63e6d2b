#!/usr/bin/python3
"""YADE reads our file and runs 1,000 steps from it: tests/clients/with_yade.py [BERNAL]

Debian: yade. Takes ten seconds.
"""
from client import *

YADE = need_program("yade", "yade")
SCRIPT = """
import json
from yade import ymport
O.periodic = True
O.cell.setBox({edges})
O.bodies.append(ymport.textExt("packing.txt"))
read = [[*b.state.pos, b.shape.radius] for b in O.bodies]
O.engines = [ForceResetter(), InsertionSortCollider([Bo1_Sphere_Aabb()]),
             InteractionLoop([Ig2_Sphere_Sphere_ScGeom()], [Ip2_FrictMat_FrictMat_FrictPhys()],
                             [Law2_ScGeom_FrictPhys_CundallStrack()]), NewtonIntegrator()]
O.dt = 0.5 * PWaveTimeStep()
O.run(1000, True)
json.dump({{"read": read, "steps": O.iter, "bodies": len(O.bodies), "energy": kineticEnergy()}}, open("yade.json", "w"))
"""


def work(folder):
    result = Result(folder, PERIODIC)
    result.export("yade", "packing.txt")
    edges = [METRES[result.unit] * edge for edge in result.edges()]
    (folder / "run.py").write_text(SCRIPT.format(edges=edges))
    run(YADE, "-n", "-x", "run.py", folder=folder)
    said = json.loads((folder / "yade.json").read_text())
    expect(same_spheres(said["read"], result.in_metres(), periods=edges), "places and radii in metres")
    expect(said["steps"] == 1000 and said["bodies"] == len(result.spheres), "1,000 steps, no body lost")
    # Nothing moves at the start, and nothing overlaps by more than rounding to metres made of it.
    expect(said["energy"] < 1e-15, f"kinetic energy {said['energy']:.3g} J: nothing pushes")


in_folder(work)
