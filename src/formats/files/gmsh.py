"""@TITLE@; for Gmsh 4.8 and later, lengths in @UNIT@.

Conforming tetrahedra of the matrix and of every type of spheres, with physical groups. Debian: apt-get install
python3-gmsh python3-numpy; else pip install gmsh numpy.
"""
import argparse
import json
import sys
import time
from pathlib import Path

import gmsh
import numpy as np

NAMES = [@NAMES@]  # of the types
EXACT = {@EXACT@}  # volume fractions
TROUBLE = @TROUBLE@
LOWER, UPPER = np.array([@LOWER@]), np.array([@UPPER@])  # of the domain
PERIODIC = @PERIODIC@
IS_BOX = @IS_BOX@
LENGTH = @LENGTH@  # of the model, in the mesh's unit
MESH_SIZE, LARGEST_SIZE, MESH_ORDER = @MESH_SIZE@, @LARGEST_SIZE@, @MESH_ORDER@  # over the radius; of any element
# x, y, z, radius, type; axis and angle of a turn, which keeps seams off the cuts
PIECES = [
@PIECES@]
CUT_AT_ENDS = [@CUT_AT_ENDS@]  # volumes
# where gaps are narrow: point, normal, reach, size in the middle and beside, layer
NARROW = np.array([
@NARROW@], dtype=float).reshape(-1, 10)
# a box: corner and size; a cylinder: base, axis and radius; a sphere: centre and radius; a polyhedron: corners and, for
# each face, loops of corners, the outline first
DOMAIN = @DOMAIN@


def domain():
    """Makes volume 1."""
    occ = gmsh.model.occ
    kind, *shape = DOMAIN
    if kind != "Polyhedron":
        getattr(occ, "add" + kind)(*shape, 1)
        return
    corners, polygons = shape
    points = [occ.addPoint(*p) for p in corners]
    lines = {}

    def line(a, b):
        if (b, a) in lines:
            return -lines[b, a]
        if (a, b) not in lines:
            lines[a, b] = occ.addLine(points[a], points[b])
        return lines[a, b]

    faces = []
    for loops in polygons:
        wires = [occ.addCurveLoop([line(a, b) for a, b in zip(loop, loop[1:] + loop[:1])]) for loop in loops]
        faces.append(occ.addPlaneSurface(wires))
    occ.addVolume([occ.addSurfaceLoop(faces)], 1)


def geometry():
    """Makes the solids; returns the volumes of the matrix and of each type."""
    occ = gmsh.model.occ
    domain()
    volumes = list(range(2, 2 + len(PIECES)))
    for tag, (x, y, z, r, _, ax, ay, az, angle) in zip(volumes, PIECES):
        occ.addSphere(x, y, z, r, tag)
        if angle:
            occ.rotate([(3, tag)], x, y, z, ax, ay, az, angle)
    if CUT_AT_ENDS:
        made, _ = occ.intersect([(3, tag) for tag in CUT_AT_ENDS], [(3, 1)], removeTool=False)
        expect(sorted(made) == [(3, tag) for tag in CUT_AT_ENDS], "every piece is one solid")
    solids = [(3, tag) for tag in volumes]
    if solids:
        _, made = occ.fragment([(3, 1)], solids)
    else:
        made = [[(3, 1)]]
    occ.synchronize()
    of_types = {name: [] for name in NAMES}
    for piece, parts in zip(PIECES, made[1:]):
        of_types[NAMES[piece[4] - 1]] += [tag for _, tag in parts]
    inside = {tag for tags in of_types.values() for tag in tags}
    expect(len(inside) == len(solids), f"{len(solids)} solids became {len(inside)}")
    return {"matrix": sorted({tag for _, tag in made[0]} - inside), **of_types}


def boxes_of(surfaces):
    return {s: np.array(gmsh.model.getBoundingBox(2, s)) for s in surfaces}


def name_groups(groups):
    """Physical groups of volumes and surfaces, and what faces what at the ends of periods."""
    for name, tags in groups.items():
        gmsh.model.setPhysicalName(3, gmsh.model.addPhysicalGroup(3, tags), name)
    every = [(3, tag) for tags in groups.values() for tag in tags]
    outer = {abs(tag) for _, tag in gmsh.model.getBoundary(every, combined=True, oriented=False)}
    faces = {abs(tag) for tags in groups.values() for v in tags for _, tag in gmsh.model.getBoundary([(3, v)], oriented=False)}
    named = {"interface": sorted(faces - outer)}
    boxes = boxes_of(outer)
    close = 1e-6 * (UPPER - LOWER).max()
    walls = set(outer)
    for axis in range(3):
        for end, at in (("lower", LOWER[axis]), ("upper", UPPER[axis])):
            if not IS_BOX and not PERIODIC[axis]:
                continue
            on = sorted(s for s in outer if abs(boxes[s][axis] - at) < close and abs(boxes[s][axis + 3] - at) < close)
            named[f"{'xyz'[axis]}_{end}"] = on
            walls -= set(on)
    named["walls"] = sorted(walls)
    for name, tags in named.items():
        if tags:
            gmsh.model.setPhysicalName(2, gmsh.model.addPhysicalGroup(2, tags), name)
    for axis in range(3):
        if not PERIODIC[axis]:
            continue
        shift = np.zeros(6)
        shift[[axis, axis + 3]] = UPPER[axis] - LOWER[axis]
        affine = np.eye(4)
        affine[axis, 3] = UPPER[axis] - LOWER[axis]
        lower, upper = (named[f"{'xyz'[axis]}_{end}"] for end in ("lower", "upper"))
        expect(len(lower) == len(upper), f"{len(lower)} and {len(upper)} faces at the ends of axis {axis}")
        left = np.array([boxes[s] for s in upper])
        pairs = []
        for s in lower:
            distance = np.abs(left - boxes[s] - shift).max(axis=1)
            near = int(distance.argmin())
            expect(distance[near] < close, f"surface {s} has an image")
            pairs.append(upper[near])
        expect(len(set(pairs)) == len(pairs), "every surface has an image of its own")
        gmsh.model.mesh.setPeriodic(2, pairs, lower, affine.ravel().tolist())


def set_sizes():
    """By curvature on spheres; in narrow gaps by what pyramids about them say."""
    set_option = gmsh.option.setNumber
    set_option("Mesh.MeshSizeMax", args.size / MESH_SIZE * LARGEST_SIZE)
    set_option("Mesh.MeshSizeFromCurvature", round(2 * np.pi / args.size))
    set_option("Mesh.MeshSizeFromPoints", 0)
    set_option("Mesh.LcIntegrationPrecision", 1e-4)  # of sizes along curves
    field = gmsh.model.mesh.field
    fields = []
    scale = args.size / MESH_SIZE
    for layer in sorted(set(NARROW[:, 9])):
        rows = NARROW[NARROW[:, 9] == layer]
        point, normal, reach = rows[:, 0:3], rows[:, 3:6], rows[:, 6:7]
        some = np.where(np.abs(normal[:, :1]) < 0.6, [[1.0, 0, 0]], [[0, 1.0, 0]])
        u = np.cross(normal, some)
        u /= np.linalg.norm(u, axis=1)[:, None]
        v = np.cross(normal, u)
        axes = [u * reach, v * reach, normal * reach / 2]
        data = []
        for a in range(3):
            for side in (1, -1):
                b, c = axes[(a + 1) % 3], axes[(a + 2) % 3] * side
                face = [point + side * axes[a] + x * b + y * c for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
                corners = np.stack(face + [point], axis=2).reshape(len(rows), 15)
                beside = np.repeat(rows[:, 8:9] * scale, 4, axis=1)
                data.append(np.concatenate([corners, beside, rows[:, 7:8] * scale], axis=1))
        view = gmsh.view.add(f"narrow {int(layer)}")
        data = np.concatenate(data)
        gmsh.view.addListData(view, "SY", len(data), data.ravel().tolist())
        gmsh.option.setNumber(f"View[{gmsh.view.getIndex(view)}].Visible", 0)
        fields.append(field.add("PostView"))
        field.setNumber(fields[-1], "ViewIndex", gmsh.view.getIndex(view))
    if fields:
        least = field.add("Min")
        field.setNumbers(least, "FieldsList", fields)
        field.setAsBackgroundMesh(least)


def tetrahedra(volume):
    """Their corners: an array (n, 4) of nodes."""
    made = []
    for kind, nodes in zip(*[gmsh.model.mesh.getElements(3, volume)[k] for k in (0, 2)]):
        corners = gmsh.model.mesh.getElementProperties(kind)[3]
        made.append(np.array(nodes, dtype=np.int64).reshape(-1, corners)[:, :4])
    return np.concatenate(made) if made else np.zeros((0, 4), dtype=np.int64)


def quality(nodes):
    """Volume, SICN and gamma of tetrahedra, as Gmsh defines them: the inverse condition number of the map from the
    regular tetrahedron, and the inscribed radius over the longest edge; both 1 if regular."""
    a, b, c, d = (POINTS[nodes[:, k]] for k in range(4))
    edges = (b - a, c - a, d - a, c - b, d - b, d - c)
    jacobian = np.stack(edges[:3], axis=2) @ np.linalg.inv([[1, 0.5, 0.5], [0, 3**0.5 / 2, 3**0.5 / 6], [0, 0, (2 / 3) ** 0.5]])
    determinant = np.linalg.det(jacobian)
    volume = np.abs(determinant) / 72**0.5
    area = sum(np.linalg.norm(np.cross(edges[p], edges[q]), axis=1) / 2 for p, q in ((0, 1), (0, 2), (1, 2), (3, 4)))
    longest = np.max([np.linalg.norm(edge, axis=1) for edge in edges], axis=0)
    cofactors = np.stack([np.cross(jacobian[:, :, (k + 1) % 3], jacobian[:, :, (k + 2) % 3]) for k in range(3)], axis=2)
    norms = np.linalg.norm(jacobian, axis=(1, 2)) * np.linalg.norm(cofactors, axis=(1, 2))
    return volume, 3 * np.abs(determinant) / norms, 24**0.5 * 3 * volume / (area * longest)


def report(groups):
    """What the mesh is, in words; a dictionary of the same."""
    global POINTS
    tags, points, _ = gmsh.model.mesh.getNodes()
    POINTS = np.zeros((int(tags.max()) + 1, 3))
    POINTS[tags.astype(np.int64)] = np.array(points).reshape(-1, 3)
    said = {"nodes": len(tags), "tetrahedra": 0, "smallest_sicn": 1.0, "smallest_gamma": 1.0, "groups": {}}
    total = 0.0
    for name, tags in groups.items():
        made = [quality(tetrahedra(tag)) for tag in tags]
        volume = sum(float(v.sum()) for v, _, _ in made)
        if args.order > 1:  # the elements are curved
            volume = sum(curved_volume(tag) for tag in tags)
        group = {"volume": volume * LENGTH**3, "tetrahedra": sum(len(v) for v, _, _ in made)}
        group["smallest_sicn"] = min((float(q.min()) for _, q, _ in made if len(q)), default=1.0)
        group["smallest_gamma"] = min((float(q.min()) for _, _, q in made if len(q)), default=1.0)
        said["groups"][name] = group
        said["tetrahedra"] += group["tetrahedra"]
        for measure in ("smallest_sicn", "smallest_gamma"):
            said[measure] = min(said[measure], group[measure])
        total += volume
    for name, group in said["groups"].items():
        group["fraction"] = group["volume"] / (total * LENGTH**3)
        exact = f", exactly {EXACT[name]:.6f}" if name in EXACT else ""
        print(f"{name}: {group['tetrahedra']} tetrahedra, volume fraction {group['fraction']:.6f}{exact}, smallest SICN {group['smallest_sicn']:.3f}, gamma {group['smallest_gamma']:.3f}")
    worst, pairs, on_ends = 0.0, 0, [0, 0]
    for _, s in gmsh.model.getEntities(2):
        master, mine, theirs, affine = gmsh.model.mesh.getPeriodicNodes(2, s)
        if master == s or len(mine) == 0:
            continue
        a = np.array(affine).reshape(4, 4)
        image = POINTS[np.array(theirs, dtype=np.int64)] @ a[:3, :3].T + a[:3, 3]
        worst = max(worst, float(np.abs(POINTS[np.array(mine, dtype=np.int64)] - image).max()))
        pairs += len(mine)
    said["periodic_pairs"], said["periodic_error"] = pairs, worst * LENGTH
    for axis in range(3):
        if PERIODIC[axis]:
            close = 1e-9 * (UPPER - LOWER).max()
            used = POINTS[np.unique(np.concatenate([tetrahedra(t).ravel() for g in groups.values() for t in g]))]
            rest = [k for k in range(3) if k != axis]
            low = used[np.abs(used[:, axis] - LOWER[axis]) < close][:, rest]
            high = used[np.abs(used[:, axis] - UPPER[axis]) < close][:, rest]
            low, high = (x[np.lexsort(np.round(x / (100 * close)).T)] for x in (low, high))
            alike = low.shape == high.shape and bool((np.abs(low - high) < 100 * close).all())
            said.setdefault("ends_alike", []).append(alike)
            print(f"ends of axis {axis}: {len(low)} and {len(high)} corners, {'the same' if alike else 'NOT the same'}")
    print(f"{said['nodes']} nodes, {said['tetrahedra']} tetrahedra, smallest SICN {said['smallest_sicn']:.3f}, gamma {said['smallest_gamma']:.3f}")
    return said


def curved_volume(tag):
    volume = 0.0
    kinds, _, _ = gmsh.model.mesh.getElements(3, tag)
    for kind in kinds:
        points, weights = gmsh.model.mesh.getIntegrationPoints(kind, f"Gauss{2 * args.order}")
        _, determinants, _ = gmsh.model.mesh.getJacobians(kind, points, tag)
        volume += float((np.array(determinants).reshape(-1, len(weights)) * weights).sum())
    return volume


def expect(holds, what):
    if not holds:
        sys.exit(f"expected that {what}: {TROUBLE or 'please report this with the script'}")


parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("-o", "--output", default=Path(__file__).stem + ".msh", help="mesh; its ending is the format: msh, vtk, unv, inp, med")
parser.add_argument("--size", type=float, default=MESH_SIZE, help="edge of an element on a sphere, over its radius")
parser.add_argument("--order", type=int, default=MESH_ORDER, help="of the elements")
parser.add_argument("--msh", type=float, default=4.1, help="version of the format msh: 2.2 for older solvers")
parser.add_argument("--geometry", action="store_true", help="make the solids and no mesh; -o then writes .brep or .step, in lengths of the model")
parser.add_argument("--json", help="write the numbers of the report to this file")
parser.add_argument("--show", action="store_true", help="open Gmsh's window at the end")
args = parser.parse_args()

gmsh.initialize(["gmsh"])
gmsh.option.setNumber("General.Verbosity", 1)
gmsh.model.add(Path(__file__).stem)
start = time.time()
groups = geometry()
count = sum(map(len, groups.values()))
print(f"{count} solids in {time.time() - start:.1f} s", flush=True)
said = {"solids": count, "volumes": {name: sum(gmsh.model.occ.getMass(3, t) for t in tags) * LENGTH**3 for name, tags in groups.items()}}
if args.geometry:
    if args.output.endswith((".brep", ".step")):
        gmsh.write(args.output)
else:
    name_groups(groups)
    set_sizes()
    gmsh.option.setNumber("Mesh.Algorithm3D", 10)  # HXT
    gmsh.option.setNumber("Mesh.OptimizeThreshold", 0.4)
    gmsh.option.setNumber("Mesh.MshFileVersion", args.msh)
    gmsh.option.setNumber("Mesh.ScalingFactor", LENGTH)  # of what is written
    start = time.time()
    gmsh.model.mesh.generate(3)
    if args.order > 1:
        gmsh.model.mesh.setOrder(args.order)
    print(f"meshed in {time.time() - start:.1f} s", flush=True)
    said.update(report(groups))
    gmsh.write(args.output)
    print(f"wrote {args.output}")
if args.json:
    Path(args.json).write_text(json.dumps(said))
if args.show:
    gmsh.fltk.run()
gmsh.finalize()
if not all(said.get("ends_alike", [])):
    sys.exit("the ends of periods have different nodes")
