#!/usr/bin/python3
"""POV-Ray renders our scene: tests/clients/with_povray.py [BERNAL]

Debian: povray. Takes ten seconds.
"""
from client import *

POVRAY = need_program("povray", "povray")


def pixels(file):
    """Of a PPM of eight bits, as (red, green, blue)."""
    data = file.read_bytes()
    width, height = [line for line in data.split(b"\n") if not line.startswith(b"#")][1].split()
    width, height = int(width), int(height)
    body = data[-3 * width * height:]
    return [tuple(body[i:i + 3]) for i in range(0, len(body), 3)]


def work(folder):
    for name, scene in (("periodic", PERIODIC), ("cylinder", CYLINDER), ("hopper", HOPPER)):
        result = Result(folder / name, scene)
        result.export("povray", "packing.pov")
        run(POVRAY, "+W160", "+H120", "-D", "+FP", "+Opicture.ppm", "packing.pov", folder=result.folder)
        seen = pixels(result.folder / "picture.ppm")
        background = max(set(seen), key=seen.count)
        share = sum(pixel != background for pixel in seen) / len(seen)
        corners = [seen[0], seen[159], seen[-160], seen[-1]]
        expect(0.2 < share < 0.9 and corners.count(background) == 4,
               f"{name}: spheres cover {100 * share:.0f} % of the picture, none of its corners")


in_folder(work)
