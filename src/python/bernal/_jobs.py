"""Waiting for what takes time: it runs in a thread of its own, so that interrupts are heard at once."""

from __future__ import annotations

import atexit
import signal
import threading
from typing import Any

from . import _core
from ._progress import Progress, display_of


class Stopped(UserWarning):
    """A run was stopped by Ctrl-C, and what it had is what `pack` returned.

    `warnings.simplefilter("error", bernal.Stopped)` makes an exception of it, which ends loops over runs.
    """


def finish(job: Any, progress: Progress, leaves_something: bool = False) -> Any:
    """The job's result. Where it `leaves_something`, the first Ctrl-C stops it at its next safe point, and what
    it has by then is the result; the second raises KeyboardInterrupt, as every one does elsewhere. The thread
    then ends by itself. A KeyboardInterrupt that `progress` raises is one by Ctrl-C, which arrives there, too. Where
    the program has ended in the main thread meanwhile, others end here."""
    display = display_of(progress)
    stopped = False
    try:
        while True:
            try:
                while not job.wait(0.05):
                    display.show(*job.progress())
                break
            except KeyboardInterrupt:
                if stopped or not leaves_something or job.progress()[0] in ("", "estimate"):
                    raise
                stopped = True
                job.cancel()
                display.say("stopping at the next safe point; once more interrupts for good")
    except BaseException:
        job.cancel()
        raise
    finally:
        display.clear()
    if _core.is_ending_elsewhere():
        raise SystemExit  # which ends a thread without a word
    return job.result()


def _end() -> None:
    """Threads that were left to themselves use what is about to be taken down."""
    if threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    _core.stop_all_jobs()


atexit.register(_end)
