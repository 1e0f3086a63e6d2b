#include "cad/repair/plane_hollows.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "core/parallel.hpp"
#include "geometry/measures.hpp"

namespace bernal::cad {
namespace {

/// Unit vectors, no two of them opposite.
std::vector<Vector<3>> directions_of(const Mesh& solid) {
  constexpr double same = 1 - 1e-7;
  constexpr std::size_t most_told_apart = 500, most_by_area = 4;
  std::vector<std::pair<double, Vector<3>>> by_area;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const FaceCorners& t : solid.triangles) {
    const Vector<3> areas = doubled_area(solid, t);
    const double area = areas.norm();
    if (!(area > 0)) continue;
    const Vector<3> normal = areas / area;
    spread += area * normal * normal.transpose();
    const auto found = std::ranges::find_if(
        by_area, [&](const auto& known) { return std::abs(known.second.dot(normal)) > same; });
    if (found != by_area.end())
      found->first += area;
    else if (by_area.size() < most_told_apart)
      by_area.emplace_back(area, normal);
  }
  std::ranges::stable_sort(by_area, std::greater<>(), [](const auto& known) { return known.first; });
  std::vector<Vector<3>> all;
  const auto add = [&](const Vector<3>& direction) {
    constexpr double nearly = 1 - 1e-6;
    if (std::ranges::none_of(all, [&](const Vector<3>& n) { return std::abs(n.dot(direction)) > nearly; }))
      all.push_back(direction);
  };
  for (std::size_t k = 0; k < std::min(most_by_area, by_area.size()); ++k) add(by_area[k].second);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
  for (int k = 0; k < 3; ++k) add(axes.eigenvectors().col(k));
  add(Vector<3>::UnitZ());
  return all;
}

/// A level at which a plane normal to the direction may be a brim.
struct Level {
  Vector<3> direction;
  /// Heights of the highest and lowest corner at this level, and of the next one below.
  double height, bottom, lower;
  double area;  ///< of the faces in the plane
  std::size_t corners;
};

/// The corners that no neighbour is above, and those whose neighbours alternate between higher and lower: the
/// top of a round brim, and the spill point of a vessel.
std::vector<std::uint32_t> peaks_and_passes(const Mesh& solid, const std::vector<std::size_t>& level) {
  std::vector<std::uint8_t> turns(level.size(), 0), is_higher(level.size(), 0);
  for (const FaceCorners& t : solid.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const bool next = level[t[(k + 1) % 3]] > level[t[k]], last = level[t[(k + 2) % 3]] > level[t[k]];
      is_higher[t[k]] |= next || last;
      if (next != last) turns[t[k]] = std::min<std::uint8_t>(turns[t[k]] + 1, 100);
    }
  std::vector<std::uint32_t> found;
  for (std::uint32_t v = 0; v < level.size(); ++v)
    if (is_higher[v] == 0 || turns[v] >= 4) found.push_back(v);
  return found;
}

void add_levels(const Mesh& solid, const Vector<3>& direction, double tolerance, std::vector<Level>& levels) {
  std::vector<std::uint32_t> order(solid.vertices.size());
  std::vector<double> height(order.size());
  for (std::uint32_t v = 0; v < order.size(); ++v) {
    order[v] = v;
    height[v] = direction.dot(solid.vertices[v]);
  }
  std::ranges::stable_sort(order, {}, [&](std::uint32_t v) { return height[v]; });
  std::vector<Level> all;
  std::vector<std::size_t> level(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    const double here = height[order[k]];
    if (k == 0 || here - all.back().bottom > tolerance)
      all.push_back({direction, here, here, k == 0 ? here : height[order[k - 1]], 0, 0});
    level[order[k]] = all.size() - 1;
    all.back().height = here;
  }
  for (const std::uint32_t v : peaks_and_passes(solid, level)) ++all[level[v]].corners;
  for (const FaceCorners& t : solid.triangles) {
    if (level[t[0]] != level[t[1]] || level[t[0]] != level[t[2]]) continue;
    all[level[t[0]]].area += std::abs(doubled_area(solid, t).dot(direction)) / 2;
  }
  all.erase(all.begin());  // nothing is below the lowest
  std::erase_if(all, [](const Level& one) { return one.corners == 0 && !(one.area > 0); });
  constexpr std::size_t most_by_area = 6, most_by_corners = 4;
  std::ranges::stable_sort(all, std::greater<>(), &Level::corners);
  std::stable_sort(all.begin() + std::ptrdiff_t(std::min(all.size(), most_by_corners)), all.end(),
                   [](const Level& a, const Level& b) { return a.area > b.area; });
  all.resize(std::min(all.size(), most_by_corners + most_by_area));
  levels.insert(levels.end(), all.begin(), all.end());
}

CutPlane plane_across(const Vector<3>& direction, double height) {
  CutPlane plane;
  plane.normal = direction;
  plane.offset = height;
  plane.text = fmt::format("{:.6g} x + {:.6g} y + {:.6g} z < {:.6g}", direction[0], direction[1],
                           direction[2], height);
  return plane;
}

double openness_of(const Space& space, const CutPlane& brim, double tolerance) {
  double lid = 0, rest = 0;
  for (const FaceCorners& t : space.walls.triangles) {
    const bool is_lid = std::ranges::all_of(
        t, [&](std::uint32_t v) { return std::abs(brim.height(space.walls.vertices[v])) <= tolerance; });
    (is_lid ? lid : rest) += doubled_area(space.walls, t).norm();
  }
  return lid / rest;
}

/// Keeps the largest of those that overlap.
class Largest {
 public:
  void add(PlaneHollow hollow) {
    const TriangleTree tree(hollow.space.walls);
    const std::optional<Vector<3>> inside = point_within(hollow.space.walls, tree);
    if (!inside) return;
    hollow.inside = *inside;
    for (std::size_t k = 0; k < kept_.size(); ++k) {
      const bool overlap = kept_[k].tree->crossing(*inside, 0, endless) == Crossing::odd ||
                           tree.crossing(kept_[k].hollow.inside, 0, endless) == Crossing::odd;
      if (!overlap) continue;
      if (kept_[k].hollow.space.volume >= hollow.space.volume) return;
      kept_.erase(kept_.begin() + std::ptrdiff_t(k--));
    }
    auto own = std::make_unique<TriangleTree>(hollow.space.walls);
    kept_.push_back({std::move(hollow), std::move(own)});
  }
  std::vector<PlaneHollow> hollows() && {
    std::vector<PlaneHollow> all;
    for (Kept& kept : kept_) all.push_back(std::move(kept.hollow));
    std::ranges::stable_sort(all, std::greater<>(),
                             [](const PlaneHollow& hollow) { return hollow.space.volume; });
    return all;
  }

 private:
  struct Kept {
    PlaneHollow hollow;
    std::unique_ptr<TriangleTree> tree;
  };
  std::vector<Kept> kept_;
};

}  // namespace

std::optional<Vector<3>> point_within(const Mesh& walls, const TriangleTree& tree) {
  const FaceCorners& largest = *std::ranges::max_element(
      walls.triangles, {}, [&](const FaceCorners& t) { return doubled_area(walls, t).squaredNorm(); });
  const Vector<3> normal = doubled_area(walls, largest).stableNormalized();
  const Vector<3> middle = middle_of(walls, largest);
  const double diagonal = bounds_of(walls).diagonal(), aside = 1e-6 * diagonal;
  for (const double side : {-1.0, 1.0}) {
    const Vector<3> from = middle + side * aside * normal;
    if (tree.crossing(from, 0, endless) != Crossing::odd) continue;
    const double way = tree.first_contact(from, aside / 4, side * normal, diagonal, aside / 4);
    return Vector<3>(from + 0.5 * side * way * normal);
  }
  return std::nullopt;
}

std::vector<PlaneHollow> hollows_below_planes(const Mesh& solid, double tolerance) {
  const Surroundings around(solid);
  std::vector<Level> levels;
  const double apart = std::max(tolerance, 1e-5 * bounds_of(solid).diagonal());
  for (const Vector<3>& direction : directions_of(solid))
    for (const double sign : {1.0, -1.0}) add_levels(solid, sign * direction, apart, levels);
  std::ranges::stable_sort(levels, std::greater<>(), &Level::area);
  constexpr double faces_in_all = 1e6;
  const double most = std::clamp(faces_in_all / static_cast<double>(solid.triangles.size()), 12.0, 100.0);
  if (static_cast<double>(levels.size()) > most) levels.resize(static_cast<std::size_t>(most));
  Largest largest;
  for (const Level& level : levels) {
    throw_if_interrupted();
    // At the corners' own height for a flat brim, and just below for others.
    constexpr double hardly_lower = 1e-4;  // of the distance to the next corner
    for (const double height :
         {level.height, level.bottom - std::max(4 * apart, hardly_lower * (level.bottom - level.lower))}) {
      const CutPlane brim = plane_across(level.direction, height);
      try {
        for (Space& space : around.closed_off({brim}, tolerance, around.crevice())) {
          const double openness = openness_of(space, brim, 2 * apart);
          constexpr double widest = 0.95;
          if (!(openness < widest)) continue;  // a dent
          largest.add({std::move(space), brim, openness, Vector<3>::Zero()});
        }
      } catch (const Error&) {  // nothing to close at this level
      }
    }
  }
  return std::move(largest).hollows();
}

}  // namespace bernal::cad
