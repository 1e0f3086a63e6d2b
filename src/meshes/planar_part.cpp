#include "meshes/planar_part.hpp"

#include <algorithm>

namespace bernal {

PlanarPart::PlanarPart(SurfaceDraft& draft, Map flat, Map back)
    : draft_(draft), flat_(std::move(flat)), back_(std::move(back)) {}

std::uint32_t PlanarPart::number(std::uint32_t id) {
  const auto [entry, is_new] = number_.try_emplace(id, static_cast<std::uint32_t>(ids_.size()));
  if (is_new) {
    ids_.push_back(id);
    patch_.points.push_back(flat_(draft_.made.vertices[id]));
  }
  return entry->second;
}

void PlanarPart::add_chain(const std::vector<std::uint32_t>& chain, bool is_closed) {
  for (std::size_t k = 0; k + (is_closed ? 0 : 1) < chain.size(); ++k)
    patch_.edges.push_back({number(chain[k]), number(chain[(k + 1) % chain.size()])});
}

void PlanarPart::add_hole(const std::vector<std::uint32_t>& chain) {
  add_chain(chain, true);
  auto& circle = patch_.circles.emplace_back();
  for (const std::uint32_t id : chain) circle.push_back(number(id));
}

void PlanarPart::mesh(std::uint32_t patch, bool turned, const std::function<double(const Vector<3>&)>& size,
                      double period, double margin) {
  patch_.size = [&](const Vector<3>& p) { return size(back_(p)); };
  patch_.period = period;
  patch_.margin = margin;
  patch_.extent = period + margin;
  for (const Vector<3>& p : patch_.points)
    patch_.extent = std::max({patch_.extent, std::abs(p[0]), std::abs(p[1])});
  const PatchMesh made = mesh_patch(patch_);
  std::vector<std::uint32_t> id = ids_;
  for (const Vector<3>& p : made.added) {
    const Vector<3> q = back_(p);
    id.push_back(draft_.add_vertex(q, size(q)));
  }
  for (const FaceCorners& t : made.triangles) {
    triangles_.push_back({id[t[0]], id[t[1]], id[t[2]]});
    draft_.add_triangle(patch, id[t[0]], id[t[turned ? 2 : 1]], id[t[turned ? 1 : 2]]);
  }
}

}  // namespace bernal
