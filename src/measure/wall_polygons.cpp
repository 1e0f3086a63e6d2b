#include "measure/wall_polygons.hpp"

#include <algorithm>
#include <cmath>

#include "core/parallel.hpp"

namespace bernal {
namespace {

constexpr std::size_t few_walls = 12;
constexpr double rounding_of_reach = 1e-12;

Vector<3> middle_of(std::span<const Vector<3>> points) {
  Vector<3> sum = Vector<3>::Zero();
  for (const Vector<3>& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

Vector<3> middle_of(const ConvexCell& cell) {
  Vector<3> sum = Vector<3>::Zero();
  for (const Vector<3>& corner : cell.corners()) sum += corner;
  return sum / static_cast<double>(cell.corners().size());
}

double area_of_loop(const std::vector<Vector<3>>& loop) {
  Vector<3> sum = Vector<3>::Zero();
  for (std::size_t k = 2; k < loop.size(); ++k) sum += (loop[k - 1] - loop[0]).cross(loop[k] - loop[0]);
  return 0.5 * sum.norm();
}

}  // namespace

WallPolygons::WallPolygons(const Domain& domain, const Container& container) : container_(container) {
  if (const auto* mesh = std::get_if<Mesh>(&domain)) {
    for (const auto& [a, b, c] : mesh->triangles)
      add({mesh->vertices[a], mesh->vertices[b], mesh->vertices[c]});
  } else if (const auto* polygon = std::get_if<Polygon>(&domain)) {
    const auto at = [](const Vector<2>& p, double z) { return Vector<3>(p[0], p[1], z); };
    for (const auto& loop : polygon->loops)
      for (std::size_t k = 0; k < loop.size(); ++k) {
        const Vector<2>&a = loop[k], &b = loop[(k + 1) % loop.size()];
        add({at(a, -1), at(b, -1), at(b, 1), at(a, 1)});
      }
  }
  build();
}

void WallPolygons::add(std::initializer_list<Vector<3>> corners) {
  Wall wall{{}, static_cast<int>(corners.size()), Vector<3>::Zero()};
  std::ranges::copy(corners, wall.corner.begin());
  wall.normal = (wall.corner[1] - wall.corner[0]).cross(wall.corner[2] - wall.corner[0]).stableNormalized();
  if (wall.normal.isZero(0)) return;  // without area
  walls_.push_back(wall);
}

void WallPolygons::build() {
  std::vector<Bounds<3>> boxes;
  for (const Wall& wall : walls_) {
    Bounds<3> box{wall.corner[0], wall.corner[0]};
    for (int c = 1; c < wall.corners; ++c) {
      box.lower = box.lower.cwiseMin(wall.corner[c]);
      box.upper = box.upper.cwiseMax(wall.corner[c]);
    }
    boxes.push_back(box);
  }
  tree_ = BoxTree<3>(boxes, 4);
  std::vector<Wall> sorted;
  for (const std::uint32_t k : tree_.order()) sorted.push_back(walls_[k]);
  walls_.swap(sorted);
}

/// The part of a piece below a plane; empty if the piece lies in the plane.
WallPolygons::Piece WallPolygons::below(const Piece& piece, const Vector<3>& normal, double offset,
                                        double rounding) {
  Piece part{{}, piece.normal};
  std::vector<double> height;
  double lowest = 0, highest = 0;
  for (const Vector<3>& p : piece.loop) {
    double h = p.dot(normal) - offset;
    if (std::abs(h) <= rounding) h = 0;
    height.push_back(h);
    lowest = std::min(lowest, h);
    highest = std::max(highest, h);
  }
  if (!(lowest < 0)) return part;
  if (!(highest > 0)) return piece;
  for (std::size_t k = 0; k < height.size(); ++k) {
    const std::size_t next = (k + 1) % height.size();
    if (height[k] <= 0) part.loop.push_back(piece.loop[k]);
    if ((height[k] < 0 && height[next] > 0) || (height[k] > 0 && height[next] < 0))
      part.loop.push_back(piece.loop[k] +
                          height[k] / (height[k] - height[next]) * (piece.loop[next] - piece.loop[k]));
  }
  part.area = area_of_loop(part.loop);
  return part;
}

std::vector<WallPolygons::Piece> WallPolygons::pieces_in(const ConvexCell& cell, const Vector<3>& center,
                                                         double rounding) const {
  std::vector<Piece> pieces;
  const std::vector<ConvexCell::Plane> planes = cell.planes();
  const auto may_be_inside = [&](const BoxTree<3>::Node& node) {
    const Vector<3> middle = node.bounds.center() - center, half = 0.5 * node.bounds.size();
    return std::ranges::none_of(planes, [&](const ConvexCell::Plane& plane) {
      return plane.normal.dot(middle) - plane.normal.cwiseAbs().dot(half) > plane.offset;
    });
  };
  tree_.for_each_leaf(may_be_inside, [&](const BoxTree<3>::Node& leaf) {
    for (std::uint32_t k = leaf.first; k < leaf.last; ++k) {
      const Wall& wall = walls_[k];
      Piece piece{{}, wall.normal};
      for (int c = 0; c < wall.corners; ++c) piece.loop.push_back(wall.corner[c] - center);
      piece.area = area_of_loop(piece.loop);
      for (const ConvexCell::Plane& plane : planes)
        if (!piece.loop.empty()) piece = below(piece, plane.normal, plane.offset, rounding);
      if (!piece.loop.empty()) pieces.push_back(std::move(piece));
    }
  });
  return pieces;
}

double WallPolygons::inside(const ConvexCell& cell, std::vector<Piece> pieces, const Vector<3>& center,
                            double rounding) const {
  throw_if_interrupted();  // cells may have very many walls
  const double volume = cell.volume();
  if (cell.empty() || !(volume > 0)) return 0;
  if (pieces.empty()) {
    Vector<3> middle = center + middle_of(cell);
    if (container_.dimension() == 2) middle[2] = 0;
    return container_.clearance_within(middle, 0) >= 0 ? volume : 0;
  }
  Vector<3> normal = Vector<3>::Zero();
  double offset = 0;
  const auto halve = [&] {
    std::vector<Vector<3>> middles;
    Bounds<3> bounds{middle_of(pieces[0].loop), middle_of(pieces[0].loop)};
    for (const Piece& piece : pieces) {
      middles.push_back(middle_of(piece.loop));
      bounds.lower = bounds.lower.cwiseMin(middles.back());
      bounds.upper = bounds.upper.cwiseMax(middles.back());
    }
    int axis = 0;
    if (!(bounds.size().maxCoeff(&axis) > 1e3 * rounding)) return false;
    const auto median = middles.begin() + static_cast<std::ptrdiff_t>(middles.size() / 2);
    std::ranges::nth_element(middles, median, {}, [&](const Vector<3>& p) { return p[axis]; });
    normal = Vector<3>::Unit(axis);
    offset = (*median)[axis];
    std::size_t low = 0, high = 0;  // pieces on one side only
    for (const Piece& piece : pieces) {
      const auto [least, most] =
          std::ranges::minmax(piece.loop, {}, [&](const Vector<3>& p) { return p[axis]; });
      low += most[axis] <= offset;
      high += least[axis] >= offset;
    }
    return std::min(low, high) > 0 && low + high >= pieces.size() / 3;
  };
  if (pieces.size() <= few_walls || !halve()) {
    const Piece& largest = *std::ranges::max_element(pieces, {}, &Piece::area);
    normal = largest.normal;
    offset = normal.dot(largest.loop[0]);
  }
  double sum = 0;
  for (const double sign : {1.0, -1.0}) {
    ConvexCell part = cell;
    part.cut(sign * normal, sign * offset, ConvexCell::wall);
    std::vector<Piece> in_part;
    for (const Piece& piece : pieces) {
      Piece kept = below(piece, sign * normal, sign * offset, rounding);
      if (!kept.loop.empty()) in_part.push_back(std::move(kept));
    }
    sum += inside(part, std::move(in_part), center, rounding);
  }
  return sum;
}

double WallPolygons::volume_inside(const ConvexCell& cell, const Vector<3>& center) const {
  const double rounding = rounding_of_reach * std::sqrt(cell.squared_reach());
  return inside(cell, pieces_in(cell, center, rounding), center, rounding);
}

}  // namespace bernal
