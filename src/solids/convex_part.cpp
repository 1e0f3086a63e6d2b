#include "solids/convex_part.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include <fmt/format.h>
#include <Eigen/LU>

#include "bernal/core/dimension.hpp"
#include "bernal/core/error.hpp"
#include "measure/convex_cell.hpp"
#include "measure/round_walls.hpp"
#include "solids/part_maker.hpp"

namespace bernal {

void refuse_part(const std::string& why) {
  throw Error(ErrorCode::bad_argument, fmt::format("the part of ‹cut› {}", why));
}

std::string place_in_part(const Vector<3>& p) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", p[0], p[1], p[2]);
}

bool ConvexPart::Face::holds(const Vector<3>& on_plane, const ConvexPart& part) const {
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vector<3>&a = part.corners[corners[k]].point,
          &b = part.corners[corners[(k + 1) % corners.size()]].point;
    if ((b - a).cross(on_plane - a).dot(keeps.normal) < 0) return false;
  }
  return true;
}

double ConvexPart::height(const Vector<3>& p) const {
  double most = -std::numeric_limits<double>::infinity();
  for (const Face& face : faces) most = std::max(most, face.keeps.normal.dot(p) - face.keeps.offset);
  return most;
}

double ConvexPart::distance(const Vector<3>& p) const {
  if (!(height(p) > 0)) return 0;
  double least = std::numeric_limits<double>::infinity();
  for (const Face& face : faces) {
    const double above = face.keeps.normal.dot(p) - face.keeps.offset;
    if (above > 0 && above < least && face.holds(p - above * face.keeps.normal, *this)) least = above;
  }
  for (const Edge& edge : edges) {
    const Vector<3>&a = corners[edge.corners[0]].point, &b = corners[edge.corners[1]].point;
    const double length = (b - a).dot(edge.along);
    least = std::min(least, (p - a - std::clamp((p - a).dot(edge.along), 0.0, length) * edge.along).norm());
  }
  return least;
}

std::optional<std::uint32_t> ConvexPart::edge_between(std::uint32_t face, std::uint32_t other) const {
  for (const std::uint32_t edge : faces[face].edges)
    if (edges[edge].faces[0] == other || edges[edge].faces[1] == other) return edge;
  return {};
}

Bounds<3> ConvexPart::bounds() const {
  Bounds<3> around = Bounds<3>::of_nothing();
  for (const Corner& corner : corners) around.add(corner.point);
  return around;
}

Domain ConvexPart::domain() const {
  if (is_box) {
    const Bounds<3> around = bounds();
    return Box{.corner = around.lower, .size = around.upper - around.lower};
  }
  Mesh mesh;
  for (const Corner& corner : corners) mesh.vertices.push_back(corner.point);
  for (const Face& face : faces)
    for (std::size_t k = 1; k + 1 < face.corners.size(); ++k)
      mesh.triangles.push_back({face.corners[0], face.corners[k], face.corners[k + 1]});
  return mesh;
}

ConvexPart part_of_box(const Bounds<3>& given) {
  if (!((given.upper - given.lower).minCoeff() > 0)) refuse_part("holds nothing");
  // The upper faces where the corner and the size of the box say that they are.
  const std::array<Vector<3>, 2> ends = {given.lower, given.lower + (given.upper - given.lower)};
  ConvexPart box;
  box.is_box = true;
  for (std::uint32_t corner = 0; corner < 8; ++corner) {
    Vector<3> p;
    for (int k = 0; k < 3; ++k) p[k] = ends[corner >> k & 1][k];
    box.corners.push_back({p, {corner & 1, 2 + (corner >> 1 & 1), 4 + (corner >> 2 & 1)}});
  }
  const auto number = [](std::uint32_t axis, std::uint32_t side) { return 2 * axis + side; };
  const Vector<3> middle = 0.5 * (ends[0] + ends[1]);
  for (std::uint32_t m = 0; m < 3; ++m)  // edges along m, at the ends a and b of the next two axes
    for (std::uint32_t b = 0; b < 2; ++b)
      for (std::uint32_t a = 0; a < 2; ++a) {
        const std::uint32_t k = (m + 1) % 3, l = (m + 2) % 3, first = a << k | b << l;
        box.edges.push_back(
            {{first, first | 1U << m}, {number(k, a), number(l, b)}, Vector<3>::Unit(static_cast<int>(m))});
      }
  const auto edge_at = [](std::uint32_t m, std::uint32_t a, std::uint32_t b) { return 4 * m + 2 * b + a; };
  for (std::uint32_t k = 0; k < 3; ++k)
    for (std::uint32_t side = 0; side < 2; ++side) {
      const std::uint32_t u = (k + 1) % 3, v = (k + 2) % 3;
      const int axis = static_cast<int>(k);
      const double level = ends[side][axis], sign = side == 0 ? -1 : 1;
      ConvexPart::Face face{
          .keeps = {sign * Vector<3>::Unit(axis), sign * level},
          .axis = axis,
          .level = level,
          .corners = {},
          .edges = {edge_at(u, 0, side), edge_at(v, side, 0), edge_at(u, 1, side), edge_at(v, side, 1)},
          .origin = middle,
          .u = Vector<3>::Unit(static_cast<int>(u)),
          .v = Vector<3>::Unit(static_cast<int>(v)),
          .is_turned = side == 0};
      face.origin[axis] = level;
      const std::uint32_t base = side << k;
      face.corners = {base, base | 1U << u, base | 1U << u | 1U << v, base | 1U << v};
      if (side == 0) std::reverse(face.corners.begin(), face.corners.end());
      box.faces.push_back(std::move(face));
    }
  return box;
}

PartMaker::PartMaker(std::vector<HalfSpace> planes) : planes_(std::move(planes)) {}

void PartMaker::add_corner(const Vector<3>& point, std::vector<std::uint32_t> planes) {
  corners_.push_back({point, std::move(planes)});
}

ConvexPart PartMaker::made(double tolerance) && {
  ConvexPart part;
  part.corners = std::move(corners_);
  for (const HalfSpace& plane : planes_) part.faces.push_back(face_in(plane));
  for (std::uint32_t c = 0; c < part.corners.size(); ++c)
    for (const std::uint32_t face : part.corners[c].faces) part.faces[face].corners.push_back(c);
  for (ConvexPart::Corner& corner : part.corners) put_where_planes_meet(part, corner, tolerance);
  std::map<std::array<std::uint32_t, 2>, std::uint32_t> known;
  bool is_whole = true;
  for (std::uint32_t f = 0; f < part.faces.size(); ++f) {
    ConvexPart::Face& face = part.faces[f];
    is_whole = is_whole && face.corners.size() >= 3;
    if (!is_whole) break;
    sort_around(part, face);
    for (std::size_t k = 0; k < face.corners.size(); ++k) {
      const std::uint32_t a = face.corners[k], b = face.corners[(k + 1) % face.corners.size()];
      const auto [entry, is_new] =
          known.try_emplace({std::min(a, b), std::max(a, b)}, static_cast<std::uint32_t>(part.edges.size()));
      face.edges.push_back(entry->second);
      if (is_new) {
        const auto& [low, high] = entry->first;
        const Vector<3> along = (part.corners[high].point - part.corners[low].point).normalized();
        part.edges.push_back({{low, high}, {f, f}, along});
      } else {
        std::array<std::uint32_t, 2>& faces = part.edges[entry->second].faces;
        is_whole = is_whole && faces[0] == faces[1];
        faces[1] = f;
      }
    }
  }
  for (const ConvexPart::Edge& edge : part.edges) is_whole = is_whole && edge.faces[0] != edge.faces[1];
  if (!is_whole || part.corners.size() + part.faces.size() != part.edges.size() + 2)
    refuse_part(fmt::format("has faces that rounding does not tell apart, to within {:.2g}", tolerance));
  if (part.faces.size() == 6 &&
      std::ranges::all_of(part.faces, [](const ConvexPart::Face& face) { return face.axis >= 0; }))
    return part_of_box(part.bounds());
  return part;
}

ConvexPart::Face PartMaker::face_in(const HalfSpace& plane) {
  ConvexPart::Face face{.keeps = plane};
  for (int k = 0; k < 3; ++k)
    if (std::abs(plane.normal[k]) == 1) {
      face.axis = k;
      face.level = plane.normal[k] * plane.offset;
      face.is_turned = plane.normal[k] < 0;
      face.u = Vector<3>::Unit((k + 1) % 3);
      face.v = Vector<3>::Unit((k + 2) % 3);
      return face;
    }
  face.u = plane.normal.unitOrthogonal();
  face.v = plane.normal.cross(face.u);
  return face;
}

/// A corner of three faces lies in their planes to rounding; others are as near to them as they were.
void PartMaker::put_where_planes_meet(const ConvexPart& part, ConvexPart::Corner& corner, double tolerance) {
  if (corner.faces.size() == 3) {
    Eigen::Matrix3d normals;
    Vector<3> offsets;
    for (int k = 0; k < 3; ++k) {
      const HalfSpace& plane = part.faces[corner.faces[static_cast<std::size_t>(k)]].keeps;
      normals.row(k) = plane.normal.transpose();
      offsets[k] = plane.offset - plane.normal.dot(corner.point);
    }
    const Vector<3> step = normals.inverse() * offsets;
    if (step.norm() <= 10 * tolerance) corner.point += step;
  }
  for (const std::uint32_t face : corner.faces) part.put_on(face, corner.point);
}

/// Puts the corners of a face in order.
void PartMaker::sort_around(const ConvexPart& part, ConvexPart::Face& face) {
  Vector<3> middle = Vector<3>::Zero();
  for (const std::uint32_t corner : face.corners) middle += part.corners[corner].point;
  middle /= static_cast<double>(face.corners.size());
  face.origin = middle;
  if (face.axis >= 0) face.origin[face.axis] = face.level;
  const double sense = face.is_turned ? -1 : 1;
  std::ranges::sort(face.corners, {}, [&](std::uint32_t corner) {
    const Vector<3> d = part.corners[corner].point - middle;
    return sense * std::atan2(d.dot(face.v), d.dot(face.u));
  });
}

ConvexPart part_between(std::span<const HalfSpace> planes, const Bounds<3>& around) {
  constexpr double rounding_of_corners = 1e-9;  // of the extent of what is around
  constexpr ConvexCell::Label outside = -1;
  const Vector<3> middle = around.center(), half = around.upper - middle;
  ConvexCell cell;
  cell.reset(-half, half, {outside, outside, outside, outside, outside, outside});
  for (std::size_t k = 0; k < planes.size() && !cell.empty(); ++k)
    cell.cut(planes[k].normal, planes[k].offset - planes[k].normal.dot(middle),
             static_cast<ConvexCell::Label>(k));
  if (cell.empty() || !(cell.volume() > 0)) refuse_part("holds nothing");
  const double tolerance = rounding_of_corners * half.norm();
  // Where more than three planes meet the cell has several corners in one place.
  std::vector<Vector<3>> points;
  std::vector<std::uint32_t> number;
  for (const Vector<3>& corner : cell.corners()) {
    const auto found =
        std::ranges::find_if(points, [&](const Vector<3>& p) { return (p - corner).norm() <= tolerance; });
    number.push_back(static_cast<std::uint32_t>(found - points.begin()));
    if (found == points.end()) points.push_back(corner);
  }
  std::map<ConvexCell::Label, std::vector<std::uint32_t>> corners_of;
  cell.for_each_face([&](ConvexCell::Label label, std::span<const std::uint32_t> loop) {
    std::vector<std::uint32_t> corners;
    for (const std::uint32_t corner : loop) corners.push_back(number[corner]);
    std::ranges::sort(corners);
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    if (corners.size() < 3) return;
    if (label == outside)
      refuse_part(fmt::format("is not closed by its planes: it goes on in the direction {}",
                              place_in_part(points[corners.front()].normalized())));
    corners_of[label] = std::move(corners);
  });
  std::vector<HalfSpace> kept;
  std::vector<std::vector<std::uint32_t>> faces_at(points.size());
  for (const auto& [label, corners] : corners_of) {
    for (const std::uint32_t corner : corners)
      faces_at[corner].push_back(static_cast<std::uint32_t>(kept.size()));
    kept.push_back(planes[static_cast<std::size_t>(label)]);
  }
  PartMaker maker(std::move(kept));
  for (std::size_t c = 0; c < points.size(); ++c)
    if (faces_at[c].size() >= 3) maker.add_corner(middle + points[c], std::move(faces_at[c]));
  return std::move(maker).made(tolerance);
}

std::optional<Piece> piece_in(const ConvexPart& part, const Vector<3>& center, double radius) {
  if (!(part.height(center) < radius) || !(part.distance(center) < radius)) return {};
  Piece piece{.center = center, .radius = radius};
  for (std::size_t f = 0; f < part.faces.size(); ++f)
    if (const HalfSpace& keeps = part.faces[f].keeps; keeps.offset - keeps.normal.dot(center) < radius)
      piece.cuts.push_back({keeps, static_cast<int>(f)});
  return piece;
}

double volume_of(const Piece& piece) {
  const double r = piece.radius;
  if (piece.cuts.empty()) return ball_volume(3, r);
  ConvexCell cell;
  const Vector<3> beyond = Vector<3>::Constant(2 * r);
  cell.reset(-beyond, beyond, {-1, -1, -1, -1, -1, -1});
  for (const Cut& cut : piece.cuts)
    if (!cell.empty())
      cell.cut(cut.keeps.normal, cut.keeps.offset - cut.keeps.normal.dot(piece.center), ConvexCell::wall);
  return volume_inside(cell, Vector<3>::Zero(), Sphere{.center = Vector<3>::Zero(), .radius = r});
}

}  // namespace bernal
