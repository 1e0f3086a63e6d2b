#!/usr/bin/python3
"""LIGGGHTS runs our script, 1,000 steps, in a CAD part and in a periodic box: tests/clients/with_liggghts.py [BERNAL]

Debian: liggghts. Takes two seconds.
"""
from client import *

LIGGGHTS = need_program("liggghts", "liggghts")
GRAVITY, DENSITY = 9.81, 2500


def table(log):
    rows, inside = [], False
    for line in log.splitlines():
        words = line.split()
        if words[:2] == ["Step", "Atoms"]:
            inside = True
        elif inside and len(words) == 4 and words[0].isdigit():
            rows.append((int(words[0]), int(words[1]), float(words[2])))
        elif rows:
            inside = False
    return rows


def check(name, result, fall):
    result.export("liggghts", "packing.data")
    rows = table(run(LIGGGHTS, "-in", "packing.in", folder=result.folder))
    count = len(result.spheres)
    expect(rows and rows[-1][0] == 1000 and all(row[1] == count for row in rows),
           f"{name}: {count} spheres, 1,000 steps, none lost")
    mass = sum(DENSITY * 4.18879020478639 * sphere[3]**3 for sphere in result.in_metres())
    bound = mass * GRAVITY * fall * METRES[result.unit]
    expect(max(row[2] for row in rows) <= bound,
           f"{name}: kinetic energy at most {max(row[2] for row in rows):.3g} J, all that gravity could give {bound:.3g} J")
    return rows


def work(folder):
    hopper = Result(folder / "hopper", HOPPER)
    bounds = hopper.report["container"]["bounds"]
    rows = check("CAD part", hopper, bounds["upper"][2] - bounds["lower"][2])
    expect(rows[-1][2] > 0, "CAD part: the spheres move")
    check("periodic box", Result(folder / "periodic", PERIODIC), 0)


in_folder(work)
