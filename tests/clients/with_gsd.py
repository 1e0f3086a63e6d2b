#!/usr/bin/python3
"""The gsd package, HOOMD's own, reads our file: tests/clients/with_gsd.py [BERNAL]

Debian: python3-gsd. Takes two seconds.
"""
from client import *

need_module("gsd.hoomd", "python3-gsd")
import gsd.hoomd


def work(folder):
    result = Result(folder, PERIODIC)
    path = str(result.export("gsd", "packing.gsd"))
    frame = gsd.hoomd.open(path, "rb")[0]
    half = [edge / 2 for edge in result.edges()]
    spheres = [(*[x + h for x, h in zip(map(float, place), half)], float(diameter) / 2)
               for place, diameter in zip(frame.particles.position, frame.particles.diameter)]
    expect(frame.particles.N == len(result.spheres), "count")
    expect(same_spheres(spheres, result.spheres, tolerance=2e-7, periods=result.edges()),
           "places about the middle and diameters, in single precision")
    expect(all(abs(a - b) <= 1e-6 * b for a, b in zip(frame.configuration.box[:3], result.edges())), "edges")
    expect(all(abs(x) <= edge / 2 for place in frame.particles.position for x, edge in zip(place, frame.configuration.box)),
           "all in the box")


in_folder(work)
