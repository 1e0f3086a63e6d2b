"""Scenes: packing problems."""

from __future__ import annotations

import inspect
import os
import tomllib
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from . import _classes, _core, _errors, _surfaces, _toml
from ._classes import Container, Engine, Output, Said, Sizes, Stage

# The keys of a scene that are keywords, by their table in a file. Sizes and other tables are parameters.
_OWN = {table["name"]: [k for k in table["keys"] if k["name"] not in ("radius", "diameter")]
        for table in _classes.group("scene")["tables"]}  # fmt: skip
_PARTS = ("container", "diameters", "radii", "zones", "engine", "stages", "outputs")
_ZONE: Any = _classes.CLASSES["Zone"]
_KEYS = {key["name"]: key for keys in _OWN.values() for key in keys}


class Scene:
    """A packing problem: a container, sizes of spheres, and all else that a scene file may say.

    A scene is immutable, see `replace`. The constructor checks it and raises `InputError`.

    Parameters
    ----------
    container : Container
        `Mesh("part.stl", unit="mm")`, `Cylinder(5, 20)`, `Box([4, 5, 6])`, `Periodic(edge=10)`, …
    diameters, radii : length, which may be text with its unit, or Sizes
        exactly one of them, so that nobody has to guess: `diameters=2`, `diameters=Lognormal(2, 0.3)` or,
        with a count, `diameters="largest"`.
    zones : Zone, or several
        parts of the container with sizes of their own, `Zone(place="z < 20", diameter=1, material="sand")`; what
        lies in none has the sizes of the scene, if it has any.
    engine : Engine
        another program that places the spheres before the first stage, such as `Lammps(ranks=4)`.
    stages : Stage, or several
        in their order; without any, the default for containers or for periodic boxes.
    outputs : Output or name of a format, or several
        files for other programs, which `Packing.write` writes beside the others.
    """

    def __init__(
        self,
        container: Container,
        *,
        diameters: float | str | Sizes | None = None,
        radii: float | str | Sizes | None = None,
        zones: Said | Iterable[Said] = (),
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
            "zones": _several(zones, _ZONE, "zones"),
            "engine": engine,
            "stages": _several(stages, Stage, "stages"),
            "outputs": tuple(
                Output(each) if isinstance(each, str) else each for each in _several(outputs, (Output, str), "outputs")
            ),
            **said,
        }
        self._file: Path | None = None
        surfaces = {surface.name: surface.arrays for surface in _surfaces_of(container)}
        packing = getattr(said.get("start"), "_core", None)
        self._core = _core.scene(self._text(), "/" + _errors.MADE_HERE, surfaces, packing)

    @classmethod
    def read(cls, file: str | os.PathLike[str]) -> Scene:
        """The scene of a TOML file. Errors name its lines."""
        name = os.path.abspath(_surfaces.path(file, "the file of a scene"))
        return cls._of(_core.read_scene(name), Path(name))

    @classmethod
    def _of(cls, core: Any, file: Path | None = None) -> Scene:
        """A scene of the library; of one from a file only with the keys that the file has."""
        scene = object.__new__(cls)
        scene._core, scene._file = core, file
        whole = _with_what_is_given(tomllib.loads(core.toml("")), core)
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
        for name in ("zone", "stage", "output"):
            text += "".join(f"\n[[{name}]]\n{each._lines()}" for each in parts[name + "s"])
        return text

    @property
    def toml(self) -> str:
        """The scene as TOML, with every default."""
        return str(self._core.toml(""))

    @property
    def file(self) -> Path | None:
        """The file that it was read from, or None."""
        return self._file

    @property
    def unit(self) -> str:
        """The unit of all lengths: "nm", "um", "mm", "cm", "m", "in" or "ft"."""
        return str(self._core.unit)

    @property
    def dimension(self) -> int:
        """The dimension of space, 2 for discs."""
        return int(self._core.dimension)

    def write(self, file: str | os.PathLike[str]) -> Path:
        """Writes it as TOML. What stands in no file, surfaces and a packing to start from, is written beside it."""
        path = Path(os.path.abspath(os.fspath(file)))
        _core.write_scene(self._core, path)
        return path

    def replace(self, **keys: Any) -> Scene:
        """A scene with other values of some parameters; None removes one."""
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


def as_scene(scene: Scene | str | os.PathLike[str], **keys: Any) -> Scene:
    """A scene, that of a TOML file, or with `keys` that of a mesh."""
    if isinstance(scene, Scene) or not _core.is_mesh_file(_surfaces.path(scene, "the file of a scene")):
        if keys:
            raise _errors.KeywordError(
                "bad_argument", f"a scene says itself what is packed; leave out {', '.join(keys)}, or see Scene.replace"
            )
        return scene if isinstance(scene, Scene) else Scene.read(scene)
    return _of_mesh(os.path.abspath(os.fspath(scene)), keys)


def _of_mesh(file: str, keys: dict[str, Any]) -> Scene:
    """The scene in which a mesh is packed. The keys are those of `Scene` and of `Mesh`; "diameter" and "radius" are
    what scene files call sizes, "file_unit" is the unit of the mesh where that is not the one of the scene."""
    if not {"diameters", "diameter", "radii", "radius", "start"} & set(keys):
        raise _errors.InputError(
            "bad_argument",
            f"{file} is a mesh, not a scene; say what is packed into it, such as diameters=2, unit='mm' (a file that "
            "says its unit, as STEP does, needs none)",
        )
    of_scene = {{"diameter": "diameters", "radius": "radii"}.get(name, name): value for name, value in keys.items()}
    mesh = _classes.CLASSES["Mesh"]
    of_mesh = {name: of_scene.pop(name) for name in [*of_scene]
               if name not in ("file", "unit") and any(key["name"] == name for key in mesh._table["keys"])}  # fmt: skip
    of_mesh["unit"] = of_scene.pop("file_unit", None)
    if of_scene.get("unit") is None:
        of_scene["unit"] = of_mesh["unit"] or _core.unit_of_mesh_file(file)
    return Scene(mesh(file, **of_mesh), **of_scene)


def _again(parts: dict[str, Any]) -> Scene:
    return Scene(**{name: value for name, value in parts.items() if value is not None})


def _surfaces_of(container: Container) -> list[_surfaces.Surface]:
    """The surfaces from arrays among the container's files."""
    values = [value for name, value in container._said.items() if _classes.names_files(container._key(name))]
    files = [file for value in values for file in (value if isinstance(value, list) else [value])]
    obstacles = [surface for each in files if isinstance(each, Container) for surface in _surfaces_of(each)]
    return [file for file in files if isinstance(file, _surfaces.Surface)] + obstacles


def _with_what_is_given(whole: dict[str, Any], core: Any) -> dict[str, Any]:
    """The tables of a scene, with surfaces and the packing to start from in place of their names."""
    given = {name: _surfaces.Surface(*arrays) for name, arrays in core.surfaces().items()}
    container = whole["container"]
    if given:
        solids = [each for each in container.get("obstacles", []) if isinstance(each, dict)]
        for solid in [container, *solids]:
            if "file" in solid:
                solid["file"] = given.get(solid["file"], solid["file"])
        if "obstacles" in container:
            container["obstacles"] = [
                each if isinstance(each, dict) else given.get(each, each) for each in container["obstacles"]
            ]
    start = core.start()
    if start is not None:
        from ._packing import Packing

        whole["spheres"]["start"] = Packing._of(start)
    return whole


def _several(given: Any, kinds: Any, name: str) -> tuple[Any, ...]:
    all_of = (given,) if isinstance(given, kinds) else tuple(given)
    for each in all_of:
        if not isinstance(each, kinds):
            raise _errors.InputError(
                "bad_scene", f"{name} of a scene are instances, such as Relax(), not {each!r:.100}"
            )
    return all_of


def _parts_of(said: dict[str, Any], whole: dict[str, Any]) -> dict[str, Any]:
    """The parameters of `Scene` for what a file says. Names of files, and what was read from them, are taken from
    `whole`, the tables of the scene that was read."""
    container = {**said["container"]}
    for key in _classes.table_of("container", container["kind"])["keys"]:
        if key["name"] in container and _classes.names_files(key):
            if key["name"] not in whole["container"]:  # replaced by the points that stand in it
                container = whole["container"]
                break
            container[key["name"]] = whole["container"][key["name"]]
    parts: dict[str, Any] = {"container": _chosen("kind", container), "diameters": None, "radii": None}
    parts["engine"] = _chosen("kind", said["engine"]) if "engine" in said else None
    parts["zones"] = tuple(
        _classes.made("", "zone", {name: _sizes(whole["zone"][k][name] if _names_a_file(value) else value)
                                   for name, value in each.items()})  # fmt: skip
        for k, each in enumerate(said.get("zone", ()))
    )
    parts["stages"] = tuple(_chosen("do", each) for each in said.get("stage", ()))
    parts["outputs"] = tuple(_chosen("format", each) for each in said.get("output", ()))
    for name, key in (("diameters", "diameter"), ("radii", "radius")):
        if key in said["spheres"]:
            sizes = said["spheres"][key]
            parts[name] = _sizes(whole["spheres"][key] if _names_a_file(sizes) else sizes)
    own = {**said, **said["spheres"], **said.get("accuracy", {})}
    parts.update({name: value for name, value in own.items() if name in _KEYS})
    for name in ("start", "inside"):  # which name files
        if name in parts:
            parts[name] = whole["spheres"][name]
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
        for selector in ("kind", "distribution"):
            if selector in value:
                return _chosen(selector, value)
        return {name: _sizes(each) for name, each in value.items()}  # a layer, which is a table and no class
    if isinstance(value, list):
        return [_sizes(each) for each in value]
    return value
