"""Waiting for jobs, which run in threads of their own, so that Python reacts to interrupts at once."""

from __future__ import annotations

import atexit
import signal
import threading
from typing import Any

from . import _core
from ._progress import Progress, display_of


class NotReached(UserWarning):
    """A run ended without what its scene asks for: it is full, loose, or came to a limit. The packing is valid.

    `warnings.simplefilter("error", bernal.NotReached)` turns it into an exception.
    """


NOT_REACHED = ("full", "loose", "hit_limit", "cancelled")
"""The outcomes of such runs."""


class Stopped(NotReached):
    """Ctrl-C stopped a run, and `pack` returned the spheres that it had placed.

    `warnings.simplefilter("error", bernal.Stopped)` turns it into an exception, which ends a loop over runs.
    """


def finish(job: Any, progress: Progress, leaves_something: bool = False) -> Any:
    """Waits for a job and returns its result.

    If the job `leaves_something`, the first Ctrl-C stops it at its next safe point, and the result is what it has by
    then; the second raises KeyboardInterrupt. For other jobs the first one does. The job's thread ends by itself. A
    KeyboardInterrupt from `progress` counts as Ctrl-C, which may arrive there. If the main thread has ended the
    program meanwhile, other threads end here.
    """
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
        raise SystemExit  # ends the thread silently
    return job.result()


def _end() -> None:
    """Ends the threads of jobs that nobody waits for, before the interpreter destroys what they use."""
    if threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    _core.stop_all_jobs()


atexit.register(_end)
