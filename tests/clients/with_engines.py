#!/usr/bin/python3
"""LAMMPS and LIGGGHTS find the places of data/engines over MPI, and what bernal makes of them is certified:
tests/clients/with_engines.py [BERNAL]

Debian: lammps, liggghts, openmpi-bin. Takes a minute.
"""
import os
import signal
import time

from client import *

LMP = find_program("lmp", "lammps")
LIGGGHTS = find_program("liggghts", "liggghts")
MPIRUN = find_program("mpirun", "openmpi-bin")
if not (LMP or LIGGGHTS):
    sys.exit(SKIPPED)


def packed(scene, folder, *options):
    run(BERNAL, "pack", scene, "-o", folder, "--quiet", *options, folder=DATA)
    run(BERNAL, "verify", folder, folder=DATA)
    return json.loads((folder / "report.json").read_text())


def alone(scene):
    """The scene on one rank, without a launcher."""
    return scene.replace("ranks = 2\n", "")


def examples(folder):
    for scene in sorted((DATA / "engines").glob("*.toml")):
        program = LMP if 'kind = "lammps"' in scene.read_text() else LIGGGHTS
        if not program or not MPIRUN:
            continue
        report = packed(scene, folder / scene.stem)
        expect(report["certified"] and report["outcome"] == "converged",
               f"{scene.stem}: {report['n']} spheres, packing fraction {report['phi']:.4f}, certified")
        expect(any(effect["name"] == "engine" for effect in report["effects"]), f"{scene.stem}: by the engine")
        left = sorted(file.name for file in (folder / scene.stem / "engine").iterdir())
        expect(len(left) == 3 and "output.txt" in left, f"{scene.stem}: its script and logs stay: {left}")


def one_seed(folder):
    text = (DATA / "engines/lammps_periodic.toml").read_text().replace("10000", "2000")
    for name, scene in (("one rank", alone(text)), ("two ranks", text)):
        if name == "two ranks" and not MPIRUN:
            continue
        (folder / "seed.toml").write_text(scene)
        hashes = [packed(folder / "seed.toml", folder / f"{name} {k}")["hash"] for k in range(2)]
        expect(hashes[0] == hashes[1], f"{name}: one seed, one packing")
    dense = packed(folder / "seed.toml", folder / "dense")
    expect(dense["phi"] >= 0.63, f"2,000 equal spheres: packing fraction {dense['phi']:.4f}")


SHAPES = {
    "sphere": ('kind = "sphere"\nradius = 10\ncenter = [5, -3, 1]', "lammps"),
    "column": ('kind = "cylinder"\nradius = 8\nheight = 20\nperiodic = true', "lammps"),
    "between walls": ('kind = "periodic"\nsize = [15, 16, 17]\nwalls = [1]', "lammps"),
    "box of LIGGGHTS": ('kind = "box"\nsize = [15, 16, 17]', "liggghts"),
    "cylinder of LIGGGHTS": ('kind = "cylinder"\nradius = 8\nheight = 20\naxis = [0, 1, 0]', "liggghts"),
    "periodic box of LIGGGHTS": ('kind = "periodic"\nedge = 16', "liggghts"),
}
WIDE = 'diameter = { distribution = "lognormal", median = 1.2, sigma = 0.5, max = 4.5 }'


def shapes(folder):
    for name, (container, kind) in SHAPES.items():
        if not (LMP if kind == "lammps" else LIGGGHTS):
            continue
        for sizes in ("diameter = 1.5", WIDE):
            (folder / "shape.toml").write_text(f"[container]\n{container}\n[spheres]\npacking_fraction = 0.5\n{sizes}\n"
                                               f'[engine]\nkind = "{kind}"\n')
            report = packed(folder / "shape.toml", folder / "shape")
            expect(report["outcome"] == "converged", f"{name}, {sizes}: packing fraction {report['phi']:.4f}")
    if LMP:
        for count in (1, 2, 3):
            (folder / "few.toml").write_text(f'[container]\nkind = "periodic"\n[spheres]\ncount = {count}\nradius = 1\n'
                                             '[engine]\nkind = "lammps"\n')
            expect(packed(folder / "few.toml", folder / "few")["n"] == count, f"{count} in a periodic box")


def poured(folder):
    """As far as friction holds them up, and no sphere in the air; the looser the rougher."""
    fractions = []
    for friction in (0.1, 0.6):
        (folder / "poured.toml").write_text('[container]\nkind = "cylinder"\nradius = 3\nheight = 14\n[spheres]\n'
                                            'count = 300\ndiameter = 1\n[engine]\nkind = "liggghts"\npour = true\n'
                                            f"friction = {friction}\n")
        report = packed(folder / "poured.toml", folder / "poured")
        expect(report["outcome"] == "converged" and report["n"] == 300, f"friction {friction}: {report['reason']}")
        heights = [float(line.split(",")[2]) for line in (folder / "poured/spheres.csv").read_text().splitlines()[2:]]
        fractions.append(300 / 6 / (9 * 2 * sum(heights) / 300))
    expect(0.5 < fractions[1] < fractions[0] - 0.01 < 0.62, f"poured: packing fractions {fractions}")
    run = subprocess.run([BERNAL, "pack", folder / "poured/scene.toml", "-o", folder / "again"], capture_output=True)
    expect(run.returncode == 0, f"the scene of a result that was poured runs again: {run.stderr}")
    (folder / "high.toml").write_text('[container]\nkind = "cylinder"\nradius = 3\nheight = 8\n[spheres]\n'
                                      'count = 300\ndiameter = 1\n[engine]\nkind = "liggghts"\npour = true\n')
    run = subprocess.run([BERNAL, "pack", folder / "high.toml", "-o", folder / "high"], capture_output=True, text=True)
    expect(run.returncode == 2 and "lie outside the container" in run.stderr, f"above the brim: {run.stderr}")


def slabs(folder):
    """As dense as all at once, in any number of slabs, of equal sizes and of others."""
    for sizes, least in (("diameter = 1.0", 0.63),
                         ('diameter = { distribution = "lognormal", median = 1.0, sigma = 0.3, max = 1.8 }', 0.65)):
        for count in (2, 3):
            (folder / "slabs.toml").write_text(f'[container]\nkind = "periodic"\n[spheres]\ncount = 10000\n{sizes}\n'
                                               f'[engine]\nkind = "lammps"\nkeep = true\nslabs = {count}\n')
            report = packed(folder / "slabs.toml", folder / "slabs")
            expect(report["certified"] and report["phi"] >= least,
                   f"{count} slabs, {sizes}: packing fraction {report['phi']:.4f}")


def interrupted(folder):
    """Ctrl-C ends the engine's processes too."""
    (folder / "long.toml").write_text('[container]\nkind = "periodic"\n[spheres]\ncount = 20000\nradius = 1\n'
                                      '[engine]\nkind = "lammps"\nranks = 2\nsteps = 1000000\n')
    process = subprocess.Popen([BERNAL, "pack", "long.toml", "-o", "long"], cwd=folder, stderr=subprocess.PIPE)
    log = folder / "long/engine/log.lammps"
    for _ in range(600):
        if log.exists() and "Step" in log.read_text():
            break
        time.sleep(0.1)
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=60)
    expect(process.returncode == 3, "Ctrl-C: ends with 3")
    time.sleep(1)
    there = [pid for pid in os.listdir("/proc") if pid.isdigit() and cwd_of(pid).startswith(str(folder / "long"))]
    expect(not there, f"Ctrl-C: no process of the engine is left {there}")


def cwd_of(pid):
    try:
        return os.readlink(f"/proc/{pid}/cwd")
    except OSError:
        return ""


def work(folder):
    examples(folder)
    if LMP:
        one_seed(folder)
        slabs(folder)
    shapes(folder)
    if LIGGGHTS:
        poured(folder)
    if LMP and MPIRUN:
        interrupted(folder)


in_folder(work)
