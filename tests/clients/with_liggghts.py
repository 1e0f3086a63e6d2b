#!/usr/bin/python3
"""LIGGGHTS runs our script, 1,000 steps, in a CAD part and in a periodic box: tests/clients/with_liggghts.py [BERNAL]

Debian: liggghts. Takes two seconds.
"""
from client import *

LIGGGHTS = need_program("liggghts", "liggghts")
GRAVITY, DENSITY = 9.81, 2500


def check(name, result, fall):
    result.export("liggghts", "packing.data")
    rows = thermo_rows(run(LIGGGHTS, "-in", "packing.in", folder=result.folder))
    count = len(result.spheres)
    expect(rows and rows[-1][0] == 1000 and all(row[1] == count for row in rows),
           f"{name}: {count} spheres, 1,000 steps, none lost")
    mass = sum(DENSITY * 4.18879020478639 * sphere[3]**3 for sphere in result.in_metres())
    bound = mass * GRAVITY * fall * METRES[result.unit]
    expect(max(row[2] for row in rows) <= bound,
           f"{name}: kinetic energy at most {max(row[2] for row in rows):.3g} J, all that gravity could give {bound:.3g} J")
    return rows


ROUND = """unit = "mm"
[container]
{container}
[spheres]
packing_fraction = 0.4
diameter = 1
"""
WALLS = {"sphere, as triangles": 'kind = "sphere"\nradius = 5\ncenter = [1, 2, 3]',
         "oblique cylinder, as triangles": 'kind = "cylinder"\nradius = 4\nheight = 10\naxis = [0.3, 0, 1]',
         "cylinder along y": 'kind = "cylinder"\nradius = 4\nheight = 10\naxis = [0, 1, 0]\nbase = [5, 1, -2]'}


def work(folder):
    hopper = Result(folder / "hopper", HOPPER)
    bounds = hopper.report["container"]["bounds"]
    rows = check("CAD part", hopper, bounds["upper"][2] - bounds["lower"][2])
    expect(rows[-1][2] > 0, "CAD part: the spheres move")
    check("periodic box", Result(folder / "periodic", PERIODIC), 0)
    for name, container in WALLS.items():
        check(name, Result(folder / name, ROUND.format(container=container)), 10)


in_folder(work)
