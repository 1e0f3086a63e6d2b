"""A packing problem as the user states it."""

from __future__ import annotations

import inspect
import os
import shutil
import tomllib
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from . import _classes, _core, _errors, _surfaces, _toml
from ._classes import Container, Engine, Output, Said, Sizes, Stage

# Keys that stand in tables of their own in a file and are keywords here; sizes and tables are parameters.
_OWN = {table["name"]: [k for k in table["keys"] if k["name"] not in ("radius", "diameter")]
        for table in _classes.group("scene")["tables"]}  # fmt: skip
_PARTS = ("container", "diameters", "radii", "engine", "stages", "outputs")
_KEYS = {key["name"]: key for keys in _OWN.values() for key in keys}


class Scene:
    """What is to be packed into what: a container, sizes of spheres, and what else a scene file may say.

    A scene does not change, see `replace`. It is checked when it is made: what is wrong raises `InputError`.

    Parameters
    ----------
    container : Container
        `Mesh("part.stl", unit="mm")`, `Cylinder(5, 20)`, `Box([4, 5, 6])`, `Periodic(edge=10)`, …
    diameters, radii : length or Sizes
        exactly one of them, so that nobody has to guess: `diameters=2` or `diameters=Lognormal(2, 0.3)`.
    engine : Engine
        another program that finds the places which the first stage begins with, such as `Lammps(ranks=4)`.
    stages : Stage, or several
        in their order; none: the one that suits any container, or any periodic box.
    outputs : Output or name of a format, or several
        files for other programs, which `Packing.write` writes beside the others.
    """

    def __init__(
        self,
        container: Container,
        *,
        diameters: float | Sizes | None = None,
        radii: float | Sizes | None = None,
        engine: Engine | None = None,
        stages: Stage | Iterable[Stage] = (),
        outputs: Output | str | Iterable[Output | str] = (),
        **keys: Any,
    ) -> None:
        known = [*_PARTS, *_KEYS]
        for name in keys:
            if name not in _KEYS:
                raise _errors.unknown(name, "Scene", known)
        if not isinstance(container, Container):
            raise _errors.InputError(
                "bad_scene", f"a scene needs a container, such as Mesh(…) or Cylinder(…), not {container!r:.100}"
            )
        if engine is not None and not isinstance(engine, Engine):
            raise _errors.InputError(
                "bad_scene", f"the engine of a scene is an instance, such as Lammps(ranks=2), not {engine!r:.100}"
            )
        said = {name: _classes.taken(_KEYS[name], value) for name, value in keys.items() if value is not None}
        self._parts: dict[str, Any] = {
            "container": container,
            "diameters": _toml.plain(diameters),
            "radii": _toml.plain(radii),
            "engine": engine,
            "stages": _several(stages, Stage, "stages"),
            "outputs": tuple(
                Output(each) if isinstance(each, str) else each for each in _several(outputs, (Output, str), "outputs")
            ),
            **said,
        }
        self._file: Path | None = None
        self._core = _core.scene(self._text(), "/" + _errors.MADE_HERE)

    @classmethod
    def read(cls, file: str | os.PathLike[str]) -> Scene:
        """The scene of a TOML file. Errors name its lines."""
        name = os.path.abspath(_surfaces.path(file, "the file of a scene"))
        return cls._of(_core.read_scene(name), Path(name))

    @classmethod
    def _of(cls, core: Any, file: Path | None = None) -> Scene:
        """Of what the library has; as far as it stands in a file with what that says alone."""
        scene = object.__new__(cls)
        scene._core, scene._file = core, file
        whole = tomllib.loads(core.toml(""))
        scene._parts = _parts_of(tomllib.loads(file.read_text("utf-8-sig")) if file else whole, whole)
        return scene

    def _text(self) -> str:
        parts = self._parts
        tables = {
            table: "".join(_toml.line(k["name"], parts[k["name"]]) for k in keys if k["name"] in parts)
            for table, keys in _OWN.items()
        }
        for name, key in (("diameters", "diameter"), ("radii", "radius")):
            if parts[name] is not None:
                tables["spheres"] += _toml.line(key, parts[name])
        text = f"{tables.pop('scene')}\n[container]\n{parts['container']._lines()}"
        text += "".join(f"\n[{table}]\n{lines}" for table, lines in tables.items())
        if parts["engine"] is not None:
            text += f"\n[engine]\n{parts['engine']._lines()}"
        for name in ("stage", "output"):
            text += "".join(f"\n[[{name}]]\n{each._lines()}" for each in parts[name + "s"])
        return text

    @property
    def toml(self) -> str:
        """The scene as a file would have it, every default explicit."""
        return str(self._core.toml(""))

    @property
    def file(self) -> Path | None:
        """Where it was read from."""
        return self._file

    @property
    def unit(self) -> str:
        """Of every length in it: "nm", "um", "mm", "cm", "m", "in" or "ft"."""
        return str(self._core.unit)

    @property
    def dimension(self) -> int:
        """Of space: 2 for discs."""
        return int(self._core.dimension)

    def write(self, file: str | os.PathLike[str]) -> Path:
        """Writes it as TOML. Surfaces that stand in no file of the user are copied beside it."""
        path = Path(os.path.abspath(os.fspath(file)))
        try:
            copies = {passing: str(path.parent / Path(passing).name) for passing in self._passing()}
            for passing, copy in copies.items():
                if os.path.isdir(passing):
                    shutil.copytree(passing, copy, dirs_exist_ok=True)
                else:
                    shutil.copyfile(passing, copy)
            path.write_text(self._with_files(copies)._core.toml(str(path.parent)), "utf-8")
        except OSError as error:
            raise _errors.WriteError("cannot_write", f"cannot be written: {error.strerror}", str(path)) from error
        return path

    def _named_files(self) -> dict[str, Any]:
        """What the container says of files, and the start."""
        said = self._parts["container"]._said
        named = {key["name"]: said[key["name"]] for key in self._parts["container"]._table["keys"]
                 if _classes.names_files(key) and key["name"] in said}  # fmt: skip
        return {**named, "start": self._parts.get("start")}

    def _passing(self) -> list[str]:
        """Its files that end with this process."""
        files = [
            file for value in self._named_files().values() for file in (value if isinstance(value, list) else [value])
        ]
        return [file for file in files if file is not None and _surfaces.is_passing(file)]

    def _with_files(self, others: dict[str, str]) -> Scene:
        """The same with these files in place of others."""
        if not others:
            return self
        named = {
            name: [others.get(each, each) for each in value] if isinstance(value, list) else others.get(value, value)
            for name, value in self._named_files().items()
        }
        start = named.pop("start")
        return self.replace(container=self._parts["container"].replace(**named), start=start)

    def replace(self, **keys: Any) -> Scene:
        """The same with other values of some parameters; None takes one away."""
        return Scene(**{name: value for name, value in {**self._parts, **keys}.items() if value is not None})

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        if name in self._parts:
            return self._parts[name]
        if name in _KEYS:
            return _KEYS[name]["default"]
        raise AttributeError(str(_errors.unknown(name, "Scene", [*_PARTS, *_KEYS])))

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._parts, *_KEYS]

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Scene) and self.toml == other.toml

    def __hash__(self) -> int:
        return hash(self.toml)

    def __reduce__(self) -> tuple[Any, ...]:
        return (_again, (self._parts,))

    def __repr__(self) -> str:
        parts = {name: value for name, value in self._parts.items() if value is not None and value != ()}
        container = parts.pop("container")
        return f"Scene({', '.join([repr(container), *(f'{name}={value!r}' for name, value in parts.items())])})"


Scene.__doc__ = f"{inspect.cleandoc(Scene.__doc__ or '')}\n" + _classes.described(list(_KEYS.values()))
_given = list(inspect.signature(Scene.__init__).parameters.values())[:-1]
Scene.__init__.__signature__ = inspect.Signature(  # type: ignore[attr-defined]
    [*_given, *(inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=None) for name in _KEYS)]
)


def as_scene(scene: Scene | str | os.PathLike[str]) -> Scene:
    return scene if isinstance(scene, Scene) else Scene.read(scene)


def _again(parts: dict[str, Any]) -> Scene:
    return Scene(**{name: value for name, value in parts.items() if value is not None})


def _several(given: Any, kinds: Any, name: str) -> tuple[Any, ...]:
    all_of = (given,) if isinstance(given, kinds) else tuple(given)
    for each in all_of:
        if not isinstance(each, kinds):
            raise _errors.InputError(
                "bad_scene", f"{name} of a scene are instances, such as Relax(), not {each!r:.100}"
            )
    return all_of


def _parts_of(said: dict[str, Any], whole: dict[str, Any]) -> dict[str, Any]:
    """What a file says, as the parameters of `Scene`; names of files, and what stands in them, as in the `whole`."""
    container = {**said["container"]}
    for key in _classes.table_of("container", container["kind"])["keys"]:
        if key["name"] in container and _classes.names_files(key):
            if key["name"] not in whole["container"]:  # its points have taken its place
                container = whole["container"]
                break
            container[key["name"]] = whole["container"][key["name"]]
    parts: dict[str, Any] = {"container": _chosen("kind", container), "diameters": None, "radii": None}
    parts["engine"] = _chosen("kind", said["engine"]) if "engine" in said else None
    parts["stages"] = tuple(_chosen("do", each) for each in said.get("stage", ()))
    parts["outputs"] = tuple(_chosen("format", each) for each in said.get("output", ()))
    for name, key in (("diameters", "diameter"), ("radii", "radius")):
        if key in said["spheres"]:
            sizes = said["spheres"][key]
            parts[name] = _sizes(whole["spheres"][key] if _names_a_file(sizes) else sizes)
    own = {**said, **said["spheres"], **said.get("accuracy", {})}
    parts.update({name: value for name, value in own.items() if name in _KEYS})
    if "start" in parts:
        parts["start"] = whole["spheres"]["start"]
    return parts


def _names_a_file(sizes: Any) -> bool:
    if isinstance(sizes, list):
        return any(map(_names_a_file, sizes))
    return isinstance(sizes, dict) and ("file" in sizes or any(map(_names_a_file, sizes.values())))


def _chosen(selector: str, table: dict[str, Any]) -> Said:
    said = {name: _sizes(value) for name, value in table.items() if name != selector}
    return _classes.made(selector, table[selector], said)


def _sizes(value: Any) -> Any:
    if isinstance(value, dict):
        return _chosen("distribution", value)
    if isinstance(value, list):
        return [_sizes(each) for each in value]
    return value
