"""Progress in a terminal, in a notebook, or for a function of the user's."""

from __future__ import annotations

import html
import math
import shutil
import sys
import time
from collections.abc import Callable
from typing import Any, Union

from . import _errors

Progress = Union[bool, None, Callable[[str, Union[float, None], str], Any]]
"""True: always shown; None: in a terminal or a notebook; False: never. A function is called with the activity
("relax"), the fraction that is done (None if unknown) and a detail in words."""

SILENCE, BETWEEN_LINES = 2.0, 10.0  # seconds


class Silent:
    """Shows nothing."""

    def show(self, activity: str, fraction: float, detail: str) -> None:
        pass

    def say(self, message: str) -> None:
        pass

    def clear(self) -> None:
        pass


class Told(Silent):
    """Calls a function when there is news."""

    def __init__(self, function: Callable[[str, float | None, str], Any]) -> None:
        self._function, self._last = function, ("", -1.0, "")

    def show(self, activity: str, fraction: float, detail: str) -> None:
        if activity and (activity, fraction, detail) != self._last:
            self._last = (activity, fraction, detail)
            self._function(activity, None if fraction < 0 else fraction, detail)


class Shown(Silent):
    """Shows progress after the first two seconds, and then not too often."""

    between = 0.1

    def __init__(self) -> None:
        self._begin = time.monotonic()
        self._next = self._begin + SILENCE
        self._drawn = False

    def show(self, activity: str, fraction: float, detail: str) -> None:
        now = time.monotonic()
        if now < self._next or not activity:
            return
        self._next = now + self.between
        self._drawn = True
        self.draw(math.floor(now - self._begin), activity, fraction, detail)

    def draw(self, seconds: int, activity: str, fraction: float, detail: str) -> None:
        raise NotImplementedError


def _line(seconds: int, activity: str, fraction: float, detail: str) -> str:
    bar = ""
    if fraction >= 0:
        done = int(24 * min(fraction, 1.0))
        bar = f"[{'#' * done}{'.' * (24 - done)}] {100 * fraction:3.0f} %  "
    return f"{seconds:5} s  {activity:<8}  {bar}{detail}"


class Terminal(Shown):
    """One line of standard error, drawn again and again."""

    def draw(self, seconds: int, activity: str, fraction: float, detail: str) -> None:
        width = shutil.get_terminal_size().columns - 1
        self._put("\r\x1b[K" + _line(seconds, activity, fraction, detail)[:width])

    def say(self, message: str) -> None:
        self._put(f"\r\x1b[Kbernal: {message}\n")

    def clear(self) -> None:
        if self._drawn:
            self._put("\r\x1b[K")

    @staticmethod
    def _put(text: str) -> None:
        try:
            sys.stderr.write(text)
            sys.stderr.flush()
        except (OSError, ValueError, AttributeError):  # standard error is closed or missing
            pass  # which is no reason to lose a run


class Lines(Terminal):
    """A line of standard error every ten seconds, for files."""

    between = BETWEEN_LINES

    def draw(self, seconds: int, activity: str, fraction: float, detail: str) -> None:
        self._put(_line(seconds, activity, fraction, detail) + "\n")

    def say(self, message: str) -> None:
        self._put(f"bernal: {message}\n")

    def clear(self) -> None:
        pass


class _Cell:
    """An output of a notebook: HTML, or the same in words."""

    def __init__(self, page: str, words: str) -> None:
        self._page, self._words = page, words

    def _repr_html_(self) -> str:
        return self._page

    def __repr__(self) -> str:
        return self._words


class Notebook(Shown):
    """A bar below the cell, removed at the end."""

    between = 0.25

    def __init__(self, display: Callable[..., Any]) -> None:
        super().__init__()
        self._display, self._handle = display, None

    def draw(self, seconds: int, activity: str, fraction: float, detail: str) -> None:
        bar = (
            f'<progress max="1" value="{min(fraction, 1.0):.3f}"></progress>'
            if fraction >= 0
            else "<progress></progress>"
        )
        words = html.escape(f"{activity}, {seconds} s" + (f": {detail}" if detail else ""))
        self._put(_Cell(
            f'<div style="display:flex;gap:.8em;align-items:center">{bar}<span>{words}</span></div>',
            _line(seconds, activity, fraction, detail),
        ))  # fmt: skip

    def say(self, message: str) -> None:
        self._drawn = True
        self._put(_Cell(f"<div>bernal: {html.escape(message)}</div>", f"bernal: {message}"))

    def clear(self) -> None:
        if self._drawn:
            self._put(_Cell("", ""))

    def _put(self, cell: _Cell) -> None:
        if self._handle is None:
            self._handle = self._display(cell, display_id=True)
        else:
            self._handle.update(cell)


def _notebook() -> Callable[..., Any] | None:
    """IPython's display function, if a notebook runs this."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython and hasattr(ipython, "get_ipython") else None
    if shell is None or not hasattr(shell, "kernel"):
        return None
    from IPython.display import display

    return display  # type: ignore[no-any-return]


def display_of(progress: Progress) -> Silent:
    if callable(progress):
        return Told(progress)
    if progress is not None and not isinstance(progress, bool):
        raise _errors.InputError("bad_argument", f"progress is True, False, None or a function, not {progress!r:.80}")
    if progress is False:
        return Silent()
    notebook = _notebook()
    if notebook:
        return Notebook(notebook)
    if _is_terminal(sys.stderr):
        return Terminal()
    return Lines() if progress else Silent()


def _is_terminal(stream: Any) -> bool:
    try:
        return bool(stream.isatty())
    except (AttributeError, ValueError, OSError):  # no stream, a closed one, or one without isatty
        return False
