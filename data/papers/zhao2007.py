#!/usr/bin/env python3
"""Zhao Liang, Li Shuixiang, Liu Yuewu: Numerical simulation of sphere packing with arbitrary diameter distribution.
Chinese Journal of Computational Physics (2007, in Chinese). Figures 1, 2, 5, 8 to 12 and table 2 again."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from common import BLUE, GAPS, GREEN, INK, RED, USUAL, Claim, axes, claims_table, pack_all, power_law, processor, run
from common import scatter, table  # fmt: skip
from zhao2007_sizes import ARBITRARY, DRAWN_SIGMA, PRINTED_SIGMA, drawn_sizes

import bernal

@dataclass(frozen=True)
class Sizes:
    """Of table 2, and what is printed there for 10,000 spheres."""

    name: str
    radii: Any
    draw: str
    phi: float | None
    coordination: float | None
    cost: float  # seconds of the published loop, over those of equal spheres
    figure: int | None  # in which the packing is shown


SIZES = [
    Sizes("equal", 1, "random", 0.646, 5.72, 1, 9),
    Sizes("radii 1 and 0.5", bernal.Classes([1, 0.5], [1, 1]), "quantiles", 0.665, 5.24, 1.3, 10),
    Sizes("lognormal 0.3", bernal.Lognormal(1, PRINTED_SIGMA), "random", 0.644, 5.64, 2.2, 11),
    Sizes("arbitrary", ARBITRARY, "random", 0.692, 4.24, 2.3, 12),
    Sizes("lognormal 0.212", bernal.Lognormal(1, DRAWN_SIGMA), "random", None, None, 1.6, None),
]
EQUAL, LOGNORMAL, AS_PRINTED = 0, 2, 4

MOST, BEYOND = 10_000, 30_000  # the shortest period alone is affordable beyond by the published loop
COUNTS = {"reference": (100, 300, 1000, 3000, 10_000), "fast": (1000, 3000, 10_000, 30_000, 100_000)}
PERIODS = (20, 100)  # fixed ones of figure 5, which the text does not state
OF_TABLE, SEEDS_OF_TABLE = 2000, 3
LOOSE = 0.75  # phi0 that the paper takes for loose packings
TOLERANCE_PHI, TOLERANCE_Z = 0.005, 0.5


@dataclass(frozen=True)
class Run:
    """One packing by relaxation. period: sweeps between two growths; 0: T = 17 lg² N."""

    sizes: int = EQUAL
    method: str = "reference"
    period: int = 0
    phi0: float = 0.86
    spheres: int = 0
    seed: int = 0

    def scene(self) -> bernal.Scene:
        of, keys = SIZES[self.sizes], {"method": self.method}
        if self.period:
            keys["period"] = self.period
        if self.phi0 != Run.phi0:
            keys["phi0"] = self.phi0
        return bernal.Scene(
            bernal.Periodic(), radii=of.radii, draw=of.draw, seed=self.seed, count=self.spheres,
            stages=bernal.Relax(**keys),
        )  # fmt: skip

    def cost(self) -> float:
        sweeps = self.period or 17 * math.log10(self.spheres) ** 2
        return (0.015 if self.method == "fast" else 1) * SIZES[self.sizes].cost * self.spheres * sweeps


def wanted(call) -> list[Run]:
    """All that the figures and the table need, each once."""
    most, runs = call.spheres or MOST, {}

    def add(run: Run, seeds: int) -> None:
        runs.update({replace(run, seed=call.seed + k): None for k in range(seeds)})

    for n in (n for n in COUNTS["reference"] if n <= most):  # figures 5 and 8; more seeds where few spheres scatter
        for period in (0, *PERIODS):
            add(Run(period=period, spheres=n), min(max(most // 3 // n, 1), 8))
        add(Run(phi0=LOOSE, spheres=n), 1)
    if most >= MOST:
        add(Run(period=PERIODS[0], spheres=BEYOND), 1)
    for n in COUNTS["fast"]:
        if not call.spheres or n <= most:
            add(Run(method="fast", spheres=n), 1)
    seeds = 1 if most < OF_TABLE else SEEDS_OF_TABLE
    for row in range(len(SIZES)):  # table 2, figures 9 to 12
        add(Run(row, spheres=min(OF_TABLE, most)), seeds)
        if call.pack:
            add(Run(row, spheres=most), 1)
        add(Run(row, "fast", spheres=most), seeds)
    return list(runs)


class Results:
    """All runs and what came of them."""

    def __init__(self, call) -> None:
        self.runs = wanted(call)
        shown = [Run(row, "fast", spheres=call.spheres or MOST, seed=call.seed) for row in range(len(SIZES))]
        self.pictured = {self.runs.index(run): SIZES[run.sizes].figure for run in shown if SIZES[run.sizes].figure}
        self.done = pack_all(
            [run.scene() for run in self.runs], name="zhao2007", pictured=self.pictured,
            costs=[run.cost() for run in self.runs],
        )  # fmt: skip

    def of(self, run: Run):
        """Those that differ from this one by nothing but the seed."""
        return [done for each, done in zip(self.runs, self.done) if replace(each, seed=0) == run]

    def counts(self, run: Run) -> list[int]:
        """The numbers of spheres that runs like this one have, ascending."""
        return sorted({each.spheres for each in self.runs if replace(each, seed=0, spheres=0) == run})

    def series(self, run: Run, value):
        counts = self.counts(run)
        return counts, [float(np.mean([value(d) for d in self.of(replace(run, spheres=n))])) for n in counts]


def phi_of(done) -> float:
    return done.phi


def seconds_of(done) -> float:
    return done.seconds


def coordination_of(done) -> float:
    return done.coordination[USUAL]


def mean(value, packings) -> float:
    return float(np.mean([value(done) for done in packings]))


# Figures 5 and 8


def figure_5(output, results: Results) -> str:
    figure, ax = axes("number of spheres $N$", "packing fraction $\\phi$")
    for run, style, colour, words in (
        (Run(), "o-", INK, "$T = 17\\,\\lg^2 N$, published loop"),
        (Run(method="fast"), "D--", RED, "$T = 17\\,\\lg^2 N$, fast loop"),
        (Run(period=PERIODS[1]), "s-", BLUE, f"$T = {PERIODS[1]}$, published loop"),
        (Run(period=PERIODS[0]), "^-", GREEN, f"$T = {PERIODS[0]}$, published loop"),
    ):
        ax.plot(*results.series(run, phi_of), style, color=colour, label=words)
    ax.plot([MOST], [SIZES[EQUAL].phi], "k*", markersize=8, markerfacecolor=INK, linestyle="none",
            label="printed, table 2")  # fmt: skip
    ax.set_xscale("log")
    ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.2), ncols=2)  # the curves fill the axes
    output.figure("zhao2007_fig5.svg", figure)

    counts = sorted({*results.counts(Run(period=PERIODS[0])), *results.counts(Run(method="fast"))})
    columns = [Run(), *(Run(period=period) for period in PERIODS), Run(method="fast")]

    def cell(run: Run, n: int) -> str:
        found = results.of(replace(run, spheres=n))
        return scatter([d.phi for d in found], 4) if found else ""

    text = f"""## Figure 5: fixed and adaptive period

![figure 5](zhao2007_fig5.svg)

Packing fractions of equal spheres, mean ± standard deviation of one packing where there are several seeds:

{table(["spheres", "adaptive, 17 lg² N", *(f"T = {p}" for p in PERIODS), "fast loop, adaptive"],
       [[n, *(cell(run, n) for run in columns)] for n in counts])}
The curves of their figure 5 are not in the text, nor are its fixed periods; what the text says is that with a fixed
period the packing fraction falls as N rises, most where the period is short, and that it hardly changes with the
adaptive one."""
    common = [n for n in results.counts(Run()) if all(results.of(Run(period=p, spheres=n)) for p in PERIODS)]
    if len(common) > 1:
        few, many = common[max(len(common) - 3, 0)], common[-1]
        reached = lambda run, n: mean(phi_of, results.of(replace(run, spheres=n)))  # noqa: E731
        change = [reached(run, many) - reached(run, few) for run in columns[:3]]
        text += f"""
Here, from {few} to {many} spheres: {change[0]:+.4f} with the adaptive period, {change[2]:+.4f} with T = {PERIODS[1]} \
and {change[1]:+.4f} with T = {PERIODS[0]}."""
    return text + "\n\n"


def figure_8(output, results: Results) -> str:
    lines = (
        (Run(), "o-", INK, "published loop, $\\phi_0 = 0.86$", "published loop, φ0 = 0.86 (close)"),
        (Run(phi0=LOOSE), "s--", BLUE, "published loop, $\\phi_0 = 0.75$", "published loop, φ0 = 0.75 (their loose)"),
        (Run(period=100), None, "", "", "published loop, T = 100"),
        (Run(method="fast"), "D-", RED, "fast loop, $\\phi_0 = 0.86$", "fast loop, φ0 = 0.86"),
    )
    figure, ax = axes("number of spheres $N$", "processor time (s)")
    rows = []
    for run, style, colour, words, name in lines:
        counts, seconds = results.series(run, seconds_of)
        if style:
            ax.loglog(counts, seconds, style, color=colour, label=words)
        law = [(n, s) for n, s in zip(counts, seconds) if n >= 300]  # below, what does not grow with N counts
        if len(law) > 1:
            exponent, error = power_law(*zip(*law))
            rows.append([name, f"{law[0][0]} to {law[-1][0]}", f"{exponent:.2f} ± {error:.2f}", f"{law[-1][1]:.3g}"])
    ax.plot([MOST], [217], "k*", markersize=8, markerfacecolor=INK, linestyle="none", label="printed, Athlon 3200+")
    ax.legend()
    output.figure("zhao2007_fig8.svg", figure)
    most = results.counts(Run(phi0=LOOSE))[-1]
    loose, close = (mean(phi_of, results.of(Run(phi0=phi0, spheres=most))) for phi0 in (LOOSE, Run.phi0))
    laws = table(["equal spheres", "N", "exponent of N", "seconds at the most"], rows) + "\n" if rows else ""
    return f"""## Figure 8: time against the number of spheres

![figure 8](zhao2007_fig8.svg)

{laws}Printed: about O(N), and 217 s for 10,000 spheres in close packing on an AMD Athlon 3200+ (2.0 GHz). With the
adaptive period the number of sweeps grows as lg² N, so that O(N lg² N) is to be expected, an exponent of 1.2 or so over
these numbers: a sweep is O(N), the whole is not quite. The fast loop keeps the period that 10,000 spheres have beyond
them.

φ0 = 0.75, which the paper takes for random loose packing, gives {loose:.4f} with {most} spheres; 0.86 gives {close:.4f}.
That is close packing by either: loose ones need a smaller φ0.

"""


# Table 2 and figures 9 to 12


def pictures(output, results: Results) -> str:
    text = "## Figures 9 to 12: the packings and their middle planes\n\n"
    for k, figure in results.pictured.items():
        output.text(f"zhao2007_fig{figure}.svg", results.done[k].picture)
        output.text(f"zhao2007_fig{figure}_plane.svg", results.done[k].section)
        of = SIZES[results.runs[k].sizes]
        text += f"Figure {figure}: {of.name}, packing fraction {results.done[k].phi:.4f}\n\n"
        text += f"![figure {figure}](zhao2007_fig{figure}.svg)\n![its plane](zhao2007_fig{figure}_plane.svg)\n\n"
    return text + "By the fast loop; colours are sizes, from light and small to dark and large.\n\n"


def table_2(results: Results) -> str:
    rows = []
    for k, of in enumerate(SIZES):
        for method, loop in (("reference", "published"), ("fast", "fast")):
            listed = set(results.counts(Run(1, method)))
            if method == "reference":
                listed.add(results.counts(Run())[-1])
            for n in results.counts(Run(k, method)):
                if n not in listed:
                    continue
                found = results.of(Run(k, method, spheres=n))
                off = f"{mean(phi_of, found) - of.phi:+.4f}" if of.phi else ""
                rows.append([
                    of.name, loop, n, len(found), scatter(map(phi_of, found), 4), f"{of.phi:.3f}" if of.phi else "",
                    off, scatter(map(coordination_of, found), 2), f"{of.coordination:.2f}" if of.coordination else "",
                    scatter(map(seconds_of, found), 1),
                ])  # fmt: skip
    head = ["sizes", "loop", "N", "seeds", "packing fraction", "printed", "difference", "coordination", "printed",
            "seconds"]  # fmt: skip
    return f"""## Table 2: packing fraction and coordination

Mean ± standard deviation of one packing. The paper prints single numbers, for 10,000 spheres.

{table(head, rows)}
"""


def gap_for(coordination, asked: float) -> float | None:
    """The gap ratio to which neighbours have to be counted for that coordination, between those counted."""
    if not coordination[0] <= asked <= coordination[-1]:
        return None
    return float(np.exp(np.interp(asked, coordination, np.log(GAPS))))


def about_equal(results: Results) -> str:
    printed, most = SIZES[EQUAL], results.counts(Run())[-1]
    book = results.of(Run(spheres=most))
    fast = results.of(Run(method="fast", spheres=results.counts(Run(1, "fast"))[-1]))
    z = book[0].coordination
    near = abs(mean(phi_of, book) - printed.phi) <= TOLERANCE_PHI
    text = f"""Equal spheres, {most} by the published loop: {mean(phi_of, book):.4f}, \
{"" if near else "not "}within {TOLERANCE_PHI} of the printed {printed.phi:.3f}. Here packings are grown until
nothing overlaps at all, as the paper's are not: that costs up to three times the overlap ratio of 2e-4 at which the loop
stops, 0.0004. The coordination depends on how near a neighbour must be: this packing has {z[3]:.2f} at a gap ratio of
5e-4, {z[USUAL]:.2f} at 0.002 (the paper's) and {z[-1]:.2f} at 0.01."""
    if min(mean(coordination_of, fast), mean(coordination_of, book)) > printed.coordination:
        gap = gap_for(fast[0].coordination, printed.coordination)
        text += f""" The fast loop, whose spheres come nearer to rest between two growths, reaches
{mean(phi_of, fast):.4f} and then has {mean(coordination_of, fast):.2f}: a denser packing has more neighbours. The
printed pair, {printed.phi:.3f} with {printed.coordination:.2f}, has fewer than either: neither loop gives both"""
        if gap:
            text += f"""; the fast loop's packing
has {printed.coordination:.2f} where neighbours are counted up to a gap ratio of {gap:.1g}"""
        text += "."
    else:
        text += " So few spheres scatter too much to be held against the printed pair."
    return text + "\n\n"


def about_others(results: Results) -> str:
    printed = SIZES[LOGNORMAL].phi
    n = results.counts(Run(AS_PRINTED))[-1]
    stated, drawn = (mean(phi_of, results.of(Run(row, spheres=n))) for row in (LOGNORMAL, AS_PRINTED))
    grains = results.of(Run(3, "fast", spheres=results.counts(Run(3, "fast"))[-1]))
    return f"""Lognormal sizes: with sigma 0.3 the published loop gives {stated:.4f} for {n} spheres, {stated - printed:+.4f}
from print; with the sigma of 0.212 that the printed formula draws it gives {drawn:.4f}. The missing factor explains
{stated - drawn:.4f} of the difference; {drawn - printed:+.4f} is left, which nothing here explains.

Arbitrary sizes: their data are not in the text, and the sizes here were chosen so that they pack about as densely. So
only the coordination says something: {mean(coordination_of, grains):.2f} against the printed \
{SIZES[3].coordination:.2f}; it depends on how many small spheres lie loose between large ones, and theirs had other
sizes.
"""


def claims_of(results: Results) -> list[Claim]:
    claims = []
    for k, of in enumerate(SIZES):
        printed = of if of.phi else SIZES[LOGNORMAL]  # which the last of them are meant to be
        for method, loop in (("reference", "published"), ("fast", "fast")):
            n = results.counts(Run() if (k, method) == (EQUAL, "reference") else Run(k or 1, method))[-1]
            found, what = results.of(Run(k, method, spheres=n)), f"{of.name}, {loop} loop, {n} spheres"
            claims.append(Claim(f"{what}: packing fraction", printed.phi, mean(phi_of, found), TOLERANCE_PHI))
            claims.append(Claim(f"{what}: coordination", printed.coordination, mean(coordination_of, found),
                                TOLERANCE_Z, 2))  # fmt: skip
    return claims


def write(output, call) -> None:
    results = Results(call)
    sizes = drawn_sizes(output, call.seed)
    claims = claims_of(results)
    parts = [sizes, figure_5(output, results), figure_8(output, results), pictures(output, results), table_2(results),
             about_equal(results), about_others(results)]  # fmt: skip
    gaps = ",".join(f"coordination_at_{gap:g}" for gap in GAPS)
    output.csv(
        "zhao2007.csv", f"sizes,loop,period,phi0,spheres,seed,phi,coordination,seconds,{gaps}",
        [(SIZES[r.sizes].name, r.method, r.period or "adaptive", r.phi0, r.spheres, r.seed, d.phi, coordination_of(d),
          round(d.seconds, 3), *map(float, d.coordination)) for r, d in zip(results.runs, results.done)],
    )  # fmt: skip
    options = "".join([" --pack" * call.pack, f" --spheres {call.spheres}" * bool(call.spheres)])
    output.text("zhao2007.md", f"""# Zhao, Li & Liu (2007), done again

Zhao Liang, Li Shuixiang, Liu Yuewu: *Numerical simulation of sphere packing with arbitrary diameter distribution*.
Chinese Journal of Computational Physics (2007, in Chinese). Written by `apps/reproduce zhao2007{options}`; its
packings took {sum(map(seconds_of, results.done)):.0f} s of one core of: {processor()}. Seconds in the tables are the
processor's, of one thread a packing; all packings are certified free of overlap. `zhao2007.csv` has every one of them.

*Published loop*: the paper's, literally. *Fast loop*: the default of `relax`, the same idea on neighbour lists with
over-relaxed steps.

{claims_table(claims)}The text below names what lies outside its tolerance, and why, as far as that is known.

{"".join(parts)}""")  # fmt: skip


if __name__ == "__main__":
    run(__doc__.splitlines()[0], write,
        [("--pack", {"action": "store_true",
                     "help": "also the published loop with 10,000 spheres of all sizes"})])  # fmt: skip
