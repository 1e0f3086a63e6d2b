"""The containers, size distributions, stages and outputs of scenes, as classes.

They are made of the table by which scenes are read: a stage that the library has is here, too. What values they
take is checked where a `Scene` is made of them.
"""

from __future__ import annotations

import inspect
import json
import math
import textwrap
from typing import Any, ClassVar

from . import _core, _errors, _surfaces, _toml

REFERENCE: list[dict[str, Any]] = json.loads(_core.reference())["groups"]


def group(name: str) -> dict[str, Any]:
    return next(each for each in REFERENCE if each["name"] == name)


def table_of(name: str, of: str) -> dict[str, Any]:
    return next(each for each in group(name)["tables"] if each["name"] == of)


def otherwise(key: dict[str, Any]) -> str:
    """The default of a key in words; "" if it has none."""
    return "" if key["default"] is None else f", default {_toml.text_of(key['default'])}"


def described(keys: list[dict[str, Any]]) -> str:
    """The parameters of a docstring."""
    text = ""
    for key in keys:
        acts = {"in_bed": " In containers.", "in_box": " In periodic boxes."}.get(key["acts"], "")
        text += f"{key['name']} : {key['expectation']}{otherwise(key)}\n"
        text += textwrap.fill(key["help"] + "." + acts, 96, initial_indent="    ", subsequent_indent="    ") + "\n"
    return text


def positional(table: dict[str, Any]) -> list[str]:
    """The keys that may be given by position: the required ones in their order, and of a choice its first set."""
    firsts = {name for choice in table["choices"] if [] not in choice for name in choice[0]}
    others = {name for choice in table["choices"] for names in choice[1:] for name in names if name not in choice[0]}
    return [
        key["name"]
        for key in table["keys"]
        if (key["required"] or key["name"] in firsts) and key["name"] not in others and key["default"] is None
    ]


def choice_in_words(choice: list[list[str]], table: dict[str, Any]) -> str:
    """One sentence: which keys to give together, and whether any are needed."""
    defaults = {key["name"]: key["default"] for key in table["keys"]}
    none = any(all(defaults[name] is not None for name in names) for names in choice)
    sets = [" and ".join(names) for names in choice if names]
    return f"\nGive {' or '.join(sets)}{', or none of them' if none else ''}.\n"


def signature_of(table: dict[str, Any]) -> inspect.Signature:
    first = positional(table)
    keys = {key["name"]: key for key in table["keys"]}
    kinds = inspect.Parameter
    parameters = [kinds(name, kinds.POSITIONAL_OR_KEYWORD, default=None) for name in first]
    parameters += [kinds(name, kinds.KEYWORD_ONLY, default=None) for name in keys if name not in first]
    return inspect.Signature(parameters)


def float_of(value: int) -> float:
    try:
        return float(value)
    except OverflowError:
        return math.inf if value > 0 else -math.inf


def names_files(key: dict[str, Any]) -> bool:
    return key["type"] in ("file", "solids")


def _absolute(inside: Any) -> Any:
    """A table of what lies inside of spheres, or several, with the absolute path of its scene."""
    if isinstance(inside, dict):
        return {name: _surfaces.named(part) if name == "scene" else part for name, part in inside.items()}
    return [_absolute(each) for each in inside] if isinstance(inside, (list, tuple)) else inside


def taken(key: dict[str, Any], value: Any) -> Any:
    """The value of a key as a scene has it. Names of files become absolute."""
    if key["table"] == "inside":
        value = _absolute(value)
    value = _toml.plain(_surfaces.named(value) if names_files(key) else value)
    if key["type"] == "integer" and isinstance(value, float) and value.is_integer():
        value = int(value)
    if isinstance(value, int) and abs(value) >= 2**63:
        raise _errors.InputError("bad_argument", f"{key['name']} is {key['expectation']}, not {float_of(value):.4g}")
    return value


class Said:
    """One table of a scene as immutable data, see `replace`."""

    _table: ClassVar[dict[str, Any]]
    _selector: ClassVar[str]
    _said: dict[str, Any]

    def __init__(self, *values: Any, **keys: Any) -> None:
        first = positional(self._table)
        if len(values) > len(first):
            raise TypeError(
                f"{type(self).__name__} takes {', '.join(first) or 'nothing'} by position; name the others, as in "
                f"{self._table['keys'][-1]['name']}=…"
            )
        said = dict(zip(first, values))
        known = [key["name"] for key in self._table["keys"]]
        for name, value in keys.items():
            if name in said:
                raise TypeError(f'{type(self).__name__} got "{name}" twice, by position and by name')
            if name not in known:
                raise _errors.unknown(name, self._called(), known)
            said[name] = value
        self.__dict__["_said"] = {name: self._taken(name, v) for name, v in said.items() if v is not None}

    def _called(self) -> str:
        return type(self).__name__

    def _key(self, name: str) -> dict[str, Any]:
        return next(key for key in self._table["keys"] if key["name"] == name)

    def _taken(self, name: str, value: Any) -> Any:
        return taken(self._key(name), value)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        known = [key["name"] for key in self._table["keys"]]
        if name not in known:
            raise AttributeError(str(_errors.unknown(name, self._called(), known)))
        return self._said.get(name, self._key(name)["default"])

    def __setattr__(self, name: str, value: Any) -> None:
        raise AttributeError(f"{type(self).__name__} does not change; take .replace({name}=…)")

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *(key["name"] for key in self._table["keys"])]

    def __eq__(self, other: object) -> bool:
        return type(self) is type(other) and vars(self) == vars(other)

    def __hash__(self) -> int:
        return hash((type(self), self._table["name"], frozenset((name, _fixed(v)) for name, v in self._said.items())))

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(f'{name}={value!r}' for name, value in self._said.items())})"

    def __reduce__(self) -> tuple[Any, ...]:
        return (made, (self._selector, self._table["name"], self._said))

    def replace(self, **keys: Any) -> Any:
        """The same with other values of some keys; None takes a key away."""
        return type(self)(**{**self._said, **keys})

    def _assignments(self) -> list[tuple[str, Any]]:
        return [*([(self._selector, self._table["name"])] if self._selector else []), *self._said.items()]

    def _lines(self) -> str:
        return "".join(_toml.line(key, value) for key, value in self._assignments())

    def _as_toml(self) -> str:
        return "{ " + ", ".join(_toml.line(key, value).rstrip() for key, value in self._assignments()) + " }"


def _fixed(value: Any) -> Any:
    """A value to hash, the same where values are equal."""
    if isinstance(value, dict):
        return frozenset((name, _fixed(part)) for name, part in value.items())
    return tuple(map(_fixed, value)) if isinstance(value, list) else value


class Container(Said):
    """What spheres are packed into. Lengths are in the scene's unit."""


class Sizes(Said):
    """How large the spheres are: lengths in the scene's unit, diameters or radii as the scene says.

    `basis` "number": every sphere counts the same; "volume": as on a balance.
    """


class Stage(Said):
    """A stage of the protocol that packs a scene."""


class Engine(Said):
    """Another program that finds the places which the first stage begins with: `bernal.Lammps(ranks=4)`."""


class Output(Said):
    """One more file of a result, as another program reads it: `bernal.Output("lammps", unit="mm")`."""

    _selector = "format"
    _tables: ClassVar[dict[str, dict[str, Any]]] = {table["name"]: table for table in group("output")["tables"]}

    def __init__(self, format: str, **keys: Any) -> None:
        if format not in self._tables:
            raise _errors.InputError(
                "bad_argument", f'no format is called "{format}"{_core.remedy(str(format), list(self._tables))}'
            )
        self.__dict__["_table"] = self._tables[format]
        super().__init__(**keys)

    @property
    def format(self) -> str:
        """ "lammps", …"""
        return str(self._table["name"])

    def _called(self) -> str:
        return f'Output("{self.format}")'

    def _taken(self, name: str, value: Any) -> Any:
        return _toml.plain(value) if name == "file" else super()._taken(name, value)  # in the folder of the result

    def __repr__(self) -> str:
        return "Output(" + ", ".join([repr(self.format), *(f"{k}={v!r}" for k, v in self._said.items())]) + ")"

    def replace(self, **keys: Any) -> Any:
        """The same with other values of some keys; None takes a key away."""
        return Output(self.format, **{**self._said, **keys})


def _class_of(base: type[Said], table: dict[str, Any], selector: str) -> type[Said]:
    name = "".join(part.capitalize() for part in table["name"].split("_"))
    choices = "".join(choice_in_words(choice, table) for choice in table["choices"])
    more = _surfaces.MESHES if any(key["type"] == "file" for key in table["keys"]) and base is Container else ""
    doc = f"{table['help'][0].upper()}{table['help'][1:]}.\n{choices}{more}\nParameters\n----------\n"
    members = {
        "__doc__": doc + described(table["keys"]),
        "__module__": "bernal",
        "__signature__": signature_of(table),
        "_table": table,
        "_selector": selector,
    }
    return type(base)(name, (base,), members)


def _made_classes() -> dict[str, type[Said]]:
    classes: dict[str, type[Said]] = {}
    for base, name in ((Container, "container"), (Sizes, "diameter"), (Stage, "stage"), (Engine, "engine"),
                       (Said, "zone")):  # fmt: skip
        of = group(name)
        for table in of["tables"]:
            each = _class_of(base, table, of["selector"])
            if each.__name__ in classes:
                raise AssertionError(f"two tables are called {each.__name__}")
            classes[each.__name__] = each
    return classes


CLASSES = _made_classes()
Output.__doc__ = f"{Output.__doc__}\n\nFormats, each with what it can be told:\n\n" + "".join(
    textwrap.fill(f"{name}: {table['help']}; {', '.join(key['name'] for key in table['keys'])}", 96) + "\n"
    for name, table in Output._tables.items()
)


def made(selector: str, name: str, said: dict[str, Any]) -> Said:
    """An instance of the class that the table `name` has, with what a scene says in it."""
    if selector == "format":
        return Output(name, **said)
    kind = next(each for each in CLASSES.values() if each._selector == selector and each._table["name"] == name)
    return kind(**said)
