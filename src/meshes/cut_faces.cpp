// Faces of a part that is cut out of a packing: its edges first, then what is between them.
#include <algorithm>
#include <cmath>
#include <set>

#include "meshes/planar_part.hpp"

namespace bernal {
namespace {

class CutFaces {
 public:
  CutFaces(SurfaceDraft& draft, const ConvexPart& part)
      : draft_(draft), part_(part), chains_(part.edges.size()), circles_at_(part.faces.size()) {
    for (const DraftPiece& piece : draft.pieces)
      for (const Circle& circle : piece.circles)
        if (piece.is_outer() && circle.kind == Circle::Kind::end)
          circles_at_[static_cast<std::size_t>(circle.face)].push_back({&piece, &circle});
  }

  void mesh() {
    for (std::uint32_t e = 0; e < part_.edges.size(); ++e) make_edge(e);
    for (std::uint32_t f = 0; f < part_.faces.size(); ++f) make_face(f);
  }

 private:
  struct CircleThere {
    const DraftPiece* piece;
    const Circle* circle;
  };
  const Vector<3>& corner(std::uint32_t c) const { return part_.corners[c].point; }
  double size_in(const ConvexPart::Face& face, const Vector<3>& p) const {
    return draft_.sizes.on_wall(p, face.keeps.normal, true);
  }

  /// Where spheres cross an edge: coordinates along it, and vertices.
  std::set<std::pair<double, std::uint32_t>> crossings_of(const ConvexPart::Edge& edge) const {
    std::set<std::pair<double, std::uint32_t>> found;
    const auto add = [&](std::uint32_t id) { found.insert({draft_.made.vertices[id].dot(edge.along), id}); };
    for (const auto& [piece, circle] : circles_at_[edge.faces[0]])
      for (std::size_t k = 0; k < circle->chains.size() && !circle->is_whole; ++k)
        for (const std::size_t end : {0, 1})
          if (const Circle& other = piece->circles[circle->ended_by[k][end]];
              other.face == static_cast<int>(edge.faces[1]))
            add(end == 0 ? circle->chains[k].front() : circle->chains[k].back());
    return found;
  }

  /// Narrow faces have no longer edges than they are wide.
  double width_beside(const ConvexPart::Edge& edge, const Vector<3>& p) const {
    double least = std::numeric_limits<double>::infinity();
    if (part_.is_box) return least;
    for (const std::uint32_t face : edge.faces)
      for (const std::uint32_t e : part_.faces[face].edges) {
        const ConvexPart::Edge& other = part_.edges[e];
        if (std::ranges::any_of(
                other.corners, [&](std::uint32_t c) { return c == edge.corners[0] || c == edge.corners[1]; }))
          continue;
        const Vector<3>& from = corner(other.corners[0]);
        const double length = (corner(other.corners[1]) - from).dot(other.along);
        const Vector<3> d = p - from;
        least = std::min(least, (d - std::clamp(d.dot(other.along), 0.0, length) * other.along).norm());
      }
    return least;
  }

  /// The parts of an edge in the fluid.
  void make_edge(std::uint32_t number) {
    const ConvexPart::Edge& edge = part_.edges[number];
    const Vector<3>&from = corner(edge.corners[0]), &to = corner(edge.corners[1]);
    const double lower = from.dot(edge.along), upper = to.dot(edge.along);
    const Vector<3> base = from - lower * edge.along;
    const auto point = [&](double x) {
      Vector<3> p = base + x * edge.along;
      for (const std::uint32_t face : edge.faces) part_.put_on(face, p);
      return p;
    };
    const auto size = [&](double x) {
      const Vector<3> p = point(x);
      return std::min({size_in(part_.faces[edge.faces[0]], p), size_in(part_.faces[edge.faces[1]], p),
                       width_beside(edge, p)});
    };
    const std::uint32_t first = draft_.vertex_at(from, size(lower));
    const std::uint32_t last = draft_.vertex_at(to, size(upper));
    std::vector<std::pair<double, std::uint32_t>> stops = {{lower, first}};
    for (const auto& crossing : crossings_of(edge))
      if (crossing.first > lower && crossing.first < upper) stops.push_back(crossing);
    stops.push_back({upper, last});
    for (std::size_t s = 0; s + 1 < stops.size(); ++s) {
      const double start = stops[s].first, length = stops[s + 1].first - start;
      const Vector<3> middle = point(start + 0.5 * length);
      if (std::ranges::any_of(circles_at_[edge.faces[0]], [&](const CircleThere& there) {
            return (middle - there.piece->piece.center).norm() < there.piece->piece.radius;
          }))
        continue;
      auto& chain = chains_[number].emplace_back(1, stops[s].second);
      for (const double share : spaced(length, 1, [&](double t) { return size(start + t * length); }))
        chain.push_back(draft_.vertex_at(point(start + share * length), size(start + share * length)));
      chain.push_back(stops[s + 1].second);
    }
  }

  void make_face(std::uint32_t number) {
    const ConvexPart::Face& face = part_.faces[number];
    PlanarPart plane(
        draft_,
        [&](const Vector<3>& p) {
          const Vector<3> d = p - face.origin;
          return Vector<3>(d.dot(face.u), d.dot(face.v), 0);
        },
        [&](const Vector<3>& p) {
          Vector<3> q = face.origin + p[0] * face.u + p[1] * face.v;
          part_.put_on(number, q);
          return q;
        });
    for (const std::uint32_t edge : face.edges)
      for (const auto& chain : chains_[edge]) plane.add_chain(chain, false);
    for (const CircleThere& there : circles_at_[number])
      for (const auto& chain : there.circle->chains) plane.add_chain(chain, there.circle->is_whole);
    if (plane.empty()) return;  // within a ball
    const std::uint32_t patch =
        draft_.add_patch({SurfacePatch::Kind::wall, number, {0, SurfacePatch::nothing}});
    plane.mesh(patch, face.is_turned, [&](const Vector<3>& p) { return size_in(face, p); });
  }

  SurfaceDraft& draft_;
  const ConvexPart& part_;
  std::vector<std::vector<std::vector<std::uint32_t>>> chains_;  ///< by edge
  std::vector<std::vector<CircleThere>> circles_at_;             ///< by face
};

}  // namespace

void mesh_cut_faces(SurfaceDraft& draft, const ConvexPart& part) { CutFaces(draft, part).mesh(); }

}  // namespace bernal
