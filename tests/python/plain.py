"""What `bernal measure` says, once more, by NumPy and textbook formulas: pairs are sorted along x, and volumes of spheres
in shells are integrals. Shares nothing with the library."""

import numpy as np


def touching_pairs(centers, radii, ratio, edges=None):
    """All pairs i < j, as two arrays sorted by i, then by j, whose gap over the sum of their radii is below the ratio, and
    their distances. With edges: of the nearest images in that periodic box. Sorted along x, each sphere is compared with
    all that follow within reach; across the end of the box these are images of the first."""
    reach = 2 * (1 + ratio) * radii.max()
    ids = np.argsort(centers[:, 0])
    count, x = len(ids), centers[ids, 0]
    if edges is not None:
        first = ids[x < x[0] + reach]
        ids, x = np.concatenate([ids, first]), np.concatenate([x, centers[first, 0] + edges[0]])
    pairs = []
    for k in range(count):
        others = ids[k + 1 : np.searchsorted(x, x[k] + reach)]
        apart = centers[others] - centers[ids[k]]
        if edges is not None:
            apart -= edges * np.rint(apart / edges)
        distance = np.sqrt((apart * apart).sum(axis=1))
        near = distance < (1 + ratio) * (radii[others] + radii[ids[k]])
        pairs += [(min(ids[k], j), max(ids[k], j), d) for j, d in zip(others[near], distance[near])]
    rows = np.array(sorted(pairs)).reshape(-1, 3)
    return rows[:, 0].astype(int), rows[:, 1].astype(int), rows[:, 2]


def coordination(pairs, counted):
    """The mean number of pairs of those that are counted."""
    return sum(counted[ends].sum() for ends in pairs[:2]) / counted.sum()


def volume_of_slices(heights, radii, edges):
    """The volume of spheres between the planes z = edges[k] and edges[k + 1]."""
    t = np.clip((edges[:, None] - heights) / radii, -1, 1)
    below = np.pi / 3 * radii**3 * (1 + t) ** 2 * (2 - t)
    return np.diff(below.sum(axis=1))


def volume_in_shells(from_axis, heights, radii, edges, low, high):
    """The volume of spheres in cylindrical shells about an axis, between z = low and z = high: of each shell from
    edges[k] to edges[k + 1] the integral over the radius rho and the angle phi of rho times the length that the line
    parallel to the axis has in common with the sphere and the slab. Gauss's rule; the line touches the sphere at
    phi = phi_most, where the length has a root that phi = phi_most sin(t) takes away."""
    node, weight = np.polynomial.legendre.leggauss(24)
    angle = np.pi / 4 * (node + 1)  # t, from 0 to π/2; the other half is the same
    volumes = []
    for inner, outer in zip(edges[:-1], edges[1:]):
        begin, end = np.maximum(inner, from_axis - radii), np.minimum(outer, from_axis + radii)
        meets = begin < end
        a, z, r, begin, end = (v[meets, None, None] for v in (from_axis, heights, radii, begin, end))
        half = (end - begin) / 2
        rho = begin + half * (node[None, :, None] + 1)
        with np.errstate(divide="ignore", invalid="ignore"):
            most = np.arccos(np.clip((rho**2 + a**2 - r**2) / (2 * rho * a), -1, 1))
        most = np.where(a > 0, most, np.pi * (rho < r))
        phi = most * np.sin(angle)[None, None, :]
        across = rho**2 + a**2 - 2 * rho * a * np.cos(phi)
        chord = np.sqrt(np.maximum(r**2 - across, 0))
        length = np.clip(z + chord, low, high) - np.clip(z - chord, low, high)
        inside = (length * np.cos(angle) * weight).sum(axis=2) * 2 * most[:, :, 0] * np.pi / 4
        volumes.append((inside * rho[:, :, 0] * weight).sum(axis=1) @ half[:, 0, 0])
    return np.array(volumes)


def side_profile(centers, radii, radius, thickness, depth, low, high):
    """The porosity of layers of a column about the z axis, from its side inwards, between two heights."""
    edges = radius - thickness * np.arange(round(depth / thickness), -1, -1)
    filled = volume_in_shells(np.hypot(centers[:, 0], centers[:, 1]), centers[:, 2], radii, edges, low, high)
    return (1 - filled / (np.pi * np.diff(edges**2) * (high - low)))[::-1]


def first_minimum(porosities, thickness, diameter):
    """The least porosity within a diameter, and where, from a parabola through three layers."""
    least = int(np.argmin(porosities[: int(diameter / thickness)]))
    before, at, after = porosities[least - 1 : least + 2]
    shift = (before - after) / (2 * (before - 2 * at + after))
    return at - (before - after) * shift / 4, (least + 0.5 + shift) * thickness
