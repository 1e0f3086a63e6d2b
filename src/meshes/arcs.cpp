#include "meshes/arcs.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace bernal {

using std::numbers::pi;

CircleFrame frame_of(const Circle& circle) {
  const Vector<3> u = circle.normal.unitOrthogonal();
  return {u, circle.normal.cross(u)};
}

std::vector<Arc> arcs_on(const DraftPiece& piece, std::size_t c) {
  const auto& circles = piece.circles;
  const Circle& circle = circles[c];
  const auto [u, v] = frame_of(circle);
  struct Gone {
    double from, to;
    std::size_t by;
  };
  std::vector<Gone> gone;
  for (std::size_t j = 0; j < circles.size(); ++j) {
    if (j == c) continue;
    const double a = circles[j].normal.dot(u), b = circles[j].normal.dot(v), m = std::hypot(a, b);
    const double level = circles[j].depth - circle.depth * circles[j].normal.dot(circle.normal);
    if (level <= -circle.radius * m) return {};
    if (level >= circle.radius * m) continue;
    const double middle = std::atan2(b, a), half = std::acos(level / (circle.radius * m));
    double from = middle - half;
    from -= 2 * pi * std::floor(from / (2 * pi));
    gone.push_back({from, from + 2 * half, j});
  }
  if (gone.empty()) return {{0, 2 * pi, {c, c}}};
  std::ranges::sort(gone, {}, &Gone::from);
  std::vector<Arc> arcs;
  // The end of what is gone so far, begun a turn before.
  const auto last = std::ranges::max_element(gone, {}, &Gone::to);
  double end = last->to - 2 * pi;
  std::size_t by = last->by;
  for (const Gone& g : gone) {
    if (g.from > end) arcs.push_back({end, g.from, {by, g.by}});
    if (g.to > end) {
      end = g.to;
      by = g.by;
    }
  }
  std::erase_if(arcs, [](const Arc& arc) { return arc.to - arc.from < 1e-9; });
  return arcs;
}

std::optional<ArcLike> arc_like(const SurfaceDraft& draft, const DraftPiece& piece, const Arc& arc,
                                const DraftPiece& other, std::size_t circle_of_other) {
  const Circle& circle = other.circles[circle_of_other];
  const std::vector<Arc> arcs = arcs_on(other, circle_of_other);
  const auto [u, v] = frame_of(circle);
  const auto ends_alike = [&](const Arc& candidate, std::size_t e) {
    return other.circles[candidate.ended_by[e]].face == piece.circles[arc.ended_by[e]].face;
  };
  for (std::size_t k = 0; k < arcs.size(); ++k) {
    if (!ends_alike(arcs[k], 0) || !ends_alike(arcs[k], 1)) continue;
    const auto& chain = circle.chains.at(k);
    const double scale = (arc.to - arc.from) / (arcs[k].to - arcs[k].from);
    const std::size_t end = circle.is_whole ? 0 : 1;
    ArcLike like{.chain = k, .angles = {}};
    for (std::size_t i = end; i + end < chain.size(); ++i) {
      const Vector<3> d = draft.made.vertices[chain[i]] - other.piece.center;
      double on = std::atan2(d.dot(v), d.dot(u)) - arcs[k].from;
      on -= 2 * pi * std::floor(on / (2 * pi));
      if (circle.is_whole && i == 0) on = 0;
      like.angles.push_back(arc.from + scale * on);
    }
    return like;
  }
  return {};
}

}  // namespace bernal
