#include "meshes/mesh_sizes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bernal/cad/mesh_container.hpp"

namespace bernal {
namespace {

/// Of edges on walls beside the largest spheres: flat walls far from all spheres have up to so many times as
/// long ones. On walls of a mesh that stand for curved ones, `SmoothWalls` limits them.
double most_far_away(const Domain& domain) {
  return std::holds_alternative<Box>(domain) || std::holds_alternative<Mesh>(domain) ? 8 : 1;
}

double largest_of(const std::vector<double>& r) { return r.empty() ? 1 : std::ranges::max(r); }

}  // namespace

std::vector<double> spaced(double length, int least, const std::function<double(double)>& size) {
  // Samples are not farther apart than sizes, as far as these do not change on less than their own length.
  int samples = 64;
  std::vector<double> sum;
  for (;;) {
    sum.assign(1, 0);
    double smallest = std::numeric_limits<double>::infinity();
    for (int k = 0; k < samples; ++k) {
      const double here = size((k + 0.5) / samples);
      smallest = std::min(smallest, here);
      sum.push_back(sum.back() + length / samples / here);
    }
    if (length / samples <= smallest || samples > (1 << 20)) break;
    samples *= 4;
  }
  const int n = std::max(least, static_cast<int>(std::ceil(sum.back())));
  std::vector<double> shares;
  std::size_t k = 0;
  for (int i = 1; i < n; ++i) {
    const double wanted = sum.back() * i / n;
    while (sum[k + 1] < wanted) ++k;
    shares.push_back((static_cast<double>(k) + (wanted - sum[k]) / (sum[k + 1] - sum[k])) / samples);
  }
  return shares;
}

MeshSizes::MeshSizes(const Solids& solids, const SurfaceMeshOptions& options)
    : solids_(solids),
      options_(options),
      boundary_(boundary_of<3>(solids.domain)),
      spheres_(solids.spheres.in<3>()),
      grid_(spheres_, boundary_, 2 * largest_of(solids.spheres.r)),
      largest_(largest_of(solids.spheres.r)),
      has_necks_(joins(solids.contacts.treatment)) {
  if (!std::holds_alternative<Mesh>(solids.domain) || solids.is_cut()) return;
  container_ = local_container(solids.domain, nullptr);
  frame_ = frame_of(solids.domain);
}

std::vector<NearBall> MeshSizes::near(const Vector<3>& center, std::uint32_t sphere, double least) const {
  std::vector<NearBall> found;
  const double r = spheres_.r[sphere], reach = std::max(least, options_.sphere_edge * r / options_.per_gap);
  grid_.for_each_near(boundary_.wrap(center), r + largest_ + reach, [&](std::uint32_t j, const Vector<3>& d) {
    const double distance = d.norm(), rj = spheres_.r[j], gap = distance - r - rj;
    if (gap > reach || distance < 1e-9 * r) return;
    found.push_back({center + d, rj, floor_at(gap, r + rj, std::min(r, rj))});
  });
  std::ranges::sort(found, {}, [](const NearBall& b) {
    return std::array{b.center[0], b.center[1], b.center[2]};
  });
  return found;
}

double MeshSizes::floor_at(double gap, double scale, double least_radius) const {
  if (!(gap < solids_.contacts.gap * scale)) return 0;
  const ContactTreatment treatment = solids_.contacts.treatment;
  if (joins(treatment)) return options_.neck_edge * least_radius;
  return treatment == ContactTreatment::cap ? options_.per_gap * solids_.contacts.gap * scale : 0;
}

double MeshSizes::from_walls(const Vector<3>& p) const {
  double least = std::numeric_limits<double>::infinity();
  if (solids_.is_cut()) return least;
  if (const auto* box = std::get_if<Box>(&solids_.domain)) {
    for (int k = 0; k < 3; ++k)
      if (!box->repeats(k))
        least = std::min({least, p[k] - box->corner[k], box->corner[k] + box->size[k] - p[k]});
  } else if (const auto* cylinder = std::get_if<Cylinder>(&solids_.domain)) {
    const Vector<3> a = cylinder->axis.normalized(), d = p - cylinder->base;
    const double z = d.dot(a);
    least = cylinder->radius - (d - z * a).norm();
    if (!cylinder->periodic) least = std::min({least, z, cylinder->height - z});
  } else if (const auto* sphere = std::get_if<Sphere>(&solids_.domain)) {
    least = sphere->radius - (p - sphere->center).norm();
  } else if (container_) {
    least = frame_.scale * container_->clearance(frame_.to_local(p));
  }
  return least;
}

double MeshSizes::from_ends(const Vector<3>& p) const {
  double least = std::numeric_limits<double>::infinity();
  if (solids_.part) {
    for (const ConvexPart::Face& face : solids_.part->faces)
      least = std::min(least, std::abs(face.keeps.offset - face.keeps.normal.dot(p)));
    return least;
  }
  for (int k = 0; k < 3; ++k)
    if (boundary_.repeats(k))
      least = std::min({least, std::abs(p[k] - boundary_.origin[k]),
                        std::abs(boundary_.origin[k] + boundary_.edges[k] - p[k])});
  return least;
}

double MeshSizes::on_sphere(const Vector<3>& p, const Vector<3>& center, double radius, bool is_cut_at_end,
                            const std::vector<NearBall>& near) const {
  double size = options_.sphere_edge * radius;
  for (const NearBall& ball : near)
    size = std::min(size, std::max(options_.per_gap * ((p - ball.center).norm() - ball.radius), ball.floor));
  const double gap = from_walls(center) - radius;
  if (gap < size / options_.per_gap) {
    size = std::min(size, std::max(options_.per_gap * from_walls(p), floor_at(gap, radius, radius)));
  }
  if (!is_cut_at_end) size = std::min(size, options_.per_gap * from_ends(p));
  // Contacts that nobody treated have no width.
  return std::max(size, 1e-4 * radius);
}

double MeshSizes::on_wall(const Vector<3>& p, const Vector<3>& normal, bool is_end) const {
  // A sphere that is out of reach asks for no shorter edges than the limit.
  double limit = (options_.wall_edge > 0 ? options_.wall_edge : 2 * options_.sphere_edge) * largest_;
  const double most = most_far_away(solids_.domain) * limit;
  double size = on_wall_within(p, normal, is_end, limit);
  while (size >= limit && limit < most) {
    limit *= 2;
    size = on_wall_within(p, normal, is_end, limit);
  }
  return std::max(size, 1e-4 * largest_);
}

double MeshSizes::on_wall_within(const Vector<3>& p, const Vector<3>& normal, bool is_end,
                                 double most) const {
  double size = most;
  grid_.for_each_near(boundary_.wrap(p), largest_ + most / growth, [&](std::uint32_t j, const Vector<3>& d) {
    const double r = spheres_.r[j], from = std::abs(d.norm() - r);
    const double along = std::abs(d.dot(normal)), beside = (d - d.dot(normal) * normal).norm();
    size = std::min(size, options_.sphere_edge * r + growth * from);
    const double gap = along - r;
    if (is_end && along < r) {
      const double rim = std::sqrt(r * r - along * along);
      size = std::min(size, std::min(options_.sphere_edge * r, std::numbers::pi / 4 * rim) +
                                growth * std::abs(beside - rim));
    } else {
      const double floor = is_end ? 0 : floor_at(gap, r, r);
      if (floor > 0 && has_necks_) size = std::min(size, floor + growth * beside);
      size = std::min(size, std::max(options_.per_gap * from, floor));
    }
  });
  return size;
}

std::size_t MeshSizes::neck_count(double radius, double least_sphere, double height) const {
  // Triangles between circles that are turned by half an edge keep 20 degrees up to this ratio.
  constexpr double edge_per_height = 5.4;
  const double around = 2 * std::numbers::pi * radius;
  const double asked = std::max(6.0, std::ceil(around / (options_.neck_edge * least_sphere)));
  const double for_angles = std::ceil(around / (edge_per_height * height));
  return static_cast<std::size_t>(std::min(std::max(asked, for_angles), 16 * asked));
}

}  // namespace bernal
