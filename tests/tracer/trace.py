#!/usr/bin/python3
"""What stands at points, or how large what a geometry holds is:

    tests/tracer/trace.py FORMAT FILE --at points.txt          # a material a line, for lines x y z in cm
    tests/tracer/trace.py FORMAT FILE --box x0,y0,z0,x1,y1,z1  # name, volume in cm³ and standard error a line

With --by-levels the points of --count are those of every level.
"""
import argparse
import sys

import numpy as np

from geometry import volumes, volumes_by_levels
from readers import READERS


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("format", choices=READERS)
    parser.add_argument("file")
    parser.add_argument("--at")
    parser.add_argument("--box")
    parser.add_argument("--count", type=int, default=1_000_000)
    parser.add_argument("--by-levels", action="store_true")
    asked = parser.parse_args()
    geometry = READERS[asked.format](asked.file)
    if asked.at:
        names, found = geometry.at(np.loadtxt(asked.at, ndmin=2))
        print("\n".join(names[k] if k >= 0 else "nothing" for k in found))
    if asked.box:
        ends = [float(x) for x in asked.box.split(",")]
        found = (volumes_by_levels if asked.by_levels else volumes)(geometry, ends[:3], ends[3:], asked.count)
        for name, (volume, error) in sorted(found.items()):
            print(name, volume, error)
    if geometry.unclear:
        sys.exit(f"{geometry.unclear} points lie in no cell, or in several")


if __name__ == "__main__":
    main()
