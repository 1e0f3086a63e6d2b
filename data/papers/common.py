"""What the scripts of papers share: packings made side by side, tables in Markdown, figures as journals print them."""

from __future__ import annotations

import argparse
import concurrent.futures
import concurrent.futures.process
import multiprocessing
import os
import shutil
import signal
import sys
import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path

import matplotlib
import numpy as np

import bernal

matplotlib.use("svg")
import matplotlib.pyplot as plt  # noqa: E402

GAPS = (1e-4, 2e-4, 3e-4, 5e-4, 7e-4, 1e-3, 2e-3, 5e-3, 1e-2)
"""Gap ratios up to which contacts are counted."""
USUAL = GAPS.index(2e-3)

INK, RED, BLUE, GREEN = "#000000", "#c1272d", "#0050a0", "#00843d"
plt.rcParams.update({
    "font.family": "STIXGeneral", "mathtext.fontset": "stix", "font.size": 9, "axes.labelsize": 10,
    "legend.fontsize": 8, "legend.frameon": False, "legend.handlelength": 2.2, "axes.linewidth": 0.7,
    "xtick.direction": "in", "ytick.direction": "in", "xtick.top": True, "ytick.right": True,
    "xtick.minor.visible": True, "ytick.minor.visible": True, "lines.linewidth": 1.1, "lines.markersize": 4.5,
    "lines.markerfacecolor": "white", "errorbar.capsize": 2, "figure.figsize": (4.6, 3.4), "svg.hashsalt": "bernal",
    "savefig.bbox": "tight", "savefig.pad_inches": 0.05,
})  # fmt: skip


# Packings


@dataclass
class Packed:
    """What became of a scene."""

    phi: float
    seconds: float  # of the processor, in one thread
    coordination: np.ndarray  # at each of GAPS
    outcome: str
    centers: np.ndarray
    radii: np.ndarray
    picture: str
    section: str

    def __len__(self) -> int:
        return len(self.radii)


class Short(Exception):
    """A packing ended without what its scene asks for."""


def _pack(file: str, pictured: bool) -> Packed:
    before = time.process_time()
    try:
        packing = bernal.pack(file, threads=1, progress=False)
    except bernal.EngineError as error:
        raise Short(str(error)) from None
    seconds = time.process_time() - before
    if not bernal.verify(packing, threads=1, progress=False):
        raise Short(f"{file}: not certified")
    return Packed(
        packing.packing_fraction, seconds, packing.coordination(GAPS), packing.outcome,
        np.array(packing.centers), np.array(packing.radii),
        str(packing.picture) if pictured else "", str(packing.section()) if pictured else "",
    )  # fmt: skip


def pack_all(scenes, *, name: str, pictured=(), costs=None, dense: bool = True) -> list[Packed]:
    """Packs all scenes, a process a core, the dearest first; every packing is certified. In the order of the scenes.
    `pictured` are indices of those that are drawn. Raises Short where one is not certified or, if they are to be
    dense, did not converge."""
    costs = costs or [scene.count or 1 for scene in scenes]
    with tempfile.TemporaryDirectory(prefix="bernal-paper-") as folder:
        files = [str(Path(folder) / f"{k}.toml") for k in range(len(scenes))]
        for scene, file in zip(scenes, files):
            scene.write(file)
        pool = concurrent.futures.ProcessPoolExecutor(
            min(cores(), len(scenes)),
            multiprocessing.get_context("spawn"),
            ignore_interrupts,
        )
        try:
            order = sorted(range(len(scenes)), key=lambda k: -costs[k])
            waiting = {pool.submit(_pack, files[k], k in pictured): k for k in order}
            done: list = [None] * len(scenes)
            for future in concurrent.futures.as_completed(waiting):
                done[waiting[future]] = future.result()
                say(f"{name}: {sum(d is not None for d in done)} of {len(scenes)} packings")
        except BaseException:
            for process in list((pool._processes or {}).values()):  # what they pack is of no use
                process.terminate()
            pool.shutdown(wait=False, cancel_futures=True)
            raise
        pool.shutdown()
    say("")
    for scene, packed in zip(scenes, done):
        if dense and packed.outcome != "converged":
            raise Short(f"{len(packed)} spheres by {scene.stages} ended as {packed.outcome}")
    return done


def cores() -> int:
    """That this process may use."""
    return len(os.sched_getaffinity(0))


def ignore_interrupts() -> None:
    """The process that waits for the others hears Ctrl-C for them."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def rods_of(radii: np.ndarray) -> float:
    """What the rod model says of these spheres and no others."""
    values, numbers = np.unique(radii, return_counts=True)
    sizes = bernal.Classes(values.tolist(), numbers.tolist()) if len(values) > 1 else bernal.Constant(float(values[0]))
    return float(bernal.predict(sizes).phi)


def say(text: str) -> None:
    """How far it is, where somebody looks."""
    if sys.stderr.isatty():
        sys.stderr.write(f"\r\033[K{text}")
        sys.stderr.flush()


# Numbers


def scatter(values, digits: int) -> str:
    """Mean and standard deviation of one of several values, or a value that stands alone."""
    values = np.asarray(list(values), float)
    mean = f"{values.mean():.{digits}f}"
    return f"{mean} ± {values.std(ddof=1):.{digits}f}" if len(values) > 1 else mean


def power_law(xs, ys) -> tuple[float, float]:
    """Exponent b of y = a x^b by least squares of the logarithms, and its standard error (0 of two points)."""
    x, y = np.log(np.asarray(xs, float)), np.log(np.asarray(ys, float))
    x, y = x - x.mean(), y - y.mean()
    exponent = (x * y).sum() / (x * x).sum()
    if len(x) < 3:
        return exponent, 0.0
    return exponent, float(np.sqrt(((y - exponent * x) ** 2).sum() / (len(x) - 2) / (x * x).sum()))


def processor() -> str:
    for line in Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(": ", 1)[1]
    return "unknown"


# Pages


def table(head, rows) -> str:
    """A table in Markdown, the numbers of all columns but the first to the right."""
    lines = [list(map(str, head)), ["---"] + ["---:"] * (len(head) - 1), *[list(map(str, row)) for row in rows]]
    return "".join("| " + " | ".join(line) + " |\n" for line in lines)


@dataclass
class Claim:
    """A number that is printed, and what it is here."""

    what: str
    printed: float
    here: float
    tolerance: float
    """By which they may differ: see the page, and tests/papers."""
    digits: int = 4

    @property
    def holds(self) -> bool:
        return abs(self.here - self.printed) <= self.tolerance

    def row(self):
        texts = [f"{value:.{self.digits}f}" for value in (self.printed, self.here)]
        return [self.what, *texts, f"{self.here - self.printed:+.{self.digits}f}", f"{self.tolerance:g}",
                "yes" if self.holds else "no"]  # fmt: skip


def claims_table(claims) -> str:
    head = ["", "printed", "here", "difference", "tolerance", "within it"]
    return "## Printed and here\n\n" + table(head, [claim.row() for claim in claims]) + "\n"


@dataclass
class Output:
    """Files of a paper, which appear in their folder together or not at all."""

    folder: Path
    files: dict = field(default_factory=dict)

    def __post_init__(self) -> None:
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            self.staged = Path(tempfile.mkdtemp(prefix=".paper-", dir=self.folder))
        except OSError as error:
            raise SystemExit(refused(f"{self.folder}: {error.strerror}")) from None

    def text(self, name: str, text: str) -> None:
        (self.staged / name).write_text(text, "utf-8")

    def csv(self, name: str, head: str, rows) -> None:
        self.text(name, head + "\n" + "".join(",".join(map(cell, row)) + "\n" for row in rows))

    def figure(self, name: str, figure) -> None:
        figure.savefig(self.staged / name, metadata={"Date": None, "Creator": None})
        plt.close(figure)

    def publish(self) -> None:
        for file in sorted(self.staged.iterdir()):
            os.replace(file, self.folder / file.name)
            print(self.folder / file.name)
        self.staged.rmdir()

    def forget(self) -> None:
        shutil.rmtree(self.staged, ignore_errors=True)


def cell(value) -> str:
    if value is None:
        return ""
    text = f"{value:.7g}" if isinstance(value, float) else str(value)
    return f'"{text}"' if "," in text else text


def axes(x: str, y: str, **size):
    figure, own = plt.subplots(**size)
    own.set_xlabel(x)
    own.set_ylabel(y)
    return figure, own


# The command


def refused(what: str) -> int:
    print(f"{Path(sys.argv[0]).stem}: {what}", file=sys.stderr)
    return 2


def whole(least: int):
    def number(text: str) -> int:
        if not text.isdigit() or int(text) < least:
            raise argparse.ArgumentTypeError(f"a whole number from {least} on, not {text}")
        return int(text)

    return number


def run(what: str, write, options=()) -> None:
    """Runs the script of a paper: `write(output, call)` writes the files into an Output. `options` are arguments of
    add_argument. Ends with 0; 2 where what is asked makes no sense; 3 where it was stopped or a packing fell short, and
    nothing is written then."""
    parser = argparse.ArgumentParser(description=what)
    parser.add_argument("-o", "--output", type=Path, required=True, metavar="DIR", help="folder for page and figures")
    parser.add_argument("--spheres", type=whole(100), default=0, metavar="N",
                        help="packings of at most so many spheres: quick, and rougher than what is published")  # fmt: skip
    parser.add_argument("--seed", type=whole(0), default=1, metavar="N", help="of the packings; 1 if absent")
    for names, how in options:
        parser.add_argument(names, **how)
    call = parser.parse_args()
    output = Output(call.output)
    signal.signal(signal.SIGINT, signal.default_int_handler)  # which jobs in the background have not
    try:
        write(output, call)
        output.publish()
    except KeyboardInterrupt:
        status = "stopped by the user; nothing is written"
    except (Short, bernal.EngineError, concurrent.futures.process.BrokenProcessPool) as error:
        status = f"{error}; nothing is written"
    except bernal.Error as error:
        output.forget()
        raise SystemExit(refused(str(error))) from None
    else:
        return
    finally:
        output.forget()
    say("")
    print(f"{Path(sys.argv[0]).stem}: {status}", file=sys.stderr)
    sys.stderr.flush()
    os._exit(3)  # threads of a search that nobody waits for go on otherwise
