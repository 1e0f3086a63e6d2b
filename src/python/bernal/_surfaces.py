"""Surfaces that stand in no file: arrays, and the meshes of other packages."""

from __future__ import annotations

import atexit
import hashlib
import multiprocessing
import multiprocessing.util
import numbers
import operator
import os
import shutil
import tempfile
from collections.abc import Iterable
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from . import _errors

MESHES = """
Instead of a file: `(vertices, faces)`, arrays of shape (V, 3) and (F, 3) or (F, 4), faces of any number of corners as
lists; or a mesh of trimesh, meshio or PyVista. They become a file of the same doubles, which lasts as long as this
process; `Packing.write` copies it beside the result.
"""


_folders: dict[int, str] = {}  # of this process, and of those that it was forked from


def _remove(process: int) -> None:
    if process == os.getpid():
        shutil.rmtree(_folders[process], ignore_errors=True)


def folder() -> str:
    """Where what this process makes for itself stands until it ends."""
    process = os.getpid()
    if process not in _folders:
        _folders[process] = tempfile.mkdtemp(prefix="bernal-")
        if multiprocessing.parent_process() is None:
            atexit.register(_remove, process)
        else:  # which ends without atexit
            multiprocessing.util.Finalize(None, _remove, (process,), exitpriority=0)
    return _folders[process]


def is_passing(file: str) -> bool:
    """Whether the file will be gone once such a process has ended."""
    return any(os.path.abspath(file).startswith(each + os.sep) for each in _folders.values())


def _refuse(message: str) -> NoReturn:
    raise _errors.InputError("bad_mesh", message)


def doubles(values: Any, name: str, shape: str) -> NDArray[np.float64]:
    """An array of doubles of real numbers; refuses what would have to be guessed at."""
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
    """PyVista's: each face as the number of its corners, then the corners."""
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
    """meshio's: arrays by the kind of cell, of which faces are meant."""
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
    """In how many lists numbers stand, by the first of each."""
    if hasattr(value, "ndim"):
        return int(value.ndim)
    if isinstance(value, (tuple, list)):
        return 1 + (_depth(value[0]) if value else 0)
    return 0


def _is_pair(mesh: Any) -> bool:
    """Whether these are vertices and faces, and not two files or meshes."""
    if not isinstance(mesh, (tuple, list)) or len(mesh) != 2 or _depth(mesh[0]) > 2:
        return False
    whole = ("vertices", "points", "_as_start", "__fspath__")
    return not any(isinstance(part, str) or any(hasattr(part, name) for name in whole) for part in mesh)


def _parts(mesh: Any) -> tuple[Any, list[list[int]]] | None:
    """Vertices and faces of what is like a mesh; None for what is none."""
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


def _off(vertices: Any, faces: list[list[int]]) -> bytes:
    points = doubles(vertices, "vertices", "(V, 3)")
    if points.ndim != 2 or points.shape[1] != 3 or not len(points):
        _refuse(f"vertices are an array of shape (V, 3), not {points.shape}")
    if not faces:
        _refuse("the surface has no faces")
    for face in faces:
        if len(face) < 3 or min(face) < 0 or max(face) >= len(points):
            _refuse(f"a face has three or more of the vertices 0 to {len(points) - 1}, not {face}")
    lines = [f"OFF\n{len(points)} {len(faces)} 0\n"]
    lines += [f"{x!r} {y!r} {z!r}\n" for x, y, z in points.tolist()]  # the shortest that read back as the same
    lines += [f"{len(face)} {' '.join(map(str, face))}\n" for face in faces]
    return "".join(lines).encode()


def written(content: bytes, ending: str) -> str:
    """A file of this content, named after it."""
    name = os.path.join(folder(), hashlib.sha256(content).hexdigest()[:16] + ending)
    if not os.path.exists(name):
        with tempfile.NamedTemporaryFile(dir=folder(), delete=False) as file:
            file.write(content)
        os.replace(file.name, name)
    return name


def files_of(value: Any) -> Any:
    """The whole name of a file, or of several, in place of its name, a mesh or a packing."""
    if isinstance(value, (str, os.PathLike)):
        return os.path.abspath(path(value, "the file"))
    if hasattr(value, "_as_start"):  # a Packing
        return value._as_start()
    parts = _parts(value)
    if parts is not None:
        return written(_off(*parts), ".off")
    if isinstance(value, Iterable):
        return [files_of(part) for part in value]
    _refuse(
        f"neither a file nor a mesh: {type(value).__name__}; give a path, (vertices, faces), or a mesh of trimesh, "
        "meshio or PyVista"
    )
