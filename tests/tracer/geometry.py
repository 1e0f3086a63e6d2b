"""Finds out what stands at points of a constructive geometry, as programs of particle transport do. It knows nothing of
bernal: each reader beside it makes such a geometry from a file alone, as the manual of the program says.

A geometry has universes. One is made of cells, of which exactly one has each point; or is a lattice; or is a list of
balls in a background. A cell holds a material, or another universe, moved and turned.
"""
import numpy as np

OUTSIDE = "outside"


class Quadric:
    """A x² + B y² + C z² + D xy + E yz + F xz + G x + H y + I z + J."""

    def __init__(self, coefficients):
        self.c = [float(c) for c in coefficients]

    def __call__(self, p):
        x, y, z = p[:, 0], p[:, 1], p[:, 2]
        a, b, c, d, e, f, g, h, i, j = self.c
        return x * (a * x + d * y + g) + y * (b * y + e * z + h) + z * (c * z + f * x + i) + j


class Plane:
    def __init__(self, normal, offset):
        self.normal, self.offset = np.array(normal, dtype=float), float(offset)

    def __call__(self, p):
        return p @ self.normal - self.offset


class Ball:
    def __init__(self, center, radius):
        self.center, self.radius = np.array(center, dtype=float), float(radius)

    def __call__(self, p):
        q = p - self.center
        return np.einsum("ij,ij->i", q, q) - self.radius**2


class Tube:
    """About a line, and a cone where the radius grows along it."""

    def __init__(self, at, axis, radius, growth=0.0):
        self.at = np.array(at, dtype=float)
        self.axis = np.array(axis, dtype=float) / np.linalg.norm(axis)
        self.radius, self.growth = float(radius), float(growth)

    def __call__(self, p):
        q = p - self.at
        along = q @ self.axis
        return np.einsum("ij,ij->i", q, q) - along**2 - (self.radius + self.growth * along) ** 2


class Within:
    """A body: negative where all of these are."""

    def __init__(self, *faces):
        self.faces = faces

    def __call__(self, p):
        return np.max([face(p) for face in self.faces], axis=0)


def frustum(base, along, first, last):
    """A body between two discs about a line."""
    base, along = np.array(base, dtype=float), np.array(along, dtype=float)
    height = np.linalg.norm(along)
    axis = along / height
    foot = base @ axis
    return Within(Tube(base, axis, first, (last - first) / height), Plane(axis, foot + height), Plane(-axis, -foot))


class Everywhere:
    def __call__(self, p):
        return np.full(len(p), -1.0)


class Placed:
    """A universe in a cell: what enters is moved by -shift and multiplied by the matrix, in this order or the other."""

    def __init__(self, universe, shift=None, matrix=None, turn_first=False):
        self.universe = universe
        self.shift = None if shift is None else np.array(shift, dtype=float)
        self.matrix = None if matrix is None else np.array(matrix, dtype=float).reshape(3, 3)
        self.turn_first = turn_first

    def enter(self, p):
        if self.turn_first and self.matrix is not None:
            p = p @ self.matrix.T
        if self.shift is not None:
            p = p - self.shift
        if not self.turn_first and self.matrix is not None:
            p = p @ self.matrix.T
        return p


class Cell:
    """`sides` are pairs (surface, sense), sense -1 where the formula is to be negative; `holds` is the name of a material or
    a Placed."""

    def __init__(self, sides, holds):
        self.sides, self.holds = sides, holds

    def has(self, p):
        inside = np.ones(len(p), dtype=bool)
        for surface, sense in self.sides:
            inside &= sense * surface(p) > 0
        return inside


class Cells:
    """`ends` where points that no cell has are outside of everything, as in a root universe."""

    def __init__(self, cells, ends=False):
        self.cells, self.ends = cells, ends

    def split(self, p):
        """Pairs (what a cell holds, which points it has); counts the points that not exactly one cell has."""
        claims = np.zeros(len(p), dtype=int)
        parts = []
        for cell in self.cells:
            has = np.nonzero(cell.has(p))[0]
            claims[has] += 1
            if len(has):
                parts.append((cell.holds, has))
        if self.ends:
            parts.append((OUTSIDE, np.nonzero(claims == 0)[0]))
        return parts, int(np.count_nonzero(claims > 1 if self.ends else claims != 1))


class Lattice:
    """`universes` has the shape (nx, ny, nz); each has its origin in the middle of its element."""

    def __init__(self, lower, pitch, universes, outer):
        self.lower, self.pitch = np.array(lower, dtype=float), np.array(pitch, dtype=float)
        self.universes, self.outer = np.array(universes), outer

    def split(self, p):
        index = np.floor((p - self.lower) / self.pitch).astype(int)
        within = np.all((index >= 0) & (index < self.universes.shape), axis=1)
        parts = [(Placed(self.outer), np.nonzero(~within)[0])] if not within.all() else []
        inside = np.nonzero(within)[0]
        flat = np.ravel_multi_index(index[inside].T, self.universes.shape)
        order = np.argsort(flat, kind="stable")
        inside, flat = inside[order], flat[order]
        starts = np.nonzero(np.diff(flat, prepend=-1))[0]
        for start, end in zip(starts, list(starts[1:]) + [len(flat)]):
            at = np.array(np.unravel_index(flat[start], self.universes.shape))
            middle = self.lower + (at + 0.5) * self.pitch
            parts.append((Placed(self.universes[tuple(at)], middle), inside[start:end]))
        return parts, 0


class Repeated:
    """A box that repeats itself without end, with one universe, whose origin moves with it."""

    def __init__(self, lower, upper, universe):
        self.lower, self.size = np.array(lower, dtype=float), np.array(upper, dtype=float) - lower
        self.universe = universe

    def split(self, p):
        return [(self, np.arange(len(p)))], 0

    def enter(self, p):
        return p - np.floor((p - self.lower) / self.size) * self.size


class Balls:
    """Balls, each with a universe about its centre, and around them a background."""

    def __init__(self, centers, radii, universes, background):
        self.centers, self.radii = centers, radii
        self.universes, self.background = universes, background
        self.grid = None

    def make_grid(self):
        low, high = (self.centers - self.radii[:, None]).min(axis=0), (self.centers + self.radii[:, None]).max(axis=0)
        pitch = max((np.prod(high - low) / len(self.radii)) ** (1 / 3), 1e-9)
        shape = np.clip(((high - low) / pitch).astype(int), 1, 200)
        pitch = (high - low) / shape
        first = np.floor((self.centers - self.radii[:, None] - low) / pitch).astype(int).clip(0, shape - 1)
        last = np.floor((self.centers + self.radii[:, None] - low) / pitch).astype(int).clip(0, shape - 1)
        span = last - first + 1
        count = np.prod(span, axis=1)
        ball = np.repeat(np.arange(len(count)), count)
        k = np.arange(len(ball)) - np.repeat(np.cumsum(count) - count, count)
        offset = np.stack([k % span[ball, 0], k // span[ball, 0] % span[ball, 1], k // (span[ball, 0] * span[ball, 1])], 1)
        box = np.ravel_multi_index((first[ball] + offset).T, shape)
        order = np.argsort(box, kind="stable")
        starts = np.searchsorted(box[order], np.arange(np.prod(shape) + 1))
        self.grid = low, pitch, shape, ball[order], starts

    def split(self, p):
        if self.grid is None:
            self.make_grid()
        low, pitch, shape, balls, starts = self.grid
        index = np.floor((p - low) / pitch).astype(int)
        within = np.nonzero(np.all((index >= 0) & (index < shape), axis=1))[0]
        box = np.ravel_multi_index(index[within].T, shape)
        count = starts[box + 1] - starts[box]
        owner, claims = np.full(len(p), -1), np.zeros(len(p), dtype=int)
        for k in range(count.max(initial=0)):
            some = np.nonzero(count > k)[0]
            ball, at = balls[starts[box[some]] + k], within[some]
            inside = ((p[at] - self.centers[ball]) ** 2).sum(axis=1) < self.radii[ball] ** 2
            owner[at[inside]] = ball[inside]
            claims[at[inside]] += 1
        parts = []
        order = np.argsort(owner, kind="stable")
        starts = np.nonzero(np.diff(owner[order], prepend=-2))[0]
        for start, end in zip(starts, list(starts[1:]) + [len(p)]):
            which = order[start:end]
            ball = owner[which[0]]
            if ball < 0:
                parts.append((Placed(self.background), which))
            else:
                parts.append((Placed(self.universes[ball], self.centers[ball]), which))
        return parts, int(np.count_nonzero(claims > 1))


class Geometry:
    """`universes` by name; `root` is the one that space begins with. `entries` by universe: what is done to coordinates that
    enter it, wherever that is."""

    def __init__(self, universes, root, entries=None):
        self.universes, self.root, self.entries = universes, root, entries or {}
        self.unclear = 0  # points that no cell had, or more than one

    def at(self, points, root=None, leaves=()):
        """The material at each point, as a list of names and an index into it a point; -1 where the file says nothing.
        Universes among the leaves count as materials."""
        names, found = {}, np.full(len(points), -1)
        self.unclear = 0
        start = self.root if root is None else root
        pending = {start: [(np.arange(len(points)), np.array(points, dtype=float))]}
        while pending:
            following = {}
            for universe, parts in pending.items():
                which = np.concatenate([w for w, _ in parts])
                p = np.concatenate([q for _, q in parts])
                if universe in leaves and universe != start:
                    found[which] = names.setdefault(universe, len(names))
                    continue
                if universe in self.entries:
                    p = self.entries[universe].enter(p)
                split, unclear = self.universes[universe].split(p)
                self.unclear += unclear
                for holds, has in split:
                    if isinstance(holds, (Placed, Repeated)):
                        following.setdefault(holds.universe, []).append((which[has], holds.enter(p[has])))
                    else:
                        found[which[has]] = names.setdefault(holds, len(names))
            pending = following
        return list(names), found


def spread(lower, upper, count, random):
    """About so many points, one at random in each box of a grid."""
    lower, upper = np.array(lower, dtype=float), np.array(upper, dtype=float)
    shape = np.maximum(1, np.round((upper - lower) * (count / np.prod(upper - lower)) ** (1 / 3)).astype(int))
    index = np.stack(np.meshgrid(*[np.arange(n) for n in shape], indexing="ij"), -1).reshape(-1, 3)
    return lower + (index + random.random(index.shape)) * ((upper - lower) / shape)


def volumes(geometry, lower, upper, count, runs=8, seed=1, root=None, leaves=(), ball=None):
    """By name (volume, standard error), from so many independent runs; of a ball about the origin where that is given."""
    random = np.random.default_rng(seed)
    whole = np.prod(np.array(upper, dtype=float) - np.array(lower, dtype=float))
    shares, unclear = {}, 0
    for run in range(runs):
        points = spread(lower, upper, count // runs, random)
        inside = points if ball is None else points[(points**2).sum(axis=1) < ball**2]
        names, found = geometry.at(inside, root, leaves)
        unclear += geometry.unclear
        for name, hits in zip(names, np.bincount(found[found >= 0], minlength=len(names))):
            shares.setdefault(name, np.zeros(runs))[run] = hits / len(points)
    geometry.unclear = unclear
    return {name: (whole * s.mean(), whole * s.std(ddof=1) / runs**0.5) for name, s in shares.items()}


def behind(geometry, universe):
    """The universe itself, or where it is a turned one alone that which it turns."""
    made = geometry.universes[universe]
    while isinstance(made, Cells) and len(made.cells) == 1 and isinstance(made.cells[0].holds, Placed):
        if any(not isinstance(surface, Everywhere) for surface, _ in made.cells[0].sides):
            break
        universe = made.cells[0].holds.universe
        made = geometry.universes[universe]
    return universe


def universes_in_balls(geometry):
    """Of every universe that a ball about its origin holds, the radius of that ball."""
    radii = {}

    def note(universe, radius):
        universe = behind(geometry, universe)
        radii[universe] = max(radii.get(universe, 0), radius)

    for made in geometry.universes.values():
        if isinstance(made, Balls):
            for universe, radius in set(zip(made.universes, made.radii)):
                note(universe, radius)
        elif isinstance(made, Cells):
            for cell in made.cells:
                if isinstance(cell.holds, Placed) and len(cell.sides) == 1:
                    surface, sense = cell.sides[0]
                    if isinstance(surface, Ball) and sense < 0:
                        note(cell.holds.universe, surface.radius)
    return radii


def volumes_by_levels(geometry, lower, upper, count, runs=8):
    """The same as `volumes`, level by level: what a universe within a ball holds is found once, from so many points, and
    counts for all places of it. Points of one level say more of small things than those of all space."""
    balls = universes_in_balls(geometry)
    known, unclear = {}, 0

    def shares(universe):
        nonlocal unclear
        if universe not in known:
            r = balls[universe]
            within = volumes(geometry, [-r] * 3, [r] * 3, count, runs, root=universe, leaves=balls, ball=r)
            unclear += geometry.unclear
            known[universe] = collected({name: (v / (4 / 3 * np.pi * r**3), e / (4 / 3 * np.pi * r**3))
                                         for name, (v, e) in within.items()})
        return known[universe]

    def collected(found):
        """With universes replaced by what they hold; errors of independent samples add up by squares."""
        total = {}
        for name, (volume, error) in found.items():
            parts = shares(name) if name in balls else {name: (1.0, 0.0)}
            for material, (share, its) in parts.items():
                v, square = total.get(material, (0.0, 0.0))
                total[material] = v + volume * share, square + (error * share) ** 2 + (volume * its) ** 2
        return {name: (v, square**0.5) for name, (v, square) in total.items()}

    outermost = volumes(geometry, lower, upper, count, runs, leaves=balls)
    unclear += geometry.unclear
    made = collected(outermost)
    geometry.unclear = unclear
    return made
