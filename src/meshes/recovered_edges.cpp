// Edges that a Delaunay triangulation lacks.
#include <algorithm>
#include <deque>

#include "meshes/delaunay.hpp"

namespace bernal {

bool Delaunay::recover(std::span<const std::array<std::uint32_t, 2>> edges) {
  if (bind(edges)) return true;
  for (const auto& [from, to] : edges)
    if (!recover(from, to)) return false;
  if (!bind(edges)) return false;
  restore();
  return true;
}

bool Delaunay::recover(std::uint32_t from, std::uint32_t to) {
  const auto side = [&](std::uint32_t point) { return side_of(from, to, point); };
  std::deque<std::array<std::uint32_t, 2>> crossing;
  std::uint32_t at = none;
  std::size_t through = 0;
  for (std::uint32_t f = 0; f < faces_.size() && at == none; ++f) {
    if (!faces_[f].is_alive || !is_finite(faces_[f])) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      if (faces_[f].corners[k] != from) continue;
      const std::uint32_t next = faces_[f].corners[(k + 1) % 3], last = faces_[f].corners[(k + 2) % 3];
      if (next == to || last == to) return true;
      if (side(next) >= 0 || side(last) <= 0) continue;
      at = f;
      through = (k + 1) % 3;
    }
  }
  while (at != none) {  // from triangle to triangle along the edge
    const std::uint32_t right = faces_[at].corners[through], left = faces_[at].corners[(through + 1) % 3];
    if (faces_[at].bound[through]) return false;
    crossing.push_back({right, left});
    at = faces_[at].beside[through];
    if (!is_finite(faces_[at])) return false;
    std::size_t k = 0;
    while (faces_[at].corners[k] != left) ++k;
    const std::uint32_t opposite = faces_[at].corners[(k + 2) % 3];
    if (opposite == to) break;
    if (side(opposite) == 0) return false;
    through = side(opposite) > 0 ? (k + 1) % 3 : (k + 2) % 3;
  }
  for (std::size_t left = 100 * crossing.size() * crossing.size(); left > 0 && !crossing.empty(); --left) {
    const std::array<std::uint32_t, 2> edge = crossing.front();
    crossing.pop_front();
    const auto [face, k] = face_at(edge[0], edge[1]);
    if (!is_convex_about(face, k)) {
      crossing.push_back(edge);
      continue;
    }
    swap_diagonal(face, k);  // the other diagonal is then its second edge
    const std::array<std::uint32_t, 2> other = {faces_[face].corners[1], faces_[face].corners[2]};
    const bool has_end = std::ranges::any_of(other, [&](std::uint32_t p) { return p == from || p == to; });
    if (!has_end && side(other[0]) != side(other[1])) crossing.push_back(other);
  }
  return crossing.empty();
}

std::pair<std::uint32_t, std::size_t> Delaunay::face_at(std::uint32_t a, std::uint32_t b) const {
  for (std::uint32_t f = 0; f < faces_.size(); ++f)
    for (std::size_t k = 0; faces_[f].is_alive && k < 3; ++k)
      if (faces_[f].corners[k] == a && faces_[f].corners[(k + 1) % 3] == b) return {f, k};
  return {none, 0};
}

}  // namespace bernal
