"""What the tables of methods and of effects share: rooms, measured runs of scenes in rounds, medians."""

import math
import random
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

SOURCE = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(SOURCE / "data/papers")]
try:
    import bernal
except ImportError:
    subprocess.run([SOURCE / "cmake/build", "release", "bernal_python_package"], check=True, stdout=sys.stderr)
    sys.path[:0] = [str(SOURCE / "build/release/python")]
    import bernal


@dataclass
class SizeClass:
    """Sizes that methods are compared with, drawn by quantiles."""

    name: str  # of files
    title: str
    sizes: object
    mean_cube: float  # of the diameters
    count: int  # of spheres, where nobody says it
    least: int  # with fewer, the box between floor and lid is too narrow for the largest
    wide: bool = False  # so wide that the small fit between the large

    def count_for(self, asked):
        return max(asked, self.least) if asked else self.count

    @property
    def predicted(self):
        """By the rod model."""
        return bernal.predict(self.sizes, rods=16_000).phi


def lognormal_cubed(sigma, most):
    """Mean cube of lognormal diameters of median 1, cut above."""
    below = lambda x: 0.5 * math.erfc(-x / math.sqrt(2))  # noqa: E731
    cut = math.log(most) / sigma
    return math.exp(4.5 * sigma**2) * below(cut - 3 * sigma) / below(cut)


EQUAL = SizeClass("equal", "equal spheres", bernal.Constant(1), 1, 2000, 100)
LOGNORMAL = SizeClass("lognormal", "lognormal spheres, sigma 0.3", bernal.Lognormal(1, 0.3, max=3),
                      lognormal_cubed(0.3, 3), 2000, 700)  # fmt: skip
ONE_TO_FIVE = SizeClass("1_5", "diameters 1 : 5, a fifth of the volume small",
                        bernal.Classes([1, 5], [1, 4], basis="volume"), 5 / (1 + 4 / 125), 3000, 1200, True)  # fmt: skip

BETWEEN_LIDS = 0.94
"""What fits between floor and lid, in shares of what is predicted without them; a box is that large."""
JAMS = 0.98
"""More than fits there: what grows to that jams before, and the tail is taken out."""


def room(of, count, sides="none", **keys):
    """A cube for so many spheres, as large as the packing needs where it has no sides, else as large as is expected to be
    filled: with a floor and a lid ("lids"), or a box like any other ("box")."""
    if sides == "none":
        keys.setdefault("container", bernal.Periodic())
        keys["count"] = count
    else:
        edge = (count * math.pi / 6 * of.mean_cube / (BETWEEN_LIDS * of.predicted)) ** (1 / 3)
        keys["container"] = bernal.Periodic(edge=edge, walls=[2]) if sides == "lids" else bernal.Box([edge] * 3)
    return bernal.Scene(keys.pop("container"), diameters=of.sizes, draw="quantiles", **keys)


@dataclass
class Trial:
    """What one run reached. phi is strict: of the spheres shrunk by the largest overlap that is left, and of the sizes
    that the scene asks for. cut_off: all that is known is that it is slower."""

    seed: int
    seconds: float  # of the processor, in one thread
    spheres: int = 0
    phi: float = 0
    core: float | None = None  # of what lies a few spheres from the walls and deeper
    held_from: float | None = None  # the smallest gap ratio at which contacts hold half of the spheres
    outcome: str = "cut_off"

    @property
    def cut_off(self):
        return self.outcome == "cut_off"


class TooSlow(Exception):
    pass


def run_trial(scene, seed, limit=math.inf, measured=False):
    """Packs and certifies; what takes the processor longer than the limit is cut off."""
    before = time.process_time()

    def watch(*_):
        if time.process_time() - before > limit:
            raise TooSlow

    try:
        packing = bernal.pack(scene, seed=seed, threads=1, progress=watch)
    except TooSlow:
        return Trial(seed, time.process_time() - before)
    trial = Trial(seed, time.process_time() - before, len(packing), outcome=packing.outcome)
    proof = bernal.verify(packing, threads=1, progress=False)
    if not proof:
        raise SystemExit(f"not certified: {scene.stages}")
    trial.phi = packing.packing_fraction * ((1 - max(0, proof.max_overlap)) / packing.size_scale) ** 3
    if measured:
        found = bernal.measure(packing, progress=False)
        trial.held_from = found.held_from_gap
        trial.core = found.walls.core_phi if found.walls else None
    return trial


def interleaved(scenes, seeds, say, **options):
    """The trials of every scene, in the order of the seeds. Every round has every scene once, in an order of its own,
    and every second one goes through that of the one before backwards, so that a machine that becomes slower or faster
    meanwhile does not favour one of them."""
    trials, done = [[] for _ in scenes], 0
    for round_, seed in enumerate(seeds):
        order = list(range(len(scenes)))
        random.Random(round_ // 2).shuffle(order)
        for k in reversed(order) if round_ % 2 else order:
            trials[k].append(run_trial(scenes[k], seed, measured=options.get("measured", {}).get(k, False),
                                       limit=options.get("limit", math.inf)))  # fmt: skip
            done += 1
            say(f"{done} of {len(scenes) * len(seeds)} runs")
    say("")
    return trials


class Spread:
    """Median, and half of what lies between the least and the greatest."""

    def __init__(self, values):
        values = list(values)
        self.median, self.half_width = float(np.median(values)), 0.5 * (max(values) - min(values))

    def text(self, digits):
        return f"{self.median:.{digits}f} ± {self.half_width:.{digits}f}"
