"""The functions of the package, most of them named like a subcommand of `bernal`."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterable
from typing import Any, Union

import numpy as np

from . import _classes, _core, _errors, _records, _surfaces, _toml
from ._classes import Container, Output, Sizes
from ._jobs import NOT_REACHED, NotReached, Stopped, finish
from ._packing import Packing
from ._progress import Progress
from ._records import Certificate, Inspection, Measurements, Plan, Prediction, Written
from ._scene import Scene, as_scene

PathLike = Union[str, "os.PathLike[str]"]


def explain(scene: Scene | PathLike, *, progress: Progress = None, **keys: Any) -> Plan:
    """Says what a scene would run, what it would cost, and how many spheres to expect. Runs nothing.

    keys : of a mesh in place of a scene, as for `pack`.

    `str` gives what `bernal explain` prints. Keys: unit, container, spheres, accuracy, expected (count,
    packing_fraction, seconds on one core, memory_bytes), caution, outputs, items, absent, stages.
    Raises InputError where parts do not fit each other. Cost: reading the mesh.
    """
    answer, words = finish(_core.explain(as_scene(scene, **keys)._core), progress)
    plan: Plan = _records.record(Plan, answer)
    plan.__dict__["words"] = words
    return plan


def pack(
    scene: Scene | PathLike, *, seed: int | None = None, threads: int = 0, progress: Progress = None, **keys: Any
) -> Packing:
    """Runs a scene, the scene of a file, or what the keys say of a mesh:

        bernal.pack("part.step", diameters=2)
        bernal.pack("part.stl", unit="mm", diameters=bernal.Lognormal(2, 0.3), count=5000, cap="z = 1.1")

    One seed gives one packing, bit for bit, for any number of threads. `seed` replaces the scene's; `threads` 0 is as
    many as the machine has.

    Ctrl-C ends the run at its next safe point. `pack` then warns with `Stopped` and returns the spheres that are in
    place, a valid packing whose outcome is "cancelled". A second Ctrl-C raises KeyboardInterrupt at once. Only the main
    thread reacts to it. A run that ends without what the scene asks for warns with `NotReached` and raises nothing, see
    `Packing.outcome`.

    progress : True, False, None (in terminals and notebooks) or a function of activity, fraction (None if unknown) and
        detail. If it raises an exception, the run ends; KeyboardInterrupt counts as Ctrl-C. Raises InputError.
    keys : where `scene` is a mesh, those of `Scene` and of `Mesh`. `unit` is that of all lengths, and may be left out
        where the file says its own, as STEP does; `file_unit` is that of the mesh alone.
    """
    asked = as_scene(scene, **keys)
    job = _core.pack(asked._core, None if seed is None else _toml.whole(seed, "seed"), _threads(threads))
    packing = Packing._of(finish(job, progress, leaves_something=True), asked)
    if packing.outcome == "cancelled":
        warnings.warn(f"stopped by Ctrl-C with {len(packing):,} {packing._noun} in place", Stopped, stacklevel=2)
    elif packing.outcome in NOT_REACHED:
        warnings.warn(f"{packing.outcome}: {packing.reason}", NotReached, stacklevel=2)
    return packing


def read(folder: PathLike, *, progress: Progress = None) -> Packing:
    """Reads the packing in a folder, from its spheres and scene.toml. These do not say how its run went, except that
    the outcome is "imported" if another program made it. Raises InputError."""
    return Packing._of(finish(_core.read(_surfaces.path(folder, "the folder")), progress))


def verify(
    packing: Packing | PathLike,
    *,
    list: int | None = 0,
    exact: bool = False,
    threads: int = 0,
    progress: Progress = None,
) -> Certificate:
    """Decides whether spheres overlap each other or protrude from the walls, for a packing or for the files in a folder.
    It tests all pairs that are near each other, with exact arithmetic wherever rounding could matter. Packings inside of
    spheres are certified by levels, and layers have to fit the spheres; those of a folder as its layers.csv has them.

    The answer is true if and only if the packing is certified. Keys are those of `bernal verify --json`: certified,
    statement, spheres, pairs_tested, overlapping_pairs, protruding_spheres, max_overlap, worst_pair, min_wall_gap, …

    list : how many overlaps and protrusions to list, the worst first; None: all of them.
    exact : use exact arithmetic everywhere, 4 to 12 times slower, with the same answer.
    """
    of = packing if isinstance(packing, Packing) else read(packing, progress=progress)
    listed = None if list is None else _toml.whole(list, "list")
    folder = None if isinstance(packing, Packing) else _surfaces.path(packing, "the folder")
    job = _core.verify(of._core, listed, _threads(threads), bool(exact), folder)
    certificate: Certificate = _records.record(Certificate, finish(job, progress))
    return certificate


def measure(
    packing: Packing | PathLike, *, gap: float = 0.002, slab: str | None = None, progress: Progress = None
) -> Measurements:
    """Measures contacts, rattlers, g(r), chambers, porosity near walls, order, and sizes against those asked for, of a
    packing or of the files in a folder.

    Keys are those of `bernal measure --json`: n, dimension, unit, phi, coordination, rattlers, backbone, fabric, by_gap,
    core_contacts (of the spheres far from the walls), slab, g_r (r, g and error of shape (bins,); between walls also
    share), size_correlation, crystalline, chambers, bed (height, porosity and layers of a bed, and how many of its
    spheres do not rest), walls, column (along its axis, and from its side, floor and lid), sizes, hash. Lists of numbers
    are arrays. Lengths are in the scene's unit. What does not apply is None, such as walls in a periodic box.
    Also `per_sphere`, arrays of shape (N,): coordination (contacts with other spheres), local_packing_fraction (the
    sphere's volume over that of its cell in the radical diagram), cell_volume, neighbours (faces of the cell), and in
    containers chamber (-1: in none).

    gap : spheres touch if the gap over the sum of their radii is below it.
    slab : "z = 10..40", "x = -5 mm..5 mm", "z < 20": walls, column, pores and g(r) are those of this slab, and the key
        slab has direction, from, to, phi and contacts of the spheres whose centres lie in it.
    """
    if not 0 <= (gap := _toml.number(gap, "gap")) <= 1:
        raise _errors.InputError("bad_argument", f"gap is a ratio from 0 to 1, not {gap}")
    of = packing if isinstance(packing, Packing) else read(packing, progress=progress)
    answer, per_sphere = finish(_core.measure(of._core, gap, None if slab is None else str(slab)), progress)
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
    """Writes a packing, or the one in a folder, for another program: `export(packing, "lammps", "bed.data")`.

    `Output` lists the formats and their keys. Without `file` the format's default name is taken. Returns files and
    note, one line on what the file holds. Raises InputError if the format cannot hold the packing, and WriteError if
    the file belongs to a result.
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
    """Diagnoses a CAD file. The answer is true if it can be a container.

    mesh : a file, `(vertices, faces)`, a mesh of trimesh, meshio or PyVista, or a `Mesh` with its repairs.
    unit : of its lengths, unless the `Mesh` says it.
    radius : of spheres; counts the chambers that they cannot leave.
    places : a PLY file to write, with the faces coloured that keep the surface from being a container.
    Keys are those of `bernal inspect --json`: usable, problems, container_lines (repairs that help), faces, volume,
    area, bounds, open_edges, self_intersections, chambers, …; lengths are those of the file.
    """
    container = mesh if isinstance(mesh, Container) else _classes.CLASSES["Mesh"](mesh)
    if unit is not None:
        container = container.replace(unit=unit)
    scene = Scene(container, diameters=1, unit=container.unit or "m")
    length = None if radius is None else _toml.number(radius, "radius")
    job = _core.inspect(scene._core, length, None if places is None else _surfaces.path(places, "places"))
    found: Inspection = _records.record(Inspection, finish(job, progress))
    return found


def predict(
    sizes: float | Sizes | Scene, *, rods: int = 16000, gap_factor: float = 0.7654, progress: Progress = None
) -> Prediction:
    """Predicts the packing fraction of spheres of these sizes, packed at random without walls, by the rod model.

    Returns phi, error (from the number of rods; that of the model is about 0.01) and rods. Packs nothing, and takes a
    millisecond.

    sizes : a distribution, whose scale does not matter, or a scene that has one.
    gap_factor : the default gives equal spheres 0.6435; 0.918 gives them 0.60, a loose packing.
    """
    core = sizes._core if isinstance(sizes, Scene) else scene_of_sizes(sizes)
    job = _core.predict(core, _rods(rods), _toml.number(gap_factor, "gap_factor"))
    answer: Prediction = _records.record(Prediction, finish(job, progress))
    return answer


def scene_of_sizes(diameters: Any) -> Any:
    """A scene of the library for sizes without a container."""
    sizes = _toml.line("diameter", _toml.plain(diameters))
    text = f'[container]\nkind = "box"\nsize = [1, 1, 1]\n[spheres]\ncount = 1\n{sizes}'
    return _core.scene(text, "/" + _errors.MADE_HERE, {}, None)


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
    level: str = "",
    progress: Progress = None,
) -> Packing:
    """Reads the packing of another program, which can be verified, measured, exported or packed on. `Packing.notes` says
    how the file was read. The domain is the container of the scene given, else the box given, else that of the file,
    else the bounds of the spheres.

    format : detected if empty. columns : "x,y,z,d", or "x=3,y=4,z=5,d=rad", by number from 1 or by name.
    diameter, radius : of all spheres; radii : a .npy of them. unit : where the file does not say it.
    box : edges of the box [0, a). periodic : axes along which it repeats itself, "xy", "none". shift : added to every
    centre. frame : of a trajectory, from 1; else the last. dimension : 2 for discs. level : of a file with spheres
    inside of spheres, "core-1-1"; else the outermost.
    """
    name = os.path.abspath(_surfaces.path(file, "the file"))
    given = None if radii is None else _surfaces.path(radii, "a file")
    scene = None if container is None else as_scene(container)._core
    sizes = [None if d is None else _toml.number(d, of) for d, of in ((diameter, "diameter"), (radius, "radius"))]
    whole = ((frame, "frame"), (dimension, "dimension"))
    counts = [None if n is None else _toml.whole(n, of, _toml.INT) for n, of in whole]
    places = [_toml.several(each, of) for each, of in ((box, "box"), (shift, "shift"))]
    texts = {"format": format, "columns": columns, "periodic": periodic, "level": level}
    texts["unit"] = "" if unit is None else unit
    for of, text in texts.items():
        if not isinstance(text, str):
            raise _errors.InputError("bad_argument", f"{of} is text, not {text!r:.80}")
    job = _core.import_(name, format, columns, *sizes, given, unit, places[0], periodic, scene, places[1], *counts, level)
    return _imported(job, name, progress)


def _imported(job: Any, name: str, progress: Progress) -> Packing:
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
    """A packing of spheres from arrays, which can be verified, measured, exported or packed on.

    centers : shape (N, D). radii : shape (N,), or one for all. unit : of all lengths.
    container : the domain. Without it: box : the edges a of the box [0, a), and periodic : the axes along which it
        repeats itself, "xyz" or "none". Without both: the bounds of the spheres.
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
    scene = None if container is None else Scene(container, diameters=1, unit=unit)._core
    return _imported(_core.import_arrays(points, sizes, unit, scene, _toml.several(box, "box"), periodic), "", False)


def _threads(threads: Any) -> int:
    return _toml.whole(threads, "threads", 1024)


def _rods(rods: Any) -> int:
    return _toml.whole(rods, "rods", _toml.INT)
