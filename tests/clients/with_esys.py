#!/usr/bin/python3
"""ESyS-Particle reads our geometry file and runs from it: tests/clients/with_esys.py [BERNAL]

Debian: esys-particle, openmpi-bin. Takes three seconds.
"""
from client import *

ESYS = need_program("esysparticle", "esys-particle")
SCRIPT = """
import json, os
from esys.lsm import *
sim = LsmMpi(numWorkerProcesses=1, mpiDimList=[1, 1, 1])
sim.initNeighbourSearch(particleType="NRotSphere", gridSpacing=3.0, verletDist=0.1)
sim.setNumTimeSteps(1000)
sim.setTimeStepSize(1e-4)
sim.readGeometry("packing.geo")
read = [list(p.getPosn()) + [p.getRadius()] for p in sorted(sim.getParticleList(), key=lambda p: p.getId())]


class Last(Runnable):  # after its run Debian's program neither answers nor ends
    def run(self):
        if sim.getTimeStep() == 1000:
            after = len(sim.getParticleList())
            with open("esys.json", "w") as file:
                json.dump({"read": read, "after": after}, file)
            os._exit(0)


last = Last()
sim.addPostTimeStepRunnable(last)
sim.run()
"""


def work(folder):
    result = Result(folder, CYLINDER)
    result.export("esys", "packing.geo")
    (folder / "run.py").write_text(SCRIPT)
    mpirun = ["mpirun", "--allow-run-as-root", "--oversubscribe", "-np", "2"]
    try:
        subprocess.run([*mpirun, ESYS, "run.py"], cwd=folder, capture_output=True, timeout=60)
    except subprocess.TimeoutExpired:  # it waits for ever where its script has failed
        pass
    expect((folder / "esys.json").exists(), "1,000 steps")
    if (folder / "esys.json").exists():
        said = json.loads((folder / "esys.json").read_text())
        expect(same_spheres(said["read"], result.spheres), "places and radii in mm")
        expect(said["after"] == len(result.spheres), "no particle lost")


in_folder(work)
