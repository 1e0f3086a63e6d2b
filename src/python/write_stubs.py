#!/usr/bin/env python3
"""Writes the type stubs of a package that is built into its folder: write_stubs.py FOLDER.

Type checkers and editors do not see classes that the package makes at run time. The stubs have them, made of the same
table, with all else that the package offers and its docstrings.
"""

from __future__ import annotations

import inspect
import sys
import textwrap
from functools import cached_property
from pathlib import Path
from typing import Any

sys.path[0] = str(Path(sys.argv[1]).resolve().parent)  # the package beside this script is not the built one

import bernal  # noqa: E402
from bernal import _classes, _scene  # noqa: E402

HEAD = """# Made by write_stubs.py; changes are lost.
import os
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any, Literal, overload

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
PathLike = str | os.PathLike[str]
Progress = bool | None | Callable[[str, float | None, str], Any]
"""
FLOATS = "Sequence[float] | NDArray[Any]"
PAIRS = "Sequence[Sequence[float]] | NDArray[Any]"
TYPES = {
    "flag": "bool", "integer": "int", "number": "float", "length": "float", "word": "str", "file": "Any", "text": "str",
    "names": "Any", "points": PAIRS, "lines": f"Sequence[{PAIRS}]", "axes": "Sequence[int]",
    "distribution": "float | Sizes", "parts": "Sequence[float | Sizes]",
    "solids": "Any", "table": "dict[str, Any]", "tables": "dict[str, Any] | Sequence[dict[str, Any]]", "table_lists": "Sequence[Sequence[dict[str, Any]]]",
}  # fmt: skip
SPECIAL = ("__init__", "__len__", "__bool__", "__str__", "__float__", "__getattr__")


def type_of(key: dict[str, Any]) -> str:
    words = f"Literal[{', '.join(map(repr, key['words']))}]"
    if key["type"] == "word":
        return words
    kind = TYPES.get(key["type"], FLOATS)
    return f"{kind} | {words}" if key["words"] and key["type"] != "names" else kind


def parameter(name: str, kind: str) -> str:
    return f"{name}: {kind} | None = None"


def parameters(table: dict[str, Any]) -> str:
    """Of a class that the table describes."""
    keys = {key["name"]: type_of(key) for key in table["keys"]}
    first = _classes.positional(table)
    named = [name for name in keys if name not in first]
    parts = [parameter(name, keys[name]) for name in first] + (["*"] if named else [])
    return ", ".join(["self", *parts, *(parameter(name, keys[name]) for name in named)])


def doc(text: str | None, indent: str) -> str:
    if not text:
        return ""
    text = inspect.cleandoc(text).replace("\\", "\\\\")
    return textwrap.indent(f'"""{text}\n"""' if "\n" in text else f'"""{text}"""', indent) + "\n"


def signature(function: Any) -> str:
    parts, named = [], False
    for p in inspect.signature(function).parameters.values():
        star = {p.VAR_POSITIONAL: "*", p.VAR_KEYWORD: "**"}.get(p.kind, "")
        named = named or p.kind is p.VAR_POSITIONAL
        if p.kind is p.KEYWORD_ONLY and not named:
            parts.append("*")
            named = True
        text = star + p.name + ("" if p.annotation is p.empty else f": {p.annotation}")
        parts.append(text + ("" if p.default is p.empty else f" = {p.default!r}"))
    result = getattr(function, "__annotations__", {}).get("return", "Any")
    return f"({', '.join(parts)}) -> {result}"


def function(name: str, of: Any, indent: str = "", decorators: str = "", text: str | None = None) -> str:
    body = doc(of.__doc__, indent + "    ")
    head = f"{indent}def {name}{text or signature(of)}:"
    return f"{decorators}{head}\n{body}" if body else f"{decorators}{head} ...\n"


def init_of(kind: type) -> str | None:
    """That of a class whose parameters come from the table."""
    if kind is bernal.Scene:
        given = [p for p in inspect.signature(kind).parameters.values() if p.name not in _scene._KEYS]
        parts = [given[0].name + f": {given[0].annotation}", "*"]
        parts += [f"{p.name}: {p.annotation} = {p.default!r}" for p in given[1:]]
        parts += [parameter(key["name"], type_of(key)) for key in _scene._KEYS.values()]
        return f"    def __init__(self, {', '.join(parts)}) -> None: ...\n"
    if kind is bernal.Output:
        text = ""
        for name, table in bernal.Output._tables.items():
            rest = parameters(table).removeprefix("self")
            text += f"    @overload\n    def __init__(self, format: Literal[{name!r}]{rest}) -> None: ...\n"
        return text
    if issubclass(kind, _classes.Said) and "_table" in vars(kind):
        return f"    def __init__({parameters(kind._table)}) -> None: ...\n"
    return None


def attributes_of(kind: type) -> dict[str, str]:
    if kind is bernal.Scene:
        keys = {
            key["name"]: f"{type_of(key)} | None" for key in _scene._KEYS.values() if not hasattr(kind, key["name"])
        }
        return {"container": "Container", "diameters": "float | Sizes | None", "radii": "float | Sizes | None",
                "zones": "tuple[Zone, ...]", "engine": "Engine | None", "stages": "tuple[Stage, ...]", "outputs": "tuple[Output, ...]", **keys}  # fmt: skip
    if issubclass(kind, _classes.Said) and "_table" in vars(kind):
        return {key["name"]: f"{type_of(key)} | None" for key in kind._table["keys"]}
    own = vars(kind).get("__annotations__", {})
    return {name: text for name, text in own.items() if not name.startswith("_")}


def class_of(kind: type) -> str:
    bases = [str(base) if getattr(base, "__args__", None) else base.__name__
             for base in vars(kind).get("__orig_bases__", kind.__bases__) if base is not object]  # fmt: skip
    bases = [base.replace("typing.", "") for base in bases if base != "Said"]
    made = init_of(kind)
    body = doc(kind.__doc__, "    ") + "".join(f"    {name}: {text}\n" for name, text in attributes_of(kind).items())
    body += made or ""
    for name, member in vars(kind).items():
        if (name.startswith("_") and name not in SPECIAL) or (made and name == "__init__"):
            continue
        if isinstance(member, (property, cached_property)):
            of = member.fget if isinstance(member, property) else member.func
            body += function(name, of, "    ", "    @property\n")
        elif isinstance(member, classmethod):
            body += function(name, member.__func__, "    ", "    @classmethod\n")
        elif inspect.isfunction(member):
            body += function(name, member, "    ")
    if kind in (bernal.Container, bernal.Sizes, bernal.Stage, bernal.Engine):
        body += "    def replace(self, **keys: Any) -> Any: ...\n"
    head = f"class {kind.__name__}({', '.join(bases)}):" if bases else f"class {kind.__name__}:"
    return f"{head}\n{body}\n" if body else f"{head} ...\n\n"


def stub_of(module: Any, head: str) -> str:
    text = doc(module.__doc__, "") + head + "\n"
    if hasattr(module, "__version__"):
        text += "__version__: str\ncommit: str\npackings_number: int\n"
    text += f"__all__ = {list(module.__all__)!r}\n\n"
    for name in module.__all__:
        of = getattr(module, name)
        if inspect.ismodule(of):
            text += f"from . import {name} as {name}\n"
        else:
            text += class_of(of) if inspect.isclass(of) else function(name, of) + "\n"
    return text


def main() -> None:
    folder = Path(sys.argv[1])
    (folder / "__init__.pyi").write_text(stub_of(bernal, HEAD), "utf-8")
    of_design = HEAD + "\nfrom . import Prediction, Sizes\n"
    (folder / "design.pyi").write_text(stub_of(bernal.design, of_design), "utf-8")


if __name__ == "__main__":
    main()
