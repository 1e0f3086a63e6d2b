#!/usr/bin/python3
"""Imports what other programs write: tests/clients/with_import.py [BERNAL]

LAMMPS and YADE press soft spheres together: imported, refused by verify for their overlaps, packed on from there by a
scene, certified. LIGGGHTS, LAMMPS, ASE, gsd and NumPy write packings of known numbers, which come back. A program that is
not installed is left out with a word. Debian: lammps liggghts yade python3-ase python3-gsd python3-numpy. Takes 15 seconds.
"""
import csv

from client import *

HERE = Path(__file__).resolve().parent / "import"


def bernal(*words):
    return subprocess.run([BERNAL, *map(str, words)], capture_output=True, text=True)


def imported(place, file, *options):
    ended = bernal("import", file, "-o", place / "imported", *options)
    expect(ended.returncode == 0, f"{file.name}: imported {ended.stderr if ended.returncode else ''}")
    return ended.stderr


def spheres_of(place):
    with open(place / "imported" / "spheres.csv") as file:
        rows = [line for line in file if not line.startswith("#")]
    return [[float(row[key]) for key in "xyzr"] for row in csv.DictReader(rows)]


def close(rows, expected, tolerance):
    return len(rows) == len(expected) and all(
        abs(a - b) <= tolerance for row, other in zip(rows, expected) for a, b in zip(row, other))


def densify(place, name):
    """From the folder `imported`: refused as it is, certified once it has been packed on."""
    report = json.loads((place / "imported" / "report.json").read_text())
    verified = bernal("verify", place / "imported", "--list=10")
    expect(verified.returncode == 1 and verified.stdout.count("\noverlap ") == 10, f"{name}: refused, ten overlaps listed")
    shutil.copy(HERE / "dense.toml", place)
    packed = bernal("pack", place / "dense.toml", "-o", place / "dense", "--quiet")
    dense = json.loads((place / "dense" / "report.json").read_text())
    expect(packed.returncode == 0 and dense["n"] == report["n"], f"{name}: packed on, {packed.stderr}")
    expect(bernal("verify", place / "dense").returncode == 0, f"{name}: certified")
    print(f"       {name}: packing fraction {report['phi']:.4f}, overlaps up to {report['max_overlap']:.3g};"
          f" certified {dense['phi']:.4f}")


def with_lammps(place):
    subprocess.run(["lmp", "-in", HERE / "compress.in"], cwd=place, check=True, stdout=subprocess.DEVNULL)
    said = imported(place, place / "pressed.dump")
    expect("frame 2 of 2" in said and "periodic box, 0.0965 x" in said, "LAMMPS: the last frame and its box")
    densify(place, "LAMMPS")
    # There and back: what LAMMPS reads of ours it writes again, to the bit.
    bernal("export", place / "dense", "--to", "lammps", "-o", place / "ours.data", "--quiet")
    (place / "again.in").write_text(
        "units si\natom_style sphere\nboundary p p p\nread_data ours.data\npair_style zero 0.01\npair_coeff * *\n"
        "run 0\nwrite_data again.data\n")
    subprocess.run(["lmp", "-in", "again.in"], cwd=place, check=True, stdout=subprocess.DEVNULL)
    before = (place / "dense" / "spheres.csv").read_text()
    imported(place, place / "again.data", "--unit", "m")
    expect((place / "imported" / "spheres.csv").read_text() == before, "LAMMPS: write_data gives our spheres, to the bit")


def with_yade(place):
    subprocess.run(["yade", "-n", "-x", HERE / "press_yade.py"], cwd=place, check=True, stdout=subprocess.DEVNULL,
                   stderr=subprocess.DEVNULL)
    imported(place, place / "yade.txt", "--unit", "m", "--box", (place / "yade.box").read_text())
    densify(place, "YADE")


def with_liggghts(place):
    (place / "s.toml").write_text('unit = "m"\n[container]\nkind = "box"\nsize = [0.1, 0.1, 0.1]\n'
                                  "[spheres]\ncount = 200\nradius = 0.005\n")
    bernal("pack", place / "s.toml", "-o", place / "box", "--quiet")
    bernal("export", place / "box", "--to", "liggghts", "-o", place / "l.data", "--quiet")
    script = (place / "l.in").read_text().replace(
        "run 1000", "dump d all custom 1 l.dump id type x y z radius\nrun 0\nwrite_data l.out")
    (place / "l.in").write_text(script)
    subprocess.run(["liggghts", "-in", "l.in"], cwd=place, check=True, stdout=subprocess.DEVNULL)
    said = imported(place, place / "l.dump", "--unit", "m", "--container", place / "s.toml")
    expect("200, diameter 0.01 m" in said, "LIGGGHTS: a dump, in the container of a scene")
    imported(place, place / "l.out", "--unit", "m", "--container", place / "s.toml")
    expect((place / "imported" / "spheres.csv").read_text() == (place / "box" / "spheres.csv").read_text(),
           "LIGGGHTS: write_data gives our spheres, to the bit")


def with_modules(place):
    numpy = find_module("numpy", "python3-numpy")
    if numpy is None:
        return
    rows = numpy.random.default_rng(1).random((50, 4)) * [8, 8, 8, 0.5] + [1, 1, 1, 0.1]
    numpy.save(place / "a.npy", numpy.asfortranarray(rows.astype(">f4")))
    imported(place, place / "a.npy", "--unit", "mm")
    expect(close(spheres_of(place), rows, 1e-6), "NumPy: Fortran order, big-endian, single precision")
    if (ase := find_module("ase", "python3-ase")) is not None:
        from ase.io import write
        atoms = ase.Atoms("X50", positions=rows[:, :3], cell=[10, 10, 10], pbc=[1, 1, 0])
        atoms.set_array("radius", rows[:, 3].copy())
        write(place / "a.extxyz", [atoms[:7], atoms])
        said = imported(place, place / "a.extxyz", "--unit", "mm")
        expect(close(spheres_of(place), rows, 1e-7) and "periodic but along axis 2" in said, "ASE: extended XYZ")
    if find_module("gsd", "python3-gsd") is not None:
        import gsd.hoomd
        make = getattr(gsd.hoomd, "Frame", None) or gsd.hoomd.Snapshot
        with gsd.hoomd.open(str(place / "a.gsd"), "wb") as trajectory:
            for k in range(40):
                frame = make()
                frame.particles.N = 50
                frame.particles.position = rows[:, :3] - 5 if k == 39 else numpy.zeros((50, 3))
                if k == 0:  # the others have the first's
                    frame.particles.diameter = 2 * rows[:, 3]
                    frame.configuration.box = [10, 10, 10, 0, 0, 0]
                trajectory.append(frame)
        said = imported(place, place / "a.gsd", "--unit", "mm")
        expect(close(spheres_of(place), rows, 2e-6) and "frame 40 of 40" in said, "gsd: the last of 40 frames")


def work(place):
    if find_program("lmp", "lammps"):
        with_lammps(place)
    if find_program("yade", "yade"):
        with_yade(place)
    if find_program("liggghts", "liggghts"):
        with_liggghts(place)
    with_modules(place)


in_folder(work)
