"""Reads the geometries of OpenMC, Serpent, SCONE and MCNP, as their manuals describe them, as far as files of spheres need
it."""
import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np

from geometry import OUTSIDE, Ball, Balls, Cell, Cells, Everywhere, Geometry, Lattice, Placed, Plane, Quadric, Repeated
from geometry import Tube, Within, frustum

UNIT = np.eye(3)


# ---- OpenMC: geometry.xml and materials.xml in one folder, or one file with both

def openmc_surface(kind, c):
    if kind == "sphere":
        return Ball(c[:3], c[3])
    if kind == "plane":
        return Plane(c[:3], c[3])
    if kind == "quadric":  # A, B, C, D xy, E yz, F xz, G, H, J z, K
        return Quadric(c)
    axis, shape = "xyz".index(kind[0]), kind[2:]
    if shape == "plane":
        return Plane(UNIT[axis], c[0])
    if shape == "cylinder":
        return Tube(np.insert(np.array(c[:2]), axis, 0), UNIT[axis], c[2])
    if shape == "cone":  # the last is the square of the slope
        return Tube(c[:3], UNIT[axis], 0, c[3] ** 0.5)
    raise ValueError(kind)


def numbers(text):
    return [float(word) for word in text.split()]


def openmc_rotation(values):
    """A matrix multiplies what has been moved. Angles turn the universe by Rz Ry Rx, so what enters by the transpose."""
    if len(values) == 9:
        return np.array(values).reshape(3, 3)
    a, b, c = np.radians(values)
    x = np.array([[1, 0, 0], [0, np.cos(a), -np.sin(a)], [0, np.sin(a), np.cos(a)]])
    y = np.array([[np.cos(b), 0, np.sin(b)], [0, 1, 0], [-np.sin(b), 0, np.cos(b)]])
    z = np.array([[np.cos(c), -np.sin(c), 0], [np.sin(c), np.cos(c), 0], [0, 0, 1]])
    return (z @ y @ x).T


def read_openmc(file):
    file = Path(file)
    if file.is_dir():
        file = file / "geometry.xml"
    materials = {"void": OUTSIDE}
    listed = file if file.name != "geometry.xml" else file.with_name("materials.xml")
    for _, element in ElementTree.iterparse(listed):
        if element.tag == "material":
            materials[element.get("id")] = element.get("name")
    surfaces, cells, universes = {}, {}, {}
    for _, element in ElementTree.iterparse(file):
        if element.tag == "surface":
            surfaces[int(element.get("id"))] = openmc_surface(element.get("type"), numbers(element.get("coeffs")))
        elif element.tag == "cell":
            sides = []
            for word in (element.get("region") or "").split():
                sides.append((int(word.lstrip("+-")), -1 if word[0] == "-" else 1))
            if element.get("fill"):
                move, turn = element.get("translation"), element.get("rotation")
                holds = Placed(int(element.get("fill")), numbers(move) if move else None,
                               openmc_rotation(numbers(turn)) if turn else None)
            else:
                holds = materials[element.get("material")]
            cells.setdefault(int(element.get("universe", "0")), []).append((sides, holds))
        elif element.tag == "lattice":
            shape = [int(n) for n in element.get("dimension").split()]
            words = [int(n) for n in element.find("universes").text.split()]
            # x fastest; rows of y from the top down; layers of z upwards
            table = np.array(words).reshape(shape[2], shape[1], shape[0])[:, ::-1, :].transpose(2, 1, 0)
            universes[int(element.get("id"))] = Lattice(
                numbers(element.find("lower_left").text), numbers(element.find("pitch").text), table,
                int(element.get("outer")))
        else:
            continue
        element.clear()
    for universe, listed in cells.items():
        assert universe not in universes, f"{universe} is a universe and a lattice"
        universes[universe] = Cells([Cell([(surfaces[s], sense) for s, sense in sides], h) for sides, h in listed],
                                    ends=universe == 0)
    return Geometry(universes, 0)


# ---- Serpent 2

CARDS = {"surf", "cell", "pbed", "trans", "mat", "set", "particle", "pin"}


def serpent_surface(kind, c):
    if kind == "inf":
        return Everywhere()
    if kind == "sph":
        return Ball(c[:3], c[3])
    if kind in ("px", "py", "pz"):
        return Plane(UNIT["xyz".index(kind[1])], c[0])
    if kind == "plane":
        return Plane(c[:3], c[3])
    if kind in ("cylx", "cyly", "cylz") and len(c) == 3:
        axis = "xyz".index(kind[3])
        return Tube(np.insert(np.array(c[:2]), axis, 0), UNIT[axis], c[2])
    if kind == "quadratic":  # A … C, D xy, E yz, F zx, G … I, J
        return Quadric(c)
    raise ValueError(kind)


def read_serpent(file):
    file = Path(file)
    words = []
    for line in file.read_text().splitlines():
        words += line.split("%")[0].split()
    starts = [k for k, word in enumerate(words) if word in CARDS] + [len(words)]
    surfaces, cells, universes, entries, beds = {}, {}, {}, {}, []
    for start, end in zip(starts, starts[1:]):
        card, rest = words[start], words[start + 1:end]
        if card == "surf":
            surfaces[rest[0]] = serpent_surface(rest[1], [float(n) for n in rest[2:]])
        elif card == "cell":
            universe, holds, sides = rest[1], rest[2], rest[3:]
            if holds == "fill":
                holds, sides = Placed(rest[3]), rest[4:]
            cells.setdefault(universe, []).append(
                ([(s.lstrip("-"), -1 if s[0] == "-" else 1) for s in sides], holds))
        elif card == "trans":
            assert rest[0] == "U" and len(rest) == 15, rest
            values = [float(n) for n in rest[2:]]
            entries[rest[1]] = Placed(None, values[:3], values[3:12], turn_first=values[12] == 1)
        elif card == "pbed":
            beds.append(rest)
    for universe, listed in cells.items():
        universes[universe] = Cells([Cell([(surfaces[s], sense) for s, sense in sides], h) for sides, h in listed])
    for universe, background, rows in beds:
        table = [line.split() for line in (file.parent / rows.strip('"')).read_text().splitlines()]
        places = np.array([[float(n) for n in row[:4]] for row in table]).reshape(-1, 4)
        assert all(len(row) == 5 for row in table)
        universes[universe] = Balls(places[:, :3], places[:, 3], [row[4] for row in table], background)
    return Geometry(universes, "0", entries)


# ---- SCONE

def scone_dictionary(words, at=0):
    made = {}
    while at < len(words) and words[at] != "}":
        name, at = words[at], at + 1
        if words[at] == "{":
            made[name], at = scone_dictionary(words, at + 1)
            at += 1
        elif words[at] == "(":
            end = words.index(")", at)
            made[name], at = words[at + 1:end], end + 2
        else:
            made[name], at = words[at], at + 2
    return made, at


def scone_matrix(angles):
    """Euler angles ZXZ of the axes: coordinates are multiplied by Z(psi) X(theta) Z(phi)."""
    phi, theta, psi = np.radians([float(a) for a in angles])

    def z(a):
        return np.array([[np.cos(a), np.sin(a), 0], [-np.sin(a), np.cos(a), 0], [0, 0, 1]])

    x = np.array([[1, 0, 0], [0, np.cos(theta), np.sin(theta)], [0, -np.sin(theta), np.cos(theta)]])
    return z(psi) @ x @ z(phi)


def scone_surface(entry):
    kind = entry["type"]

    def listed(key):
        return np.array([float(n) for n in entry[key]])

    if kind == "sphere":
        return Ball(listed("origin"), float(entry["radius"]))
    if kind == "box":
        low, high = listed("origin") - listed("halfwidth"), listed("origin") + listed("halfwidth")
        return Within(*[Plane(UNIT[k], high[k]) for k in range(3)], *[Plane(-UNIT[k], -low[k]) for k in range(3)])
    if kind == "plane":
        return Plane(listed("coeffs")[:3], listed("coeffs")[3])
    if kind == "quadric":
        return Quadric(listed("coeffs"))
    axis = "xyz".index(kind[0])
    if kind[1:] == "Plane":
        return Plane(UNIT[axis], float(entry[f"{kind[0]}0"]))
    if kind[1:] == "Cylinder":
        return Tube(listed("origin"), UNIT[axis], float(entry["radius"]))
    raise ValueError(kind)


def read_scone(file):
    text = re.sub(r"(!|//).*", " ", Path(file).read_text())
    words = re.sub(r"([{}();])", r" \1 ", text).split()
    geometry = scone_dictionary(words)[0]["geometry"]
    surfaces = {entry["id"]: scone_surface(entry) for entry in geometry["surfaces"].values()}
    cells = {}
    for entry in geometry["cells"].values():
        holds = Placed(entry["universe"]) if entry["filltype"] == "uni" else entry["material"]
        sides = [(surfaces[s.lstrip("-")], -1 if s[0] == "-" else 1) for s in entry["surfaces"]]
        cells[entry["id"]] = Cell(sides, OUTSIDE if holds == "void" else holds)
    universes, entries, root = {}, {}, None
    for entry in geometry["universes"].values():
        if entry["type"] == "rootUniverse":
            root = entry["id"]
            border, fill = surfaces[entry["border"]], re.fullmatch(r"u<(\d+)>", entry["fill"])[1]
            universes[root] = Cells([Cell([(border, -1)], Placed(fill)), Cell([(border, 1)], OUTSIDE)])
            continue
        universes[entry["id"]] = Cells([cells[c] for c in entry["cells"]])
        if "origin" in entry or "rotation" in entry:
            angles = entry.get("rotation")
            # SCONE's own matrix of three angles is a rotation only where the first or the last of them is zero.
            assert not angles or 0 in (float(angles[0]), float(angles[2])), angles
            entries[entry["id"]] = Placed(None, [float(n) for n in entry.get("origin", (0, 0, 0))],
                                          scone_matrix(angles) if angles else None, turn_first=True)
    return Geometry(universes, root, entries)


# ---- MCNP

def mcnp_surface(kind, c):
    kind = kind.upper()
    if kind == "SPH":
        return Ball(c[:3], c[3])
    if kind == "RPP":
        return Within(*[Plane(UNIT[k], c[2 * k + 1]) for k in range(3)], *[Plane(-UNIT[k], -c[2 * k]) for k in range(3)])
    if kind == "RCC":
        return frustum(c[:3], c[3:6], c[6], c[6])
    if kind == "TRC":
        return frustum(c[:3], c[3:6], c[6], c[7])
    if kind in ("PX", "PY", "PZ"):
        return Plane(UNIT["XYZ".index(kind[1])], c[0])
    if kind == "P":
        return Plane(c[:3], c[3])
    if kind == "GQ":  # A … C, D xy, E yz, F zx, G … J, K
        return Quadric(c)
    raise ValueError(kind)


def read_mcnp(file):
    lines = Path(file).read_text().splitlines()
    assert all(len(line) <= 80 for line in lines[1:] if not line.startswith("c "))
    blocks, names = [[]], {}
    for line in lines[1:]:
        if not line.strip():
            blocks.append([])
        elif line.startswith("c "):
            found = re.match(r"c m(\d+) is ([^:]+):", line)
            if found:
                names[found[1]] = found[2]
        elif line.startswith("     "):
            blocks[-1][-1] += line.split()
        else:
            blocks[-1].append(line.split())
    surfaces = {words[0]: mcnp_surface(words[1], [float(n) for n in words[2:]]) for words in blocks[1]}
    boxes = {words[0]: [float(n) for n in words[2:]] for words in blocks[1] if words[1] == "RPP"}
    cells, universes = {}, {}
    for words in blocks[0]:
        is_void = words[1] == "0"
        assert is_void or float(words[2]) < 0
        options = dict(word.split("=") for word in words if "=" in word)
        sides = [word for word in words[2 if is_void else 3:] if "=" not in word]
        if options.get("lat") == "1":
            box = boxes[sides[0].lstrip("-")]
            universes[options["u"]] = Repeated(box[::2], box[1::2], options["fill"])
            continue
        holds = OUTSIDE if is_void else names[words[1]]
        if "fill" in options:
            holds = Placed(options["fill"])
        cells.setdefault(options.get("u", "0"), []).append(
            Cell([(surfaces[s.lstrip("-")], -1 if s[0] == "-" else 1) for s in sides], holds))
    universes.update({universe: Cells(listed) for universe, listed in cells.items()})
    return Geometry(universes, "0")


READERS = {"openmc": read_openmc, "serpent": read_serpent, "scone": read_scone, "mcnp": read_mcnp}
