"""The rod model of Farr (2013): its sizes, table 1, figures 1 and 5."""

from __future__ import annotations

import heapq
import statistics
import time
from dataclasses import dataclass

import numpy as np
from common import BLUE, GREEN, INK, RED, Claim, axes, pack_all, plt, say, table

import bernal

RODS = 16_000
KTS = {"fmt": "^", "color": INK, "markersize": 5}


def lognormal(sigma: float, mean: float = 1):
    """By volume, of that volume-weighted mean diameter."""
    if sigma < 1e-9:
        return bernal.Constant(mean)
    return bernal.Lognormal(mean * np.exp(-0.5 * sigma * sigma), sigma, basis="volume")


@dataclass(frozen=True)
class Mixture:
    """A row of table 2: event-driven packings by the algorithm of Kansal, Torquato and Stillinger (KTS), three of each,
    and the rod model as printed there. Volume-weighted mean diameters 1 : ratio, of b `share` of the volume."""

    spheres: int
    sigma_a: float
    sigma_b: float
    ratio: float
    share: float
    kts: float
    error: float
    rods: float

    @property
    def sizes(self):
        return mixed(self.sigma_a, self.sigma_b, self.ratio, self.share)

    @property
    def name(self) -> str:
        return f"σ {self.sigma_a}" + (f" and σ {self.sigma_b}, 1 : 2" if self.share else "")


def mixed(sigma_a: float, sigma_b: float, ratio: float, share: float):
    if share == 0:
        return lognormal(sigma_a)
    if share == 1 or (ratio == 1 and sigma_a == sigma_b):
        return lognormal(sigma_b, ratio)
    return bernal.Mixture([lognormal(sigma_a), lognormal(sigma_b, ratio)], [1 - share, share], basis="volume")


TABLE_2 = [
    Mixture(1024, 0, 0, 1, 0, 0.6426, 0.0005, 0.643), Mixture(2048, 0.3, 0, 1, 0, 0.6671, 0.0006, 0.671),
    Mixture(2048, 0, 0, 2, 0.5, 0.6736, 0.0007, 0.676), Mixture(2048, 0.3, 0, 2, 0.5, 0.6939, 0.0011, 0.702),
    Mixture(2048, 0, 0.3, 2, 0.5, 0.6724, 0.0005, 0.674), Mixture(2048, 0.3, 0.3, 2, 0.5, 0.6931, 0.0002, 0.699),
]  # fmt: skip
ONE_POPULATION = TABLE_2[:2]
# sigma, rods, packing fraction and milliseconds as printed; 3.2 GHz Pentium
TABLE_1 = [(0, 16000, 0.643485, 40), (0.5, 16000, 0.707259, 479), (1, 16000, 0.801339, 507),
           (0, 64000, 0.643485, 331), (0.5, 64000, 0.707262, 2151), (1, 64000, 0.801368, 2644)]  # fmt: skip


class Part:
    """What a figure or table leaves in the page of the whole."""

    def __init__(self, output, call, claims) -> None:
        self.output, self.call, self.claims = output, call, claims
        self.seconds = 0.0  # of the processor, that packings took
        self.at_most = lambda n: min(n, call.spheres or n)

    def pack(self, scenes, **keys):
        done = pack_all(scenes, name="farr2013", dense=not self.call.spheres, **keys)
        self.seconds += sum(d.seconds for d in done)
        return done


# Table 1


def published_erfc(x):
    """As the published program has it: Abramowitz & Stegun 7.1.26, right to 1.5e-7."""
    t = 1 / (1 + 0.3275911 * np.abs(x))
    tail = t * (0.254829592 + t * (-0.284496736 + t * (1.421413741 + t * (-1.453152027 + t * 1.061405429))))
    tail *= np.exp(-x * x)
    return np.where(x < 0, 2 - tail, tail)


def published_share_below(length, sigma: float):
    """The share of the chords, of spheres of mean diameter 1, that are shorter than `length`: eq. 34."""
    if sigma == 0:
        return np.minimum(length * length, 1)
    below = (np.log(length) + 1.5 * sigma**2) / (sigma * np.sqrt(2))
    above = below + sigma * np.sqrt(2)
    return 1 - 0.5 * published_erfc(below) + 0.5 * length**2 * np.exp(5 * sigma**2) * published_erfc(above)


def covered(lengths, f: float = 0.7654) -> float:
    """The share of the line that rods of descending lengths cover, each put at the end of the largest gap; gaps beside
    a rod and a smaller one are never below f times the smaller, and the line grows where that needs it."""
    gaps, total, rods = [-f * lengths[0]], f * lengths[0], lengths[0]
    for length in lengths[1:]:
        gap, left = -gaps[0], f * length
        right = max(gap - (1 + f) * length, left)
        heapq.heapreplace(gaps, -left)
        heapq.heappush(gaps, -right)
        total += left + right - gap
        rods += length
    return rods / (rods + total)


def published_fraction(sigma: float, rods: int) -> float:
    """The model with that erfc, by bisection: the digits that were printed."""
    share = (rods - np.arange(rods) - 0.5) / rods
    low, high = np.full(rods, -40.0), np.full(rods, 40.0)  # of ln L
    for _ in range(60):
        middle = 0.5 * (low + high)
        shorter = published_share_below(np.exp(middle), sigma) < share
        low, high = np.where(shorter, middle, low), np.where(shorter, high, middle)
    return covered(np.exp(low).tolist())


def table_1(part: Part) -> str:
    rows = []
    for sigma, rods, printed, milliseconds in TABLE_1:
        times = []
        for _ in range(5):
            start = time.perf_counter()
            here = bernal.predict(lognormal(sigma), rods=rods).phi
            times.append(1e3 * (time.perf_counter() - start))
        again = published_fraction(sigma, rods)
        rows.append((sigma, rods, here, again, printed, statistics.median(times), milliseconds))
        part.claims.append(Claim(f"table 1: sigma {sigma}, {rods} rods", printed, round(again, 6), 1e-9, 6))
    part.output.csv("table1.csv", "sigma,rods,phi,phi_with_published_erfc,phi_published,milliseconds,"
                    "milliseconds_published",
                    [(s, n, h, round(a, 6), p, round(t, 3), m) for s, n, h, a, p, t, m in rows])  # fmt: skip
    head = ["sigma", "rods", "printed", "with the erfc of the published program", "with an exact erfc", "ms printed",
            "ms here"]  # fmt: skip
    return f"""## Table 1: the rod model

{table(head, [[s, n, f"{p:.6f}", f"{a:.6f}", f"{h:.7f}", m, f"{t:.3f}"] for s, n, h, a, p, t, m in rows])}
The published program evaluates erfc by a formula that is right to 1.5e-7; with it the printed digits come out, and an
exact one changes the fifth at sigma = 1. Printed times are of a 3.2 GHz Pentium, those here of a call from Python.

"""


# Figure 1


def fit(sigma):
    """Eq. 27."""
    wave = 1 - np.exp(-0.75 * sigma**0.7 - 0.025 * sigma**4)
    return 1 - 0.57 * np.exp(-sigma) + 0.2135 * np.exp(-0.57 * sigma / 0.2135) + 0.0019 * (np.cos(2 * np.pi * wave) - 1)


def figure_1(part: Part) -> str:
    sigmas = np.linspace(0, 3, 121)
    made = [bernal.predict(lognormal(float(s)), rods=64_000) for s in sigmas]
    phi, fitted = np.array([p.phi for p in made]), fit(sigmas)
    part.output.csv("fig1.csv", "sigma,phi_rods,error_from_rods,phi_fit,fit_minus_rods",
                    [(float(s), float(a), p.error, float(b), float(b - a))
                     for s, a, p, b in zip(sigmas, phi, made, fitted)])  # fmt: skip
    figure, ax = axes("width $\\sigma$ of $\\ln D$", "packing fraction $\\phi$")
    ax.plot(sigmas, phi, color=INK, label="rod model, 64,000 rods")
    ax.plot([s for s, n, *_ in TABLE_1 if n == 64_000], [p for _, n, p, _ in TABLE_1 if n == 64_000], "o", color=RED,
            label="printed, table 1")  # fmt: skip
    ax.set_xlim(0, 3)
    ax.legend(loc="upper left")
    inset = ax.inset_axes([0.5, 0.15, 0.46, 0.42])
    inset.plot(sigmas, 1e4 * (fitted - phi), color=BLUE)
    inset.axhline(0, color=INK, linewidth=0.5)
    inset.set_xlim(0, 3)
    inset.set_ylabel("$10^4$ (fit − rods)", fontsize=8)
    inset.tick_params(labelsize=7)
    part.output.figure("fig1.svg", figure)
    worst = int(np.abs(fitted - phi).argmax())
    part.claims.append(Claim("figure 1: largest error of the fit, eq. 27", 0, float(abs(fitted - phi)[worst]), 3e-4, 5))
    return f"""## Figure 1: one lognormal population

![figure 1](fig1.svg)

The curve and, in the inset, how far the fit of eq. 27 is off: at most {abs(fitted - phi)[worst]:.1e}, at sigma =
{sigmas[worst]:g}. The printed curve is not in the text; its values at 0, 0.5 and 1 are those of table 1.

"""


# Figure 5


def figure_5(part: Part) -> str:
    widths, ratios, shares = (0, 0.3, 0.6), (1, 2, 4, 8), np.linspace(0, 1, 51)
    figure, panels = plt.subplots(3, 3, figsize=(6.6, 6.0), sharex=True, sharey=True)
    rows, lower_left = [], {}
    for i, sigma_b in enumerate(widths):
        for j, sigma_a in enumerate(widths):
            ax = panels[i][j]
            for ratio, style, colour in zip(ratios, ("-", "--", "-.", ":"), (INK, BLUE, RED, GREEN)):
                made = [bernal.predict(mixed(sigma_a, sigma_b, ratio, float(w)), rods=RODS) for w in shares]
                rows += [(sigma_a, sigma_b, ratio, float(w), p.phi, p.error) for w, p in zip(shares, made)]
                ax.plot(shares, [p.phi for p in made], style, color=colour, label=f"$R = {ratio}$")
                if (sigma_a, sigma_b) == (0, 0.6):
                    lower_left[ratio] = made[15].phi  # where 30 % of the volume are b
            printed = [r for r in TABLE_2 if (r.sigma_a, r.sigma_b, r.share) == (sigma_a, sigma_b, 0.5)]
            ax.plot([r.share for r in printed], [r.rods for r in printed], "o", color=INK, label="printed, table 2")
            ax.set_title(f"$\\sigma_a = {sigma_a}$, $\\sigma_b = {sigma_b}$", fontsize=9)
            ax.set_xlim(0, 1)
        say(f"farr2013: figure 5, {i + 1} of 3 rows")
    panels[0][0].legend(fontsize=7)
    figure.supxlabel("share $w$ of b in the volume", fontsize=10)
    figure.supylabel("packing fraction $\\phi$", fontsize=10)
    figure.tight_layout()
    part.output.figure("fig5.svg", figure)
    part.output.csv("fig5.csv", "sigma_a,sigma_b,ratio,share_b,phi,error", rows)
    so = "so it is" if lower_left[2] < lower_left[1] else "it is not so at this share"
    return f"""## Figure 5: mixtures of two populations

![figure 5](fig5.svg)

Printed: in the lower left panel, where equal spheres (a) are mixed with wide ones (b, sigma 0.6), the lowest packing
fraction need not be at equal means. Here, where 30 % of the volume are b: {lower_left[1]:.4f} at equal means and
{lower_left[2]:.4f} at means of 1 : 2: {so}.

"""
