#include <fmt/format.h>
#include <fmt/ranges.h>

#include "formats/snappy_case.hpp"
#include "formats/text_file.hpp"
#include "mesh_files/mesh_file.hpp"
#include "mesh_files/poly_mesh.hpp"

namespace bernal {
namespace {

void add_header(TextFile& out, const MeshToWrite& file, std::string_view kind, std::string_view name,
                const std::string& note = {}) {
  out.add("// ", file.title, "; lengths in ", file.unit,
          "\nFoamFile\n{\n    version     2.0;\n    format      "
          "ascii;\n    class       ",
          kind, ";\n");
  if (!note.empty()) out.add("    note        \"", note, "\";\n");
  out.add("    location    \"constant/polyMesh\";\n    object      ", name, ";\n}\n");
}

template <class Values, class Add>
void write_list(const MeshToWrite& file, StagedFolder& staged, std::string_view kind, const std::string& name,
                const Values& values, const std::string& note, const Add& add) {
  TextFile out(staged.add("constant/polyMesh/" + name));
  add_header(out, file, kind, name, note);
  out.add(values.size(), "\n(\n");
  for (const auto& value : values) add(out, value);
  out.add(")\n");
  out.close();
}

void write_boundary(const MeshToWrite& file, const PolyMesh& poly, StagedFolder& staged) {
  write_list(file, staged, "polyBoundaryMesh", "boundary", poly.patches, {},
             [](TextFile& out, const PolyMesh::Patch& patch) {
               out.add("    ", patch.name, "\n    {\n        type            ", patch.type, ";\n");
               if (!patch.neighbour.empty())
                 out.add("        neighbourPatch  ", patch.neighbour,
                         ";\n        transform       "
                         "translational;\n        "
                         "separationVector (",
                         patch.separation[0], ' ', patch.separation[1], ' ', patch.separation[2],
                         ");\n        matchTolerance  0.0001;\n");
               out.add("        nFaces          ", patch.count, ";\n        startFace       ", patch.first,
                       ";\n    }\n");
             });
}

void write_faces(const MeshToWrite& file, const PolyMesh& poly, StagedFolder& staged) {
  TextFile out(staged.add("constant/polyMesh/faces"));
  add_header(out, file, "faceList", "faces");
  out.add(poly.faces.size(), "\n(\n");
  for (std::size_t f = 0; f < poly.faces.size(); ++f) {
    const auto corners = poly.faces[f];
    out.add(corners.size());
    for (std::size_t k = 0; k < corners.size(); ++k) out.add(k == 0 ? '(' : ' ', corners[k]);
    out.add(")\n");
  }
  out.add(")\n");
  out.close();
}

/// Cells of groups; those of prisms come after all tetrahedra.
void write_zones(const MeshToWrite& file, const PolyMesh& poly, StagedFolder& staged) {
  const VolumeMesh& mesh = file.mesh;
  const auto cells = by_group(mesh.tetrahedra.size(), file.groups.volumes.size(),
                              [&](std::size_t t) { return file.groups.volume_of(mesh, t); });
  std::vector<std::size_t> zones(cells.size());
  for (std::size_t v = 0; v < zones.size(); ++v) zones[v] = v;
  const std::size_t zone_of_prisms = file.groups.volume_of_region[0],
                    prisms = poly.cells - mesh.tetrahedra.size();
  write_list(file, staged, "regIOobject", "cellZones", zones, {}, [&](TextFile& out, std::size_t v) {
    out.add("    ", file.groups.volumes[v],
            "\n    {\n        type            cellZone;\n        cellLabels  "
            "    List<label>\n",
            cells[v].size() + (v == zone_of_prisms ? prisms : 0), "\n(\n");
    for (const std::uint32_t cell : cells[v]) out.add(cell, "\n");
    for (std::size_t p = 0; p < prisms && v == zone_of_prisms; ++p) out.add(mesh.tetrahedra.size() + p, "\n");
    out.add(");\n    }\n");
  });
}

/// Faces between regions, a zone a surface, whose normals are those of its triangles: out of the spheres.
void write_face_zones(const MeshToWrite& file, const PolyMesh& poly, StagedFolder& staged) {
  struct ZoneFace {
    std::size_t face;
    bool is_flipped;
  };
  if (file.mesh.regions.size() < 2) return;
  std::vector<std::vector<ZoneFace>> of_surface(file.groups.surfaces.size());
  const auto sides = sides_of_triangles(file.mesh);
  for (std::size_t t = 0; t < sides.size(); ++t) {
    const auto& [behind, before] = sides[t];
    if (!behind.is_there() || !before.is_there()) continue;
    of_surface[file.groups.surface_of(file.mesh, t)].push_back(
        {poly.face_between(behind.tetrahedron, before.tetrahedron), before.tetrahedron < behind.tetrahedron});
  }
  std::vector<std::size_t> zones;
  for (std::size_t s = 0; s < of_surface.size(); ++s)
    if (!of_surface[s].empty()) zones.push_back(s);
  if (zones.empty()) return;
  write_list(file, staged, "regIOobject", "faceZones", zones, {}, [&](TextFile& out, std::size_t s) {
    out.add("    ", file.groups.surfaces[s],
            "\n    {\n        type            faceZone;\n        faceLabels      List<label>\n",
            of_surface[s].size(), "\n(\n");
    for (const ZoneFace& of : of_surface[s]) out.add(of.face, "\n");
    out.add(");\n        flipMap         List<bool>\n", of_surface[s].size(), "\n(\n");
    for (const ZoneFace& of : of_surface[s]) out.add(of.is_flipped ? "1\n" : "0\n");
    out.add(");\n    }\n");
  });
}

std::string write_mesh_for_openfoam(const MeshToWrite& file, StagedFolder& staged) {
  const VolumeMesh& mesh = file.mesh;
  const PolyMesh poly = poly_mesh_of(mesh, file.groups);
  write_list(file, staged, "vectorField", "points", mesh.vertices, {},
             [](TextFile& out, const Vector<3>& p) { out.add('(', p[0], ' ', p[1], ' ', p[2], ")\n"); });
  write_faces(file, poly, staged);
  const std::string note =
      fmt::format("nPoints: {} nCells: {} nFaces: {} nInternalFaces: {}", mesh.vertices.size(), poly.cells,
                  poly.faces.size(), poly.neighbour.size());
  const auto add_label = [](TextFile& out, std::uint32_t label) { out.add(label, "\n"); };
  write_list(file, staged, "labelList", "owner", poly.owner, note, add_label);
  write_list(file, staged, "labelList", "neighbour", poly.neighbour, note, add_label);
  write_boundary(file, poly, staged);
  write_zones(file, poly, staged);
  write_face_zones(file, poly, staged);
  write_system_of_openfoam(file, staged);
  staged.write(file.name.string(), "");
  std::vector<std::string> patches;
  for (const PolyMesh::Patch& patch : poly.patches)
    patches.push_back(fmt::format("{} ({})", patch.name, patch.type));
  return fmt::format(
      "constant/polyMesh with {} faces, {} of them inside, and {} cell zones; patches {}; lengths in {}{}",
      poly.faces.size(), poly.neighbour.size(), file.groups.volumes.size(), fmt::join(patches, ", "),
      file.unit, file.unit == "m" ? "" : ", which OpenFOAM takes for m: ‹unit=m› converts");
}

}  // namespace

std::string type_of_patch(const MeshGroups& groups, std::size_t surface) {
  return groups.is_opening[surface] ? "patch" : "wall";
}

void write_system_of_openfoam(const MeshToWrite& file, StagedFolder& staged) {
  for (const auto& [name, text] : system_files_of_openfoam())
    if (!stands(file.folder / name)) staged.write(std::string(name), text);
}

MeshWriter openfoam_of_mesh() {
  return {
      .format = {"openfoam",
                 "OpenFOAM: constant/polyMesh beside the file, a patch a surface, cyclic ones at ends of "
                 "periods, a cell zone a region, a face zone a surface between regions",
                 ".foam", 1, true},
      .others = {"constant/polyMesh/points", "constant/polyMesh/faces", "constant/polyMesh/owner",
                 "constant/polyMesh/neighbour", "constant/polyMesh/boundary", "constant/polyMesh/cellZones",
                 "constant/polyMesh/faceZones"},
      .outdated = {"constant/polyMesh/pointZones", "constant/polyMesh/cellLevel",
                   "constant/polyMesh/pointLevel", "constant/polyMesh/level0Edge",
                   "constant/polyMesh/surfaceIndex", "constant/polyMesh/refinementHistory",
                   "constant/polyMesh/points.gz", "constant/polyMesh/faces.gz", "constant/polyMesh/owner.gz",
                   "constant/polyMesh/neighbour.gz", "constant/polyMesh/boundary.gz"},
      .for_gradients = true,
      .write = write_mesh_for_openfoam};
}

}  // namespace bernal
