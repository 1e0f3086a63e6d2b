#!/usr/bin/python3
"""Meshes of bernal in other programs: tests/clients/with_meshes.py [BERNAL]

Meshes a bed of bridged spheres in a box and one in a cylinder. OpenFOAM's checkMesh finds the fluid good, with prisms too,
and that of snappyHexMesh, whose case bernal writes, with layers in a cylinder and in a bed of two periods; CalculiX solves
heat conduction through fluid, spheres and bridges at the first try, and the conductance lies between the bounds that hold
for any arrangement of these volumes (Wiener 1912); meshio reads volumes and groups as bernal states them. Each is left
out with a word where it is not installed. Debian: tetgen openfoam calculix-ccx python3-meshio. Takes some minutes.
"""
import os

from client import *

need_program("tetgen", "tetgen")
BOX = """unit = "mm"
[container]
kind = "box"
size = [5, 5, 5]
[spheres]
fill = true
radius = 1
[[stage]]
do = "insert"
[[stage]]
do = "compress"
"""
COLUMN = """unit = "mm"
[container]
kind = "cylinder"
radius = 2.5
height = 4
[spheres]
count = 60
radius = 0.5
[[stage]]
do = "settle"
"""
FEW = """unit = "mm"
[container]
kind = "cylinder"
radius = 1.2
height = 2.5
[spheres]
count = 5
diameter = 1
"""
SLAB = """unit = "mm"
[container]
kind = "periodic"
size = [3, 3, 2.5]
walls = [2]
[spheres]
count = 8
diameter = 1
bed = "poured"
"""
CONTROL = """FoamFile { version 2.0; format ascii; class dictionary; object controlDict; }
application simpleFoam; startFrom startTime; startTime 0; stopAt endTime; endTime 1; deltaT 1;
writeControl timeStep; writeInterval 1;
"""
HEAT = """*INCLUDE, INPUT=bed.inp
*MATERIAL, NAME=of_fluid
*CONDUCTIVITY
1.0
*MATERIAL, NAME=of_solids
*CONDUCTIVITY
10.0
*SOLID SECTION, ELSET=fluid, MATERIAL=of_fluid
*SOLID SECTION, ELSET=spheres, MATERIAL=of_solids
*SOLID SECTION, ELSET=bridges, MATERIAL=of_solids
*STEP
*HEAT TRANSFER, STEADY STATE
*BOUNDARY
x_lower, 11, 11, 0
x_upper, 11, 11, 1
*NODE PRINT, NSET=x_upper, TOTALS=ONLY
RFL
*END STEP
"""


def mesh(result, to, file, *options):
    text = run(BERNAL, "mesh", "result", "--to", to, "-o", file, "--json", *options, folder=result.folder)
    report = json.loads(text[text.index("{"):text.rindex("}") + 1])
    expect(report["least_sicn"] >= 0.1, f"{file}: {report['tetrahedra']} tetrahedra, SICN {report['least_sicn']:.3f}")
    return report


def with_openfoam(result, name, *options):
    case = result.folder / "case"
    (case / "system").mkdir(parents=True, exist_ok=True)
    (case / "system" / "controlDict").write_text(CONTROL)
    report = mesh(result, "openfoam", "case/bed.foam", *options)
    os.environ.setdefault("WM_PROJECT_DIR", "/usr/share/openfoam")
    said = run("checkMesh", "-case", case, "-allGeometry", "-allTopology", folder=result.folder)
    expect("Mesh OK" in said, f"{name}: checkMesh finds the mesh good")
    cells = [line.split()[-1] for line in said.splitlines() if line.strip().startswith("cells:")]
    count = sum(report[kind] for kind in ("tetrahedra", "prisms", "prism_ends"))
    expect(cells == [str(count)], f"{name}: it counts {cells} cells")
    mesh(result, "openfoam", "case/bed.foam", "--regions", "all")
    said = run("checkMesh", "-case", case, "-allTopology", folder=result.folder)
    zones = said[said.index("Checking faceZone topology"):said.index("Checking basic cellZone")]
    expect("Mesh OK" in said and all(zone in zones for zone in ("surface_of_spheres", "necks", "caps")),
           f"{name}: it finds the zones of faces between regions")
    return report


def with_snappy(result, name, *options):
    text = run(BERNAL, "mesh", "result", "--to", "snappy", "-o", "snappy/bed.foam", "--json", *options, folder=result.folder)
    report = json.loads(text[text.index("{"):text.rindex("}") + 1])
    said = run(result.folder / "snappy" / "Allmesh", folder=result.folder, seconds=1800)
    said = said[said.rindex("Mesh stats"):]
    expect("Mesh OK" in said, f"snappyHexMesh, {name}: checkMesh finds the mesh good")
    volume = float(said[said.index("Total volume = "):].split()[3].rstrip("."))
    fluid = report["groups"][0]["volume"] * 1e-9  # in m
    expect(0.95 * fluid < volume < 1.01 * fluid, f"snappyHexMesh, {name}: {volume:.5g} m^3 of {fluid:.5g}")
    boundary = (result.folder / "snappy/constant/polyMesh/boundary").read_text(errors="replace")
    expect("surface_of_spheres" in boundary and ("cyclic" in boundary) == (name == "periods"), f"{name}: it has its patches")


def with_calculix(result):
    report = mesh(result, "abaqus", "bed.inp", "--regions", "all")
    (result.folder / "heat.inp").write_text(HEAT)
    run("ccx", "heat", folder=result.folder)
    flow = float((result.folder / "heat.dat").read_text().split()[-1])
    length = 5  # of the box: with it, its section and the difference of temperatures
    conducts = flow * length / length**2
    fluid = report["meshed_porosity"]
    parallel, series = fluid + 10 * (1 - fluid), 1 / (fluid + (1 - fluid) / 10)
    expect(series < conducts < parallel, f"CalculiX: it conducts {conducts:.4f}, bounds {series:.4f} and {parallel:.4f}")


def with_meshio(result, meshio):
    report = mesh(result, "gmsh", "bed.msh", "--regions", "all")
    mesh(result, "vtu", "bed.vtu", "--regions", "all")
    read = meshio.read(result.folder / "bed.msh")
    points, known = read.points, {group["name"]: group["volume"] for group in report["groups"]}
    found = dict.fromkeys(known, 0.0)
    for cells, groups in zip(read.cells, read.cell_data["gmsh:physical"]):
        if cells.type != "tetra":
            continue
        a, b, c, d = (points[cells.data[:, k]] for k in range(4))
        volumes = abs(((b - a) * numpy.cross(c - a, d - a)).sum(axis=1)) / 6
        for name, (number, dimension) in read.field_data.items():
            if dimension == 3:
                found[name] += volumes[groups == number].sum()
    expect(all(abs(found[name] - known[name]) < 1e-9 * known[name] for name in known), f"meshio: volumes {found}")
    again = meshio.read(result.folder / "bed.vtu")
    count = sum(len(cells.data) for cells in again.cells if cells.type == "tetra")
    expect(count == report["tetrahedra"], f"meshio: {count} tetrahedra in the .vtu")


def with_prisms(result, meshio):
    """Prisms, pyramids and tetrahedra fill the fluid; all are turned as meshio and VTK have them."""
    for to, file in ("gmsh", "prisms.msh"), ("vtu", "prisms.vtu"):
        report = mesh(result, to, file, "--prisms", "3")
        read = meshio.read(result.folder / file)
        counts, least, volume = dict.fromkeys(("wedge", "pyramid", "tetra"), 0), numpy.inf, 0
        for cells in read.cells:
            if cells.type not in counts:
                continue
            counts[cells.type] += len(cells.data)
            p = [read.points[cells.data[:, k]] for k in range(cells.data.shape[1])]
            for a, b, c, d in {"wedge": ((0, 1, 2, 3), (1, 2, 3, 4), (2, 3, 4, 5)),
                               "pyramid": ((0, 1, 2, 4), (0, 2, 3, 4)), "tetra": ((0, 1, 2, 3),)}[cells.type]:
                of_part = ((p[b] - p[a]) * numpy.cross(p[c] - p[a], p[d] - p[a])).sum(axis=1) / 6
                least, volume = min(least, of_part.min()), volume + of_part.sum()
        expect(counts["wedge"] == report["prisms"], f"{file}: {counts['wedge']} prisms")
        of_cells = sum(report[kind] for kind in ("tetrahedra", "prisms", "prism_ends"))
        expect(sum(counts.values()) == of_cells, f"{file}: {counts} of {of_cells} cells")
        expect(least > 0, f"{file}: no cell is turned inside out")
        known = report["groups"][0]["volume"]
        expect(abs(volume / known - 1) < 1e-9, f"{file}: cells fill {volume:.9g} of {known:.9g}")


with tempfile.TemporaryDirectory() as made:
    box = Result(Path(made) / "box", BOX)
    column = Result(Path(made) / "column", COLUMN)
    if find_program("checkMesh", "openfoam"):
        with_openfoam(box, "box")
        with_openfoam(column, "column")
        report = with_openfoam(column, "prisms", "--prisms", "3")
        expect(report["prism_share"] > 0.3, f"prisms stand on {100 * report['prism_share']:.0f} % of the spheres")
    if find_program("snappyHexMesh", "openfoam"):
        with_snappy(Result(Path(made) / "few", FEW), "cylinder", "--prisms", "2")
        with_snappy(Result(Path(made) / "slab", SLAB), "periods")
    if find_program("ccx", "calculix-ccx"):
        with_calculix(box)
    meshio, numpy = find_module("meshio", "python3-meshio"), find_module("numpy", "python3-numpy")
    if meshio and numpy:
        with_meshio(box, meshio)
        with_prisms(box, meshio)
    finish()
