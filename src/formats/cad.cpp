#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "cad/write_shapes.hpp"
#include "formats/format.hpp"
#include "formats/layered.hpp"
#include "solids/flat_faces.hpp"

namespace bernal {
namespace {

constexpr std::size_t most_faces = 100'000;  // of a container

std::vector<cad::BallShape::Plane> planes_of(const std::vector<Cut>& cuts) {
  std::vector<cad::BallShape::Plane> planes;
  for (const Cut& cut : cuts) planes.push_back({cut.keeps.normal, cut.keeps.offset});
  return planes;
}

/// How far the part that planes keep is from a ball's centre, 0 where it holds that, and which of the planes
/// cut a ball of that radius. Planes that meet are perpendicular.
struct CutsOfBall {
  CutsOfBall(const Vector<3>& center, double radius, const std::vector<Cut>& all) {
    constexpr double touch = 1e-6;  // relative: what is thinner OpenCASCADE does not make
    double squared = 0;
    for (const Cut& cut : all) {
      const double depth = cut.keeps.offset - cut.keeps.normal.dot(center);
      if (depth < 0) squared += depth * depth;
      if (depth < (1 - touch) * radius) cuts.push_back(cut);
    }
    is_there = squared < (1 - touch) * (1 - touch) * radius * radius;
  }
  std::vector<Cut> cuts;
  bool is_there = true;
};

/// A solid for each layer of a piece.
void add_layers(const Piece& piece, const Seam& seam, const LayeredSpheres& layers,
                std::vector<cad::BallShape>& balls) {
  const std::span<const double> outer = layers.of(piece.sphere);
  for (std::size_t k = 0; k < outer.size(); ++k) {
    const CutsOfBall cut(piece.center, outer[k], piece.cuts);
    if (!cut.is_there) continue;
    const double inner = k == 0 ? 0 : outer[k - 1];
    balls.push_back({piece.center, outer[k], seam.pole, seam.meridian, planes_of(cut.cuts),
                     layers.kind[layers.first[piece.sphere] + k] + 1,
                     CutsOfBall(piece.center, inner, piece.cuts).is_there ? inner : 0});
  }
}

cad::SolidShapes shapes_of(const Exported& file) {
  const Solids& solids = file.solids;
  const std::vector<Seam> seams = seams_of(solids);
  cad::SolidShapes shapes{.balls = {}, .necks = {}, .type_names = {}, .domain = file.domain, .faces = {}};
  const bool by_layers = shows_layers(file);
  const LayeredSpheres layers = by_layers ? layered(file) : LayeredSpheres();
  for (std::size_t p = 0; p < solids.pieces.size(); ++p) {
    const Piece& piece = solids.pieces[p];
    if (by_layers) {
      add_layers(piece, seams[p], layers, shapes.balls);
      continue;
    }
    shapes.balls.push_back({piece.center, piece.radius, seams[p].pole, seams[p].meridian,
                            planes_of(piece.cuts), file.types[piece.sphere]});
  }
  for (const Bridge& bridge : solids.bridges)
    shapes.necks.push_back({bridge.rims,
                            bridge.radius,
                            {solids.spheres.r[bridge.spheres[0]], solids.spheres.r[bridge.spheres[1]]},
                            planes_of(bridge.cuts)});
  for (std::uint32_t type = 1; !by_layers && type <= file.type_count; ++type)
    shapes.type_names.push_back(file.name_of_type(type));
  for (const LayeredSpheres::Kind& kind : layers.kinds) shapes.type_names.push_back(kind.name);
  if (const auto* mesh = std::get_if<Mesh>(&file.domain)) {
    const std::vector<FlatFace> faces = flat_faces_of(*mesh, 1e-9 * bounds_of(file.domain).diagonal());
    if (faces.size() <= most_faces)
      for (const FlatFace& face : faces) shapes.faces.push_back(face.loops);
  }
  return shapes;
}

/// OpenCASCADE merges points closer than 1e-7, in any unit. A cut displaced by this leaves a wedge of that
/// width and height: relative to a ball's volume, the square of 1e-7 over its radius.
constexpr double confusion = 1e-7, least_error = 1e-9;

void require_size(const Exported& file) {
  if (file.spheres.empty()) return;
  const double smallest = shows_layers(file) ? std::ranges::min(layered(file).outer)
                                             : std::ranges::min(file.spheres.r),
               least = confusion / std::sqrt(least_error);
  if (smallest >= least) return;
  std::string remedy = "scale the packing up";
  for (const Unit unit : {Unit::mm, Unit::um, Unit::nm}) {
    if (smallest * conversion_factor(file.unit(), unit) < least) continue;
    remedy = fmt::format("the format brep takes the unit {}", name_of(unit));
    break;
  }
  throw Error(ErrorCode::bad_argument,
              fmt::format("spheres down to a radius of {:.3g} {} are too small for OpenCASCADE, whose "
                          "volumes are exact from {:.2g} on; {}",
                          smallest, name_of(file.unit()), least, remedy),
              {file.name()});
}

template <cad::SolidFormat format>
std::string write_cad(const Exported& file, StagedFolder& staged) {
  require_size(file);
  const cad::WrittenShapes written =
      cad::write_with_opencascade(shapes_of(file), format, staged.add(file.output.file.string()));
  const double exact = file.contacts.volume_after;
  const double off = exact > 0 ? std::abs(written.volume / exact - 1) : 0;
  return fmt::format(
      "{} solids of spheres{} and images, volumes in OpenCASCADE within {:.1g} of the exact ones; {}",
      written.solids, shows_layers(file) ? ", a layer each," : "", off,
      written.has_container ? "the container is a solid of its own"
                            : fmt::format("the container is left out, for it has more than {} flat faces; "
                                          "the format stl has it, with ‹surface=container›",
                                          grouped(most_faces)));
}

template <cad::SolidFormat format>
Format cad_format(std::string_view name, std::string_view help, std::string_view file,
                  const std::vector<std::string_view>& keys) {
  return {.name = name,
          .writes = help,
          .keys = keys,
          .file = file,
          .sizes = "solids",
          .solids = true,
          .write_with_note = write_cad<format>};
}

}  // namespace

Format step_format() {
  Format made = cad_format<cad::SolidFormat::step>(
      "step",
      "STEP, in millimetres: spheres as true spheres, cut at the ends of periods, products by type, and the "
      "container as a solid",
      "spheres.step", {"types", "bridge_radius", "layers"});
  made.unit = Unit::mm;
  return made;
}

Format brep_format() {
  return cad_format<cad::SolidFormat::brep>("brep",
                                            "BREP of OpenCASCADE, the same as STEP without names and units",
                                            "spheres.brep", {"unit", "types", "bridge_radius", "layers"});
}

}  // namespace bernal
