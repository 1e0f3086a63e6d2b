"""What bernal does: a function for each of the command's subcommands that users call from Python."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterable
from typing import Any, Union

import numpy as np

from . import _classes, _core, _errors, _records, _surfaces, _toml
from ._classes import Container, Output, Sizes
from ._jobs import Stopped, finish
from ._packing import Packing
from ._progress import Progress
from ._records import Certificate, Inspection, Measurements, Plan, Prediction, Written
from ._scene import Scene, as_scene

PathLike = Union[str, "os.PathLike[str]"]


def explain(scene: Scene | PathLike, *, progress: Progress = None) -> Plan:
    """What a scene would run, what it would cost, and how many spheres to expect. Runs nothing.

    As text it is what `bernal explain` prints. Keys: unit, container, spheres, accuracy, expected (count,
    packing_fraction, seconds on one core, memory_bytes), caution, outputs, items, absent, stages.
    Raises InputError where parts do not fit each other. Cost: reading the mesh.
    """
    answer, words = finish(_core.explain(as_scene(scene)._core), progress)
    plan: Plan = _records.record(Plan, answer)
    plan.__dict__["words"] = words
    return plan


def pack(scene: Scene | PathLike, *, seed: int | None = None, threads: int = 0, progress: Progress = None) -> Packing:
    """Runs a scene, or the scene of a file.

    One seed gives one packing, bit for bit, for any number of threads; `seed` stands for the scene's, `threads` 0 for
    as many as the machine has.

    Ctrl-C ends the run at its next safe point: what is there is returned, a valid packing whose outcome is
    "cancelled", with the warning `Stopped`. A second one raises KeyboardInterrupt at once. Only the main thread hears
    it. Not reaching what the scene asks for is no error either: see `Packing.outcome`.

    progress : True, False, None (where somebody looks) or a function of activity, fraction (None where nobody knows)
        and detail; an exception of it ends the run, but KeyboardInterrupt, which is Ctrl-C. Raises InputError.
    """
    asked = as_scene(scene)
    job = _core.pack(asked._core, None if seed is None else _toml.whole(seed, "seed"), _threads(threads))
    packing = Packing._of(finish(job, progress, leaves_something=True), asked)
    if packing.outcome == "cancelled":
        warnings.warn(f"stopped by Ctrl-C with {len(packing):,} spheres in place", Stopped, stacklevel=2)
    return packing


def read(folder: PathLike, *, progress: Progress = None) -> Packing:
    """The packing that stands in a folder: its spheres.csv and scene.toml. How its run went is not among it, but
    whether another program made it. Raises InputError."""
    return Packing._of(finish(_core.read(_surfaces.path(folder, "the folder")), progress))


def verify(
    packing: Packing | PathLike,
    *,
    list: int | None = 0,
    exact: bool = False,
    threads: int = 0,
    progress: Progress = None,
) -> Certificate:
    """Decides for every two spheres that are near each other, and for every sphere near a wall, whether they overlap,
    by exact arithmetic wherever rounding could matter; of a packing, or of the files in a folder.

    The answer is true if and only if it is certified. Keys are those of `bernal verify --json`: certified, statement,
    spheres, pairs_tested, overlapping_pairs, protruding_spheres, max_overlap, worst_pair, min_wall_gap, …

    list : so many overlaps and protrusions are listed, the worst; None: all of them.
    exact : exact arithmetic throughout, 4 to 12 times slower, with the same answer.
    """
    of = packing if isinstance(packing, Packing) else read(packing, progress=progress)
    listed = None if list is None else _toml.whole(list, "list")
    job = _core.verify(of._core, listed, _threads(threads), bool(exact))
    certificate: Certificate = _records.record(Certificate, finish(job, progress))
    return certificate


def measure(packing: Packing | PathLike, *, gap: float = 0.002, progress: Progress = None) -> Measurements:
    """Contacts, rattlers, g(r), chambers, porosity near walls, order, sizes against those asked for; of a packing, or
    of the files in a folder.

    Keys are those of `bernal measure --json`: n, dimension, unit, phi, coordination, rattlers, backbone, by_gap, g_r
    (r, g and error of shape (bins,)), size_correlation, crystalline, chambers, bed (height, porosity and layers of
    a bed, and how many of its spheres do not rest), walls, sizes, hash. Lists of numbers
    are arrays. Lengths are in the scene's unit, radii are radii; what there is not is None, such as g_r between walls.
    Also `per_sphere`, arrays of shape (N,): local_packing_fraction (the sphere's volume over that of its cell in the
    radical diagram), cell_volume, neighbours (faces of the cell), and in containers chamber (-1: in none).

    gap : spheres touch below this gap over the sum of their radii.
    """
    if not 0 <= (gap := _toml.number(gap, "gap")) <= 1:
        raise _errors.InputError("bad_argument", f"gap is a ratio from 0 to 1, not {gap}")
    of = packing if isinstance(packing, Packing) else read(packing, progress=progress)
    answer, per_sphere = finish(_core.measure(of._core, gap), progress)
    measured: Measurements = _records.record(Measurements, answer, arrays=True)
    measured["per_sphere"] = _records.Record(per_sphere)
    return measured


def export(
    packing: Packing | PathLike,
    format: str | Output,
    file: PathLike | None = None,
    *,
    progress: Progress = None,
    **keys: Any,
) -> Written:
    """Writes a packing, or that of a folder, as another program reads it: `export(packing, "lammps", "bed.data")`.

    Formats and what each can be told: see `Output`. Without `file` the format's own name is taken. Returns files and
    note, one line of what the file holds. Raises InputError where the format cannot hold the packing, WriteError where
    a file of a result would be overwritten.
    """
    output = format.replace(**keys) if isinstance(format, Output) else Output(format, **keys)
    of = packing if isinstance(packing, Packing) else read(packing, progress=progress)
    said = dict(output._said)
    name = said.get("file") or _core.file_of_format(output.format) if file is None else _surfaces.path(file, "the file")
    said.pop("file", None)
    words = {key: value if isinstance(value, str) else _toml.text_of(value) for key, value in said.items()}
    files, note = finish(_core.export(of._core, output.format, words, name), progress)
    return Written(files=files, note=note)


def inspect(
    mesh: Container | PathLike | Any,
    *,
    unit: str | None = None,
    radius: float | None = None,
    places: PathLike | None = None,
    progress: Progress = None,
) -> Inspection:
    """What a CAD file is, and whether it can be a container: true if it can.

    mesh : a file, `(vertices, faces)`, a mesh of trimesh, meshio or PyVista, or a `Mesh` with what is to be done to it.
    unit : of its lengths, unless the `Mesh` says it.
    radius : counts the chambers that spheres of this radius cannot leave.
    places : writes the faces that keep it from being a container, coloured, into a PLY file.
    Keys are those of `bernal inspect --json`: usable, problems, container_lines (what helps), faces, volume, area,
    bounds, open_edges, self_intersections, chambers, …; lengths are those of the file.
    """
    options = None
    if isinstance(mesh, Container):
        if unit is not None:
            mesh = mesh.replace(unit=unit)
        options = Scene(mesh, diameters=1, unit=mesh.unit or "m")._core
        file = mesh.file
    else:
        file = os.fspath(_surfaces.files_of(mesh))
        if unit is not None:
            options = Scene(_classes.CLASSES["Mesh"](file, unit=unit), diameters=1, unit=unit)._core
    length = None if radius is None else _toml.number(radius, "radius")
    job = _core.inspect(file, options, length, None if places is None else _surfaces.path(places, "places"))
    found: Inspection = _records.record(Inspection, finish(job, progress))
    return found


def predict(
    sizes: float | Sizes | Scene, *, rods: int = 16000, gap_factor: float = 0.7654, progress: Progress = None
) -> Prediction:
    """How densely spheres of these sizes pack at random, without walls, by the rod model: phi, error (from the number
    of rods; the model's own is about 0.01), rods. Nothing is packed; a millisecond.

    sizes : a distribution, whose scale does not matter, or a scene that has one.
    gap_factor : 0.918 gives equal spheres 0.60, a loose packing; as it is 0.6435.
    """
    core = sizes._core if isinstance(sizes, Scene) else scene_of_sizes(sizes)
    job = _core.predict(core, _rods(rods), _toml.number(gap_factor, "gap_factor"))
    answer: Prediction = _records.record(Prediction, finish(job, progress))
    return answer


def scene_of_sizes(diameters: Any) -> Any:
    """The library's scene of sizes that stand for themselves."""
    sizes = _toml.line("diameter", _toml.plain(diameters))
    text = f'[container]\nkind = "box"\nsize = [1, 1, 1]\n[spheres]\ncount = 1\n{sizes}'
    return _core.scene(text, "/" + _errors.MADE_HERE)


def import_(
    file: PathLike,
    *,
    format: str = "",
    columns: str = "",
    diameter: float | None = None,
    radius: float | None = None,
    radii: PathLike | None = None,
    unit: str | None = None,
    box: Iterable[float] = (),
    periodic: str = "",
    container: Scene | PathLike | None = None,
    shift: Iterable[float] = (),
    frame: int | None = None,
    dimension: int | None = None,
    progress: Progress = None,
) -> Packing:
    """The packing of another program, to be verified, measured, exported or packed on; `Packing.notes` says what was
    understood of the file. Its domain is the container of the scene given, else the box given, else that of the file,
    else the bounds of the spheres.

    format : if empty told by the file. columns : "x,y,z,d", or "x=3,y=4,z=5,d=rad", by number from 1 or by name.
    diameter, radius : of all spheres; radii : a .npy of them. unit : where the file does not say it.
    box : edges of the box [0, a). periodic : axes along which it repeats itself, "xy", "none". shift : added to every
    centre. frame : of a trajectory, from 1; else the last. dimension : 2 for discs.
    """
    if isinstance(container, Scene):
        container = _surfaces.written(container.toml.encode(), ".toml")
    name = os.path.abspath(_surfaces.path(file, "the file"))
    paths = [None if each is None else _surfaces.path(each, "a file") for each in (radii, container)]
    sizes = [None if d is None else _toml.number(d, of) for d, of in ((diameter, "diameter"), (radius, "radius"))]
    whole = ((frame, "frame"), (dimension, "dimension"))
    counts = [None if n is None else _toml.whole(n, of, _toml.INT) for n, of in whole]
    places = [_toml.several(each, of) for each, of in ((box, "box"), (shift, "shift"))]
    texts = {"format": format, "columns": columns, "periodic": periodic, "unit": "" if unit is None else unit}
    for of, text in texts.items():
        if not isinstance(text, str):
            raise _errors.InputError("bad_argument", f"{of} is text, not {text!r:.80}")
    job = _core.import_(
        name, format, columns, *sizes, paths[0], unit, places[0], periodic, paths[1], places[1], *counts
    )
    core, notes = finish(job, progress)
    packing = Packing._of(core)
    packing.notes.update(notes)
    packing._imported_from = name
    return packing


def from_arrays(
    centers: Any,
    radii: Any,
    *,
    unit: str,
    container: Container | None = None,
    box: Iterable[float] = (),
    periodic: str = "",
) -> Packing:
    """A packing of spheres that somebody else placed, to be verified, measured, exported or packed on.

    centers : shape (N, D). radii : shape (N,), or one for all. unit : of all lengths.
    container : what they lie in; else the box [0, a) of these edges, along whose axes `periodic`, "xyz" or "none", it
        repeats itself; else the bounds of the spheres.
    """
    points = _surfaces.doubles(centers, "centers", "(N, D)")
    if not points.size and points.ndim == 1:
        points = points.reshape(0, 3)
    sizes = _surfaces.doubles(radii, "radii", "(N,)")
    if points.ndim != 2 or sizes.shape not in ((), points.shape[:1]):
        raise _errors.InputError(
            "bad_argument", f"centers have the shape (N, D) and radii (N,), not {points.shape} and {sizes.shape}"
        )
    sizes = np.broadcast_to(sizes, points.shape[:1])
    dimension = points.shape[1]
    names = ["x", "y", "z"][:dimension] if dimension <= 3 else [f"x{k}" for k in range(dimension)]
    rows = np.column_stack([points, sizes]).tolist()
    text = f"# unit: {unit}\n{','.join([*names, 'r'])}\n" + "".join(f"{','.join(map(repr, row))}\n" for row in rows)
    scene = None if container is None else Scene(container, diameters=1, unit=unit)
    file = _surfaces.written(text.encode(), ".csv")
    return import_(file, container=scene, box=box, periodic=periodic, progress=False)


def _threads(threads: Any) -> int:
    return _toml.whole(threads, "threads", 1024)


def _rods(rods: Any) -> int:
    return _toml.whole(rods, "rods", _toml.INT)
