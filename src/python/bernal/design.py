"""Searches for sizes that pack densest, or to a given packing fraction, by the rod model; `bernal.predict` says how good
it is.

In the answers `diameters` is a size distribution: `bernal.Scene(…, diameters=answer.diameters)`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from . import _classes, _core, _records, _toml
from ._classes import Sizes
from ._errors import InputError
from ._jobs import finish
from ._progress import Progress
from ._records import Prediction
from ._work import _rods, scene_of_sizes

__all__ = ["maximise", "target", "best", "density", "relative_viscosity"]


def _answer(answer: Any) -> Prediction:
    made: Prediction = _records.record(Prediction, answer)
    return made


def maximise(populations: Iterable[float | Sizes], *, rods: int = 16000, progress: Progress = None) -> Prediction:
    """Finds the densest mixture of two to six populations, diameters or distributions: `maximise([1, 3, 9])`.

    Returns phi, error, rods, shares (of the volume, in the order given), diameters (the mixture), and how reliable the
    search was: of `starts` searches `agreeing` ended within 0.00001 of the best, the worst one `spread` below it.
    """
    parts = [*populations]
    answer = _answer(finish(_core.maximise([scene_of_sizes(part) for part in parts], _rods(rods)), progress))
    mixed = [(part, round(share, 6)) for part, share in zip(parts, answer.shares) if round(share, 6) > 0]
    answer["diameters"] = _mixture([part for part, _ in mixed], [share for _, share in mixed])
    return answer


def target(
    phi: float,
    family: Callable[[float], Sizes] | None = None,
    narrow: float = 1e-3,
    wide: float = 3.0,
    *,
    rods: int = 16000,
    progress: Progress = None,
) -> Prediction:
    """Finds the member of a family of sizes that packs to `phi`: `target(0.7)` gives lognormal sizes of sigma 0.4619.

    family : a function that returns the distribution for a number from `narrow` to `wide`; the smallest number that
        packs to `phi` is taken. Without it lognormal sizes by volume, whose number is sigma.
    Returns found, parameter, diameters, phi, error, rods; where nothing is found, `reachable` says what the family
    reaches, from the least to the most, and the sizes are those that come nearest.
    """
    if not 0 < (phi := _toml.number(phi, "phi")) < 1:
        raise InputError("bad_argument", f"a packing fraction lies between 0 and 1, not at {phi}")
    member = family if family is not None else lambda sigma: _classes.CLASSES["Lognormal"](1, sigma, basis="volume")
    ends = _toml.number(narrow, "narrow"), _toml.number(wide, "wide")
    job = _core.target(lambda number: scene_of_sizes(member(number)), *ends, phi, _rods(rods))
    answer = _answer(finish(job, progress))
    answer["diameters"] = member(answer.parameter)
    return answer


def best(
    smallest: float, largest: float, count: int = 3, *, rods: int = 16000, progress: Progress = None
) -> Prediction:
    """Finds the `count` diameters from `smallest` to `largest`, both included, that pack densest, and their shares of
    the volume."""
    count = _toml.whole(count, "count", _toml.INT)
    answer = _answer(finish(_core.densest_sizes(_size(smallest), _size(largest), count, _rods(rods)), progress))
    values = [2 * radius for radius in answer.pop("radii")]
    pairs = [(value, share) for value, share in zip(values, answer.shares) if share > 0]
    answer["values"] = values
    answer["diameters"] = _mixture([value for value, _ in pairs], [share for _, share in pairs])
    return answer


def density(
    smallest: float, largest: float, bins: int = 16, *, rods: int = 16000, progress: Progress = None
) -> Prediction:
    """Finds the size density by volume that packs densest, in 2, 4, 8, 16, 32 or 64 bins on a logarithmic axis from
    `smallest` to `largest`, as a sieve curve. `levels` says what fewer bins reach, `power_law_phi` what the best power
    law does."""
    bins = _toml.whole(bins, "bins", _toml.INT)
    answer = _answer(finish(_core.densest_density(_size(smallest), _size(largest), bins, _rods(rods)), progress))
    edges, passing = [2 * radius for radius in answer.pop("radii")], [0.0]
    for share in answer.shares:
        passing.append(min(passing[-1] + 100 * share, 100.0))
    answer["diameters"] = _classes.CLASSES["Sieve"](edges, [*passing[:-1], 100.0])
    return answer


def relative_viscosity(solids: float, phi: float, intrinsic: float = 2.5) -> float:
    """The viscosity of a suspension over that of its liquid, with a volume fraction `solids` of spheres that pack to
    `phi` (Krieger and Dougherty)."""
    return float(_core.relative_viscosity(*(_toml.number(each, "a fraction") for each in (solids, phi, intrinsic))))


def _size(value: float) -> float:
    return _toml.number(value, "a diameter")


def _mixture(parts: list[Any], shares: list[float]) -> Sizes:
    name = "Mixture" if any(isinstance(part, Sizes) for part in parts) else "Classes"
    if len(parts) == 1:
        only = parts[0] if isinstance(parts[0], Sizes) else _classes.CLASSES["Constant"](parts[0])
    else:
        only = _classes.CLASSES[name](parts, shares, basis="volume")
    assert isinstance(only, Sizes)
    return only
