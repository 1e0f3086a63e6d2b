"""What a notebook shows of a packing."""

from __future__ import annotations

import html
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ._packing import Packing


def page_of(packing: Packing, is_amber: bool) -> str:
    """A table of what it is, and its picture. Amber, which can be read on white and on black, for the outcome of a run
    that ended without what was asked."""

    def colour(row: str) -> str:
        return ' style="color:#b87400;font-weight:600"' if row == "outcome" and is_amber else ""

    fraction = packing.expected_packing_fraction
    expected = f" ({fraction:.3f} was expected)" if fraction > 0 else ""
    size = " × ".join(f"{edge:.4g}" for edge in packing.bounds[1] - packing.bounds[0])
    noun = "discs" if packing.dimension == 2 else "spheres"
    rows = {
        noun: f"{len(packing):,} in a {packing._core.domain()} of {size} {packing.unit}",
        "packing fraction": f"{packing.packing_fraction:.4f}{expected}",
        "outcome": f"{packing.outcome}: {packing.reason}" if packing.reason else packing.outcome,
    }
    if len(packing):
        low, high = packing.diameters.min(), packing.diameters.max()
        range_of = f"{low:.4g}" if low == high else f"{low:.4g} to {high:.4g}"
        rows["diameters"] = f"{range_of} {packing.unit}"
    cells = "".join(
        f'<div style="opacity:.65">{name}</div><div{colour(name)}>{html.escape(text)}</div>'
        for name, text in rows.items()
    )
    picture = packing.picture._repr_html_() if packing.dimension in (2, 3) else ""
    return (
        '<div style="display:grid;grid-template-columns:max-content 1fr;gap:.2em 1.2em;max-width:44em">'
        f"{cells}</div>{picture}"
    )
