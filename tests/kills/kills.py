#!/usr/bin/python3
"""Kills a run again and again, by SIGKILL at random moments, and lets it go on: it has to come to the spheres of a run
that nothing disturbed, to lose no more than the interval each time, and to leave nothing behind.

  tests/kills/kills.py COMMAND [--spheres N] [--kills K] [--every SECONDS] [--threads T] [--apart]

`--apart`: each kill hits a run of its own, at a moment of all of its time, and that goes on to its end; otherwise one run
takes all of them.
"""

import argparse
import json
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import time

SCENE = """[container]
kind = "periodic"
[spheres]
count = {spheres}
radius = 1.0
[[stage]]
do = "relax"
alpha = 2.0
"""


def fail(what):
    sys.exit("kills.py: " + what)


class Runs:
    def __init__(self, options, folder):
        self.options = options
        self.scene = folder / "scene.toml"
        self.scene.write_text(SCENE.format(spheres=options.spheres))

    def start(self, out, resume):
        words = [self.options.command, "pack", self.scene, "-o", out, "--no-view", "--threads",
                 str(self.options.threads), "--checkpoint-every", str(self.options.every)]
        return subprocess.Popen(words + ["--resume"] * resume, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                text=True)

    def to_the_end(self, out, resume):
        start = time.monotonic()
        run = self.start(out, resume)
        said = run.communicate()[1]
        if run.returncode != 0:
            fail(f"exit code {run.returncode}: {said}")
        return json.loads((out / "report.json").read_text()), time.monotonic() - start

    def killed_after(self, seconds, out, resume):
        """Whether it lived that long."""
        run = self.start(out, resume)
        try:
            run.wait(seconds)
            return False
        except subprocess.TimeoutExpired:
            run.kill()
            run.communicate()
            return True


def left_in(folder):
    return sorted(entry.name for entry in folder.iterdir() if entry.name.startswith("."))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("command")
    parser.add_argument("--spheres", type=int, default=30000)
    parser.add_argument("--kills", type=int, default=6)
    parser.add_argument("--every", type=float, default=0.2)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--apart", action="store_true")
    options = parser.parse_args()
    moments = random.Random(options.seed)
    folder = pathlib.Path(tempfile.mkdtemp(prefix="bernal-kills-"))
    try:
        runs = Runs(options, folder)
        whole, seconds = runs.to_the_end(folder / "whole", False)
        print(f"undisturbed: {seconds:.1f} s, {whole['hash']}", flush=True)
        seconds = min(seconds, 1.3 * whole["seconds"])  # measuring may take longer than packing
        out = folder / "out"
        kills, resume, ended = 0, False, False
        while kills < options.kills:
            wait = moments.uniform(0, seconds if options.apart else 2.5 * seconds / options.kills)
            if not runs.killed_after(wait, out, resume):
                if not options.apart:
                    ended = True
                    break
                shutil.rmtree(out)
                continue
            kills += 1
            resume = not options.apart
            print(f"killed after {wait:.1f} s; there: {', '.join(left_in(out)) if out.exists() else 'nothing'}",
                  flush=True)
            if options.apart:
                there = any((out / ".bernal-checkpoint" / name).exists() for name in ("latest", "before"))
                report, more = runs.to_the_end(out, True)
                if report["hash"] != whole["hash"]:
                    fail(f"came to {report['hash']}")
                if report["resumed"] != there:
                    fail(f"went on {report['resumed']} times")
                print(f"  went on for {more:.1f} s to the same spheres", flush=True)
                if left_in(out):
                    fail(f"left {left_in(out)}")
                shutil.rmtree(out)
        if not options.apart:
            report = json.loads((out / "report.json").read_text()) if ended else runs.to_the_end(out, True)[0]
            print(f"went on {report['resumed']} times, in all {report['seconds']:.1f} s, to {report['hash']}")
            if report["hash"] != whole["hash"]:
                fail("that is another packing")
            if left_in(out):
                fail(f"left {left_in(out)}")
        print(f"{kills} kills, and the same spheres")
    finally:
        shutil.rmtree(folder)


main()
