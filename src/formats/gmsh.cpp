#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "domain/revolved_surface.hpp"
#include "formats/format.hpp"
#include "formats/templates.hpp"
#include "measure/touching.hpp"
#include "scene/toml_text.hpp"
#include "solids/flat_faces.hpp"
#include "solids/narrow_places.hpp"

namespace bernal {
namespace {

constexpr double near_gap = 1e-3;  // gaps below this can make usual meshes fail

/// OpenCASCADE merges points closer than 1e-7 in any unit, and loses digits of large numbers: a domain with a
/// diagonal not between 1 and 1000 is built in a model unit, a power of ten of the file's, in which it is
/// between 10 and 100; its mesh is written in the file's unit.
int exponent_of_model(const Domain& domain) {
  constexpr double smallest = 1, largest = 1e3;
  const double diagonal = bounds_of(domain).diagonal();
  if (!(diagonal > 0 && std::isfinite(diagonal)) || (diagonal >= smallest && diagonal <= largest)) return 0;
  return static_cast<int>(std::floor(std::log10(diagonal))) - 1;
}

/// Converts to lengths of ten to the power of `exponent`; other quantities stay. A negative power of ten is
/// no double: with whole numbers only the result is rounded.
Exported in_length_of_model(const Exported& file, int exponent) {
  const double times = exponent < 0 ? std::pow(10, -exponent) : 1,
               by = exponent > 0 ? std::pow(10, exponent) : 1;
  const auto into = [=](double length) { return length * times / by; };
  const Mapping mapping{[=](double x, int) { return into(x); }, into};
  const auto convert_report = [&](ContactReport& report) {
    for (double* volume : {&report.volume_before, &report.volume_after, &report.domain_volume})
      *volume = into(into(into(*volume)));
    report.contact_area = into(into(report.contact_area));
  };
  Exported made = file;
  mapping.map(made.spheres);
  made.domain = mapping.of(made.domain);
  convert_report(made.contacts);
  Solids& solids = made.solids;
  mapping.map(solids.spheres);
  solids.domain = mapping.of(solids.domain);
  convert_report(solids.contacts);
  for (Piece& piece : solids.pieces) {
    piece.center = mapping.point(piece.center);
    piece.radius = into(piece.radius);
    for (Cut& cut : piece.cuts) cut.keeps.offset = into(cut.keeps.offset);
  }
  return made;
}

/// The reason why no solids can be made: untreated spheres that overlap or cross the walls; empty if there is
/// none.
std::string reason_against_solids(const Exported& file) {
  if (file.contacts.treatment != ContactTreatment::none) return {};
  if (file.overlap > 0) return "spheres overlap, and contact gap or shrink makes room";
  if (file.protruding > 0) return "spheres cross the walls, and contact gap or shrink makes room";
  return {};
}

/// Whether untreated spheres come so close to each other or the walls that meshing is doubtful.
bool comes_near(const Exported& file) {
  return file.contacts.treatment == ContactTreatment::none &&
         (!near_pairs(file.spheres, file.domain, near_gap).empty() ||
          !near_walls(file.spheres, file.domain, near_gap, nullptr).empty());
}

/// The rotation about a sphere's centre that moves its seam to a better place, see `Seam`. Gmsh's spheres
/// have their poles along z and their meridian towards x.
Eigen::AngleAxisd turn_to(const Seam& seam) {
  Eigen::Matrix3d to;
  to.col(0) = seam.meridian;
  to.col(2) = seam.pole;
  to.col(1) = seam.pole.cross(seam.meridian);
  return Eigen::AngleAxisd(to);
}

std::string numbers(const Vector<3>& v) { return row_of(v, ", "); }

/// The Python expression that makes volume 1.
struct PythonDomain {
  std::string operator()(const Box& box) const {
    return fmt::format("(\"Box\", {}, {})", numbers(box.corner), numbers(box.size));
  }
  std::string operator()(const Cylinder& cylinder) const {
    return fmt::format("(\"Cylinder\", {}, {}, {})", numbers(cylinder.base),
                       numbers(cylinder.height * cylinder.axis.normalized()), cylinder.radius);
  }
  std::string operator()(const Sphere& sphere) const {
    return fmt::format("(\"Sphere\", {}, {})", numbers(sphere.center), sphere.radius);
  }
  std::string operator()(const Mesh& mesh) const {
    std::string corners, polygons;
    for (const Vector<3>& v : mesh.vertices) corners += fmt::format("    ({}),\n", numbers(v));
    for (const FlatFace& face : flat_faces_of(mesh, 1e-9 * bounds_of(Domain(mesh)).diagonal()))
      polygons += fmt::format("    {},\n", face.loops);
    return fmt::format("(\"Polyhedron\", [\n{}], [\n{}])", corners, polygons);
  }
  std::string operator()(const Revolved& revolved) const {
    constexpr int sides = 96;  // each of which gmsh makes a surface of
    return (*this)(surface_of(revolved, sides, RoundAs::circumscribed));
  }
  std::string operator()(const Polygon&) const { return "()"; }
};

std::string pieces_in_python(const Exported& file) {
  const std::vector<Seam> seams = seams_of(file.solids);
  std::string text;
  for (std::size_t p = 0; p < file.solids.pieces.size(); ++p) {
    const Piece& piece = file.solids.pieces[p];
    const Eigen::AngleAxisd turn =
        piece.cuts.empty() ? Eigen::AngleAxisd(0, Vector<3>::UnitZ()) : turn_to(seams[p]);
    text += fmt::format("    ({}, {}, {}, {:.6g}, {:.6g}, {:.6g}, {:.6g}),\n", numbers(piece.center),
                        piece.radius, file.types[piece.sphere], turn.axis()[0], turn.axis()[1],
                        turn.axis()[2], turn.angle());
  }
  return text;
}

/// The numbers of the volumes that an end of a period cuts: 1 is the domain, followed by the pieces in order.
std::string cut_volumes(const Solids& solids) {
  std::vector<std::size_t> volumes;
  for (std::size_t p = 0; p < solids.pieces.size(); ++p)
    if (!solids.pieces[p].cuts.empty()) volumes.push_back(2 + p);
  return fmt::format("{}", fmt::join(volumes, ", "));
}

std::string narrow_places_in_python(const Exported& file) {
  std::string text;
  for (const NarrowPlace& place : narrow_places_of(file.solids, file.output.mesh_size, file.output.mesh_gap))
    text += fmt::format("    ({:.9g}, {:.9g}, {:.9g}, {:.6g}, {:.6g}, {:.6g}, {:.5g}, {:.5g}, {:.5g}, {}),\n",
                        place.point[0], place.point[1], place.point[2], place.normal[0], place.normal[1],
                        place.normal[2], place.reach, place.size, place.size_beside, place.layer);
  return text;
}

std::string names_of_groups(const Exported& file) {
  std::vector<std::string> names;
  for (std::uint32_t type = 1; type <= file.type_count; ++type)
    names.push_back(toml_string(file.name_of_type(type)));
  return fmt::format("{}", fmt::join(names, ", "));
}

/// Exact volume fractions: of whole balls, by type, and of the rest. Empty where balls overlap or stick out.
std::string exact_fractions(const Exported& file) {
  if (!reason_against_solids(file).empty()) return {};
  const double total = volume_of(file.domain);
  std::vector<double> of_type(file.type_count, 0.0);
  const auto& radii = file.solids.spheres.r;
  for (std::size_t i = 0; i < radii.size(); ++i)
    of_type[file.types[i] - 1] += cap_volume(radii[i], 2 * radii[i]);
  double solid = 0;
  for (const double volume : of_type) solid += volume;
  std::string text = fmt::format("\"matrix\": {}", 1 - solid / total);
  for (std::uint32_t type = 1; type <= file.type_count; ++type)
    text += fmt::format(", {}: {}", toml_string(file.name_of_type(type)), of_type[type - 1] / total);
  return text;
}

void write_gmsh(const Exported& exported, StagedFolder& staged) {
  const int exponent = exponent_of_model(exported.domain);
  const Exported file = in_length_of_model(exported, exponent);
  const std::string_view unit = name_of(file.unit());
  const std::string length = exponent == 0 ? "1" : fmt::format("1e{}", exponent);
  const Bounds<3> bounds = bounds_of(file.domain);
  staged.write(
      file.output.file.string(),
      filled(gmsh_py,
             {{"TITLE", file.title()},
              {"UNIT", exponent == 0 ? std::string(unit)
                                     : fmt::format("{0} (built in lengths of {1} {0})", unit, length)},
              {"NAMES", names_of_groups(file)},
              {"EXACT", exact_fractions(file)},
              {"TROUBLE", toml_string(reason_against_solids(file))},
              {"LOWER", numbers(bounds.lower)},
              {"UPPER", numbers(bounds.upper)},
              {"PERIODIC", periods_in_python(file)},
              {"IS_BOX", std::holds_alternative<Box>(file.domain) ? "True" : "False"},
              {"LENGTH", length},
              {"MESH_SIZE", fmt::format("{}", file.output.mesh_size)},
              {"LARGEST_SIZE",
               fmt::format("{}", file.output.mesh_size *
                                     (file.size() ? file.largest_radius() : bounds.diagonal() / 10))},
              {"MESH_ORDER", fmt::format("{}", file.output.mesh_order)},
              {"PIECES", pieces_in_python(file)},
              {"CUT_AT_ENDS", cut_volumes(file.solids)},
              {"NARROW", narrow_places_in_python(file)},
              {"DOMAIN", std::visit(PythonDomain(), file.domain)}}));
}

std::string note_of_gmsh(const Exported& file) {
  std::string note = fmt::format("{} solids", file.solids.pieces.size());
  if (std::isfinite(file.solids.end_distance))
    note += fmt::format(", ends of the periods at least {:.3g} radii from touching a sphere",
                        file.solids.end_distance);
  if (const std::string trouble = reason_against_solids(file); !trouble.empty())
    return note + fmt::format("; no mesh is to be expected of {}: {}", file.name_as_word(), trouble);
  note += fmt::format("; python3 {} makes the mesh", file.name_as_word());
  if (comes_near(file))
    note += fmt::format(
        "; nothing has been done about gaps below {} radii, where elements become poor or none are made: "
        "contact gap",
        near_gap);
  return note;
}

/// .geo is for scripts in Gmsh's own language.
void require_python_ending(const void* options, const schema::Section& section) {
  const std::filesystem::path& file = static_cast<const Output*>(options)->file;
  if (file.extension() == ".geo")
    section.fail("file", fmt::format("the script that Gmsh is driven by is Python; name it {}",
                                     toml_string(file_beside(file, ".py"))));
}

}  // namespace

Format gmsh_format() {
  return {
      .name = "gmsh",
      .writes =
          "Gmsh 4.8 and later: a Python script that makes conforming tetrahedra of matrix and spheres with "
          "equal nodes at opposite ends of periods. The walls of a CAD part are its triangles, joined to "
          "polygons where they lie in one plane",
      .keys = {"unit", "types", "mesh_size", "mesh_gap", "mesh_order"},
      .file = "packing.py",
      .sizes = "solids",
      .solids = true,
      .rule = require_python_ending,
      .write = write_gmsh,
      .note = note_of_gmsh};
}

}  // namespace bernal
