"""Answers, which are dictionaries with their keys as attributes."""

from __future__ import annotations

import json
from typing import Any

import numpy as np

from . import _errors


class _Both(list[Any]):
    """A list under a key that has the name of a method of dictionaries, and that method: `plan.items` is a list, and
    json and pickle can call `plan.items()`."""

    _method: Any

    def __call__(self) -> Any:
        return self._method()

    def __reduce__(self) -> Any:
        return (list, ([*self],))


class Record(dict[str, Any]):
    """A dictionary whose keys are attributes, too: `answer["phi"]` is `answer.phi`."""

    def __getattribute__(self, name: str) -> Any:
        found = super().__getattribute__(name)
        if name.startswith("_") or name not in _METHODS or name not in self:
            return found
        value = self[name]
        if not isinstance(value, list):
            return value
        both = _Both(value)
        both._method = found
        return both

    def __getattr__(self, name: str) -> Any:
        try:
            return self[name]
        except KeyError:
            raise AttributeError(str(_errors.unknown(name, type(self).__name__, list(self)))) from None

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self]

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(f'{key}={_short(value)}' for key, value in dict.items(self))})"

    def __copy__(self) -> Record:
        made = type(self)(self)
        made.__dict__.update(self.__dict__)
        return made


_METHODS = frozenset(dir(dict))


class Plan(Record):
    """What a scene would run, and what that would cost, see `explain`. `str` gives what `bernal explain` prints."""

    words: str

    def __str__(self) -> str:
        return self.words

    def _repr_html_(self) -> str:
        return f"<pre>{_escaped(self.words)}</pre>"


class Certificate(Record):
    """The result of `verify`. True if the packing is certified."""

    def __bool__(self) -> bool:
        return bool(self["certified"])

    def __str__(self) -> str:
        return str(self["statement"])


class Measurements(Record):
    """The result of `measure`."""


class Inspection(Record):
    """The result of `inspect`. True if the CAD file can be a container."""

    def __bool__(self) -> bool:
        return bool(self["usable"])


class Prediction(Record):
    """A packing fraction by the rod model, see `predict` and `design`. `float` gives phi."""

    def __float__(self) -> float:
        return float(self["phi"])


class Written(Record):
    """Files that were written, see `Packing.write` and `export`."""


def record(kind: type[Record], answer: Any, arrays: bool = False) -> Any:
    """A record of JSON or of dictionaries. With `arrays` lists of numbers become arrays, with NaN for null."""
    if isinstance(answer, str):
        answer = json.loads(answer)
    return kind({key: _inside(value, arrays) for key, value in answer.items()})


def _inside(value: Any, arrays: bool) -> Any:
    if isinstance(value, dict):
        return record(Record, value, arrays)
    if not isinstance(value, list):
        return value
    if arrays and value and all(type(each) in (int, float, type(None)) for each in value):
        return np.array([np.nan if each is None else each for each in value], dtype=float)
    return [_inside(each, arrays) for each in value]


def _short(value: Any) -> str:
    if isinstance(value, np.ndarray):
        return f"array of shape {value.shape}" if value.size > 4 else repr(value.tolist())
    text = repr(value)
    return text if len(text) <= 100 else text[:99] + "…"


def _escaped(text: str) -> str:
    return text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")
