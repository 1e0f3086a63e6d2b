#!/usr/bin/env python3
"""@TITLE@; for OpenMC, lengths in cm.

    python3 build.py                            # writes model.xml
    from build import model; model().run()      # or goes on in Python

The geometry has @LEVELS@. What the materials are made of it does not know: say it here.
"""
from pathlib import Path

import openmc

here = Path(__file__).resolve().parent


def compose(material):
    """Gives a material what it is made of."""
    material.add_element("C", 1.0)
    if material.density_units == "sum":  # none is known
        material.set_density("g/cm3", 1.0)


def model():
    materials = openmc.Materials.from_xml(here / "materials.xml")
    for material in materials:  # material.name is one of @MATERIALS@
        compose(material)
    geometry = openmc.Geometry.from_xml(here / "geometry.xml", materials)
    return openmc.Model(geometry, materials, openmc.Settings.from_xml(here / "settings.xml"))


if __name__ == "__main__":
    model().export_to_model_xml(here / "model.xml")
