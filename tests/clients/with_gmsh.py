#!/usr/bin/python3
"""Meshes exports of bernal with Gmsh: tests/clients/with_gmsh.py [BERNAL] [--large]

Small packings in a periodic box, a cylinder and a CAD part: fragments of the spheres as they are, touching; conforming
tetrahedra with a gap of 1 %, their quality, volume fractions and nodes at opposite ends; STEP and
BREP opened, their volumes, of layers one by one. --large: 800 spheres in a periodic box and 300 in a CAD part, the
layers of 10,000 spheres, half an hour. --layers: these alone, a minute and a half, with what they cost. Debian:
python3-gmsh python3-numpy. Takes two minutes.
"""
import math
import resource
from collections import defaultdict

from client import *

gmsh = need_module("gmsh", "python3-gmsh")
need_module("numpy", "python3-numpy")  # which the exported script takes

PERIODIC = 'kind = "periodic"\n[spheres]\ncount = {}\nradius = {{ distribution = "uniform", min = 0.8, max = 1.2, basis = "number" }}\n'
CYLINDER = 'kind = "cylinder"\nradius = 4\nheight = 6\naxis = [0.2, 0, 1]\n[spheres]\ncount = {}\nradius = 0.7\n'
CAD = 'kind = "mesh"\nfile = "' + str(DATA / "meshes/block_fillets_bore.step") + '"\n[spheres]\ncount = {}\nradius = {}\n'
LAYERS = """unit = "mm"
seed = 1
container = {{ kind = "box", size = [{0}, {0}, {0}] }}
[spheres]
count = {1}
diameter = {{ distribution = "lognormal", median = 1.0, sigma = 0.2, basis = "number" }}
layers = [{{ name = "core" }}, {{ name = "buffer", share = 0.2 }}, {{ name = "coating", thickness = 0.03 }}]
[[stage]]
do = "insert"
"""
SIZE = 0.3  # of elements, over the radius


def export(folder, to, file, **words):
    call = [BERNAL, "export", str(folder / "out"), "--to", to, "-o", str(folder / file), "--quiet"]
    for key, value in words.items():
        call += ["--" + key.replace("_", "-"), str(value)]
    subprocess.run(call, check=True)
    return folder / file


def run(script, *options):
    result = script.with_suffix(".json")
    subprocess.run([sys.executable, str(script), "-o", str(script.with_suffix(".msh")), "--json", str(result), *options],
                   check=True, stdout=subprocess.DEVNULL)
    return json.loads(result.read_text())


def volumes_in(file):
    """Of the solids in a CAD file, the largest last."""
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setString("Geometry.OCCTargetUnit", "MM")
    gmsh.model.occ.importShapes(str(file))
    made = sorted(gmsh.model.occ.getMass(3, tag) for _, tag in gmsh.model.occ.getEntities(3))
    gmsh.finalize()
    return made


def check(name, scene, count):
    with tempfile.TemporaryDirectory() as made:
        folder = Path(made)
        (folder / "scene.toml").write_text('unit = "mm"\nseed = 1\n[container]\n' + scene)
        subprocess.run([BERNAL, "pack", str(folder / "scene.toml"), "-o", str(folder / "out"), "--quiet"], check=True)
        report = json.loads((folder / "out/report.json").read_text())
        phi = report["phi"]

        touching = run(export(folder, "gmsh", "none.py"), "--geometry")
        total = sum(touching["volumes"].values())
        solid = total - touching["volumes"]["matrix"]
        expect(touching["solids"] >= count + 1 and abs(solid / total - phi) < 1e-4,
               f"{name}: fragments of {count} spheres that touch, {touching['solids']} solids")

        script = export(folder, "gmsh", "gap.py", contact="gap", mesh_size=SIZE)
        exact = phi_after(script)
        mesh = run(script)
        fraction = 1 - mesh["groups"]["matrix"]["fraction"]
        # Triangles of edges h r lie 3/8 h² of the volume below the sphere.
        expect(0 < exact - fraction < 1.2 * 3 / 8 * SIZE**2 * exact, f"{name}: volume fraction {fraction:.4f} of the mesh, {exact:.4f} of spheres")
        expect(mesh["smallest_sicn"] >= 0.1,
               f"{name}: {mesh['tetrahedra']} tetrahedra, smallest SICN {mesh['smallest_sicn']:.3f}, gamma {mesh['smallest_gamma']:.3f}")
        if "periodic" in scene:
            expect(mesh["ends_alike"] == [True] * 3 and mesh["periodic_error"] < 1e-9,
                   f"{name}: the same corners at opposite ends, {mesh['periodic_pairs']} pairs")
        lines = script.with_suffix(".msh").read_text().splitlines()
        names = {line.split()[2].strip('"') for line in lines[lines.index("$PhysicalNames") + 2:lines.index("$EndPhysicalNames")]}
        expect({"matrix", "interface"} <= names, f"{name}: the mesh has groups {sorted(names)}")
        for to in ("step", "brep"):
            volumes = volumes_in(export(folder, to, f"a.{to}", contact="gap"))
            # Gmsh's volumes of pieces that are cut are good to some millionths.
            expect(abs(sum(volumes[:-1]) / volumes[-1] - exact) < 1e-4, f"{name}: {to} holds {len(volumes) - 1} solids and the container")


def layers_in(file):
    """The volumes of the solids about each centre in a CAD file, from the innermost; without the container's."""
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setString("Geometry.OCCTargetUnit", "MM")
    gmsh.model.occ.importShapes(str(file))
    solids = [tag for _, tag in gmsh.model.occ.getEntities(3)]
    volumes = {tag: gmsh.model.occ.getMass(3, tag) for tag in solids}
    solids.remove(max(solids, key=volumes.get))
    about = defaultdict(list)
    for tag in solids:
        low, high = (gmsh.model.occ.getBoundingBox(3, tag)[k] for k in (0, 3))
        about[place(gmsh.model.occ.getCenterOfMass(3, tag))].append((high - low, volumes[tag]))
    gmsh.finalize()
    return {at: [volume for _, volume in sorted(of)] for at, of in about.items()}


def place(center):
    """A centre to a thousandth, by which spheres that do not overlap are told apart."""
    return tuple(round(x, 3) for x in center)


def check_layers(count):
    """A solid for each layer of each sphere, with its volume, in a product for each layer."""
    with tempfile.TemporaryDirectory() as made:
        folder = Path(made)
        (folder / "scene.toml").write_text(LAYERS.format(2.2 * count ** (1 / 3), count))
        subprocess.run([BERNAL, "pack", str(folder / "scene.toml"), "-o", str(folder / "out"), "--quiet"], check=True)
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        file = export(folder, "step", "a.step")
        children = resource.getrusage(resource.RUSAGE_CHILDREN)
        rows = (folder / "out/spheres.csv").read_text().splitlines()[2:]
        centers = [place(map(float, row.split(",")[:3])) for row in rows]
        expected = defaultdict(list)
        for line in (folder / "out/layers.csv").read_text().splitlines()[2:]:
            sphere, (inner, outer) = int(line.split(",")[0]), map(float, line.split(",")[3:])
            expected[centers[sphere]].append(4 / 3 * math.pi * (outer - inner) * (outer**2 + outer * inner + inner**2))
        before_reading = resource.getrusage(resource.RUSAGE_SELF).ru_utime
        read = layers_in(file)
        own = resource.getrusage(resource.RUSAGE_SELF)
        alike = len(read) == count and all(len(read.get(at, [])) == len(of) == 3 for at, of in expected.items())
        error = max(abs(v / e - 1) for at, of in expected.items() for v, e in zip(read[at], of)) if alike else math.inf
        expect(error < 1e-9, f"layers: {sum(map(len, read.values()))} solids, each volume within {error:.1e}")
        print(f"      STEP of {count} spheres: written in {children.ru_utime - before:.0f} s of a processor, {children.ru_maxrss / 1024:.0f} MB; "
              f"read in {own.ru_utime - before_reading:.0f} s, {own.ru_maxrss / 1024:.0f} MB", flush=True)
        text = file.read_text()
        expect(all(f"'{name}'" in text for name in ("core", "buffer", "coating")), "layers: products have their names")


def phi_after(script):
    """What the script says of the spheres after they shrank."""
    for line in script.read_text().splitlines():
        if line.startswith("EXACT = "):
            return 1 - json.loads(line[len("EXACT = "):line.index("}") + 1])["matrix"]
    raise ValueError("no exact fractions")


if "--layers" in sys.argv:
    check_layers(10000)
elif "--large" in sys.argv:
    check("periodic", PERIODIC.format(800), 800)
    check("CAD part", CAD.format(300, 2.7), 300)
    check_layers(10000)
else:
    check("periodic", PERIODIC.format(20), 20)
    check("cylinder", CYLINDER.format(20), 20)
    check("CAD part", CAD.format(10, 4), 10)
    check_layers(30)
finish()
