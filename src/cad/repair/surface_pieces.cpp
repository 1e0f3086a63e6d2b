#include "cad/repair/surface_pieces.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "bernal/core/error.hpp"
#include "geometry/changes.hpp"
#include "geometry/measures.hpp"

namespace bernal::cad {

SurfacePieces::SurfacePieces(const Mesh& mesh)
    : mesh_(mesh), topology_(topology_of(mesh)), tree_(mesh), corner_(count(), no_index), depth_(count(), 0) {
  constexpr std::uint32_t most = 2000;
  if (count() > most)
    throw Error(ErrorCode::bad_mesh,
                fmt::format("the surface has {} pieces, too many to test what each encloses; choose "
                            "\"solids\"",
                            count()));
  for (std::size_t t = mesh.triangles.size(); t-- > 0;) corner_[piece_of(t)] = mesh.triangles[t][0];
  for (std::uint32_t c = 0; c < count(); ++c)
    for (std::uint32_t other = 0; other < count(); ++other) depth_[c] += encloses(other, c);
}

std::vector<double> SurfacePieces::volumes() const {
  std::vector<double> volumes(count(), 0);
  const Vector<3> center = bounds_of(mesh_).center();
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
    volumes[piece_of(t)] += six_signed_volumes(mesh_, mesh_.triangles[t], center);
  for (double& volume : volumes) volume = std::abs(volume) / 6;
  return volumes;
}

bool SurfacePieces::encloses(std::uint32_t piece, const Vector<3>& p) const {
  return tree_.crossing(p, 0, std::numeric_limits<double>::infinity(),
                        [&](std::uint32_t t) { return piece_of(t) != piece; }) == Crossing::odd;
}

std::uint32_t SurfacePieces::around(const Vector<3>& p) const {
  std::uint32_t found = no_index;
  for (std::uint32_t c = 0; c < count(); ++c)
    if (encloses(c, p) && (found == no_index || depth_[c] > depth_[found])) found = c;
  return found;
}

Mesh SurfacePieces::walls_of(const std::vector<bool>& outermost) const {
  std::vector<bool> kept = outermost;
  for (std::uint32_t c = 0; c < count(); ++c)
    for (std::uint32_t other = 0; other < count(); ++other)
      if (outermost[other] && depth_[c] == depth_[other] + 1 && encloses(other, c)) kept[c] = true;
  Mesh result{mesh_.vertices, {}};
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
    if (kept[piece_of(t)]) result.triangles.push_back(mesh_.triangles[t]);
  drop_unused_vertices(result);
  return result;
}

}  // namespace bernal::cad
