#!/usr/bin/python3
"""ParaView loads the spheres and an image of ours: tests/clients/with_paraview.py [BERNAL]

Debian: paraview. Takes some seconds. No window is made: what ParaView makes of the files does not need one.
"""
from client import *

PVBATCH = need_program("pvbatch", "paraview")
SCRIPT = """
import json
from paraview.simple import *
spheres = XMLPolyDataReader(FileName=["result/spheres.vtp"])
spheres.UpdatePipeline()
about = spheres.GetDataInformation()
image = XMLImageDataReader(FileName=["packing.vti"])
image.UpdatePipeline()
glyphs = Glyph(Input=spheres, GlyphType="Sphere", GlyphMode="All Points", ScaleArray=["POINTS", "radius"], ScaleFactor=2)
glyphs.UpdatePipeline()
json.dump({"points": about.GetNumberOfPoints(), "arrays": [spheres.PointData[i].Name for i in range(len(spheres.PointData[:]))],
           "cells": image.GetDataInformation().GetNumberOfCells(), "bounds": image.GetDataInformation().GetBounds(),
           "drawn": glyphs.GetDataInformation().GetBounds()},
          open("paraview.json", "w"))
"""


def work(folder):
    result = Result(folder, PERIODIC)
    result.export("vti", "packing.vti", "--resolution", "40")
    (folder / "load.py").write_text(SCRIPT)
    run(PVBATCH, "load.py", folder=folder)
    said = json.loads((folder / "paraview.json").read_text())
    expect(said["points"] == len(result.spheres), f"{said['points']} points, with {', '.join(said['arrays'])}")
    expect(said["cells"] == 40**3 and all(abs(said["bounds"][2 * k + 1] - result.edges()[k]) < 1e-9 for k in range(3)),
           "an image of the period")
    reach = [side for k in range(3) for side in (min(s[k] - s[3] for s in result.spheres),
                                                 max(s[k] + s[3] for s in result.spheres))]
    expect(all(abs(a - b) < 0.05 for a, b in zip(said["drawn"], reach)), "spheres as large as they are")


in_folder(work)
