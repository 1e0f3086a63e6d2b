#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/cad/read_mesh.hpp"
#include "bernal/run/run.hpp"

namespace bernal {
namespace {

struct MakeDomain {
  Unit unit;  // of the scene
  std::string* notes;

  Domain operator()(const Box& box) const { return box; }
  Domain operator()(const Cylinder& cylinder) const { return cylinder; }
  Domain operator()(const Sphere& sphere) const { return sphere; }
  Domain operator()(const MeshFile& mesh) const {
    const Unit of_file = mesh.unit.value_or(unit);
    ImportedMesh imported = read_container_mesh(mesh.file, conversion_factor(of_file, unit));
    if (notes) {
      *notes = fmt::format("{} faces; {}; coordinates are {}", imported.report.faces, imported.report.reader,
                           name_of(of_file));
      if (!imported.report.repairs.empty())
        *notes += fmt::format("; {}", fmt::join(imported.report.repairs, ", "));
    }
    return std::move(imported.mesh);
  }
  /// The unit cube where the scene gives no size.
  Domain operator()(const PeriodicBox& box) const {
    Vector<dynamic> edges = Vector<dynamic>::Constant(box.dimension, box.edge.value_or(1.0));
    if (!box.size.empty()) edges = Eigen::Map<const Eigen::VectorXd>(box.size.data(), box.dimension);
    std::vector<bool> walls(static_cast<std::size_t>(box.dimension), false);
    for (const int axis : box.walls) walls.at(static_cast<std::size_t>(axis)) = true;
    return periodic_box(edges, walls);
  }
};

}  // namespace

Domain domain_of(const Scene& scene, std::string* notes) {
  return std::visit(MakeDomain{scene.unit, notes}, scene.container);
}

Domain packed_domain_of(const Scene& scene) {
  const auto* box = std::get_if<PeriodicBox>(&scene.container);
  if (box && box->size.empty() && !box->edge)
    throw Error(
        ErrorCode::bad_scene,
        "does not say how large the periodic box is; give its \"size\", as the scene.toml that bernal "
        "pack writes beside the spheres does",
        scene.container.locations.whole);
  return domain_of(scene);
}

}  // namespace bernal
