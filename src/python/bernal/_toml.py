"""Values of Python as values of a scene's TOML."""

from __future__ import annotations

import json
import numbers
import os
from collections.abc import Iterable
from typing import Any

from . import _errors


def plain(value: Any) -> Any:
    """Flags, numbers, text and lists of such, from whatever is like them: arrays, paths, tuples."""
    if hasattr(value, "tolist"):  # arrays and scalars of NumPy
        value = value.tolist()
    if value is None or isinstance(value, (bool, str)):
        return value
    if isinstance(value, numbers.Integral):
        return int(value)
    if isinstance(value, numbers.Real):
        return float(value)
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if hasattr(value, "_as_toml"):  # a size distribution
        return value
    if isinstance(value, Iterable) and not isinstance(value, (bytes, dict)):
        return [plain(part) for part in value]
    raise _errors.InputError(
        "bad_argument", f"a scene takes numbers, text, flags and lists of them, not {value!r:.200}"
    )


def text_of(value: Any) -> str:
    """Of a plain value."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        text = json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
        try:
            text.encode()
        except UnicodeEncodeError as error:
            raise _errors.InputError(
                "bad_scene", f"{value!a} is no valid text, which a scene cannot hold; give the file another name"
            ) from error
        return text
    if isinstance(value, list):
        return "[" + ", ".join(map(text_of, value)) + "]"
    return value._as_toml() if hasattr(value, "_as_toml") else repr(value)


def line(key: str, value: Any) -> str:
    return f"{key} = {text_of(value)}\n"
