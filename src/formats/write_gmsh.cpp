#include <cmath>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "formats/gmsh_model.hpp"
#include "io/seal.hpp"
#include "measure/touching.hpp"

namespace bernal {
namespace {

constexpr std::string_view python_ending = ".py";
constexpr double near_gap = 1e-3;  // below what meshes of the usual sizes can fail

/// Spheres of Gmsh have their poles along z and their meridian towards x.
Turn turn_to(const Seam& seam) {
  Eigen::Matrix3d to;
  to.col(0) = seam.meridian;
  to.col(2) = seam.pole;
  to.col(1) = seam.pole.cross(seam.meridian);
  const Eigen::AngleAxisd turn(to);
  return {turn.axis(), turn.angle()};
}

std::vector<CapTool> cap_tools(const Piece& piece) {
  std::vector<CapTool> tools;
  for (const Cut& cut : piece.cuts) {
    if (cut.face != Cut::contact) continue;
    const double depth = cut.keeps.offset - cut.keeps.normal.dot(piece.center), r = piece.radius;
    if (!(depth < r)) continue;
    tools.push_back({piece.center + depth * cut.keeps.normal, 2 * (r - depth) * cut.keeps.normal,
                     1.5 * std::sqrt(r * r - depth * depth)});
  }
  return tools;
}

bool has_end(const std::vector<Cut>& cuts) {
  for (const Cut& cut : cuts)
    if (cut.face != Cut::contact) return true;
  return false;
}

/// Spheres that are as they were and overlap or cross the walls; or empty.
std::string trouble_of(const Exported& file) {
  const ContactTreatment treatment = file.contacts.treatment;
  if (treatment != ContactTreatment::none && treatment != ContactTreatment::bridge) return {};
  if (file.overlap > 0) return "spheres overlap, and contact gap, shrink or cap makes room";
  if (file.protruding > 0) return "spheres cross the walls, and contact gap, shrink or cap makes room";
  return {};
}

/// Whether spheres that nobody treated come so near each other or the walls that meshing is doubtful.
bool comes_near(const Exported& file) {
  return file.contacts.treatment == ContactTreatment::none &&
         (!near_pairs(file.spheres, file.domain, near_gap).empty() ||
          !near_walls(file.spheres, file.domain, near_gap, nullptr).empty());
}

void write_gmsh(const Exported& file, StagedFolder& staged) {
  if (file.output.file.string().find_first_of("\"\\") != std::string::npos)
    throw Error(
        ErrorCode::bad_argument,
        "has a quotation mark or a backslash in its name, which scripts of Gmsh cannot write; give it "
        "another name",
        {file.name()});
  const int exponent = exponent_of_model(file.domain);
  const Exported scaled = in_length_of_model(file, exponent);
  const GmshModel model(scaled, exponent);
  staged.write(file.output.file.string(), gmsh_geo(model));
  staged.write(file_beside(file.output.file, python_ending), sealed_script(gmsh_python(model)));
}

std::string note_of_gmsh(const Exported& file) {
  std::string note = fmt::format("{} solids", file.solids.pieces.size() + file.solids.bridges.size());
  if (std::isfinite(file.solids.end_distance))
    note += fmt::format(", ends of the periods at least {:.3g} radii from touching a sphere",
                        file.solids.end_distance);
  const std::string python = file_beside(file.output.file, python_ending);
  if (const std::string trouble = trouble_of(file); !trouble.empty())
    return note + fmt::format("; no mesh is to be expected of {} and {}: {}", as_word(python),
                              file.name_as_word(), trouble);
  note += fmt::format("; python3 {} makes the mesh, or gmsh {} -", as_word(python), file.name_as_word());
  if (comes_near(file))
    note += fmt::format(
        "; nothing has been done about gaps below {} radii, where elements become poor or none are made: "
        "contact gap",
        near_gap);
  return note;
}

}  // namespace

GmshModel::GmshModel(const Exported& exported, int exponent_of_length)
    : file(exported),
      exponent(exponent_of_length),
      solids(exported.solids),
      bounds(bounds_of(exported.domain)),
      periods(exported.periods()) {
  const std::vector<Seam> seams = seams_of(solids);
  for (std::size_t p = 0; p < solids.pieces.size(); ++p) {
    const Piece& piece = solids.pieces[p];
    turns.push_back(piece.cuts.empty() ? Turn() : turn_to(seams[p]));
    caps.push_back(cap_tools(piece));
    if (has_end(piece.cuts)) cut_pieces.push_back(p);
  }
  for (std::size_t b = 0; b < solids.bridges.size(); ++b)
    if (has_end(solids.bridges[b].cuts)) cut_bridges.push_back(b);
  if (const auto* mesh = std::get_if<Mesh>(&file.domain))
    faces = flat_faces_of(*mesh, 1e-9 * bounds.diagonal());
  places = narrow_places_of(solids, file.output.mesh_size, file.output.mesh_gap);
  largest_size = file.output.mesh_size * (file.size() ? file.largest_radius() : bounds.diagonal() / 10);
}

std::string GmshModel::trouble() const { return trouble_of(file); }

std::string GmshModel::unit_in_words() const {
  const std::string_view unit = name_of(file.unit());
  return exponent == 0 ? std::string(unit) : fmt::format("{0} (built in lengths of {1} {0})", unit, length());
}

std::string GmshModel::name_of_type(std::uint32_t type) const {
  return file.type_count == 1 ? "spheres" : fmt::format("spheres_{}", type);
}

const Format& gmsh_format() {
  static const Format format{
      .table =
          {.keys = output_entry(
               "gmsh",
               "Gmsh 4.8 and later: a .geo and a Python script, either makes conforming tetrahedra of "
               "matrix and spheres with equal nodes at opposite ends of periods. The walls of a CAD part "
               "are its triangles, joined to polygons where they lie in one plane",
               {"unit", "types", "bridge_radius", "mesh_size", "mesh_gap", "mesh_order"}),
           .file = "packing.geo",
           .endings = {python_ending},
           .sizes = "solids",
           .solids = true},
      .write = write_gmsh,
      .note = note_of_gmsh};
  return format;
}

}  // namespace bernal
