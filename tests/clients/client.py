"""What the scripts beside this one share: they pack a scene, export it, and let a program read it.

Each takes bernal's command as its first argument (build/release/bernal without one) and ends with 0 where all held, with
1 where something did not, and with 77, which CTest calls skipped, where the program is not installed.
"""
import json
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ARGUMENTS = [word for word in sys.argv[1:] if not word.startswith("--")]
BERNAL = str(Path(ARGUMENTS[0] if ARGUMENTS else "build/release/bernal").resolve())
DATA = Path(__file__).resolve().parents[2] / "data"
SKIPPED = 77

PERIODIC = """unit = "mm"
[container]
kind = "periodic"
[spheres]
count = 500
packing_fraction = 0.55
diameter = { distribution = "lognormal", median = 1.0, sigma = 0.3 }
"""
CYLINDER = """unit = "mm"
[container]
kind = "cylinder"
radius = 5
height = 12
base = [1, 2, 3]
[spheres]
packing_fraction = 0.5
diameter = { distribution = "classes", values = [0.8, 1.2], shares = [0.5, 0.5] }
"""
HOPPER = f"""unit = "m"
[container]
kind = "mesh"
file = "{DATA}/meshes/hopper.stl"
unit = "m"
[spheres]
packing_fraction = 0.45
diameter = 0.12
"""
METRES = {"m": 1, "cm": 1e-2, "mm": 1e-3, "um": 1e-6}

failures = 0


def find_program(name, package):
    """Where it is; None, with a word on how to install it, where it is not."""
    found = shutil.which(name)
    if not found:
        print(f"skipped: {name} is not installed (apt-get install {package})", flush=True)
    return found


def find_module(name, package):
    """The same of a module of Python's."""
    try:
        return __import__(name, fromlist=["any"])
    except ImportError:
        print(f"skipped: Python's {name} is not installed (apt-get install {package})", flush=True)
        return None


def need_program(name, package):
    return find_program(name, package) or sys.exit(SKIPPED)


def need_module(name, package):
    return find_module(name, package) or sys.exit(SKIPPED)


def expect(holds, what):
    global failures
    failures += not holds
    print("ok    " if holds else "FAILED", what, flush=True)


def finish():
    sys.exit(1 if failures else 0)


def run(*command, folder, seconds=600):
    """What it printed; ends the script where it fails."""
    command = [str(word) for word in command]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=seconds)
    if done.returncode != 0:
        print("FAILED", " ".join(command), f"ended with {done.returncode}\n", done.stdout[-3000:], done.stderr[-3000:])
        sys.exit(1)
    return done.stdout + done.stderr


class Result:
    """A scene that has been packed, in a folder of its own."""

    def __init__(self, folder, scene):
        folder = Path(folder)
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "scene.toml").write_text(scene)
        self.folder = folder
        run(BERNAL, "pack", "scene.toml", "-o", "result", "--quiet", folder=folder)
        lines = (folder / "result" / "spheres.csv").read_text().splitlines()
        self.unit = lines[0].split()[-1]
        self.spheres = [tuple(map(float, line.split(",")[:4])) for line in lines if line[0] in "-.0123456789"]
        self.report = json.loads((folder / "result" / "report.json").read_text())

    def export(self, to, file, *options):
        run(BERNAL, "export", "result", "--to", to, "-o", file, "--quiet", *options, folder=self.folder)
        return self.folder / file

    def in_metres(self):
        return [tuple(METRES[self.unit] * number for number in sphere) for sphere in self.spheres]

    def edges(self):
        return self.report["box"]["edges"]


def same_spheres(read, known, tolerance=1e-12, periods=None):
    """Whether two lists of (x, y, z, r), in one order, agree: to the tolerance over the largest number, and to whole
    periods."""
    if len(read) != len(known):
        return False
    largest = max(abs(number) for sphere in known for number in sphere)
    for one, other in zip(read, known):
        for k in range(4):
            difference = one[k] - other[k]
            if periods and k < 3:
                difference -= periods[k] * round(difference / periods[k])
            if not abs(difference) <= tolerance * largest:
                return False
    return True


def thermo_rows(log):
    """(step, atoms, kinetic energy) of every line below "Step Atoms KinEng …", as LAMMPS and LIGGGHTS print them."""
    rows, width = [], 0
    for line in log.splitlines():
        words = line.split()
        if words[:2] == ["Step", "Atoms"]:
            width = len(words)
        elif width and len(words) == width and words[0].isdigit():
            rows.append((int(words[0]), int(words[1]), float(words[2])))
        elif rows:
            width = 0
    return rows


def in_folder(work):
    """Calls work(folder) with one that goes afterwards, then ends the script."""
    with tempfile.TemporaryDirectory() as folder:
        work(Path(folder))
    finish()
