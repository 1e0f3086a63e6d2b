#include <cmath>

#include <fmt/format.h>

#include "cad/write_shapes.hpp"
#include "export/format.hpp"
#include "solids/flat_faces.hpp"

namespace bernal {
namespace {

constexpr std::size_t most_faces = 5000;  // of a container: sewing takes a minute

std::vector<cad::BallShape::Plane> planes_of(const std::vector<Cut>& cuts) {
  std::vector<cad::BallShape::Plane> planes;
  for (const Cut& cut : cuts) planes.push_back({cut.keeps.normal, cut.keeps.offset});
  return planes;
}

cad::SolidShapes shapes_of(const Exported& file) {
  const Solids& solids = file.solids;
  const std::vector<Seam> seams = seams_of(solids);
  cad::SolidShapes shapes{.balls = {}, .necks = {}, .type_names = {}, .domain = file.domain, .faces = {}};
  for (std::size_t p = 0; p < solids.pieces.size(); ++p) {
    const Piece& piece = solids.pieces[p];
    shapes.balls.push_back({piece.center, piece.radius, seams[p].pole, seams[p].meridian,
                            planes_of(piece.cuts), file.types[piece.sphere]});
  }
  for (const Bridge& bridge : solids.bridges)
    shapes.necks.push_back({bridge.rims,
                            bridge.radius,
                            {solids.spheres.r[bridge.spheres[0]], solids.spheres.r[bridge.spheres[1]]},
                            planes_of(bridge.cuts)});
  for (std::uint32_t type = 1; type <= file.type_count; ++type)
    shapes.type_names.push_back(file.type_count == 1 ? "spheres" : fmt::format("spheres_{}", type));
  if (const auto* mesh = std::get_if<Mesh>(&file.domain)) {
    const std::vector<FlatFace> faces = flat_faces_of(*mesh, 1e-9 * bounds_of(file.domain).diagonal());
    if (faces.size() <= most_faces)
      for (const FlatFace& face : faces) shapes.faces.push_back(face.loops);
  }
  return shapes;
}

template <cad::SolidFormat format>
std::string write_cad(const Exported& file, StagedFolder& staged) {
  const cad::WrittenShapes written =
      cad::write_with_opencascade(shapes_of(file), format, staged.add(file.output.file.string()));
  const double exact = file.contacts.volume_after;
  const double off = exact > 0 ? std::abs(written.volume / exact - 1) : 0;
  return fmt::format(
      "{} solids of spheres and images, volumes in OpenCASCADE within {:.1g} of the exact ones; {}",
      written.solids, off,
      written.has_container ? "the container is a solid of its own"
                            : "the container is left out: it has too many faces");
}

}  // namespace

const Format& step_format() {
  static const Format format{
      .table = {.keys =
                    output_entry("step",
                                 "STEP, in millimetres: spheres as true spheres, cut at the ends of periods, "
                                 "products by type, and the container as a solid",
                                 {"types", "bridge_radius"}),
                .file = "spheres.step",
                .unit = Unit::mm,
                .sizes = "solids",
                .solids = true},
      .write_and_tell = write_cad<cad::SolidFormat::step>};
  return format;
}

const Format& brep_format() {
  static const Format format{
      .table = {.keys = output_entry("brep", "BREP of OpenCASCADE, the same as STEP without names and units",
                                     {"unit", "types", "bridge_radius"}),
                .file = "spheres.brep",
                .sizes = "solids",
                .solids = true},
      .write_and_tell = write_cad<cad::SolidFormat::brep>};
  return format;
}

}  // namespace bernal
