#include "meshes/mesh_quality.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace bernal {

double sicn(const Vector<3>& a, const Vector<3>& b, const Vector<3>& c, const Vector<3>& d) {
  const Vector<3> u = b - a, v = c - a, w = d - a;
  const Vector<3> face_d = u.cross(v), face_c = w.cross(u), face_b = v.cross(w);
  const double edges = u.squaredNorm() + v.squaredNorm() + w.squaredNorm() + (c - b).squaredNorm() +
                       (d - c).squaredNorm() + (d - b).squaredNorm();
  const double faces = face_b.squaredNorm() + face_c.squaredNorm() + face_d.squaredNorm() +
                       (face_b + face_c + face_d).squaredNorm();  // four times the squares of the areas
  const double norm = std::sqrt(edges * faces);
  return norm > 0 ? 6 * w.dot(face_d) / norm : 0;
}

std::array<double, 6> dihedral_angles(const Vector<3>& a, const Vector<3>& b, const Vector<3>& c,
                                      const Vector<3>& d) {
  const std::array<const Vector<3>*, 4> at = {&a, &b, &c, &d};
  std::array<double, 6> angles{};
  for (std::size_t e = 0; e < angles.size(); ++e) {
    const auto [i, j] = edges_of_tetrahedron[e];
    // The other two corners: those of the six pairs that this edge does not have.
    int k = 0;
    while (k == i || k == j) ++k;
    const int l = 6 - i - j - k;
    const Vector<3> along =
        (*at[static_cast<std::size_t>(j)] - *at[static_cast<std::size_t>(i)]).normalized();
    const auto away = [&](int corner) {
      const Vector<3> to = *at[static_cast<std::size_t>(corner)] - *at[static_cast<std::size_t>(i)];
      return Vector<3>(to - to.dot(along) * along);
    };
    const Vector<3> p = away(k), q = away(l);
    angles[e] = std::atan2(p.cross(q).norm(), p.dot(q)) * 180 / std::numbers::pi;
  }
  return angles;
}

MeshQuality quality_of(const VolumeMesh& mesh) {
  constexpr std::size_t most_places = 10;
  MeshQuality found;
  double sum = 0;
  const auto is_worse = [](const MeshQuality::Place& a, const MeshQuality::Place& b) {
    return a.sicn < b.sicn;
  };
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    std::array<const Vector<3>*, 4> at{};
    for (std::size_t k = 0; k < 4; ++k) at[k] = &mesh.vertices[mesh.tetrahedra[t][k]];
    const double quality = sicn(*at[0], *at[1], *at[2], *at[3]);
    sum += quality;
    found.least_sicn = std::min(found.least_sicn, quality);
    const int tenth = static_cast<int>(std::floor(10 * quality));
    ++found.histogram[static_cast<std::size_t>(std::clamp(tenth, 0, 9))];
    for (const double angle : dihedral_angles(*at[0], *at[1], *at[2], *at[3])) {
      found.least_angle = std::min(found.least_angle, angle);
      found.largest_angle = std::max(found.largest_angle, angle);
    }
    if (found.worst.size() == most_places && quality >= found.worst.back().sicn) continue;
    const MeshQuality::Place place{quality, t, (*at[0] + *at[1] + *at[2] + *at[3]) / 4};
    found.worst.insert(std::ranges::upper_bound(found.worst, place, is_worse), place);
    if (found.worst.size() > most_places) found.worst.pop_back();
  }
  if (!mesh.tetrahedra.empty()) found.mean_sicn = sum / static_cast<double>(mesh.tetrahedra.size());
  return found;
}

}  // namespace bernal
