#!/usr/bin/python3
"""Reads files of triangles with the programs they are for: tests/clients/with_surfaces.py [BERNAL]

Packs 1,000 spheres in a cylinder and 60 in a periodic box, exports them in every format of triangles, and compares what
numpy, meshio, VTK, admesh, gmsh and bernal itself (assimp) read: closed, oriented, the same volume; no triangles of different
spheres that meet; opposite ends of a period that match node by node. With OpenFOAM a case of snappyHexMesh is meshed and
checked, in a cylinder and in a periodic box. A program that is not installed is left out with a word. Debian:
python3-numpy python3-meshio python3-vtk9 (or python3-paraview) admesh gmsh python3-gmsh openfoam. Takes half a minute, with OpenFOAM some minutes.
"""
from client import *

CYLINDER = """unit = "mm"
[container]
kind = "cylinder"
radius = 5
height = {height}
base = [5, -3, 1]
[spheres]
count = {count}
radius = {radius}
[[stage]]
do = "{stage}"
"""
BOX = """unit = "mm"
[container]
kind = "periodic"
dimension = 3
{size}
[spheres]
count = {count}
radius = {{ distribution = "lognormal", median = 0.5, sigma = 0.3 }}
[[stage]]
do = "{stage}"
"""


numpy = need_module("numpy", "python3-numpy")
meshio = find_module("meshio", "python3-meshio")
gmsh = find_module("gmsh", "python3-gmsh")
vtk = find_module("vtk", "python3-vtk9")
admesh = find_program("admesh", "admesh")
snappy = find_program("snappyHexMesh", "openfoam")


def pack(folder, scene):
    folder.mkdir()
    (folder / "scene.toml").write_text(scene)
    subprocess.run([BERNAL, "pack", str(folder / "scene.toml"), "-o", str(folder / "out"), "--quiet"])
    return folder


def export(folder, to, name, *keys):
    file = folder / name
    said = subprocess.run([BERNAL, "export", str(folder / "out"), "--to", to, "-o", str(file), *keys], check=True,
                          capture_output=True, text=True).stderr
    print("      ", said.splitlines()[0])
    return file


def read_stl(file):
    """The corners of its triangles: an array (triangles, 3, 3) of floats."""
    record = numpy.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attributes", "<u2")])
    return numpy.fromfile(file, dtype=record, offset=84)["corners"]


def read_ply(file):
    """Vertices, corners of triangles, spheres of triangles."""
    content = file.read_bytes()
    end = content.index(b"end_header\n") + len(b"end_header\n")
    counts = [int(line.split()[2]) for line in content[:end].decode().splitlines() if line.startswith("element")]
    points = numpy.frombuffer(content, "<f4", 3 * counts[0], end).reshape(-1, 3)
    record = numpy.dtype([("three", "u1"), ("corners", "<i4", 3), ("sphere", "<i4")])
    faces = numpy.frombuffer(content, record, counts[1], end + 12 * counts[0])
    return points, faces["corners"], faces["sphere"]


def volume(corners):
    a, b, c = (corners[:, k].astype(float) for k in range(3))
    return numpy.einsum("ij,ij->i", a, numpy.cross(b, c)).sum() / 6


def inspect(file, *keys):
    said = subprocess.run([BERNAL, "inspect", str(file), "--json", *keys], capture_output=True, text=True)
    return json.loads(said.stdout)


def check_formats(folder, surface, spheres):
    keys = ("--surface", surface, "--deflection", "0.05")
    stl = export(folder, "stl", f"{surface}.stl", *keys)
    corners = read_stl(stl)
    whole = volume(corners)
    report = inspect(stl, "--unit", "mm")
    expect(report["closed"] and report["faces"] == len(corners), f"stl {surface}: closed, {len(corners)} triangles")
    expect(report["self_intersections"] == 0, f"stl {surface}: no two triangles meet")
    for to, ending in (("obj", "obj"), ("ply", "ply"), ("3mf", "3mf"), ("gltf", "glb")):
        file = export(folder, to, f"{surface}.{ending}", *keys)
        unit = () if to in ("3mf", "gltf") else ("--unit", "mm")
        report = inspect(file, *unit)
        expect(report["closed"] and report["faces"] == len(corners), f"{to} {surface}: assimp reads {report['faces']}")
        if meshio and to == "obj":
            mesh = meshio.read(file)
            cells = numpy.concatenate([block.data for block in mesh.cells if block.type == "triangle"])
            expect(len(cells) == len(corners) and abs(volume(mesh.points[cells]) / whole - 1) < 1e-5,
                   f"{to} {surface}: meshio reads the same")
        if to == "ply":  # whose numbers of faces meshio 5 cannot read in binary files
            points, cells, of = read_ply(file)
            expect(len(cells) == len(corners) and abs(volume(points[cells]) / whole - 1) < 1e-5,
                   f"ply {surface}: numpy reads the same")
            expect(of.max() == spheres - 1 and (surface == "spheres") == (of.min() == 0),
                   f"ply {surface}: numpy knows the sphere of every triangle")
            if vtk:
                reader = vtk.vtkPLYReader()
                reader.SetFileName(str(file))
                reader.Update()
                expect(reader.GetOutput().GetNumberOfCells() == len(corners), f"ply {surface}: VTK reads it")
    if meshio:
        mesh = meshio.read(stl)
        expect(abs(volume(mesh.points[mesh.cells_dict["triangle"]]) / whole - 1) < 1e-5, f"stl {surface}: meshio reads it")
    if admesh:
        said = subprocess.run([admesh, str(stl)], capture_output=True, text=True).stdout
        lines = {line.split(":")[0].strip(): line.split(":")[1].split() for line in said.splitlines() if ":" in line}
        expect(all(lines[key][0] == "0" for key in ("Degenerate facets", "Edges fixed", "Facets reversed")),
               f"stl {surface}: admesh has nothing to repair")
    if gmsh:
        gmsh.initialize()
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(str(stl))
        _, tags, _ = gmsh.model.mesh.getElements(2)
        expect(sum(len(t) for t in tags) == len(corners), f"stl {surface}: gmsh reads it")
        gmsh.finalize()
    return corners


def check_ends(corners, what):
    """Corners and triangles at opposite ends are the same, bit for bit."""
    for axis in range(3):
        found = []
        for end in (corners[:, :, axis].min(), corners[:, :, axis].max()):
            face = corners[(corners[:, :, axis] == end).all(axis=1)]
            flat = numpy.delete(face, axis, axis=2)
            found.append({frozenset(map(tuple, triangle)) for triangle in flat})
        expect(len(found[0]) > 0 and found[0] == found[1], f"{what}: {len(found[0])} triangles match across axis {axis}")


def check_snappy(folder, name):
    case = export(folder, "snappy", f"case_{name}")
    run = subprocess.run([str(case / "Allmesh")], capture_output=True, text=True)
    (folder / f"snappy_{name}.log").write_text(run.stdout + run.stderr)
    said = run.stdout[run.stdout.rfind("Mesh stats"):]
    for line in said.splitlines():
        if any(word in line for word in ("cells:", "non-orthogonality Max", "skewness =", "volume", "Mesh OK", "Failed", "***")):
            print("       ", line.strip())
    expect(run.returncode == 0 and "Mesh OK" in said, f"snappyHexMesh {name}: checkMesh finds the mesh good")


def work(place):
    bed = pack(place / "bed", CYLINDER.format(height=12, count=1000, radius=0.5, stage="relax"))
    for kind in ("spheres", "all", "pores"):
        check_formats(bed, kind, 1000)
    box = pack(place / "box", BOX.format(count=60, stage="relax", size=""))
    check_ends(check_formats(box, "spheres", 60), "spheres")
    check_ends(check_formats(box, "pores", 60), "pores")
    if snappy:  # spheres that do not touch: where they do no mesh is good
        few = pack(place / "few", CYLINDER.format(height=8, count=50, radius=0.9, stage="insert"))
        check_snappy(few, "cylinder")
        few = pack(place / "few_box", BOX.format(count=50, stage="fly", size="size = [6.0, 6.0, 6.0]"))
        check_snappy(few, "box")


in_folder(work)
