#!/usr/bin/python3
"""LAMMPS reads our data file and runs 1,000 steps from it: tests/clients/with_lammps.py [BERNAL]

Debian: lammps. Takes three seconds.
"""
from client import *

LMP = need_program("lmp", "lammps")
SCRIPT = """units si
atom_style sphere
boundary {boundary}
newton off
comm_modify vel yes
read_data {data}
neighbor 2e-4 bin
pair_style gran/hertz/history 1e6 NULL 50 NULL 0.5 0
pair_coeff * *
{walls}
fix motion all nve/sphere
velocity all create {temperature} 4711
timestep 1e-7
thermo 50
thermo_style custom step atoms ke
dump read all custom 1000000 read.dump id type diameter x y z mass
dump_modify read sort id format float %.17g
run 1000
"""


def check(name, result, boundary, walls):
    result.export("lammps", "packing.data")
    script = SCRIPT.format(data="packing.data", boundary=boundary, walls=walls, temperature=1e10)
    (result.folder / "in.run").write_text(script)
    log = run(LMP, "-in", "in.run", folder=result.folder)
    rows = thermo_rows(log)
    count = len(result.spheres)
    expect(rows and rows[-1][0] == 1000 and all(row[1] == count for row in rows),
           f"{name}: {count} spheres, 1,000 steps, none lost")
    # The spheres are elastic in no better than damped contacts: what they get from an overlap would come on top.
    expect(rows and 0 < max(row[2] for row in rows) <= 1.001 * rows[0][2],
           f"{name}: kinetic energy {rows[0][2]:.3g} at the start, at most {max(row[2] for row in rows):.3g} J")
    lines = (result.folder / "read.dump").read_text().splitlines()
    begin = next(i for i, line in enumerate(lines) if line.startswith("ITEM: ATOMS")) + 1
    atoms = [list(map(float, line.split())) for line in lines[begin:begin + count]]
    periods = [METRES[result.unit] * edge for edge in result.edges()] if "p" in boundary else None
    expect(same_spheres([(a[3], a[4], a[5], a[2] / 2) for a in atoms], result.in_metres(), periods=periods),
           f"{name}: places and radii in metres")
    expect(all(abs(a[6] - 2500 * 3.141592653589793 / 6 * a[2]**3) <= 1e-9 * a[6] for a in atoms),
           f"{name}: masses of 2,500 kg/m3")
    radii = sorted({sphere[3] for sphere in result.spheres})
    few = len(radii) <= 10
    expect(all(a[1] == (radii.index(s[3]) + 1 if few else 1) for a, s in zip(atoms, result.spheres)),
           f"{name}: types by class")


def work(folder):
    check("periodic box", Result(folder / "periodic", PERIODIC), "p p p", "")
    check("cylinder", Result(folder / "cylinder", CYLINDER), "f f f",
          "region side cylinder z 1e-3 2e-3 5e-3 3e-3 15e-3 side in\n"
          "fix walls all wall/gran/region hertz/history 1e6 NULL 50 NULL 0.5 0 region side")


in_folder(work)
