#!/usr/bin/python3
"""Reads cells of bernal by other ways: tests/clients/with_cells.py [BERNAL]

Packs 10,000 lognormal spheres in a periodic box, spheres in a cylinder and in a box, and writes their cells. A tessellation
of Neper's is read here by the manual's definition and with this script's own arithmetic: volumes against those of `bernal
measure --local`, planes against the seeds and weights in the file, images against the periods; of some cells all corners
are held against all spheres. Then VTK reads polyhedra, and Gmsh meshes grains; either is left out with a word where it is
not installed. Debian: python3-vtk9 gmsh. Takes a minute.
"""
import math
import random

from client import *

GRAINS = PERIODIC.replace("count = 500", "count = 10000").replace("sigma = 0.3", "sigma = 0.35")
BOX = """unit = "mm"
[container]
kind = "box"
size = [4, 5, 6]
[spheres]
packing_fraction = 0.5
diameter = { distribution = "lognormal", median = 1.0, sigma = 0.2 }
"""


def minus(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


class Tessellation:
    """A .tess file, format 3.5, as Neper's reference manual says."""

    def __init__(self, file):
        self.words = iter(file.read_text().split())
        self.expect("***tess", "**format", "3.5", "**general", "3")
        self.kind = self.word()
        self.expect("**cell")
        count = self.whole()
        word = self.word()
        self.ids = list(range(1, count + 1))
        if word == "*id":
            self.ids = [self.whole() for _ in range(count)]
            word = self.word()
        assert word == "*seed", word
        self.seeds = self.rows(count, lambda: self.numbers(4))
        self.expect("**vertex")
        self.vertices = self.rows(self.whole(), lambda: self.numbers(4)[:3])
        self.expect("**edge")
        self.edges = self.rows(self.whole(), lambda: self.wholes(3)[:2])
        self.expect("**face")
        self.faces = self.rows(self.whole(), self.face)
        self.expect("**polyhedron")
        self.cells = self.rows(self.whole(), lambda: self.wholes(self.whole()))
        self.expect("**domain", "*general")
        self.domain = self.word()
        self.expect("*vertex")
        self.domain_vertices = self.rows(self.whole(), self.domain_vertex)
        self.expect("*edge")
        self.domain_edges = self.rows(self.whole(), self.domain_edge)
        self.expect("*face")
        self.domain_faces = self.rows(self.whole(), self.domain_face)
        self.images = {}
        if self.word() == "**periodicity":
            self.expect("*general")
            self.periodic, self.periods = self.wholes(3), self.numbers(3)
            for what, columns in (("seed", 4), ("vertex", 4), ("edge", 5), ("face", 5)):
                self.expect("*" + what)
                self.images[what] = [self.wholes(columns + 1) for _ in range(self.whole())]
            self.expect("***end")

    def word(self):
        return next(self.words)

    def expect(self, *words):
        for word in words:
            found = self.word()
            assert found == word, f"{found} in place of {word}"

    def whole(self):
        return int(self.word())

    def wholes(self, count):
        return [self.whole() for _ in range(count)]

    def numbers(self, count):
        return tuple(float(self.word()) for _ in range(count))

    def rows(self, count, row):
        made = []
        for number in range(1, count + 1):
            assert self.whole() == number
            made.append(row())
        return made

    def face(self):
        vertices, edges, plane = self.wholes(self.whole()), self.wholes(self.whole()), self.numbers(4)
        self.expect("0", "0", "0", "0", "0")
        return vertices, edges, plane

    def domain_vertex(self):
        place, label = self.numbers(3), self.word()
        return place, label, self.wholes(self.whole())

    def domain_edge(self):
        ends = self.wholes(self.whole())
        self.expect("line", "0")
        label = self.word()
        return ends, label, self.wholes(self.whole())

    def domain_face(self):
        corners, edges = self.wholes(self.whole()), self.wholes(self.whole())
        self.expect("plane", "4")
        plane, label = self.numbers(4), self.word()
        return corners, edges, plane, label, self.wholes(self.whole())

    def place(self, vertex):
        return self.vertices[vertex - 1]

    def volume(self, cell):
        """Of pyramids from its seed over the triangles of its faces: a positive face points outwards."""
        apex, sixfold = self.seeds[cell][:3], 0.0
        for face in self.cells[cell]:
            loop = [minus(self.place(v), apex) for v in self.faces[abs(face) - 1][0]]
            for k in range(1, len(loop) - 1):
                sixfold += math.copysign(1, face) * dot(loop[0], cross(loop[k], loop[k + 1]))
        return sixfold / 6


def check_tessellation(name, result, folder):
    file = result.folder / f"{name}.tess"
    run(BERNAL, "cells", "result", "--to", "neper", "-o", file.name, "--quiet", folder=result.folder)
    run(BERNAL, "measure", "result", "--local", "local.csv", folder=result.folder)
    rows = (result.folder / "local.csv").read_text().splitlines()[2:]
    measured = [float(row.split(",")[1]) for row in rows]
    tess = Tessellation(file)
    worst, total = 0.0, 0.0
    for cell, number in enumerate(tess.ids):
        volume = tess.volume(cell)
        total += volume
        if name != "cylinder":  # whose cells at the wall are cut flat
            worst = max(worst, abs(volume - measured[number - 1]) / measured[number - 1])
    whole = sum(measured)
    expect(worst < 1e-6, f"{name}: volumes of {len(tess.cells)} cells are those of measure, off by {worst:.1e} at most")
    expect(abs(total - whole) < 1e-9 * whole, f"{name}: they fill the domain, off by {abs(total / whole - 1):.1e}")
    edges_hold = planes_hold = 0
    for vertices, edges, (d, a, b, c) in tess.faces:
        ends = [tess.edges[abs(e) - 1][:: 1 if e > 0 else -1] for e in edges]
        edges_hold += [end[0] for end in ends] == vertices and all(
            one[1] == other[0] for one, other in zip(ends, ends[1:] + ends[:1]))
        planes_hold += abs(a * a + b * b + c * c - 1) < 1e-9 and all(
            abs(dot((a, b, c), tess.place(v)) - d) < 1e-8 for v in vertices)
    expect(edges_hold == len(tess.faces), f"{name}: edges run around every face")
    expect(planes_hold == len(tess.faces), f"{name}: faces lie in their planes")
    euler = sum(len({v for f in cell for v in tess.faces[abs(f) - 1][0]})
                - sum(len(tess.faces[abs(f) - 1][0]) for f in cell) // 2 + len(cell) == 2 for cell in tess.cells)
    expect(euler == len(tess.cells), f"{name}: Euler holds for every cell")
    check_seeds(name, tess)
    if tess.images:
        check_images(name, tess)
    else:
        check_domain(name, tess)


def check_seeds(name, tess):
    """Neper's definition, |x - c|² - w², at all corners of some cells, against every seed by brute force."""
    draw = random.Random(1)
    periods = [p if is_periodic else 0 for p, is_periodic in zip(tess.periods, tess.periodic)] if tess.images else [0, 0, 0]
    worst = 0.0
    for cell in draw.sample(range(len(tess.cells)), 20):
        own = tess.seeds[cell]
        for vertex in {v for f in tess.cells[cell] for v in tess.faces[abs(f) - 1][0]}:
            place = tess.place(vertex)
            power = dot(minus(place, own), minus(place, own)) - own[3] ** 2
            for seed in tess.seeds:
                away = [place[k] - seed[k] for k in range(3)]
                away = [d - p * round(d / p) if p else d for d, p in zip(away, periods)]
                worst = max(worst, power - (dot(away, away) - seed[3] ** 2))
    expect(worst < 1e-9, f"{name}: no corner of 20 cells is nearer to another of all seeds, by more than {worst:.1e}")


def check_images(name, tess):
    def moved(place, shift):
        return tuple(x + s * p for x, s, p in zip(place, shift, tess.periods))

    off = max(max(abs(a - b) for a, b in zip(tess.place(second), moved(tess.place(first), shift)))
              for second, first, *shift in (row[:5] for row in tess.images["vertex"]))
    expect(off < 1e-9, f"{name}: images of corners are where the periods say, within {off:.1e}")
    first_of = {row[0]: row[1] for row in tess.images["vertex"]}
    is_image = all(
        [first_of.get(v, v) for v in tess.edges[second - 1]][::way]
        == [first_of.get(v, v) for v in tess.edges[first - 1]]
        for second, first, _, _, _, way in tess.images["edge"])
    expect(is_image, f"{name}: images of edges have the images of their ends")
    same = all({first_of.get(v, v) for v in tess.faces[second - 1][0]} == {first_of.get(v, v) for v in tess.faces[first - 1][0]}
               and dot(tess.faces[second - 1][2][1:], tess.faces[first - 1][2][1:]) * way > 0.999999
               for second, first, _, _, _, way in tess.images["face"])
    expect(same, f"{name}: images of faces have their corners, and point as they say")
    faces = [abs(f) for cell in tess.cells for f in cell]
    images = {row[0] for row in tess.images["face"]} | {row[1] for row in tess.images["face"]}
    expect(all((faces.count(f) == 1) == (f in images) for f in random.Random(2).sample(faces, 200)),
           f"{name}: a face of one cell has an image of another")


def check_domain(name, tess):
    count = len(tess.domain_vertices) - len(tess.domain_edges) + len(tess.domain_faces)
    expect(count == 2, f"{name}: Euler holds for the domain")
    walls = sorted(f for *_, faces in tess.domain_faces for f in faces)
    faces = [abs(f) for cell in tess.cells for f in cell]
    times = {}
    for face in faces:
        times[face] = times.get(face, 0) + 1
    expect(walls == sorted(f for f, n in times.items() if n == 1), f"{name}: faces of one cell are those at the walls")
    lies = all(abs(dot(plane[1:], tess.place(v)) - plane[0]) < 1e-8
               for *_, plane, _, faces in tess.domain_faces for f in faces for v in tess.faces[f - 1][0])
    expect(lies, f"{name}: they lie in the planes of the domain")
    expect(all(len(corners) == len(edges) >= 3 for corners, edges, *_ in tess.domain_faces),
           f"{name}: edges run around every face of the domain")


def check_vtk(result):
    vtk = find_module("vtk", "python3-vtk9")
    if not vtk:
        return
    run(BERNAL, "cells", "result", "--to", "vtu", "-o", "cells.vtu", "--quiet", folder=result.folder)
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(result.folder / "cells.vtu"))
    reader.Update()
    grid = reader.GetOutput()
    volumes = grid.GetCellData().GetArray("volume")
    closed, worst = 0, 0.0
    for k in range(grid.GetNumberOfCells()):
        cell = grid.GetCell(k)
        closed += cell.GetCellType() == vtk.VTK_POLYHEDRON
        sixfold = 0.0
        for f in range(cell.GetNumberOfFaces()):
            points = cell.GetFace(f).GetPoints()
            loop = [points.GetPoint(p) for p in range(points.GetNumberOfPoints())]
            for p in range(1, len(loop) - 1):
                sixfold += dot(loop[0], cross(loop[p], loop[p + 1]))
        worst = max(worst, abs(sixfold / 6 / volumes.GetValue(k) - 1))
    expect(closed == len(result.spheres), f"VTK reads {closed} polyhedra")
    expect(worst < 1e-9, f"VTK's faces point outwards and enclose the volumes, off by {worst:.1e}")
    run(BERNAL, "cells", "result", "--to", "struts", "-o", "foam.vtp", "--quiet", folder=result.folder)
    lines = vtk.vtkXMLPolyDataReader()
    lines.SetFileName(str(result.folder / "foam.vtp"))
    lines.Update()
    data = lines.GetOutput().GetCellData()
    share = sum(math.pi * data.GetArray("radius").GetValue(k) ** 2 * data.GetArray("length").GetValue(k)
                for k in range(lines.GetOutput().GetNumberOfLines())) / math.prod(result.edges())
    expect(abs(share - 0.05) < 1e-9, f"VTK reads {lines.GetOutput().GetNumberOfLines()} struts, {share:.4f} of the volume")


def check_gmsh(name, result):
    gmsh = find_program("gmsh", "gmsh")
    if not gmsh:
        return
    run(BERNAL, "cells", "result", "--to", "gmsh", "-o", "grains.geo", "--quiet", folder=result.folder)
    said = run(gmsh, "-3", "grains.geo", "-format", "msh2", "-o", "grains.msh", folder=result.folder)
    expect("Error" not in said, f"{name}: Gmsh meshes the grains without an error")
    lines = iter((result.folder / "grains.msh").read_text().splitlines())
    nodes, volumes = {}, {}
    for line in lines:
        if line == "$Nodes":
            for _ in range(int(next(lines))):
                number, *place = next(lines).split()
                nodes[number] = tuple(map(float, place))
        if line == "$Elements":
            for _ in range(int(next(lines))):
                words = next(lines).split()
                if words[1] != "4":
                    continue
                a, b, c, d = (nodes[word] for word in words[-4:])
                volume = abs(dot(minus(b, a), cross(minus(c, a), minus(d, a)))) / 6
                volumes[int(words[3])] = volumes.get(int(words[3]), 0) + volume
    rows = (result.folder / "local.csv").read_text().splitlines()[2:]
    measured = [float(row.split(",")[1]) for row in rows]
    worst = max(abs(volumes.get(k + 1, 0) / volume - 1) for k, volume in enumerate(measured))
    expect(worst < 1e-9, f"{name}: tetrahedra of {len(volumes)} physical groups fill the cells, off by {worst:.1e}")


def work(folder):
    small = Result(folder / "small", PERIODIC.replace("count = 500", "count = 60"))
    box = Result(folder / "box", BOX)
    check_tessellation("grains", Result(folder / "grains", GRAINS), folder)
    check_tessellation("small", small, folder)
    check_tessellation("box", box, folder)
    check_tessellation("cylinder", Result(folder / "cylinder", CYLINDER), folder)
    check_vtk(small)
    check_gmsh("box", box)
    check_gmsh("periodic", small)


in_folder(work)
