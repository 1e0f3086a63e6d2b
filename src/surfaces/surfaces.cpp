#include "surfaces/surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "bernal/verify/certificate.hpp"
#include "geometry/point_numbers.hpp"

namespace bernal {
namespace {

double largest_radius_of(const Spheres<dynamic>& spheres) {
  return spheres.empty() ? 0 : *std::ranges::max_element(spheres.r);
}

/// Of circumscribed walls, in the domain's unit: the same share of the largest sphere's radius as for
/// spheres.
double wall_deflection(const Spheres<dynamic>& spheres, const Domain& domain, double deflection) {
  const double radius = largest_radius_of(spheres);
  return deflection * (radius > 0 ? radius : 0.1 * bounds_of(domain).size().maxCoeff());
}

double largest_coordinate(const Spheres<dynamic>& spheres, const Domain& domain, const WallSurface& walls) {
  const Bounds<3> bounds = bounds_of(domain);
  double largest = std::max(bounds.lower.cwiseAbs().maxCoeff(), bounds.upper.cwiseAbs().maxCoeff());
  for (std::size_t i = 0; i < spheres.size(); ++i)
    for (const auto& column : spheres.x) largest = std::max(largest, std::abs(column[i]) + spheres.r[i]);
  for (const FloatPoint& p : walls.walls.vertices)
    for (const float x : p) largest = std::max(largest, static_cast<double>(std::abs(x)));
  return largest * (1 + 0x1p-20);
}

Spheres<dynamic> wrapped(Spheres<dynamic> spheres, const Domain& domain) {
  wrap(spheres, domain);
  return spheres;
}

/// The first of them.
Spheres<dynamic> first_of(Spheres<dynamic> spheres, std::size_t count) {
  if (count == spheres.size()) return spheres;
  for (std::vector<double>& column : spheres.x) column.resize(count);
  spheres.r.resize(count);
  return spheres;
}

/// The balls that contain the written surfaces.
Spheres<dynamic> smaller_by(Spheres<dynamic> spheres, double inset) {
  for (double& r : spheres.r) r -= inset;
  return spheres;
}

/// For each end, the triangles of spheres in it.
using Covered = std::array<std::vector<std::array<FloatPoint, 3>>, 6>;

/// Points at which spheres in the ends of other periods cross the outline of this one, at either end of its
/// own period: all four lines in which the ends of two periods meet are divided at the same points, even if a
/// sphere that just reaches such a line has no triangle at one end.
std::vector<FloatPoint> points_on_outline(const WallSurface::End& end,
                                          const std::vector<WallSurface::End>& ends, const Covered& covered) {
  const auto place_of = [](const WallSurface::End& e) {
    return e.outline.front()[static_cast<std::size_t>(e.axis())];
  };
  std::set<FloatPoint> points;
  for (const WallSurface::End& other : ends) {
    if (other.axis() == end.axis()) continue;
    for (const auto& triangle : covered[static_cast<std::size_t>(other.face)]) {
      for (FloatPoint p : triangle) {
        float& along = p[static_cast<std::size_t>(end.axis())];
        const bool meets = std::ranges::any_of(
            ends, [&](const auto& e) { return e.axis() == end.axis() && along == place_of(e); });
        if (!meets) continue;
        along = place_of(end);
        for (const WallSurface::End& e : ends) {
          if (e.axis() != other.axis()) continue;
          p[static_cast<std::size_t>(e.axis())] = place_of(e);
          points.insert(p);
        }
      }
    }
  }
  return {points.begin(), points.end()};
}

bool may_be_covered(std::int8_t face) { return face >= 0; }

}  // namespace

Surfaces::Surfaces(const Spheres<dynamic>& spheres, const Domain& domain, double deflection,
                   SurfaceChoice choice, const Monitor& monitor, const Nested& nested)
    : choice_(choice),
      nested_(nested),
      deflection_(deflection),
      walls_(choice == SurfaceChoice::spheres
                 ? WallSurface()
                 : wall_surface(domain, wall_deflection(spheres, domain, deflection))),
      shift_(single_precision_shift(largest_coordinate(spheres, domain, walls_))),
      spheres_(choice == SurfaceChoice::container ? std::vector<Piece>()
                                                  : pieces_of(wrapped(spheres, domain), domain),
               domain, deflection, shift_),
      monitor_(monitor) {
  bool overlaps = false;
  if (has_spheres()) {
    measures_ = spheres_.measure();
    const Certificate pairs =
        certify(smaller_by(first_of(spheres, nested.outer), spheres_.inset()), domain, {.monitor = monitor});
    if (pairs.cancelled) throw Cancelled();
    overlaps = pairs.overlapping_pairs > 0;
    proof_ =
        pairs.overlapping_pairs == 0
            ? "inside the true spheres, no two of them touch"
            : fmt::format("inside the true spheres, of which {}, up to {:.2g} of the sum of two radii",
                          pairs.overlapping_pairs == 1 ? std::string("1 pair overlaps")
                                                       : grouped(pairs.overlapping_pairs) + " pairs overlap",
                          pairs.max_overlap);
  }
  if (choice != SurfaceChoice::spheres) make_container(overlaps);
  if (has_spheres() && choice != SurfaceChoice::spheres && !walls_.walls.triangles.empty()) {
    // A thousandth more than the walls were moved, for the rounding of unit conversion.
    const Certificate in = certify(smaller_by(spheres, 1.001 * shift_),
                                   walls_.extended(boundary_of<3>(domain)), {.monitor = monitor});
    if (in.cancelled) throw Cancelled();
    proof_ += in.protruding_spheres == 0
                  ? " each other or the walls"
                  : fmt::format(" each other, {} across the walls", grouped(in.protruding_spheres));
  } else if (has_spheres() && proof_.ends_with("touch")) {
    proof_ += " each other";
  }
  count();
}

void Surfaces::make_container(bool overlaps) {
  if (choice_ != SurfaceChoice::pores || walls_.ends.empty()) {
    container_ = walls_.closed();
    return;
  }
  Covered covered;
  for (std::size_t i = 0; i < spheres_.spheres(); ++i) {
    if (spheres_.is_whole(i)) continue;
    spheres_.visit(i, [&](const FloatSurface& surface) {
      for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        if (surface.faces[t] < 0) continue;
        const auto& [a, b, c] = surface.triangles[t];
        covered[static_cast<std::size_t>(surface.faces[t])].push_back(
            {surface.vertices[a], surface.vertices[b], surface.vertices[c]});
      }
    });
  }
  container_ = walls_.walls;
  PointNumbers<FloatPoint> numbers;  // the walls are joined: all their points are distinct
  for (const FloatPoint& p : container_.vertices) numbers.of(p);
  const auto add = [&](FloatSurface end) {
    renumber(end.triangles, [&](std::uint32_t v) {
      return rim_.emplace(end.vertices[v], numbers.of(end.vertices[v])).first->second;
    });
    container_.triangles.insert(container_.triangles.end(), end.triangles.begin(), end.triangles.end());
    container_.faces.insert(container_.faces.end(), end.faces.begin(), end.faces.end());
  };
  for (const WallSurface::End& end : walls_.ends) {
    if (end.is_upper()) continue;
    const auto opposite = std::ranges::find(walls_.ends, end.face + 1, &WallSurface::End::face);
    const std::optional<FloatSurface> lower = end_between(end, covered[static_cast<std::size_t>(end.face)],
                                                          points_on_outline(end, walls_.ends, covered));
    if (!lower && !overlaps) throw std::logic_error("spheres cross each other at the end of a period");
    if (!lower)
      throw Error(
          ErrorCode::bad_argument,
          "spheres overlap at the end of a period, where their triangles bound no pore space; contact "
          "gap or shrink makes room, bernal verify says where");
    add(*lower);
    add(moved_to(*opposite, *lower));
  }
  container_.vertices = std::move(numbers.points);
}

void Surfaces::visit_spheres(const std::vector<std::uint32_t>* order, const Visit& visit) const {
  std::uint32_t next = 0;
  if (!container_.triangles.empty()) {
    visit({.sphere = {},
           .first_vertex = 0,
           .vertices = container_.vertices,
           .triangles = container_.triangles});
    next = static_cast<std::uint32_t>(container_.vertices.size());
  }
  if (!has_spheres()) return;
  std::vector<FloatPoint> vertices;
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> number;
  const bool is_pore = choice_ == SurfaceChoice::pores;
  const std::size_t count = order ? order->size() : spheres_.spheres();
  for (std::size_t n = 0; n < count; ++n) {
    const std::size_t i = order ? (*order)[n] : n;
    if (n % 1024 == 0) {
      if (monitor_.stop()) throw Cancelled();
      monitor_.report({"triangles", static_cast<double>(n) / static_cast<double>(count), {}});
    }
    const bool inward = is_pore || (nested_.are_holes && i >= nested_.outer);
    spheres_.visit(i, [&](const FloatSurface& surface) {
      vertices.clear();
      triangles.clear();
      number.assign(surface.vertices.size(), ~0U);
      for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        if (is_pore && may_be_covered(surface.faces[t])) continue;
        Triangle triangle = surface.triangles[t];
        if (inward) std::swap(triangle[1], triangle[2]);
        for (std::uint32_t& v : triangle) {
          if (number[v] == ~0U) {
            const auto rim = rim_.empty() ? rim_.end() : rim_.find(surface.vertices[v]);
            if (rim != rim_.end()) {
              number[v] = rim->second;
            } else {
              number[v] = next + static_cast<std::uint32_t>(vertices.size());
              vertices.push_back(surface.vertices[v]);
            }
          }
          v = number[v];
        }
        triangles.push_back(triangle);
      }
      visit({static_cast<std::uint32_t>(i), next, vertices, triangles});
      next += static_cast<std::uint32_t>(vertices.size());
    });
  }
}

void Surfaces::count() {
  const auto include = [&](const FloatPoint& p) {
    for (std::size_t k = 0; k < 3; ++k) {
      lower_[k] = std::min(lower_[k], p[k]);
      upper_[k] = std::max(upper_[k], p[k]);
    }
  };
  if (choice_ == SurfaceChoice::spheres) {
    vertices_ = measures_.vertices;
    triangles_ = measures_.triangles;
    lower_ = measures_.lower;
    upper_ = measures_.upper;
  } else {
    if (!container_.vertices.empty()) lower_ = upper_ = container_.vertices.front();
    for (const FloatPoint& p : container_.vertices) include(p);
    if (choice_ == SurfaceChoice::all && measures_.vertices > 0) {
      include(measures_.lower);
      include(measures_.upper);
    }
    if (rim_.empty()) {
      vertices_ = container_.vertices.size() + measures_.vertices;
      triangles_ = container_.triangles.size() + measures_.triangles;
    } else {
      visit([&](const SurfacePart& part) {
        vertices_ += part.vertices.size();
        triangles_ += part.triangles.size();
      });
    }
  }
  if (vertices_ > 0xffff'fffeU)
    throw Error(
        ErrorCode::bad_argument,
        fmt::format("{} vertices are more than a file of triangles can number; allow a larger deflection",
                    grouped(vertices_)));
}

std::string Surfaces::note() const {
  if (!has_spheres())
    return fmt::format("{} triangles of the container in single precision", grouped(triangles_));
  return fmt::format(
      "{} triangles in single precision, {} (proven); at most {:.3g} of a radius below the sphere, "
      "{:.4g} of its volume",
      grouped(triangles_), proof_, measures_.deflection, measures_.volume_share);
}

}  // namespace bernal
