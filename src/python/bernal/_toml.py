"""Values of Python as TOML."""

from __future__ import annotations

import json
import numbers
import os
from collections.abc import Iterable
from typing import Any

from . import _errors


def plain(value: Any) -> Any:
    """A flag, a number, text or a list of such, from arrays, paths, tuples and the like."""
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
    if hasattr(value, "_as_toml"):  # a size distribution, a surface, a packing to start from
        return value
    if isinstance(value, dict):
        return {str(key): plain(part) for key, part in value.items() if part is not None}
    if isinstance(value, Iterable) and not isinstance(value, bytes):
        return [plain(part) for part in value]
    raise _errors.InputError(
        "bad_argument", f"a scene takes numbers, text, flags and lists of them, not {value!r:.200}"
    )


def text_of(value: Any) -> str:
    """A plain value as TOML."""
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
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {text_of(part)}" for key, part in value.items()) + " }"
    return value._as_toml() if hasattr(value, "_as_toml") else repr(value)


def line(key: str, value: Any) -> str:
    return f"{key} = {text_of(value)}\n"


def whole(value: Any, name: str, limit: int = 2**63 - 1) -> int:
    """A whole number of at least 0."""
    number = value if isinstance(value, str) or value is None else plain(value)
    if not isinstance(number, int) or isinstance(number, bool) or not 0 <= number <= limit:
        below = "" if limit == 2**63 - 1 else f" and at most {limit}"
        raise _errors.InputError("bad_argument", f"{name} is a whole number of at least 0{below}, not {value!r:.80}")
    return number


def number(value: Any, name: str) -> float:
    """A finite number."""
    given = value if isinstance(value, str) or value is None else plain(value)
    if not isinstance(given, (int, float)) or isinstance(given, bool) or not abs(given) <= 1.7e308:
        raise _errors.InputError("bad_argument", f"{name} is a finite number, not {value!r:.80}")
    return float(given)


def several(values: Any, name: str) -> list[float]:
    """Finite numbers, such as the edges of a box."""
    if isinstance(values, str) or not isinstance(values, Iterable):
        raise _errors.InputError("bad_argument", f"{name} is a list of numbers, one for each axis, not {values!r:.80}")
    return [number(each, name) for each in values]


INT = 2**31 - 1
