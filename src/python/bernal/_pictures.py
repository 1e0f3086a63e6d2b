"""What is seen of a packing: pictures, and a view to turn."""

from __future__ import annotations

import base64
import html
import os
from pathlib import Path


class Picture:
    """An SVG picture, which notebooks show; `str` gives the SVG."""

    def __init__(self, svg: str) -> None:
        self.svg = svg

    def __str__(self) -> str:
        return self.svg

    def __repr__(self) -> str:
        return f"<Picture, {len(self.svg) / 1000:.0f} kB of SVG>"

    def write(self, file: str | os.PathLike[str]) -> Path:
        """Writes it into a file."""
        path = Path(file)
        path.write_text(self.svg, "utf-8")
        return path

    def _repr_html_(self) -> str:  # an image, so that names of gradients do not clash in a page
        data = base64.b64encode(self.svg.encode()).decode()
        return f'<img alt="" style="max-width:100%;max-height:32em" src="data:image/svg+xml;base64,{data}">'


class View:
    """An HTML page with an interactive view by WebGL, which notebooks show in a frame. It loads nothing else."""

    def __init__(self, page: str, height: int) -> None:
        self.page, self.height = page, height

    def __repr__(self) -> str:
        return f"<View, {len(self.page) / 1000:.0f} kB of HTML>"

    def write(self, file: str | os.PathLike[str]) -> Path:
        """Writes the page into a file, for a browser."""
        path = Path(file)
        path.write_text(self.page, "utf-8")
        return path

    def _repr_html_(self) -> str:
        return (
            f'<iframe srcdoc="{html.escape(self.page)}" style="width:100%;height:{self.height}px;border:0" '
            'title="A view of a packing"></iframe>'
        )
