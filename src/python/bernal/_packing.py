"""A packing: spheres in a domain, and how the run went that placed them."""

from __future__ import annotations

import os
from collections.abc import Iterable
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _core, _records, _surfaces, _toml
from ._errors import InputError
from ._jobs import NOT_REACHED, finish
from ._pages import page_of
from ._pictures import Picture, View
from ._progress import Progress
from ._records import Record, Written
from ._scene import Scene

Array = NDArray[np.float64]


def _gap_ratio(gap: float) -> float:
    ratio = _toml.number(gap, "gap")
    if not 0 <= ratio <= 1:
        raise InputError("bad_argument", f"gap is a ratio from 0 to 1, not {ratio}")
    return ratio


class Packing:
    """Spheres that were packed, read or imported; N of them in D dimensions, lengths in the scene's `unit`.

    `x`, `y`, `z`, `radii` and `columns` are read-only arrays over the library's memory, without a copy, and keep it
    alive. Packings pickle with all that they hold, for other processes with the same
    `bernal.packings_number`; files keep them for longer, see `write`.
    """

    _core: Any

    def __init__(self) -> None:
        raise TypeError("packings come from bernal.pack, bernal.read, bernal.import_ and bernal.from_arrays")

    @classmethod
    def _of(cls, core: Any, scene: Scene | None = None, **more: Any) -> Packing:
        packing = object.__new__(cls)
        packing.__dict__.update(_core=core, _given_scene=scene, notes=Record(), _imported_from=None, **more)
        return packing

    notes: Record
    """Of an imported packing: format, unit, domain and what else was read from its file."""
    _given_scene: Scene | None
    _imported_from: str | None  # the file; "" of arrays

    # The spheres

    @cached_property
    def _columns(self) -> tuple[Array, ...]:
        columns: tuple[Array, ...] = self._core.columns()
        return columns

    @property
    def columns(self) -> tuple[Array, ...]:
        """The coordinates, one array of shape (N,) for each of the D axes. No copies; read-only."""
        return self._columns[:-1]

    @property
    def radii(self) -> Array:
        """Shape (N,). No copy; read-only."""
        return self._columns[-1]

    def _axis(self, axis: int, name: str) -> Array:
        if axis >= self.dimension:
            raise AttributeError(f"a packing of {self.dimension} dimensions has no {name}; see .columns")
        return self._columns[axis]

    @property
    def x(self) -> Array:
        """The x coordinates, shape (N,). No copy; read-only."""
        return self._axis(0, "x")

    @property
    def y(self) -> Array:
        """The y coordinates, shape (N,), in two or more dimensions. No copy; read-only."""
        return self._axis(1, "y")

    @property
    def z(self) -> Array:
        """The z coordinates, shape (N,), in three or more dimensions. No copy; read-only."""
        return self._axis(2, "z")

    @cached_property
    def _classes(self) -> tuple[NDArray[np.uint32], list[tuple[str, str, float | None]]]:
        classes: tuple[NDArray[np.uint32], list[tuple[str, str, float | None]]] = self._core.classes()
        classes[0].setflags(write=False)
        return classes

    @property
    def classes(self) -> NDArray[np.uint32]:
        """Of each sphere, the place of its class in `class_names`: its zone, its class of sizes, its material. Empty
        where the scene tells no spheres apart."""
        return self._classes[0]

    @property
    def class_names(self) -> list[str]:
        """The names of the classes."""
        return [name for name, _, _ in self._classes[1]]

    @property
    def materials(self) -> list[str]:
        """What each class is made of; "" where the scene does not say."""
        return [material for _, material, _ in self._classes[1]]

    @cached_property
    def weights(self) -> Array:
        """Of each Laguerre cell, where the scene asks for volumes of cells, as `cells = {"volume": …}` does: squared
        lengths, of which only differences matter. A point belongs to the cell in which the squared distance from the
        centre less the weight is least. Empty elsewhere: then the weights are the squared radii."""
        weights: Array = self._core.weights()
        weights.setflags(write=False)
        return weights

    @cached_property
    def layers(self) -> list[dict[str, Any]]:
        """What layers the spheres have, class by class and from the centre out; empty where the scene names none.

        Each has `class`, `name`, `material`, `material_density` (kg/m3 or None) and, as arrays of one length, `spheres`
        (the numbers of those that have it), `inner` and `outer` (where it begins and ends, from the centre)."""
        layers: list[dict[str, Any]] = self._core.layers()
        for layer in layers:
            for name in ("spheres", "inner", "outer"):
                layer[name].setflags(write=False)
        return layers

    @cached_property
    def inside(self) -> list[dict[str, Any]]:
        """The packings inside of the spheres of each class that has some; empty where the scene names none.

        Each has `class`, `layer` (the innermost, "" without layers), `templates` (packings, in balls about the origin
        and in the unit of their own scene) and, as arrays of one length, `spheres` (the numbers of those that are
        filled), `which` (of the templates, from 0) and `rotations` (unit quaternions w, x, y, z, shape (n, 4))."""
        insides: list[dict[str, Any]] = self._core.inside()
        for inside in insides:
            inside["templates"] = [Packing._of(core) for core in inside["templates"]]
            for name in ("spheres", "which", "rotations"):
                inside[name].setflags(write=False)
        return insides

    @property
    def levels(self) -> list[dict[str, Any]]:
        """The spheres themselves, then what lies inside of them, a level below each other: `name`, `packings` that were
        made with `packed` spheres in them, spheres that are `filled`, `spheres` that stand for themselves, the radius of
        the `ball` in `unit`, `packing_fraction` of the balls, and the `share` of the domain's volume."""
        levels: list[dict[str, Any]] = self._core.levels()
        return levels

    @cached_property
    def centers(self) -> Array:
        """Shape (N, D). A copy, made at the first access and then kept; read-only."""
        centers = np.stack(self.columns, axis=1)
        return np.ndarray(centers.shape, float, centers.tobytes())  # over bytes, so that it stays read-only

    @property
    def diameters(self) -> Array:
        """Shape (N,). A copy each time."""
        return 2 * self.radii

    def __len__(self) -> int:
        return len(self.radii)

    # What they lie in

    @property
    def scene(self) -> Scene:
        """The scene that was packed."""
        if self._given_scene is None:
            self._given_scene = Scene._of(self._core.scene())
        return self._given_scene

    @property
    def unit(self) -> str:
        """The unit of all lengths."""
        return self.scene.unit

    @property
    def dimension(self) -> int:
        """The dimension D of space."""
        return int(self._core.dimension)

    @property
    def bounds(self) -> Array:
        """The lowest and the highest corner of the domain, shape (2, D); of a periodic box one period."""
        return np.array(self._core.bounds())

    @property
    def volume(self) -> float:
        """The volume of the domain, or of one period, in unit^D."""
        return float(self._core.volume)

    @property
    def walls(self) -> tuple[Array, NDArray[np.uint32]] | None:
        """Vertices of shape (V, 3) and triangles of shape (T, 3) of a container that is a mesh, else None. Copies."""
        walls: tuple[Array, NDArray[np.uint32]] | None = self._core.walls()
        return walls

    # How it came out

    @property
    def packing_fraction(self) -> float:
        """The volume of the spheres over that of the domain."""
        return float(self._core.packing_fraction)

    @property
    def expected_packing_fraction(self) -> float:
        """What the plan expected before the run; 0 or NaN if there was no run."""
        return float(self._core.expected_packing_fraction)

    @property
    def outcome(self) -> str:
        """How the run ended: "converged", "loose", "full", "hit_limit", "cancelled", or "imported"."""
        return str(self._core.outcome)

    @property
    def reason(self) -> str:
        """One sentence that explains the outcome."""
        return str(self._core.reason)

    @property
    def program(self) -> str:
        """Which bernal packed it, such as "0.2.0 (packings 25, commit 0123456789ab)"; empty if it was read."""
        return str(self._core.program)

    @property
    def seed(self) -> int:
        """One seed gives one packing, bit for bit, for any number of threads."""
        return int(self._core.seed)

    @property
    def seconds(self) -> float:
        """The seconds that the run took."""
        return float(self._core.seconds)

    @property
    def size_scale(self) -> float:
        """The sizes over those that were drawn: other than 1 only if `polish` let the spheres grow."""
        return float(self._core.size_scale)

    @property
    def hash(self) -> str:
        """A hash of the bits of all spheres in their order, 16 hexadecimal digits."""
        return str(self._core.hash())

    def coordination(self, gaps: Iterable[float] = (0.002,)) -> Array:
        """The mean number of contacts of a sphere with others, for each of several gaps: spheres touch if
        the gap over the sum of their radii is below it. Gaps are from 0 to 1. Cost: that of the largest gap."""
        return np.array(self._core.coordination([_gap_ratio(gap) for gap in gaps]))

    def contacts(self, gap: float = 0.002) -> Record:
        """All contacts, one by one, sorted by i, then by j: arrays i and j of shape (M,), the indices of the spheres,
        with j = -1 at a wall; gap, the distance of the surfaces in the scene's unit, negative where they overlap;
        normal of shape (M, D), unit vectors from i to j or to the wall; place of shape (M, D), the middle of the gap.
        A pair stands there once, with i < j. Where spheres touch across a period, normal and place are those of the
        image that sphere i touches.

        gap : spheres touch if the gap over the sum of their radii is below it, at a wall over the radius.
        """
        return Record(self._core.contacts(_gap_ratio(gap)))

    def cells(self, sides: int = 64) -> Record:
        """The cells of the power (Laguerre) diagram as polyhedra, in the plane as polygons, that share corners and faces,
        as `bernal cells` writes them, in the scene's unit. With N spheres, V corners, F faces and D dimensions:

        corners of shape (V, D), each once a period; periods of shape (D,), 0 along axes that have none.
        first_corner of shape (F + 1,): the corners of face f are face_corners[first_corner[f]:first_corner[f + 1]], each
        moved by as many periods as its row of corner_images says, anticlockwise seen from outside the first of its
        face_cells (F, 2). The second, moved by the face_images (F, D), is behind it, or -1 at a wall; face_walls (F,)
        are the numbers of walls, or -1.
        first_side of shape (N + 1,): the faces of cell i are cell_faces[first_side[i]:first_side[i + 1]]; where
        from_beyond says so, cell i is behind the face, which has to be moved back by its image. An empty cell has none.
        volumes, surfaces, centroids (N, D), sphericity, aspect, faces and neighbours of shape (N,).

        sides : flat walls around a round one, 8 to 1024.
        """
        return Record(self._core.cells(_toml.whole(sides, "sides", 1024)))

    @property
    def history(self) -> list[Record]:
        """The state after each stage, or each round of a stage: stage, spheres, packing_fraction, potential (mean
        height), max_overlap (ratio), seconds."""
        return [Record(each) for each in self._core.history()]

    @property
    def effects(self) -> list[Record]:
        """What the run did: name, calls, seconds."""
        return [Record(each) for each in self._core.effects()]

    # Files and pictures

    def write(
        self,
        folder: str | os.PathLike[str],
        *,
        with_mesh: bool = False,
        list: int = 0,
        progress: Progress = None,
    ) -> Written:
        """Writes the files of `bernal pack` into a folder: spheres, scene, report, pictures and the scene's outputs. The
        certificate is of the file that was written. Either all files are written, or none.

        with_mesh : copies the CAD files, and the file of a start, beside the spheres, so that the folder stands for
            itself. What stands in no file is always written there.
        list : how many overlapping pairs and protruding spheres the certificate lists, the worst first.
        Returns files, certificate and notes. Raises WriteError.
        """
        job = _core.write(
            self._core,
            _surfaces.path(folder, "the folder"),
            bool(with_mesh),
            _toml.whole(list, "list"),
            self._imported_from,
        )
        files, certificate, notes = finish(job, progress)
        proof = _records.record(_records.Certificate, certificate)
        return Written(files=[Path(file) for file in files], certificate=proof, notes=notes)

    def _as_toml(self) -> str:
        """What a scene calls it that starts from it."""
        return f'"packing-{self.hash}.npy"'

    def mesh(self, format: str, file: str | os.PathLike[str], *, progress: Progress = None, **keys: Any) -> Written:
        """Meshes the space between the spheres, and the spheres where that is asked for, as `bernal mesh` does:
        `packing.mesh("openfoam", "case/bed.foam", mesh_size=0.25)`. The program tetgen has to be installed, but not for
        "snappy".

        format : "gmsh", "abaqus", "openfoam", "snappy" or "vtu".
        Returns files, note and what `bernal mesh --json` prints: tetrahedra, least_sicn, worst, porosity,
        meshed_porosity, groups, parts, …. Raises InputError for what cannot be meshed, and WriteError. A least SICN
        below promised_sicn is no error.
        """
        plain = {name: _toml.plain(value) for name, value in keys.items()}
        words = {name: value if isinstance(value, str) else _toml.text_of(value) for name, value in plain.items()}
        job = _core.mesh(self._core, format, words, _surfaces.path(file, "the file"))
        report, files, note = finish(job, progress)
        made: Written = _records.record(Written, report)
        made.update(files=[Path(each) for each in files], note=note)
        return made

    assert mesh.__doc__
    mesh.__doc__ += "\n" + "".join(f"        {name} : {what}.\n" for name, what in _core.mesh_keys())

    @property
    def picture(self) -> Picture:
        """The picture in `packing.svg`; empty unless there are two or three dimensions."""
        return Picture(self._core.picture())

    def view(self, height: int = 520) -> View:
        """An interactive view, in two and three dimensions, in a notebook so many pixels high."""
        return View(self._core.view(), height)

    def section(self, plane: str | None = None) -> Picture:
        """A section of a packing of three dimensions through a plane, "z = 1.5" or "0.6 x + 0.8 z = 2"; None is one
        through the middle. The circles are exact."""
        return Picture(self._core.section(plane))

    def __reduce__(self) -> tuple[Any, ...]:
        state = {"notes": self.notes, "_imported_from": self._imported_from}
        return Packing._of, (self._core, self._given_scene), state

    def __copy__(self) -> Packing:
        return self  # it does not change

    def __deepcopy__(self, memo: dict[int, Any]) -> Packing:
        return self

    @property
    def _noun(self) -> str:
        noun = "disc" if self.dimension == 2 else "sphere"
        return noun if len(self) == 1 else noun + "s"

    def __repr__(self) -> str:
        end = f"{self.outcome}: {self.reason}" if self.outcome in NOT_REACHED else self.outcome
        return (
            f"<Packing of {len(self):,} {self._noun} in a {self._core.domain()}, "
            f"packing fraction {self.packing_fraction:.4f}, {end}>"
        )

    def _repr_html_(self) -> str:
        return page_of(self, self.outcome in NOT_REACHED)
