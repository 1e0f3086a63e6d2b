#!/usr/bin/env python3
"""Ctrl-C, progress, and runs side by side."""

import gc
import io
import os
import signal
import subprocess
import sys
import threading
import time
import unittest
import warnings
from contextlib import redirect_stderr
from unittest import mock

from support import InFolder, small

import bernal
from bernal import _jobs, _progress

LONG = {"count": 30_000, "stages": bernal.Relax(alpha=100)}  # minutes


def interrupt():
    os.kill(os.getpid(), signal.SIGINT)


class CtrlC(InFolder):
    def stopped(self, **keys):
        with self.assertWarnsRegex(bernal.Stopped, "stopped by Ctrl-C"):
            packing = bernal.pack(small(**LONG), **keys)
        self.assertEqual(packing.outcome, "cancelled")
        self.assertEqual(len(packing), 30_000)
        self.assertTrue(bernal.verify(packing))
        return packing

    def test_in_the_middle_of_a_run_it_returns_the_partial_packing(self):
        timer = threading.Timer(1.0, interrupt)
        timer.start()
        packing = self.stopped(progress=False)
        timer.join()
        self.assertLess(packing.packing_fraction, 0.6)
        packing.write("out")
        self.assertTrue(bernal.verify("out"))

    def test_while_progress_is_shown_too(self):
        told = []

        def tell(activity, fraction, detail):
            told.append((activity, fraction, detail))
            if activity == "relax" and not any(activity == "relax" for activity, _, _ in told[:-1]):
                interrupt()

        self.stopped(progress=tell)
        self.assertIn("spheres", told[-1][2])
        self.assertTrue(all(fraction is None or 0 <= fraction <= 1 for _, fraction, _ in told))

    def test_the_warning_can_be_an_error_that_ends_a_loop(self):
        timer = threading.Timer(0.5, interrupt)
        timer.start()
        with warnings.catch_warnings(), self.assertRaises(bernal.Stopped):
            warnings.simplefilter("error", bernal.Stopped)
            bernal.pack(small(**LONG), progress=False)
        timer.join()

    def test_the_second_one_raises_at_once(self):
        class Stubborn:
            """Work that stops at no safe point."""

            asked, waits = 0, 0

            def wait(self, seconds):
                self.waits += 1
                if self.waits in (2, 5):
                    raise KeyboardInterrupt
                return False

            def progress(self):
                return "relax", 0.5, ""

            def cancel(self):
                self.asked += 1

        job, said = Stubborn(), io.StringIO()
        with redirect_stderr(said), self.assertRaises(KeyboardInterrupt):
            _jobs.finish(job, True, leaves_something=True)
        self.assertEqual(job.waits, 5)
        self.assertGreaterEqual(job.asked, 1)
        self.assertIn("once more interrupts for good", said.getvalue())

    def test_where_nothing_would_be_left_the_first_one_raises(self):
        packing = bernal.pack(bernal.Scene(bernal.Box([60] * 3), diameters=1, count=100_000, stages=bernal.Insert()))
        timer = threading.Timer(0.2, interrupt)
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            for _ in range(1000):
                bernal.measure(packing)
        timer.join()

    def test_an_exception_of_the_users_function_ends_the_run(self):
        def fail(activity, fraction, detail):
            raise ZeroDivisionError

        begin = time.monotonic()
        with self.assertRaises(ZeroDivisionError):
            bernal.pack(small(**LONG), progress=fail)
        self.assertLess(time.monotonic() - begin, 60)

    def test_a_program_ends_though_something_runs(self):
        program = (
            "import bernal, threading, time\n"
            "s = bernal.Scene(bernal.Periodic(), diameters=1, count=30000, stages=bernal.Relax(alpha=100))\n"
            "threading.Thread(target=bernal.pack, args=(s,), daemon=True).start()\n"
            "time.sleep(0.5)\n"
        )
        ended = subprocess.run([sys.executable, "-c", program], timeout=60)
        self.assertEqual(ended.returncode, 0)

    def test_a_program_ends_though_threads_go_on_beginning(self):
        program = (
            "import bernal, threading, time, sys\n"
            "s = bernal.Scene(bernal.Periodic(edge=6), diameters=1, unit='mm')\n"
            "def work():\n"
            "    while True: bernal.pack(s, threads=1)\n"
            "for _ in range(3): threading.Thread(target=work, daemon=True).start()\n"
            "time.sleep(float(sys.argv[1]))\n"
        )
        for seconds in (0.1, 0.2, 0.35):
            with self.subTest(seconds):
                ended = subprocess.run(
                    [sys.executable, "-c", program, str(seconds)], timeout=60, capture_output=True, text=True
                )
                self.assertEqual((ended.returncode, ended.stderr), (0, ""))

    def test_a_program_ends_though_threads_go_on_being_refused(self):
        program = (
            "import bernal, threading, time\n"
            "def work():\n"
            "    while True:\n"
            "        try: bernal.Scene(bernal.Periodic(edge=-1), diameters=1)\n"
            "        except bernal.Error: pass\n"
            "for _ in range(3): threading.Thread(target=work, daemon=True).start()\n"
            "time.sleep(0.3)\n"
        )
        for _ in range(3):
            ended = subprocess.run([sys.executable, "-c", program], timeout=60, capture_output=True, text=True)
            self.assertEqual((ended.returncode, ended.stderr), (0, ""))

    def test_nothing_begins_once_a_program_has_ended(self):
        program = (
            "import atexit\n"
            "def late():\n"
            "    try: bernal.predict(1)\n"
            "    except RuntimeError as error: print(error)\n"
            "atexit.register(late)\n"
            "import bernal\n"
        )
        ended = subprocess.run([sys.executable, "-c", program], timeout=60, capture_output=True, text=True)
        self.assertIn("the program ends", ended.stdout)

    def test_a_forked_process_ends_though_its_parent_goes_on(self):
        program = (
            "import bernal, threading, time, os, sys\n"
            "s = bernal.Scene(bernal.Periodic(), diameters=1, count=30000, stages=bernal.Relax(alpha=100))\n"
            "threading.Thread(target=bernal.pack, args=(s,), daemon=True).start()\n"
            "time.sleep(0.5)\n"
            "child = os.fork()\n"
            "sys.exit(0 if child == 0 else os.waitpid(child, 0)[1])\n"
        )
        self.assertEqual(subprocess.run([sys.executable, "-c", program], timeout=60).returncode, 0)


class SideBySide(InFolder):
    def test_several_threads_pack_at_once_and_alike(self):
        asked = {seed: bernal.pack(small(), seed=seed).hash for seed in (1, 2)}
        made = []
        threads = [
            threading.Thread(
                target=lambda seed: made.append((seed, bernal.pack(small(), seed=seed).hash)), args=(k % 2 + 1,)
            )
            for k in range(6)
        ]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(sorted(made), sorted([*asked.items()] * 3))

    def test_python_goes_on_while_it_packs(self):
        counted = 0
        thread = threading.Thread(target=lambda: bernal.pack(small(count=5000), progress=False))
        thread.start()
        while thread.is_alive():
            counted += 1
            time.sleep(0.001)
        self.assertGreater(counted, 20)

    def test_what_is_forgotten_is_gone(self):
        for _ in range(20):
            packing = bernal.pack(small(count=50))
        view = packing.radii
        del packing
        gc.collect()
        self.assertEqual(len(view), 50)


class Progress(InFolder):
    def draw(self, display):
        with mock.patch.object(time, "monotonic", side_effect=[0.0, 1.0, 3.0, 3.01, 20.0]):
            shown = display()
            for _ in range(4):
                shown.show("relax", 0.5, "300 spheres")
        return shown

    def test_a_terminal_gets_one_line_that_goes_again(self):
        with redirect_stderr(io.StringIO()) as out, mock.patch.dict(os.environ, COLUMNS="60"):
            self.draw(_progress.Terminal).clear()
        drawn = out.getvalue().split("\r\x1b[K")
        self.assertEqual(len(drawn), 4)  # nothing, after 3 s, after 20 s, nothing
        self.assertEqual(drawn[1], "    3 s  relax     [############............]  50 %  300 spheres"[:59])
        self.assertEqual(drawn[3], "")

    def test_a_file_gets_lines(self):
        with redirect_stderr(io.StringIO()) as out:
            self.draw(_progress.Lines).clear()
        self.assertEqual(len(out.getvalue().splitlines()), 2)

    def test_a_notebook_gets_a_bar_that_goes_again(self):
        cells = []

        class Handle:
            def update(self, cell):
                cells.append(cell)

        def display(cell, display_id):
            cells.append(cell)
            return Handle()

        self.draw(lambda: _progress.Notebook(display)).clear()
        self.assertEqual(len(cells), 3)
        self.assertIn('<progress max="1" value="0.500">', cells[0]._repr_html_())
        self.assertIn("300 spheres", cells[0]._repr_html_())
        self.assertEqual(cells[-1]._repr_html_(), "")

    def test_a_stream_that_is_none_or_closed_shows_nothing_and_loses_nothing(self):
        closed = io.StringIO()
        closed.close()
        for stream in (None, closed, object()):
            with mock.patch.object(sys, "stderr", stream):
                self.assertIs(type(_progress.display_of(None)), _progress.Silent)
                self.draw(_progress.Lines).clear()

    def test_nothing_is_shown_where_nobody_looks(self):
        with redirect_stderr(io.StringIO()) as out:
            self.assertIs(type(_progress.display_of(None)), _progress.Silent)
            self.assertIs(type(_progress.display_of(True)), _progress.Lines)
            bernal.pack(small())
        self.assertEqual(out.getvalue(), "")


if __name__ == "__main__":
    unittest.main()
