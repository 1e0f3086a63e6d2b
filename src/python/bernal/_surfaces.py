"""Surfaces from arrays, and from meshes of other packages."""

from __future__ import annotations

import hashlib
import itertools
import numbers
import operator
import os
from collections.abc import Iterable
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from . import _errors

Array = NDArray[np.float64]

MESHES = """
Instead of a file: `(vertices, faces)`, arrays of shape (V, 3) and (F, 3) or (F, 4), faces of any number of corners as
lists; or a mesh of trimesh, meshio or PyVista. `Packing.write` and `Scene.write` write a file of the same doubles.
"""


def _refuse(message: str) -> NoReturn:
    raise _errors.InputError("bad_mesh", message)


def doubles(values: Any, name: str, shape: str) -> Array:
    """An array of doubles; refuses masked values, complex numbers, and others that are no exact doubles."""
    if np.ma.is_masked(values):
        _refuse(f"{name} are masked in places, which only you can fill or leave out")
    try:
        array = np.asarray(values)
    except (ValueError, TypeError):
        _refuse(f"{name} are an array of shape {shape}, whose rows have one length")
    if array.dtype.kind == "O" and array.ndim and all(isinstance(each, numbers.Real) for each in array.ravel()):
        array = array.astype(float)
    if array.dtype.kind not in "iuf":
        what = f"an array of {array.dtype}" if array.dtype.kind != "O" else _short(values)
        _refuse(f"{name} are an array of numbers of shape {shape}, not {what}")
    if not np.isfinite(array).all():
        _refuse(f"there are {name} that are not finite")
    if array.dtype.kind in "iu" and array.size and max(int(array.max()), -int(array.min())) > 2**53:
        _refuse(f"there are {name} beyond 2^53, which are not exact as doubles; give them as floats")
    return array.astype(float, copy=False)


def _short(value: Any) -> str:
    return f"{value!r:.80}" if isinstance(value, (str, bytes, list, tuple)) or value is None else type(value).__name__


def path(value: Any, name: str) -> str:
    """The name of a file or a folder."""
    try:
        text = os.fsdecode(value)
    except TypeError:
        raise _errors.InputError("bad_argument", f"{name} is a path, not {_short(value)}") from None
    if not text or "\0" in text:
        raise _errors.InputError("bad_argument", f"{name} is a path, which {text!r:.80} is not; give its name")
    return text


def _faces(faces: Any) -> list[list[int]]:
    """Lists of indices of vertices, from an array or from lists."""
    if np.ma.is_masked(faces):
        _refuse("faces are masked in places, which only you can fill or leave out")
    if isinstance(faces, np.ndarray) and faces.dtype != object:
        if not np.issubdtype(faces.dtype, np.integer) and faces.size:
            _refuse(f"faces are numbers of vertices, integers, not {faces.dtype}")
        faces = faces.tolist()
    try:
        return [[operator.index(k) for k in face] for face in faces]
    except TypeError:
        _refuse(f"faces are an array of shape (F, 3) or lists of numbers of vertices, integers, not {_short(faces)}")


def _flat_faces(faces: Any) -> list[list[int]]:
    """Faces in PyVista's format: the number of corners of a face, then the corners, for each face."""
    array = np.asarray(faces)
    if array.size and not np.issubdtype(array.dtype, np.integer):
        _refuse(f"faces are numbers of vertices, integers, not {array.dtype}")
    flat, found, at = array.ravel().tolist(), [], 0
    while at < len(flat):
        if not 0 < flat[at] < len(flat) - at:
            _refuse(f"faces are numbers of corners, each followed by so many corners; at {at} there is {flat[at]}")
        found.append(flat[at + 1 : at + 1 + flat[at]])
        at += 1 + flat[at]
    return found


def _of_cells(cells: dict[str, Any]) -> list[list[int]]:
    """Faces in meshio's format: an array for each kind of cell."""
    kinds = {kind: block for kind, block in cells.items() if len(block)}
    faces = [kind for kind in kinds if kind in ("triangle", "quad", "polygon")]
    others = [kind for kind in kinds if kind not in (*faces, "vertex", "line")]
    if others or not faces:
        _refuse(
            "a container is a surface of triangles, quads or polygons, but the mesh has cells "
            f"{', '.join(kinds) or 'none'}; extract its surface first"
        )
    return [face for kind in faces for face in _faces(kinds[kind])]


def _depth(value: Any) -> int:
    """How deep lists are nested, by the first element of each."""
    if hasattr(value, "ndim"):
        return int(value.ndim)
    if isinstance(value, (tuple, list)):
        return 1 + (_depth(value[0]) if value else 0)
    return 0


def _is_pair(mesh: Any) -> bool:
    """Whether this is a pair of vertices and faces, and not of two files or meshes."""
    if not isinstance(mesh, (tuple, list)) or len(mesh) != 2 or _depth(mesh[0]) > 2:
        return False
    whole = ("vertices", "points", "_as_toml", "__fspath__")
    return not any(isinstance(part, str) or any(hasattr(part, name) for name in whole) for part in mesh)


def _parts(mesh: Any) -> tuple[Any, list[list[int]]] | None:
    """The vertices and faces of a mesh of any kind; None if it is no mesh."""
    if _is_pair(mesh):
        return mesh[0], _faces(mesh[1])
    if hasattr(mesh, "vertices") and hasattr(mesh, "faces"):  # trimesh
        return mesh.vertices, _faces(mesh.faces)
    if hasattr(mesh, "points") and hasattr(mesh, "cells_dict"):  # meshio
        return mesh.points, _of_cells(mesh.cells_dict)
    if hasattr(mesh, "points") and hasattr(mesh, "faces"):  # PyVista
        faces = np.asarray(mesh.faces)
        return mesh.points, _faces(faces) if faces.ndim == 2 else _flat_faces(faces)
    return None


class Surface:
    """A surface from arrays, the `file` of a `Mesh` that was made of them. Immutable.

    vertices : shape (V, 3). corners : of all faces, one after the other. counts : how many each face has.
    """

    def __init__(self, vertices: Array, corners: NDArray[np.uint32], counts: NDArray[np.uint32]) -> None:
        self.vertices, self.corners, self.counts = vertices, corners, counts
        for array in self.arrays:
            array.setflags(write=False)
        digest = hashlib.sha256(b"".join(array.tobytes() for array in self.arrays)).hexdigest()
        self.name = f"surface-{digest[:16]}.off"  # what it is called in TOML, and beside a result

    @property
    def arrays(self) -> tuple[Array, NDArray[np.uint32], NDArray[np.uint32]]:
        return self.vertices, self.corners, self.counts

    def _as_toml(self) -> str:
        return f'"{self.name}"'

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Surface) and self.name == other.name

    def __hash__(self) -> int:
        return hash(self.name)

    def __repr__(self) -> str:
        return f"<surface of {len(self.vertices):,} vertices and {len(self.counts):,} faces>"


def _surface(vertices: Any, faces: list[list[int]]) -> Surface:
    points = doubles(vertices, "vertices", "(V, 3)")
    if points.ndim != 2 or points.shape[1] != 3 or not len(points):
        _refuse(f"vertices are an array of shape (V, 3), not {points.shape}")
    if not faces:
        _refuse("the surface has no faces")
    for face in faces:
        if len(face) < 3 or min(face) < 0 or max(face) >= len(points):
            _refuse(f"a face has three or more of the vertices 0 to {len(points) - 1}, not {face}")
    corners = np.fromiter(itertools.chain.from_iterable(faces), np.uint32)
    return Surface(np.array(points, order="C"), corners, np.array([len(face) for face in faces], np.uint32))


def named(value: Any) -> Any:
    """The value of a key for files: an absolute path, a surface, a packing to start from, or a list of such."""
    if isinstance(value, (str, os.PathLike)):
        return os.path.abspath(path(value, "the file"))
    if hasattr(value, "_as_toml"):
        return value
    parts = _parts(value)
    if parts is not None:
        return _surface(*parts)
    if isinstance(value, Iterable):
        return [named(part) for part in value]
    _refuse(
        f"neither a file nor a mesh: {type(value).__name__}; give a path, (vertices, faces), or a mesh of trimesh, "
        "meshio or PyVista"
    )
