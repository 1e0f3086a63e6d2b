#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "bernal/core/random.hpp"
#include "solids/solids.hpp"

namespace bernal {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

/// A candidate start of a period, and its distance from the nearest end of a sphere over the radius.
struct Place {
  double at, distance;
};

/// Distance from x to the nearest image of y.
double apart(double x, double y, double period) {
  const double d = x - y;
  return std::abs(d - period * std::nearbyint(d / period));
}

/// The extent of an object along an axis: `reach` on both sides of its middle. `scale` is its radius.
struct Extent {
  double middle, reach, scale;
};

std::vector<Extent> extents_along(int axis, const Spheres<dynamic>& spheres,
                                  const std::vector<Bridge>& bridges) {
  std::vector<Extent> extents;
  for (std::size_t i = 0; i < spheres.size(); ++i)
    extents.push_back({spheres.x[static_cast<std::size_t>(axis)][i], spheres.r[i], spheres.r[i]});
  for (const Bridge& bridge : bridges)
    extents.push_back(
        {0.5 * (bridge.rims[0] + bridge.rims[1])[axis], bridge.reach_along(axis), bridge.radius});
  return extents;
}

/// The middles of the widest gaps between extents along an axis, the widest first.
std::vector<Place> places_along(int axis, const std::vector<Extent>& extents, const Boundary<3>& boundary,
                                std::size_t most) {
  const double lower = boundary.origin[axis], period = boundary.edges[axis];
  std::vector<double> ends;
  for (const Extent& extent : extents)
    for (const double end : {extent.middle - extent.reach, extent.middle + extent.reach})
      ends.push_back(end - lower - period * std::floor((end - lower) / period));
  std::ranges::sort(ends);
  std::vector<Place> gaps;
  for (std::size_t k = 0; k < ends.size(); ++k) {
    const double next = k + 1 < ends.size() ? ends[k + 1] : ends[0] + period;
    gaps.push_back({lower + 0.5 * (ends[k] + next), next - ends[k]});
  }
  if (gaps.empty()) return {{lower, unlimited}};
  std::ranges::stable_sort(gaps, std::greater{}, &Place::distance);
  gaps.resize(std::min(gaps.size(), most));
  for (Place& place : gaps) {
    place.distance = unlimited;
    for (const Extent& extent : extents)
      place.distance = std::min(
          place.distance, std::abs(apart(extent.middle, place.at, period) - extent.reach) / extent.scale);
    if (place.at >= lower + period) place.at -= period;
  }
  return gaps;
}

/// Distance from the edge where the first two axes of `axes` begin, or the corner of all three, to the
/// nearest sphere's surface, over the radius.
double distance_from(const Spheres<dynamic>& spheres, const Boundary<3>& boundary,
                     std::initializer_list<std::pair<int, double>> axes) {
  double least = unlimited;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    double squared = 0;
    for (const auto& [axis, at] : axes) {
      const double d = apart(spheres.x[static_cast<std::size_t>(axis)][i], at, boundary.edges[axis]);
      squared += d * d;
    }
    least = std::min(least, std::abs(std::sqrt(squared) - spheres.r[i]) / spheres.r[i]);
  }
  return least;
}

struct Ends {
  Vector<3> origin;
  double distance;
};

/// The best combination of one place an axis, with edges where two axes are periodic.
Ends best_of(const std::array<std::vector<Place>, 3>& places, const Spheres<dynamic>& spheres,
             const Boundary<3>& boundary) {
  std::array<std::vector<double>, 3> edges;  // of the other two axes, the successor's places fastest
  for (int k = 0; k < 3; ++k) {
    const int a = (k + 1) % 3, b = (k + 2) % 3;
    for (const Place& pb : places[static_cast<std::size_t>(b)])
      for (const Place& pa : places[static_cast<std::size_t>(a)])
        edges[static_cast<std::size_t>(k)].push_back(
            boundary.repeats(a) && boundary.repeats(b)
                ? distance_from(spheres, boundary, {{a, pa.at}, {b, pb.at}})
                : unlimited);
  }
  const auto [nx, ny, nz] = std::array{places[0].size(), places[1].size(), places[2].size()};
  Ends best{boundary.origin, -1};
  const bool has_corners = boundary.edges.minCoeff() > 0;
  for (std::size_t x = 0; x < nx; ++x)
    for (std::size_t y = 0; y < ny; ++y)
      for (std::size_t z = 0; z < nz; ++z) {
        double distance = std::min({places[0][x].distance, places[1][y].distance, places[2][z].distance,
                                    edges[0][z * ny + y], edges[1][x * nz + z], edges[2][y * nx + x]});
        if (!(distance > best.distance)) continue;
        const Vector<3> origin(places[0][x].at, places[1][y].at, places[2][z].at);
        if (has_corners)
          distance = std::min(
              distance, distance_from(spheres, boundary, {{0, origin[0]}, {1, origin[1]}, {2, origin[2]}}));
        if (distance > best.distance) best = {origin, distance};
      }
  return best;
}

}  // namespace

ClearEnds with_clear_ends(const Spheres<dynamic>& spheres, const Domain& domain,
                          const std::vector<Bridge>& bridges) {
  const Boundary<3> boundary = boundary_of<3>(domain);
  if (!boundary.repeats() || spheres.empty()) return {domain, unlimited};
  // Limits the places so that the work for edges is some million distances.
  const auto n = static_cast<double>(spheres.size());
  const auto most = static_cast<std::size_t>(std::clamp(std::sqrt(1e7 / n), 4.0, 40.0));
  std::array<std::vector<Place>, 3> places;
  for (int k = 0; k < 3; ++k)
    places[static_cast<std::size_t>(k)] =
        boundary.repeats(k) ? places_along(k, extents_along(k, spheres, bridges), boundary, most)
                            : std::vector<Place>{{boundary.origin[k], unlimited}};
  const Ends best = best_of(places, spheres, boundary);
  Domain moved = domain;
  if (auto* box = std::get_if<Box>(&moved)) {
    for (int k = 0; k < 3; ++k)
      if (boundary.repeats(k)) box->corner[k] = best.origin[k];
  } else if (auto* cylinder = std::get_if<Cylinder>(&moved)) {
    const int k = cylinder->coordinate_axis();
    cylinder->base[k] += best.origin[k] - boundary.origin[k];
  }
  return {moved, best.distance};
}

double Bridge::reach_along(int axis) const {
  const Vector<3> span = rims[1] - rims[0];
  const double along = span[axis] / span.norm();
  return 0.5 * std::abs(span[axis]) + radius * std::sqrt(std::max(0.0, 1 - along * along));
}

Seam seam_clear_of(const std::vector<HalfSpace>& planes) {
  constexpr int tries = 200, steps = 96;
  Random random(1, 0);
  Seam best;
  if (planes.empty()) return best;
  double best_score = -1;
  std::vector<double> above(planes.size());
  for (int t = 0; t < tries; ++t) {
    const auto direction = [&] {
      Vector<3> v;
      do
        for (int k = 0; k < 3; ++k) v[k] = 2 * random.uniform() - 1;
      while (v.squaredNorm() > 1 || v.squaredNorm() < 0.01);
      return Vector<3>(v.normalized());
    };
    Seam seam{.pole = direction()};
    seam.meridian = (seam.pole.cross(direction())).normalized();
    double score = unlimited;
    for (int s = 0; s <= steps && score > best_score; ++s) {
      const double angle = std::numbers::pi * s / steps;
      const Vector<3> p = std::cos(angle) * seam.pole + std::sin(angle) * seam.meridian;
      const Vector<3> along = -std::sin(angle) * seam.pole + std::cos(angle) * seam.meridian;
      for (std::size_t k = 0; k < planes.size(); ++k) {
        above[k] = std::abs(planes[k].normal.dot(p) - planes[k].offset);
        const bool is_pole = s == 0 || s == steps;
        const double steepness = is_pole ? 0 : 0.5 * std::abs(planes[k].normal.dot(along));
        score = std::min(score, std::max(above[k], steepness));
        for (std::size_t l = 0; l < k; ++l) score = std::min(score, std::max(above[k], above[l]));
      }
    }
    if (score > best_score) {
      best_score = score;
      best = seam;
    }
  }
  return best;
}

std::vector<Seam> seams_of(const Solids& solids) {
  std::vector<std::optional<Seam>> of_sphere(solids.spheres.size());
  std::vector<Seam> seams;
  for (const Piece& piece : solids.pieces) {
    std::optional<Seam>& seam = of_sphere[piece.sphere];
    if (!seam) {
      std::vector<HalfSpace> planes;
      for (const Cut& cut : piece.cuts)
        planes.push_back(
            {cut.keeps.normal, (cut.keeps.offset - cut.keeps.normal.dot(piece.center)) / piece.radius});
      seam = seam_clear_of(planes);
    }
    seams.push_back(*seam);
  }
  return seams;
}

}  // namespace bernal
