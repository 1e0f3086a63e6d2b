#!/usr/bin/env python3
"""R. S. Farr: Random close packing fractions of lognormal distributions of hard spheres. Powder Technology 245, 28
(2013). Figures 1 to 6 and tables 1 and 2 again."""

from __future__ import annotations

import concurrent.futures
import time

import numpy as np
from common import BLUE, GREEN, INK, RED, USUAL, Claim, axes, claims_table, cores, plt, processor, rods_of, run, say
from common import scatter, table, whole  # fmt: skip
from farr2013_rods import KTS, ONE_POPULATION, RODS, TABLE_2, Part, figure_1, figure_5, lognormal, table_1

import bernal


def scene(sizes, spheres: int, stage, seed: int, **more) -> bernal.Scene:
    return bernal.Scene(bernal.Periodic(), diameters=sizes, draw="quantiles", count=spheres, stages=stage, seed=seed,
                        **more)  # fmt: skip


def as_printed(sigma: float):
    return bernal.Grow(delta=0.1, phi_init=0.2 if sigma == 0 else 0.15)


# Table 2, figures 3 and 4


def table_2(part: Part) -> str:
    rods = [bernal.predict(row.sizes, rods=RODS).phi for row in TABLE_2]
    scenes = [scene(r.sizes, part.at_most(r.spheres), as_printed(r.sigma_a + r.sigma_b + r.share), part.call.seed)
              for r in TABLE_2]  # fmt: skip
    few = part.at_most(10_000)
    if part.call.pack:
        scenes += [scene(row.sizes, few, bernal.Relax(), part.call.seed) for row in TABLE_2]
    done = part.pack(scenes, pictured=set(range(len(TABLE_2))))
    grown, relaxed = done[: len(TABLE_2)], done[len(TABLE_2) :] or [None] * len(TABLE_2)
    part.output.csv(
        "table2.csv", "sigma_a,sigma_b,ratio,share_b,phi_rods,phi_rods_published,phi_kts,error_kts,spheres_kts,"
        "phi_grown,spheres_grown,coordination_grown,seconds_grown,phi_relax,spheres_relax,coordination_relax",
        [(row.sigma_a, row.sigma_b, row.ratio, row.share, phi, row.rods, row.kts, row.error, row.spheres, g.phi, len(g),
          float(g.coordination[USUAL]), round(g.seconds, 2),
          *((r.phi, len(r), float(r.coordination[USUAL])) if r else (None,) * 3))
         for row, phi, g, r in zip(TABLE_2, rods, grown, relaxed)],
    )  # fmt: skip
    for k, g in enumerate(grown):
        part.output.text(f"fig3_{k + 1}.svg", g.picture)

    figure, ax = plt.subplots(figsize=(5.4, 3.4))
    at = np.arange(len(TABLE_2))
    ax.hlines(rods, at - 0.3, at + 0.3, color=RED, label="rod model, 16,000 rods")
    ax.errorbar(at, [r.kts for r in TABLE_2], [r.error for r in TABLE_2], **KTS, label="KTS, printed")
    ax.plot(at, [g.phi for g in grown], "o", color=BLUE, label="growth, here")
    if relaxed[0]:
        ax.plot(at, [r.phi for r in relaxed], "s", color=GREEN, label=f"relax, {few} spheres, here")
    ax.set_xticks(at, [row.name.replace(" and ", "\n") for row in TABLE_2], fontsize=8)
    ax.tick_params(axis="x", which="both", length=0)
    ax.set_ylabel("packing fraction $\\phi$")
    ax.legend(loc="lower right")
    part.output.figure("fig4.svg", figure)

    off = [g.phi - row.kts for row, g in zip(TABLE_2, grown)]
    for row, phi, g in zip(TABLE_2, rods, grown):
        part.claims.append(Claim(f"table 2, {row.name}: rod model", row.rods, phi, 5e-4))
        part.claims.append(Claim(f"table 2, {row.name}: growth against KTS", row.kts, g.phi, 0.006))
    head = ["sizes", "rods printed", "rods here", "KTS printed", "growth here", "difference"]
    head += ["relax here"] * bool(relaxed[0])
    rows = [[row.name, row.rods, f"{phi:.4f}", f"{row.kts} ± {row.error}", f"{g.phi:.4f}", f"{d:+.4f}",
             *([f"{r.phi:.4f}"] if r else [])] for row, phi, g, d, r in zip(TABLE_2, rods, grown, off, relaxed)]  # fmt: skip
    shown = "".join(f"![{row.name}](fig3_{k + 1}.svg)\n" for k, row in enumerate(TABLE_2))
    return f"""## Table 2 and figures 3 and 4: mixtures

![figure 4](fig4.svg)

{table(head, rows)}
Growth with delta = 0.1 and the printed number of spheres and first packing fraction, one seed. It ends {min(off):+.4f} to
{max(off):+.4f} from print: when their growth stopped and how often it was rescaled is not in the text. These packings, in
the order of the table:

{shown}
"""


# Figure 2

# Packings by growth: as printed, delta = 0.1, as long as that jams; beyond with the growth of our own, and so many
# spheres that the largest of them leaves the box room. At sigma = 1 that is not so with 50,000: they are cut, and 200,000
# have come to 0.34 only after five minutes.
GROWN = [(0, 1024), (0.1, 2048), (0.2, 2048), (0.3, 2048), (0.4, 2048), (0.5, 2048), (0.6, 5000), (0.8, 20_000),
         (1.0, 50_000)]  # fmt: skip


def grown_scene(sigma: float, spheres: int, call) -> bernal.Scene:
    sizes = lognormal(sigma)
    if sigma == 1:
        sizes = sizes.replace(max=float(np.exp(0.5 * sigma**2)))
    return scene(sizes, spheres, as_printed(sigma) if sigma <= 0.5 else bernal.Grow(pressure=1e3), call.seed)


def rods_curve(sigmas):
    return [bernal.predict(lognormal(float(s)), rods=RODS).phi for s in sigmas]


def figure_2(part: Part) -> str:
    sigmas = np.linspace(0, 1, 101)
    curve = rods_curve(sigmas)
    points = [("KTS, printed", r.sigma_a, r.spheres, r.kts, curve[round(100 * r.sigma_a)]) for r in ONE_POPULATION]
    if part.call.pack:
        relaxed, few = [round(0.1 * k, 1) for k in range(8)], part.at_most(10_000)
        grown = [(s, n) for s, n in GROWN if n <= part.at_most(n)] or [(s, part.at_most(n)) for s, n in GROWN[:6]]
        done = part.pack([scene(lognormal(s), few, bernal.Relax(), part.call.seed) for s in relaxed]
                         + [grown_scene(s, n, part.call) for s, n in grown],
                         costs=[few] * len(relaxed) + [5 * n * (1 + 2 * s) for s, n in grown])  # fmt: skip
        names = ["relax, here"] * len(relaxed) + ["grow, here"] * len(grown)
        points += [(name, s, len(d), d.phi, rods_of(d.radii))
                   for name, s, d in zip(names, relaxed + [s for s, _ in grown], done)]  # fmt: skip
    part.output.csv("fig2.csv", "source,sigma,spheres,phi,phi_rods_of_them",
                    [("rods", float(s), None, phi, None) for s, phi in zip(sigmas, curve)]
                    + [(name.split(",")[0], *rest) for name, *rest in points])  # fmt: skip
    figure, ax = axes("width $\\sigma$ of $\\ln D$", "packing fraction $\\phi$")
    ax.plot(sigmas, curve, color=RED, label="rod model, 16,000 rods")
    ax.errorbar([r.sigma_a for r in ONE_POPULATION], [r.kts for r in ONE_POPULATION], [r.error for r in ONE_POPULATION],
                **KTS, label="KTS, printed")  # fmt: skip
    for name, style, colour in (("relax, here", "s", GREEN), ("grow, here", "o", BLUE)):
        own = [(s, phi) for source, s, _, phi, _ in points if source == name]
        if own:
            ax.plot(*zip(*own), style, color=colour, label=name)
    ax.set_xlim(-0.02, 1.02)
    ax.legend()
    part.output.figure("fig2.svg", figure)
    rows = [[name, f"{s:.2f}", n, f"{phi:.4f}", f"{rods:.4f}"] for name, s, n, phi, rods in points]
    return f"""## Figure 2: packings of lognormal spheres

![figure 2](fig2.svg)

{table(["source", "sigma", "spheres", "packing fraction", "rod model of these"], rows)}
Of the printed points those of table 2 alone are in the text. The rod model is that of the very spheres that were packed,
which are so many and no more; of KTS, of the distribution. At sigma = 1 sizes end four sigmas above the median by number,
so that 16 % of the volume are cut off: larger spheres leave the box of 50,000 too little room.

"""


def soft_particles(part: Part) -> str:
    """Figure 2 once more, with a soft particle method of today: LAMMPS pushes the spheres apart while their box grows,
    and relax takes the rest of their overlap from them."""
    spheres, seeds, widths = part.at_most(part.call.soft or 6000), 3, [round(0.1 * k, 1) for k in range(8)]
    scenes = [scene(lognormal(sigma), spheres, bernal.Relax(), part.call.seed + k, **engine)
              for engine in ({"engine": bernal.Lammps()}, {}) for sigma in widths for k in range(seeds)]  # fmt: skip
    done = part.pack(scenes)
    triples = [done[k : k + seeds] for k in range(0, len(done), seeds)]
    soft, alone = triples[: len(widths)], triples[len(widths) :]
    rods = rods_curve(widths)
    of_these = [float(np.mean([rods_of(d.radii) for d in three])) for three in soft]
    figure, ax = axes("width $\\sigma$ of $\\ln D$", "packing fraction $\\phi$")
    fine = np.linspace(0, 0.7, 71)
    ax.plot(fine, rods_curve(fine), color=RED, label="rod model, 16,000 rods")
    ax.errorbar([r.sigma_a for r in ONE_POPULATION], [r.kts for r in ONE_POPULATION], [r.error for r in ONE_POPULATION],
                **KTS, label="KTS, printed")  # fmt: skip
    rows, csv = [], []
    for threes, style, colour, name in ((soft, "o", BLUE, "LAMMPS, then relax"), (alone, "s", GREEN, "relax alone")):
        phis = [[d.phi for d in three] for three in threes]
        ax.errorbar(widths, [np.mean(p) for p in phis], [np.std(p, ddof=1) for p in phis], fmt=style, color=colour,
                    label=f"{name}, {spheres} spheres")  # fmt: skip
        csv += [(name, s, float(np.mean(p)), float(np.std(p, ddof=1)), len(three[0]), r)
                for s, p, three, r in zip(widths, phis, threes, of_these)]  # fmt: skip
    ax.legend()
    part.output.figure("fig2soft.svg", figure)
    part.output.csv("fig2soft.csv", "source,sigma,phi,deviation,spheres,phi_rods_of_them", csv)
    from_rods = [np.mean([d.phi for d in three]) - r for three, r in zip(soft, of_these)]
    denser = [np.mean([d.phi for d in a]) - np.mean([d.phi for d in s]) for a, s in zip(alone, soft)]
    deviation = max(np.std([d.phi for d in three], ddof=1) for three in soft)
    printed = {r.sigma_a: f"{r.kts} ± {r.error}" for r in ONE_POPULATION}
    for sigma, r, mine, s, off, a in zip(widths, rods, of_these, soft, from_rods, alone):
        rows.append([f"{sigma:.1f}", f"{r:.4f}", f"{mine:.4f}", scatter([d.phi for d in s], 4), f"{off:+.4f}",
                     scatter([d.phi for d in a], 4), printed.get(sigma, "")])  # fmt: skip
    head = ["sigma", "rods", "rods of these", "LAMMPS, then relax", "from rods", "relax alone", "KTS, printed"]
    return f"""## Figure 2 with soft particles of today

![figure 2 with soft particles](fig2soft.svg)

{spheres} lognormal spheres in a periodic box, {seeds} seeds, ± the deviation of one packing. LAMMPS pushes soft particles
apart while their box grows, and `relax` removes the overlaps that are left (`[engine]`). Beside them are packings of the
same sizes by `relax` alone. All are certified. *Rods* is the curve, from 16,000 rods; *rods of these* is the rod model's
answer to the very diameters that were packed.

{table(head, rows)}
The paper draws its soft particles and does not print their numbers, so the two cannot be compared in numbers. Its text
says that they agree with the rod model excellently and lie slightly above the KTS packings. Here, too, wider sizes pack
denser by what the model says. But the packings lie {min(from_rods):+.4f} to {max(from_rods):+.4f} from the rod model of their sizes, and
a packing scatters by up to {deviation:.4f}. Soft particles become denser if they come to rest more slowly; here they do so in a
thousand steps. `relax` alone ends {min(denser):+.4f} to {max(denser):+.4f} from them.

"""


# Figure 6

LARGEST_RATIO = 10
# Where packings are made: D2 / D1, D3 / D2, alpha, spheres. At the first three two of the three sizes are densest, and
# `relax` comes within the error of the model, 0.01; wider ones need more sweeps for that. Three sizes are densest from
# D3 / D1 of about 6 on: the last point.
PACKED_POINTS = [(1.8, 1.25, 60, 10_000), (1.3, 2.1, 60, 10_000), (2.2, 1.35, 60, 10_000), (3, 3, 200, 20_000)]


def densest(second: float, third: float):
    diameters = [1, second, second * third]
    return bernal.design.maximise(diameters, rods=4000, progress=False)


def figure_6(part: Part) -> str:
    ratios = np.geomspace(1, LARGEST_RATIO, part.call.points).tolist()
    best = {}
    with concurrent.futures.ThreadPoolExecutor(cores()) as pool:  # the search is the library's: threads will do
        waiting = {pool.submit(densest, x, y): (x, y) for y in ratios for x in ratios}
        for future in concurrent.futures.as_completed(waiting):
            best[waiting[future]] = future.result()
            if len(best) % 50 == 0:
                say(f"farr2013: figure 6, {len(best)} of {len(waiting)} optima")
    say("")
    phi = np.array([[best[x, y].phi for x in ratios] for y in ratios])
    rows = [("rods", x, y, best[x, y].phi, *best[x, y].shares, None, None, None) for y in ratios for x in ratios]
    figure, ax = axes("$D_2 / D_1$", "$D_3 / D_2$", figsize=(4.6, 4.4))
    levels = np.arange(0.65, phi.max(), 0.01)
    bold = np.isclose(np.round(levels * 20) / 20, levels, atol=1e-6)
    ax.contourf(ratios, ratios, phi, np.arange(0.64, phi.max() + 0.01, 0.01), cmap="Greys", vmax=1.15, vmin=0.6)
    lines = ax.contour(ratios, ratios, phi, levels, colors=INK, linewidths=np.where(bold, 1.4, 0.4))
    ax.clabel(lines, levels[bold], fmt="%.2f", fontsize=7)
    text = ""
    if part.call.pack:
        points = [(x, y, alpha, part.at_most(n)) for x, y, alpha, n in PACKED_POINTS]
        found = [densest(x, y) for x, y, *_ in points]
        done = part.pack([scene(b.diameters, n, bernal.Relax(alpha=alpha), part.call.seed)
                          for b, (_, _, alpha, n) in zip(found, points)])  # fmt: skip
        for (x, y, *_), b, d in zip(points, found, done):
            rows.append(("relax", x, y, d.phi, *b.shares, b.phi, len(d), float(d.coordination[USUAL])))
            ax.annotate(f"{d.phi:.4f}", (x, y), xytext=(5, -2), textcoords="offset points", fontsize=7, color=RED)
        ax.plot([x for x, *_ in points], [y for _, y, *_ in points], "o", color=RED, label="$\\phi$ packed by relax")
        ax.legend(loc="lower right", frameon=True, facecolor="white", framealpha=1, edgecolor=INK)
        head = ["D2 / D1", "D3 / D2", "shares of the volume", "rod model", "packed", "difference"]
        text = "\n" + table(head, [[x, y, " : ".join(f"{s:.2f}" for s in b.shares), f"{b.phi:.4f}", f"{d.phi:.4f}",
                                    f"{d.phi - b.phi:+.4f}"] for (x, y, *_), b, d in zip(points, found, done)])  # fmt: skip
    ax.set(xscale="log", yscale="log", xticks=(1, 2, 5, 10), yticks=(1, 2, 5, 10), xticklabels=(1, 2, 5, 10),
           yticklabels=(1, 2, 5, 10))  # fmt: skip
    ax.minorticks_off()
    part.output.figure("fig6.svg", figure)
    part.output.csv("fig6.csv", "source,d2_over_d1,d3_over_d2,phi,share_1,share_2,share_3,phi_rods,spheres,coordination",
                    rows)  # fmt: skip
    inside = "in it" if phi.min() < 0.65 and phi.max() > 0.9 else "not all in it"
    return f"""## Figure 6: the densest of three sizes

![figure 6](fig6.svg)

Printed: contours at every 0.01, bold from 0.65 at the bottom left to 0.9 near the top right. Here: from {phi.min():.4f} to
{phi.max():.4f}, so the same bold contours are {inside}.
{text}
"""


PARTS = {"table1": table_1, "table2": table_2, "fig1": figure_1, "fig2": figure_2, "fig2soft": soft_particles,
         "fig5": figure_5, "fig6": figure_6}  # fmt: skip
OPTIONS = [
    ("--only", {"choices": PARTS, "help": "one of them; table2 holds figures 3 and 4 too"}),
    ("--pack", {"action": "store_true", "help": "also packings of the rod model's sizes"}),
    ("--soft", {"type": whole(100), "default": 0, "metavar": "N",
                "help": "also figure 2 with so many soft particles, 6000 in the paper, by LAMMPS, which it needs"}),
    ("--points", {"type": int, "choices": range(2, 201), "default": 33, "metavar": "N",
                  "help": "of figure 6, along each axis; 33 if absent"}),
]  # fmt: skip


def write(output, call) -> None:
    start = time.process_time()
    claims: list[Claim] = []
    part = Part(output, call, claims)
    names = [call.only] if call.only else [name for name in PARTS if name != "fig2soft" or call.soft]
    text = "".join(PARTS[name](part) for name in names)
    options = "".join([f" --only {call.only}" * bool(call.only), " --pack" * call.pack, f" --soft {call.soft}" * bool(call.soft),
                       f" --spheres {call.spheres}" * bool(call.spheres)])  # fmt: skip
    output.text(f"{call.only or 'farr2013'}.md", f"""# Farr (2013), done again

R. S. Farr: *Random close packing fractions of lognormal distributions of hard spheres*. Powder Technology 245 (2013)
28–34. Written by `apps/reproduce farr2013{options}` in {time.process_time() - start:.0f} s of the processor for the rod model and {part.seconds:.0f} for
packings, on: {processor()}.

{claims_table(claims) if claims else ""}{text}""")  # fmt: skip


if __name__ == "__main__":
    run(__doc__.splitlines()[0], write, OPTIONS)
