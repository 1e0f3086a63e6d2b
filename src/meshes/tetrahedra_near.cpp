#include "meshes/tetrahedra_near.hpp"

#include <algorithm>

#include "core/parallel.hpp"

namespace bernal {
namespace {

bool has(const TetrahedronCorners& corners, std::uint32_t vertex) {
  return std::ranges::find(corners, vertex) != corners.end();
}

}  // namespace

TetrahedraNear::TetrahedraNear(VolumeMesh& mesh, bool for_gradients)
    : mesh_(mesh),
      is_fixed_(mesh.vertices.size(), 0),
      is_touched_(mesh.vertices.size(), 0),
      slot_(mesh.vertices.size(), none) {
  for (const FaceCorners& triangle : mesh.triangles)
    for (const std::uint32_t vertex : triangle) is_fixed_[vertex] = 1;
  if (!for_gradients) return;
  const auto is_outer = [&](std::size_t t) {
    const SurfacePatch& patch = mesh.patches[mesh.patch[t]];
    return patch.kind != SurfacePatch::Kind::period_end &&
           std::ranges::find(patch.regions, SurfacePatch::nothing) != patch.regions.end();
  };
  std::vector<FaceCorners> outside;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!is_outer(t)) continue;
    outside.push_back(mesh.triangles[t]);
    std::ranges::sort(outside.back());
  }
  std::ranges::sort(outside);
  first_outside_.assign(mesh.vertices.size() + 1, 0);
  for (const FaceCorners& corners : outside) {
    ++first_outside_[corners[0] + 1];
    outside_.push_back({corners[1], corners[2]});
  }
  for (std::size_t v = 1; v < first_outside_.size(); ++v) first_outside_[v] += first_outside_[v - 1];
}

bool TetrahedraNear::is_outside(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
  FaceCorners of = {a, b, c};
  std::ranges::sort(of);
  if (!is_fixed_[of[0]]) return false;
  for (std::uint32_t k = first_outside_[of[0]]; k < first_outside_[of[0] + 1]; ++k)
    if (outside_[k][0] == of[1] && outside_[k][1] == of[2]) return true;
  return false;
}

double TetrahedraNear::determinant_of_inner_faces(const TetrahedronCorners& c) const {
  std::array<Vector<3>, 4> areas;
  std::size_t count = 0;
  double mean = 0;
  for (const auto& face : faces_of_tetrahedron) {
    const auto [i, j, k] =
        std::array{c[static_cast<std::size_t>(face[0])], c[static_cast<std::size_t>(face[1])],
                   c[static_cast<std::size_t>(face[2])]};
    if (is_outside(i, j, k)) continue;
    areas[count] = (at(j) - at(i)).cross(at(k) - at(i));
    mean += areas[count++].norm();
  }
  if (count < 3) return 0;
  mean /= static_cast<double>(count);
  // The determinant of a sum of n n^T is the sum of squares of all triple products.
  double sum = 0;
  for (std::size_t out = count == 3 ? 3 : 0; out < 4; ++out) {
    std::array<std::size_t, 3> of{};
    for (std::size_t k = 0, n = 0; k < 4; ++k)
      if (k != out) of[n++] = k;
    const double triple = areas[of[0]].cross(areas[of[1]]).dot(areas[of[2]]) / (mean * mean * mean);
    sum += triple * triple;
  }
  return sum / 8;
}

double TetrahedraNear::quality(const TetrahedronCorners& c) const {
  const double shape = sicn(at(c[0]), at(c[1]), at(c[2]), at(c[3]));
  if (shape <= most_of_ill_posed || first_outside_.empty()) return shape;
  const auto fixed = std::ranges::count_if(c, [&](std::uint32_t vertex) { return is_fixed_[vertex] != 0; });
  constexpr double well_shaped = 0.5;  // whose four faces give more, and of which three at most lie inside
  if (fixed < 3 && shape > well_shaped) return shape;
  return determinant_of_inner_faces(c) < least_determinant ? most_of_ill_posed : shape;
}

void TetrahedraNear::keep_star(std::uint32_t vertex) {
  if (slot_[vertex] != none) return;
  slot_[vertex] = static_cast<std::uint32_t>(stars_.size());
  stars_.emplace_back();
}

std::vector<std::uint32_t> TetrahedraNear::look(double goal) {
  std::ranges::fill(slot_, none);
  stars_.clear();
  std::vector<std::uint32_t> bad;
  std::vector<double> of_bad;
  std::vector<std::uint8_t> is_near(mesh_.vertices.size(), 0);
  const auto count = static_cast<std::uint32_t>(mesh_.tetrahedra.size());
  for (std::uint32_t t = 0; t < count; ++t) {
    if (t % 65536 == 0) throw_if_interrupted();
    if (!is_there(t)) continue;
    if (const double q = quality(t); q < goal) {
      bad.push_back(t);
      of_bad.push_back(q);
      for (const std::uint32_t vertex : corners(t)) is_near[vertex] = 1;
    }
  }
  for (std::uint32_t t = 0; t < count; ++t)
    if (is_there(t) && std::ranges::any_of(corners(t), [&](std::uint32_t v) { return is_near[v]; }))
      for (const std::uint32_t vertex : corners(t)) keep_star(vertex);
  for (std::uint32_t t = 0; t < count; ++t)
    if (is_there(t))
      for (const std::uint32_t vertex : corners(t))
        if (has_star(vertex)) stars_[slot_[vertex]].push_back(t);
  std::vector<std::uint32_t> order(bad.size()), sorted;
  for (std::uint32_t k = 0; k < order.size(); ++k) order[k] = k;
  std::ranges::stable_sort(order, {}, [&](std::uint32_t k) { return of_bad[k]; });
  sorted.reserve(bad.size());
  for (const std::uint32_t k : order) sorted.push_back(bad[k]);
  return sorted;
}

double TetrahedraNear::least_quality(std::span<const std::uint32_t> of) const {
  double least = 1;
  for (const std::uint32_t t : of) least = std::min(least, quality(t));
  return least;
}

std::vector<std::uint32_t> TetrahedraNear::around(std::uint32_t a, std::uint32_t b) const {
  std::vector<std::uint32_t> ring;
  for (const std::uint32_t t : star(a))
    if (has(corners(t), b)) ring.push_back(t);
  return ring;
}

std::uint32_t TetrahedraNear::behind(std::uint32_t t, int corner) const {
  const auto& face = faces_of_tetrahedron[static_cast<std::size_t>(corner)];
  std::array<std::uint32_t, 3> of{};
  for (std::size_t k = 0; k < 3; ++k) of[k] = corners(t)[static_cast<std::size_t>(face[k])];
  if (!has_star(of[0])) return none;
  for (const std::uint32_t other : star(of[0]))
    if (other != t && has(corners(other), of[1]) && has(corners(other), of[2]))
      return region(other) == region(t) ? other : none;
  return none;
}

void TetrahedraNear::replace(std::span<const std::uint32_t> old, std::span<const TetrahedronCorners> by) {
  const std::uint32_t of = region(old[0]);
  for (const std::uint32_t t : old) {
    touch(t);
    for (const std::uint32_t vertex : corners(t))
      if (has_star(vertex)) std::erase(stars_[slot_[vertex]], t);
    mesh_.region[t] = none;
    gaps_.push_back(t);
  }
  for (const TetrahedronCorners& made : by) {
    if (gaps_.empty()) {
      gaps_.push_back(static_cast<std::uint32_t>(mesh_.tetrahedra.size()));
      mesh_.tetrahedra.emplace_back();
      mesh_.region.push_back(none);
    }
    const std::uint32_t t = gaps_.back();
    gaps_.pop_back();
    mesh_.tetrahedra[t] = made;
    mesh_.region[t] = of;
    for (const std::uint32_t vertex : made)
      if (has_star(vertex)) stars_[slot_[vertex]].push_back(t);
  }
}

std::uint32_t TetrahedraNear::add_vertex(const Vector<3>& at) {
  const auto vertex = static_cast<std::uint32_t>(mesh_.vertices.size());
  mesh_.vertices.push_back(at);
  is_fixed_.push_back(0);
  is_touched_.push_back(1);
  slot_.push_back(none);
  keep_star(vertex);
  return vertex;
}

void TetrahedraNear::drop_vertex() {
  mesh_.vertices.pop_back();
  is_fixed_.pop_back();
  is_touched_.pop_back();
  slot_.pop_back();
  stars_.pop_back();
}

std::vector<std::uint8_t> TetrahedraNear::take_touched() {
  std::vector<std::uint8_t> touched(is_touched_.size(), 0);
  touched.swap(is_touched_);
  return touched;
}

void TetrahedraNear::close() {
  std::size_t kept = 0;
  for (std::uint32_t t = 0; t < mesh_.tetrahedra.size(); ++t) {
    if (!is_there(t)) continue;
    mesh_.tetrahedra[kept] = mesh_.tetrahedra[t];
    mesh_.region[kept++] = mesh_.region[t];
  }
  mesh_.tetrahedra.resize(kept);
  mesh_.region.resize(kept);
  std::vector<std::uint8_t> is_used(is_fixed_);
  for (const TetrahedronCorners& corners : mesh_.tetrahedra)
    for (const std::uint32_t vertex : corners) is_used[vertex] = 1;
  // Those of triangles come first and keep their numbers.
  std::vector<std::uint32_t> number(mesh_.vertices.size(), none);
  std::uint32_t next = 0;
  for (std::uint32_t v = 0; v < mesh_.vertices.size(); ++v) {
    if (!is_used[v]) continue;
    mesh_.vertices[next] = mesh_.vertices[v];
    number[v] = next++;
  }
  mesh_.vertices.resize(next);
  for (TetrahedronCorners& corners : mesh_.tetrahedra)
    for (std::uint32_t& vertex : corners) vertex = number[vertex];
}

}  // namespace bernal
