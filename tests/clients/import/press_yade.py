# 700 spheres that YADE presses together in a periodic cell: yade -n -x press_yade.py
import os

from yade import export, pack

O.periodic = True
O.cell.setBox(0.1, 0.1, 0.1)
spheres = pack.SpherePack()
spheres.makeCloud((0, 0, 0), (0.1, 0.1, 0.1), rMean=0.005, rRelFuzz=0.2, num=700, periodic=True, seed=1)
O.materials.append(FrictMat(young=1e6, poisson=0.3, frictionAngle=0.0, density=2500))
spheres.toSimulation()
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb()], allowBiggerThanPeriod=True),
    InteractionLoop([Ig2_Sphere_Sphere_ScGeom()], [Ip2_FrictMat_FrictMat_FrictPhys()],
                    [Law2_ScGeom_FrictPhys_CundallStrack()]),
    PeriIsoCompressor(charLen=0.01, stresses=[-2e4, -1e4], doneHook="O.pause()", keepProportions=True),
    NewtonIntegrator(damping=0.4),
]
O.dt = 0.5 * PWaveTimeStep()
O.run(20000, True)
export.textExt("yade.txt", "x_y_z_r")
with open("yade.box", "w") as file:
    file.write(",".join(repr(edge) for edge in O.cell.size))
os._exit(0)
