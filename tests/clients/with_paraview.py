#!/usr/bin/python3
"""ParaView loads the spheres and an image of ours: tests/clients/with_paraview.py [BERNAL]

Debian: paraview, xvfb, xauth. Takes ten seconds.
"""
from client import *

PVBATCH = need_program("pvbatch", "paraview")
XVFB = need_program("xvfb-run", "xvfb xauth")
SCRIPT = """
import json
from paraview.simple import *
spheres = XMLPolyDataReader(FileName=["result/spheres.vtp"])
spheres.UpdatePipeline()
about = spheres.GetDataInformation()
image = XMLImageDataReader(FileName=["packing.vti"])
image.UpdatePipeline()
json.dump({"points": about.GetNumberOfPoints(), "arrays": [spheres.PointData[i].Name for i in range(len(spheres.PointData[:]))],
           "cells": image.GetDataInformation().GetNumberOfCells(), "bounds": image.GetDataInformation().GetBounds()},
          open("paraview.json", "w"))
glyphs = Glyph(Input=spheres, GlyphType="Sphere")
Show(glyphs)
Render()
SaveScreenshot("paraview.png", ImageResolution=[400, 300])
"""


def work(folder):
    result = Result(folder, PERIODIC)
    result.export("vti", "packing.vti", "--resolution", "40")
    (folder / "load.py").write_text(SCRIPT)
    run(XVFB, "-a", PVBATCH, "load.py", folder=folder)
    said = json.loads((folder / "paraview.json").read_text())
    expect(said["points"] == len(result.spheres), f"{said['points']} points, with {', '.join(said['arrays'])}")
    expect(said["cells"] == 40**3 and all(abs(said["bounds"][2 * k + 1] - result.edges()[k]) < 1e-9 for k in range(3)),
           "an image of the period")
    expect((folder / "paraview.png").stat().st_size > 5000, "a picture")


in_folder(work)
