#!/usr/bin/env python3
"""K. Han, Y. T. Feng, D. R. J. Owen: Sphere packing with a geometric based compression algorithm. Powder Technology
155, 33 (2005). The cylinder, local directions, shaking and time again."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from common import BLUE, INK, RED, Claim, axes, claims_table, pack_all, power_law, processor, run, table

import bernal

# The one result in the text: a 1.4 GHz PC; radii and dimensions of the cylinder are not in it.
PRINTED_SPHERES, PRINTED_PHI, PRINTED_SECONDS = 26_787, 0.5289, 181
RADIUS, HEIGHT = 1.0, 2.0
CYLINDER = np.pi * RADIUS**2 * HEIGHT


@dataclass(frozen=True)
class Protocol:
    """What is done to spheres that were inserted at random."""

    name: str
    compress: bool = True
    tilt: float = 0  # of the local directions
    shakes: int = 0  # rounds of shaking after each compression
    refill: bool = False

    def stages(self):
        stages = [bernal.Insert()]
        # The end of a compression as the paper has it, by energy.
        keys = {"tilt": self.tilt, "tolerance": 1e-2, "max_iterations": 400}
        if self.compress:
            stages.append(bernal.Compress(**keys))
        if self.shakes:
            stages.append(bernal.Shake(rounds=2 if self.refill else self.shakes, **keys))
        if self.refill:
            stages.append(bernal.Refill(shakes=self.shakes, **keys))
        return stages


PROTOCOLS = [
    Protocol("insertion at random", compress=False),
    Protocol("compression along one direction"),
    Protocol("the same, local directions", tilt=2),
    Protocol("the same, and shaking", tilt=2, shakes=1),
    Protocol("one direction, refilling", refill=True),
    Protocol("one direction, shaking, refilling", shakes=1, refill=True),
    Protocol("local directions, refilling", tilt=2, refill=True),
    Protocol("local directions, shaking, refilling", tilt=2, shakes=1, refill=True),
]
WHOLE = PROTOCOLS[-1]
TILTS, OF_TILTS = (0, 0.5, 1, 2, 4), 6000
COUNTS = (1000, 3000, 10_000, 30_000, 100_000)


def tilted(tilt: float, shaken: bool) -> Protocol:
    return Protocol("shaking, refilling" if shaken else "refilling", True, tilt, int(shaken), True)


def radius_of(spheres: int) -> float:
    """Of which so many equal ones are the printed packing fraction of the cylinder."""
    return float(np.cbrt(PRINTED_PHI * CYLINDER / spheres / (4 / 3 * np.pi)))


def scene(spheres: int, protocol: Protocol, seed: int, **keys) -> bernal.Scene:
    """Spheres of that size, as many as find a place, or else as `keys` say."""
    keys = keys or {"fill": True, "radii": radius_of(spheres)}
    return bernal.Scene(bernal.Cylinder(RADIUS, HEIGHT), stages=protocol.stages(), seed=seed, **keys)


def phi_of_bed(done) -> float:
    """The spheres' volume over that of the cylinder up to twice their mean height."""
    volumes = 4 / 3 * np.pi * done.radii**3
    height = 2 * (volumes * done.centers[:, 2]).sum() / volumes.sum()
    return float(volumes.sum() / (np.pi * RADIUS**2 * min(HEIGHT, height)))


def bars(output, done) -> None:
    figure, ax = axes("packing fraction of the bed", "", figsize=(5.6, 3.0))
    values = [phi_of_bed(d) for d in done]
    ax.barh(range(len(values)), values, height=0.55, color="0.78", edgecolor=INK, linewidth=0.6)
    for k, (value, d) in enumerate(zip(values, done)):
        ax.text(value + 0.008, k, f"{value:.4f}, {d.seconds:.2g} s", va="center", fontsize=8)
    ax.axvline(PRINTED_PHI, color=RED, linestyle="--", label=f"printed: {PRINTED_PHI}")
    ax.set_yticks(range(len(values)), [p.name for p in PROTOCOLS])
    ax.tick_params(axis="y", which="both", length=0)
    ax.set_xlim(0, 0.78)
    ax.invert_yaxis()
    ax.legend(loc="lower left", bbox_to_anchor=(0, 1))
    output.figure("han2005_protocols.svg", figure)


def write(output, call) -> None:
    at_most = lambda n: min(n, call.spheres or n)  # noqa: E731
    spheres, of_tilts = at_most(PRINTED_SPHERES), at_most(OF_TILTS)
    counted = [at_most(n) for k, n in enumerate(COUNTS) if k == 0 or n <= at_most(n)]
    # Radii from 1 to 2, all as frequent by number, of which as many have the same volume: mean r³ is 15/4.
    unit = radius_of(spheres) / 3.75 ** (1 / 3)
    mixed = {"count": spheres, "radii": bernal.Uniform(unit, 2 * unit), "draw": "quantiles"}
    asked = [
        ("as printed", WHOLE, scene(spheres, WHOLE, call.seed, count=spheres, radii=radius_of(spheres)), spheres),
        ("as printed", WHOLE, scene(spheres, WHOLE, call.seed, **mixed), spheres),
        *(("protocols", p, scene(spheres, p, call.seed), spheres) for p in PROTOCOLS),
        *(("tilts", p, scene(of_tilts, p, call.seed), of_tilts)
          for p in (tilted(tilt, shaken) for tilt in TILTS for shaken in (False, True))),
        *(("counts", WHOLE, scene(n, WHOLE, call.seed), n) for n in counted),
    ]  # fmt: skip
    costs = [n * ((1 + 0.7 * p.tilt + 0.5 * p.shakes) if p.refill else 0.1) for _, p, _, n in asked]
    done = pack_all([s for *_, s, _ in asked], name="han2005", pictured={1}, costs=costs, dense=False)
    of = {g: [d for (group, *_), d in zip(asked, done) if group == g] for g in ("as printed", "protocols", "tilts",
                                                                              "counts")}  # fmt: skip
    output.csv(
        "han2005.csv", "group,protocol,compress,tilt,shakes,refill,spheres,phi,phi_of_bed,seconds",
        [(group, p.name, int(p.compress), p.tilt, p.shakes, int(p.refill), len(d), d.phi, phi_of_bed(d),
          round(d.seconds, 3)) for (group, p, *_), d in zip(asked, done)],
    )  # fmt: skip

    output.text("han2005_packing.svg", done[1].picture)
    bars(output, of["protocols"])
    figure, ax = axes("tilt: length of the random part of the local direction", "packing fraction $\\phi$")
    ax.plot(TILTS, [d.phi for d in of["tilts"][1::2]], "o-", color=INK, label="with shaking")
    ax.plot(TILTS, [d.phi for d in of["tilts"][::2]], "s--", color=BLUE, label="without")
    if not call.spheres:
        ax.axhline(PRINTED_PHI, color=RED, linestyle=":", label=f"printed: {PRINTED_PHI}, of {PRINTED_SPHERES} spheres")
    ax.legend()
    output.figure("han2005_tilts.svg", figure)
    counts, seconds = [len(d) for d in of["counts"]], [d.seconds for d in of["counts"]]
    figure, ax = axes("number of spheres $N$", "processor time (s)")
    ax.loglog(counts, seconds, "o-", color=INK, label="local directions, shaking, refilling")
    ax.plot([PRINTED_SPHERES], [PRINTED_SECONDS], "k*", markersize=8, markerfacecolor=INK, linestyle="none",
            label="printed, 1.4 GHz PC")  # fmt: skip
    ax.legend()
    output.figure("han2005_time.svg", figure)
    law = "Fitted: N^({:.2f} ± {:.2f}). ".format(*power_law(counts, seconds)) if len(set(counts)) > 1 else ""

    p = of["protocols"]

    def gained(without, with_):
        return f"{with_.phi - without.phi:+.4f} for {with_.seconds / max(without.seconds, 1e-3):.2g} times the time"

    names = ["equal spheres", "radii from 1 to 2"]
    # Uniform radii are drawn evenly: their volume is right to one sphere in some thousands.
    claims = [Claim(f"{name}: packing fraction", PRINTED_PHI, d.phi, 5e-4) for name, d in zip(names, of["as printed"])]
    claims += [Claim(f"{name}: spheres, of those asked for", spheres, len(d), 0, 0)
               for name, d in zip(names, of["as printed"])]  # fmt: skip
    reached = "Both are reached" if all(c.holds for c in claims[2:]) else \
        "Not all find a place: near walls there are too many of so few"  # fmt: skip
    printed_rows = [["printed", PRINTED_SPHERES, PRINTED_PHI, PRINTED_SECONDS],
                    *([f"here, {name}", len(d), f"{d.phi:.4f}", f"{d.seconds:.1f}"]
                      for name, d in zip(names, of["as printed"]))]  # fmt: skip
    both = lambda d: (f"{d.phi:.4f}", f"{d.seconds:.2f}")  # noqa: E731
    tilt_rows = [[f"{tilt:g}", *both(alone), *both(shaken)]
                 for tilt, alone, shaken in zip(TILTS, of["tilts"][::2], of["tilts"][1::2])]  # fmt: skip
    option = f" --spheres {call.spheres}" if call.spheres else ""
    output.text("han2005.md", f"""# Han, Feng & Owen (2005), done again

K. Han, Y. T. Feng, D. R. J. Owen: *Sphere packing with a geometric based compression algorithm*. Powder Technology 155
(2005) 33–41. Written by `apps/reproduce han2005{option}`; its packings took {sum(d.seconds for d in done):.0f} s of one
core of: {processor()}. Seconds in the tables are the processor's, of one thread a packing; all packings are certified
free of overlap. `han2005.csv` has every one of them.

{claims_table(claims)}## The cylinder

![packing](han2005_packing.svg)

{table(["", "spheres", "packing fraction", "seconds"], printed_rows)}
The paper fills a cylinder with {PRINTED_SPHERES} spheres on a 1.4 GHz PC; its text gives neither the dimensions of the
cylinder nor the radii. Here the cylinder is twice as high as its radius. The scene asks for {spheres} spheres, equal or with
radii uniform between 1 and 2, so large that they have the printed packing fraction. {reached}. If the same protocol places
as many equal spheres as it can, it reaches {p[-1].phi:.4f}.

## What each part gains

![protocols](han2005_protocols.svg)

The same spheres, as many as find a place. *Packing fraction*: in the whole cylinder. *Of the bed*: in the cylinder up to
twice the mean height of the spheres; this is what compression alone changes.

{table(["protocol", "spheres", "packing fraction", "of the bed", "seconds"],
       [[q.name, len(d), f"{d.phi:.4f}", f"{phi_of_bed(d):.4f}", f"{d.seconds:.2f}"] for q, d in zip(PROTOCOLS, p)])}
The pages of the paper that were at hand describe compression along one global direction. A public summary of the rest says
that this leaves chains of spheres; that every sphere therefore gets a random local direction, too; and that shaking moves
spheres across the global direction and breaks arches. With refilling, local directions alone gain
{gained(p[4], p[6])}, shaking after that {gained(p[6], p[7])}, and shaking without local directions
{gained(p[4], p[5])}. Two things differ from the text. A sphere that has touched another one slides on, so one direction alone
reaches {p[4].phi:.4f}. And a compression ends where the potential along the global direction hardly falls: this is from the
summary, with a threshold chosen here.

## Local directions

![tilts](han2005_tilts.svg)

Spheres compressed and refilled, {of_tilts} of which have 52.89 % of the cylinder's volume. The tilt is the length of the
random part of the local direction; the global part has the length 1.

{table(["tilt", "without shaking", "seconds", "with shaking", "seconds"], tilt_rows)}
## Time

![time](han2005_time.svg)

{table(["spheres", "packing fraction", "seconds"], [[len(d), f"{d.phi:.4f}", f"{d.seconds:.2f}"] for d in of["counts"]])}
{law}The paper calls its search for contacts highly efficient; its text gives no times over N.
""")  # fmt: skip


if __name__ == "__main__":
    run(__doc__.splitlines()[0], write)
