#pragma once
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <variant>

#include "bernal/cad/mesh_container.hpp"
#include "bernal/core/dimension.hpp"
#include "bernal/plan/plan.hpp"
#include "bernal/scene/read_scene.hpp"
#include "cad/open_ends.hpp"
#include "plan/estimate.hpp"

// Plans that no scene file can state: of a given mesh, or of a scene that has been scaled and shifted.
namespace bernal::testing {

/// A size distribution with every radius multiplied.
class ScaledSizes : public SizeDistribution {
 public:
  ScaledSizes(std::unique_ptr<SizeDistribution> sizes, double factor)
      : SizeDistribution(factor * sizes->min(), factor * sizes->max()),
        sizes_(std::move(sizes)),
        factor_(factor) {}

  double quantile(double p) const override { return factor_ * sizes_->quantile(p); }
  double cumulative(double radius) const override { return sizes_->cumulative(radius / factor_); }
  double moment(int k) const override { return std::pow(factor_, k) * sizes_->moment(k); }
  double moment_above(int k, double radius) const override {
    return std::pow(factor_, k) * sizes_->moment_above(k, radius / factor_);
  }
  double radius_at(double u) const override { return factor_ * sizes_->radius_at(u); }
  std::vector<double> atoms() const override {
    std::vector<double> all = sizes_->atoms();
    for (double& radius : all) radius *= factor_;
    return all;
  }

 private:
  std::unique_ptr<SizeDistribution> sizes_;
  double factor_;
};

/// Rounding of its corners has moved them, less than this.
inline void make_period_exact(Mesh& mesh) {
  constexpr double rounding = 1e-12;
  double farthest = 0;
  for (const Vector<3>& v : mesh.vertices) farthest = std::max(farthest, v.cwiseAbs().maxCoeff());
  if (mesh.repeats()) cad::open_ends(mesh, mesh.periodic, rounding * farthest);
}

inline Domain scaled(Domain shape, double factor) {
  if (auto* box = std::get_if<Box>(&shape)) {
    box->corner *= factor;
    box->size *= factor;
    box->tilt = bernal::scaled(box->tilt, factor);
  } else if (auto* cylinder = std::get_if<Cylinder>(&shape)) {
    cylinder->base *= factor;
    cylinder->radius *= factor;
    cylinder->height *= factor;
  } else if (auto* sphere = std::get_if<Sphere>(&shape)) {
    sphere->center *= factor;
    sphere->radius *= factor;
  } else if (auto* polygon = std::get_if<Polygon>(&shape)) {
    for (auto& loop : polygon->loops)
      for (Vector<2>& v : loop) v *= factor;
  } else if (auto* revolved = std::get_if<Revolved>(&shape)) {
    revolved->base *= factor;
    for (Vector<2>& v : revolved->profile) v *= factor;
  } else {
    for (Vector<3>& v : std::get<Mesh>(shape).vertices) v *= factor;
    make_period_exact(std::get<Mesh>(shape));
  }
  return shape;
}

inline Domain shifted(Domain shape, const Vector<3>& by) {
  if (auto* box = std::get_if<Box>(&shape)) {
    box->corner += by.head(box->dimension());
  } else if (auto* cylinder = std::get_if<Cylinder>(&shape)) {
    cylinder->base += by;
  } else if (auto* sphere = std::get_if<Sphere>(&shape)) {
    sphere->center += by;
  } else if (auto* polygon = std::get_if<Polygon>(&shape)) {
    for (auto& loop : polygon->loops)
      for (Vector<2>& v : loop) v += by.head<2>();
  } else if (auto* revolved = std::get_if<Revolved>(&shape)) {
    revolved->base += by;
  } else {
    for (Vector<3>& v : std::get<Mesh>(shape).vertices) v += by;
    make_period_exact(std::get<Mesh>(shape));
  }
  return shape;
}

inline void scale(std::vector<Layer>& layers, double factor) {
  for (Layer& layer : layers) {
    if (layer.radius) *layer.radius *= factor;
    if (!layer.thickness) continue;
    layer.thickness->mean *= factor;
    layer.thickness->sd *= factor;
    if (layer.thickness->min) *layer.thickness->min *= factor;
    if (layer.thickness->max) *layer.thickness->max *= factor;
  }
}

/// Without what lies inside of its spheres, whose scenes have lengths of their own.
inline Plan scaled(Plan plan, double factor) {
  scale(plan.scene.layers, factor);
  if (auto* classes = std::get_if<Classes>(&plan.scene.sizes))
    for (std::vector<Layer>& layers : classes->layers) scale(layers, factor);
  plan.insides.clear();
  plan.scene.inside.clear();
  plan.domain = scaled(std::move(plan.domain), factor);
  plan.container = nullptr;
  plan.radii = std::make_unique<ScaledSizes>(std::move(plan.radii), factor);
  for (auto& column : plan.start.spheres.x)
    for (double& x : column) x *= factor;
  for (double& r : plan.start.spheres.r) r *= factor;
  plan.start.edges *= factor;
  plan.scene.gap *= factor;
  plan.scene.wall_gap *= factor;
  return plan;
}

/// A box of kind "periodic" has no place.
inline Plan shifted(Plan plan, const Vector<3>& by) {
  if (!plan.scene.is_periodic()) {
    plan.domain = shifted(std::move(plan.domain), by);
    for (std::size_t i = 0; i < plan.start.spheres.size(); ++i)
      plan.start.spheres.set_center(i, plan.start.spheres.center(i) + by);
  }
  plan.container = nullptr;
  return plan;
}

/// The plan of a scene in TOML.
inline Plan plan_of(const std::string& toml) { return build(parse_scene(toml, "test.toml")); }

/// The same with the container replaced, and what is likely to fit into it.
inline Plan plan_of(const std::string& toml, Domain container) {
  Plan plan = plan_of(toml);
  plan.container = plan.scene.is_periodic()
                       ? nullptr
                       : make_local_container(container, frame_of(container), plan.scene.walls);
  plan.attainable_packing_fraction =
      expected_packing_fraction(plan.scene, container, *plan.radii, plan.container);
  const double spheres_to_fill = volume_of(container) / (ball_volume(3, 1) * plan.radii->moment(3));
  plan.expected_count = plan.attainable_packing_fraction * spheres_to_fill;
  if (plan.scene.target.count)
    plan.expected_count = std::min(plan.expected_count, static_cast<double>(*plan.scene.target.count));
  plan.expected_packing_fraction = plan.expected_count / spheres_to_fill;
  plan.expected_memory_bytes = 0;
  plan.domain = std::move(container);
  return plan;
}

}  // namespace bernal::testing
