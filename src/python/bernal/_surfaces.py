"""Surfaces that stand in no file: arrays, and the meshes of other packages."""

from __future__ import annotations

import atexit
import hashlib
import os
import shutil
import tempfile
from collections.abc import Iterable
from typing import Any

import numpy as np

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
        atexit.register(_remove, process)
    return _folders[process]


def is_passing(file: str) -> bool:
    """Whether the file will be gone once such a process has ended."""
    return any(os.path.abspath(file).startswith(each + os.sep) for each in _folders.values())


def _refuse(message: str) -> None:
    raise _errors.InputError("bad_mesh", message)


def _faces(faces: Any) -> list[list[int]]:
    """Lists of indices of vertices, from an array or from lists."""
    if isinstance(faces, np.ndarray) and faces.dtype != object and not np.issubdtype(faces.dtype, np.integer):
        _refuse(f"faces are numbers of vertices, integers, not {faces.dtype}")
    return [[int(k) for k in face] for face in faces]


def _flat_faces(faces: Any) -> list[list[int]]:
    """PyVista's: each face as the number of its corners, then the corners."""
    flat, found, at = np.asarray(faces).ravel().tolist(), [], 0
    while at < len(flat):
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


def _parts(mesh: Any) -> tuple[Any, list[list[int]]] | None:
    """Vertices and faces of what is like a mesh; None for what is none."""
    if isinstance(mesh, (tuple, list)) and len(mesh) == 2 and not any(isinstance(p, (str, os.PathLike)) for p in mesh):
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
    points = np.asarray(vertices, dtype=float)
    if points.ndim != 2 or points.shape[1] != 3 or not len(points):
        _refuse(f"vertices are an array of shape (V, 3), not {points.shape}")
    if not np.isfinite(points).all():
        _refuse("there are vertices that are not finite")
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
        return os.path.abspath(os.fspath(value))
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
