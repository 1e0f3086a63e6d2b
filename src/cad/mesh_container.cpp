#include "bernal/cad/mesh_container.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bernal/core/error.hpp"
#include "bernal/core/tolerance.hpp"
#include "cad/clearance_field.hpp"
#include "cad/repeated_container.hpp"
#include "cad/triangle_tree.hpp"
#include "domain/free_path.hpp"
#include "domain/inset_container.hpp"
#include "geometry/openings.hpp"

namespace bernal {
namespace {

class MeshContainer final : public Container {
 public:
  /// `around`: the mesh itself, or where it repeats itself with its images.
  MeshContainer(const Mesh& mesh, const Mesh& around, WallArithmetic arithmetic, double resolution)
      : Container(arithmetic, resolution),
        bounds_(bounds_of(mesh)),
        volume_(volume_of(mesh)),
        tree_(around),
        field_(tree_, bounds_, mesh.periodic) {}

  std::string_view kind() const override { return "mesh"; }
  Bounds<3> bounds() const override { return bounds_; }
  double volume() const override { return volume_; }

  double clearance(const Vector<3>& p) const override {
    return clearance_within(p, std::numeric_limits<double>::infinity());
  }

  double clearance_within(const Vector<3>& p, double reach) const override {
    const cad::ClearanceBounds known = field_.at(p);
    if (known.lower >= reach) return reach;
    const cad::Side side = field_.side(p);
    if (side == cad::Side::wall) return std::min(0.0, reach);
    if (side == cad::Side::outside) return -tree_.distance(p, -known.lower);
    return tree_.distance(p, std::min(reach, known.upper));
  }

  bool contains(const Vector<3>& c, double r) const override {
    // Exact arithmetic throughout takes no shortcut.
    const cad::ClearanceBounds known =
        arithmetic() == WallArithmetic::exact ? cad::ClearanceBounds{} : field_.at(c);
    if (known.lower >= r && known.inside()) return true;
    if (known.outside() || known.upper < r) return false;
    return tree_.clears(c, r, arithmetic()) && field_.side(c) != cad::Side::outside;
  }

  void facets_near(const Vector<3>& c, double reach, std::vector<NearFacet>& out) const override {
    few_facets_near(c, reach, std::numeric_limits<std::size_t>::max(), out);
  }

  bool few_facets_near(const Vector<3>& c, double reach, std::size_t most,
                       std::vector<NearFacet>& out) const override {
    return field_.at(c).lower >= reach || tree_.within(c, reach, out, most);
  }

  void contacts(const Vector<3>& c, double r, std::vector<WallContact>& out) const override {
    if (field_.at(c).lower < r) tree_.contacts(c, r, out);
  }

  double first_contact(const Vector<3>& c, double r, const Vector<3>& direction,
                       double limit) const override {
    const double skin = tolerance::skin(r, resolution());
    if (field_.at(c).lower >= r + skin + limit) return limit;
    return tree_.first_contact(c, r, direction, limit, skin);
  }

  double free_path(const Vector<3>& c, double r, const Vector<3>& direction, double limit) const override {
    const double speed = direction.stableNorm();
    const Motion motion{c, r, direction, limit};
    const double bound = free_path_bound(c, r);
    if (arithmetic() != WallArithmetic::exact && field_.at(c).lower >= r + bound + limit * speed)
      return limit;
    if (arithmetic() != WallArithmetic::plain) return tree_.free_path(motion, bound, arithmetic());
    if (!(speed > 0)) return contains(c, r) ? limit : 0;
    const double way = limit * speed;
    const double path = tree_.first_contact(c, r, direction / speed, way, plain_skin * bound);
    return path == way ? limit : std::min(limit, path / speed);
  }

 private:
  Bounds<3> bounds_;
  double volume_;
  cad::TriangleTree tree_;
  cad::ClearanceField field_;
};

}  // namespace

std::unique_ptr<Container> make_mesh_container(const Mesh& mesh, WallArithmetic arithmetic,
                                               double resolution) {
  if (mesh.triangles.size() < 4)
    throw Error(ErrorCode::bad_argument, "a mesh container needs a closed mesh; use read_container_mesh");
  std::unique_ptr<Container> facets;
  if (mesh.repeats()) {
    const std::array<int, 3> images = cad::images_around(mesh);
    const RepeatedMesh around = repeated(mesh, images);
    facets = cad::make_repeated_container(
        std::make_unique<MeshContainer>(mesh, around.mesh, arithmetic, resolution), mesh, images,
        around.mesh.triangles.size() - around.closures);
  } else {
    facets = std::make_unique<MeshContainer>(mesh, mesh, arithmetic, resolution);
  }
  if (mesh.inset == 0) return facets;
  return make_inset_container(std::move(facets), mesh.inset, volume_of(mesh));
}

std::unique_ptr<Container> make_container(const Domain& shape, WallArithmetic arithmetic, double resolution) {
  if (const auto* mesh = std::get_if<Mesh>(&shape)) return make_mesh_container(*mesh, arithmetic, resolution);
  return make_analytic_container(shape, arithmetic, resolution);
}

std::unique_ptr<Container> make_local_container(const Domain& of_scene, const Frame& frame,
                                                WallArithmetic arithmetic) {
  return make_container(to_local(of_scene, frame), arithmetic, frame.resolution);
}

std::shared_ptr<const Container> local_container(const Domain& of_scene,
                                                 const std::shared_ptr<const Container>& made) {
  return made ? made : make_local_container(of_scene, frame_of(of_scene), WallArithmetic::plain);
}

}  // namespace bernal
