"""@TITLE@; for OpenMC, lengths in cm.

    particle = openmc.Universe(cells=[...])                    # what every sphere holds
    bed = openmc.Cell(region=region(), fill=lattice(particle, matrix, (10, 10, 10)))

or, for few spheres, openmc.Cell(fill=fuel, region=-s) for each s of spheres().
"""
from pathlib import Path

import numpy as np
import openmc
import openmc.model

here = Path(__file__).resolve().parent
centers = np.load(here / @CENTERS@)  # (N, 3)
radii = np.load(here / @RADII@)  # (N,)
lower = np.array(@LOWER@, dtype=float)
upper = np.array(@UPPER@, dtype=float)
periodic = @PERIODIC@


def with_images():
    """Centres and radii, and those of all images that reach into the box where it repeats itself."""
    c, r = centers, radii
    for axis in range(3):
        if not periodic[axis]:
            continue
        edge = np.zeros(3)
        edge[axis] = upper[axis] - lower[axis]
        low = c[:, axis] - r < lower[axis]
        high = c[:, axis] + r > upper[axis]
        c = np.concatenate([c, c[low] + edge, c[high] - edge])
        r = np.concatenate([r, r[low], r[high]])
    # Beyond an edge or a corner of the box an image may be near two faces and not reach in.
    gap = np.maximum(np.maximum(lower - c, c - upper), 0)
    reach_in = np.square(gap).sum(axis=1) < r**2
    reach_in[: len(centers)] = True
    return c[reach_in], r[reach_in]


def region(wall="vacuum"):
    """What the spheres lie in; wall is the boundary_type of its surfaces."""
@REGION@

def spheres():
    """A surface for every sphere and image."""
    return [openmc.Sphere(*c, r) for c, r in zip(*with_images())]


def trisos(universe):
    return [openmc.model.TRISO(r, universe, c) for c, r in zip(*with_images())]


def lattice(universe, background, shape):
    """Finds spheres fast: of so many cells along each axis."""
    pitch = (upper - lower) / np.array(shape)
    return openmc.model.create_triso_lattice(trisos(universe), lower, pitch, shape, background)
