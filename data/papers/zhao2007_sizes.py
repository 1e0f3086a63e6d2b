"""Sizes of Zhao, Li & Liu (2007): figures 1 and 2, as they are drawn, against their density."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from common import BLUE, RED, axes, table

import bernal

PRINTED_SIGMA = 0.3
DRAWN_SIGMA = PRINTED_SIGMA / math.sqrt(2)
"""Of the formula r = exp(sigma √(-ln t) sin 2πt'), which lacks a factor 2 beside the logarithm."""

# Their figure 2, which has the data of the arbitrary sizes, is not in the text: a reading of what it must show, as in
# data/scenes/relax_arbitrary.toml.
ARBITRARY = bernal.Table(
    [0.2, 0.4, 0.6, 0.8, 1.0, 1.2, 1.4, 1.6, 1.8, 2.0, 2.4, 2.8, 3.2, 3.6, 4.0],
    [0.0, 0.75, 1.0, 0.93, 0.79, 0.65, 0.53, 0.43, 0.34, 0.27, 0.17, 0.10, 0.06, 0.03, 0.0],
)


class Density:
    """The natural cubic spline through points, negative values left out, as a distribution."""

    def __init__(self, xs, ys) -> None:
        x, y = np.asarray(xs, float), np.asarray(ys, float)
        h, n = np.diff(x), len(x)
        slopes, system, right = np.diff(y) / h, np.eye(n), np.zeros(n)
        for i in range(1, n - 1):
            system[i, i - 1 : i + 2] = h[i - 1], 2 * (h[i - 1] + h[i]), h[i]
            right[i] = 6 * (slopes[i] - slopes[i - 1])
        m = np.linalg.solve(system, right)
        fine = np.linspace(x[0], x[-1], 20_001)
        k = np.clip(np.searchsorted(x, fine, "right") - 1, 0, n - 2)
        t = fine - x[k]
        b, c, d = slopes[k] - h[k] * (2 * m[k] + m[k + 1]) / 6, m[k] / 2, (m[k + 1] - m[k]) / (6 * h[k])
        density = np.maximum(y[k] + t * (b + t * (c + t * d)), 0)
        self.x = fine
        self.share = np.concatenate([[0], np.cumsum(0.5 * (density[1:] + density[:-1]) * np.diff(fine))])
        self.share /= self.share[-1]

    def cumulative(self, radii):
        return np.interp(radii, self.x, self.share)


class Lognormal:
    def __init__(self, sigma: float) -> None:
        self.sigma = sigma

    def cumulative(self, radii):
        return np.array([0.5 * math.erfc(-math.log(r) / self.sigma / math.sqrt(2)) if r > 0 else 0.0 for r in radii])


@dataclass
class Drawn:
    """Ten thousand sizes, and the distribution that is stated."""

    radii: np.ndarray
    stated: Any
    edges: np.ndarray

    @cached_property
    def bars(self):
        return np.histogram(self.radii, self.edges)[0] / len(self.radii) / np.diff(self.edges)

    def density(self, stated):
        return np.diff(stated.cumulative(self.edges)) / np.diff(self.edges)

    def difference(self, stated) -> float:
        """The largest between the shares at or below any radius (Kolmogorov and Smirnov)."""
        expected, n = stated.cumulative(np.sort(self.radii)), len(self.radii)
        return float(max((expected - np.arange(n) / n).max(), (np.arange(1, n + 1) / n - expected).max()))


def drawn_here(sizes, seed: int) -> np.ndarray:
    """As a scene draws them: inserted at random into a box with more than enough room."""
    scene = bernal.Scene(bernal.Box([200] * 3), radii=sizes, count=10_000, draw="random", seed=seed,
                         stages=bernal.Insert())  # fmt: skip
    return np.array(bernal.pack(scene, progress=False).radii)


def printed_formula(seed: int) -> np.ndarray:
    """Of uniform numbers each and the next, and no factor 2 beside the logarithm."""
    t = 1 - np.random.default_rng(seed).random(10_001)
    return np.exp(PRINTED_SIGMA * np.sqrt(-np.log(t[:-1])) * np.sin(2 * np.pi * t[1:]))


def drawn_sizes(output, seed: int) -> str:
    wide, narrow, spline = Lognormal(PRINTED_SIGMA), Lognormal(DRAWN_SIGMA), Density(ARBITRARY.x, ARBITRARY.density)
    edges, grain_edges = np.linspace(0.2, 2.6, 49), np.linspace(0, 4.2, 49)
    own = Drawn(drawn_here(bernal.Lognormal(1, PRINTED_SIGMA), seed), wide, edges)
    printed = Drawn(printed_formula(seed), narrow, edges)
    grains = Drawn(drawn_here(ARBITRARY, seed), spline, grain_edges)

    for name, drawn, label, curves in (
        ("fig1", own, "radius / median", [(wide, RED, "-", "density, $\\sigma = 0.3$"),
                                          (narrow, BLUE, "--", "density, $\\sigma = 0.212$: the printed formula's")]),
        ("fig2", grains, "diameter", [(spline, RED, "-", "cubic spline through points")]),
    ):  # fmt: skip
        figure, ax = axes(label, "density")
        ax.stairs(drawn.bars, drawn.edges, fill=True, color="0.82", label="10,000 sizes, drawn here")
        middles = 0.5 * (drawn.edges[1:] + drawn.edges[:-1])
        for stated, colour, dashes, words in curves:
            ax.plot(middles, drawn.density(stated), dashes, color=colour, label=words)
        ax.set_xlim(drawn.edges[0], drawn.edges[-1])
        ax.set_ylim(bottom=0)
        ax.legend()
        output.figure(f"zhao2007_{name}.svg", figure)
    output.csv(
        "zhao2007_sizes.csv", "figure,size,density_drawn,density_stated",
        [(name, float(0.5 * (a + b)), float(bar), float(stated))
         for name, drawn in (("1", own), ("1 as printed", printed), ("2", grains))
         for a, b, bar, stated in zip(drawn.edges, drawn.edges[1:], drawn.bars, drawn.density(drawn.stated))],
    )  # fmt: skip
    rows = [
        ["lognormal, drawn here", "sigma 0.3", f"{own.difference(wide):.4f}"],
        ["by the printed formula", "sigma 0.3", f"{printed.difference(wide):.4f}"],
        ["by the printed formula", "sigma 0.3/√2 = 0.212", f"{printed.difference(narrow):.4f}"],
        ["arbitrary, drawn here", "the spline", f"{grains.difference(spline):.4f}"],
    ]
    head = ["10,000 sizes", "held against", "largest difference of the cumulative shares"]
    return f"""## Figures 1 and 2: drawn sizes against their density

![figure 1](zhao2007_fig1.svg)
![figure 2](zhao2007_fig2.svg)

{table(head, rows)}
If sizes follow the distribution, one draw in twenty differs by more than {1.36 / 100:.4f}. The printed formula,
r = exp(σ √(−ln t) sin 2πt') with t' the next t, lacks the factor 2 of Box and Muller beside the logarithm: it draws a
narrower distribution than the one it is said to. The data of their figure 2 are not in the text; one broad hump, skewed
to the right, stands for them. The paper rejects drawn numbers until one fits. Here the distribution is
inverted: one number gives one radius.

"""
