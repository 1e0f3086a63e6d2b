"""What bad input raises."""

from __future__ import annotations

import re

from . import _core


class Error(Exception):
    """Bad input, in one line that names the remedy. Its subclasses are what is raised.

    Not reaching what a scene asks for is no error: see `Packing.outcome`.
    """

    code: str
    """"bad_scene", "bad_mesh", "bad_packing", "bad_argument", "cannot_write" or "no_engine"."""
    message: str
    """What is wrong and what to do, without the place."""
    file: str | None
    """The user's file with the mistake; None if it is in no file."""
    line: int | None
    """The line of the file, from 1; None if unknown."""
    column: int | None
    """The column, likewise."""

    def __init__(
        self,
        code: str,
        message: str,
        file: str | None = None,
        line: int | None = None,
        column: int | None = None,
    ) -> None:
        Exception.__init__(self, code, message, file, line, column)
        self.code, self.message = code, message
        self.file, self.line, self.column = file, line, column

    def __str__(self) -> str:
        place = [str(part) for part in (self.file, self.line) if part is not None]
        return ": ".join([":".join(place), self.message] if place else [self.message])


class InputError(Error, ValueError):
    """A scene, a CAD file, spheres or an argument that cannot be used."""


class KeywordError(InputError, TypeError):
    """An unknown keyword; the message names the nearest known one."""


class WriteError(Error, OSError):
    """A file or folder that cannot be written, or whose content is not to be replaced."""


class EngineError(Error, RuntimeError):
    """The engine of a scene is not there, crashed, or left no whole result; the message names its folder."""


def unknown(name: str, where: str, known: list[str]) -> KeywordError:
    """The error for an unknown name, with the nearest known one."""
    return KeywordError("bad_argument", f'{where} has no "{name}"{_core.remedy(name, known)}')


# The library's name for a scene from Python, and for surfaces and packings in such a scene. Errors do not show them,
# since no such files exist.
MADE_HERE = "a scene made in Python"
GIVEN = re.compile(r"(surface|packing)-[0-9a-f]{16}\.(off|npy)")


def _made(code: str, message: str, file: str, line: int, column: int) -> Error:
    kind = {"cannot_write": WriteError, "no_engine": EngineError}.get(code, InputError)
    if not file or file.endswith(MADE_HERE) or GIVEN.fullmatch(file):
        return kind(code, message)
    return kind(code, message, file, line or None, column or None)


_core.raise_errors_as(_made)
