#include "cad/repair/caged_repair.hpp"

#include <fmt/format.h>

#include "geometry/measures.hpp"
#include "process/cage.hpp"

namespace bernal::cad {

RepairedMesh repair_in_cage(const Mesh& mesh, double seconds, const std::function<RepairedMesh()>& repair) {
  const CageLimits limits{(std::uint64_t{4} << 30U) + 20'000 * mesh.triangles.size(), seconds};
  RepairedMesh repaired;
  const std::string befell = run_in_cage(
      "CGAL", limits, [&] { repaired = repair(); },
      [&](Archive& a) { a(repaired.done, repaired.mesh.vertices, repaired.mesh.triangles); });
  if (befell.empty()) return repaired;
  return {mesh, fmt::format("not repaired: {}", befell)};
}

std::string what_is_left(const Mesh& before, const Mesh& after) {
  constexpr double edges_rounded_off = 0.98;
  const Vector<3> was = bounds_of_faces(before).size(), is = bounds_of_faces(after).size();
  if ((is.array() >= edges_rounded_off * was.array()).all()) return {};
  const auto size = [](const Vector<3>& s) {
    return fmt::format("{:.4g} x {:.4g} x {:.4g}", s[0], s[1], s[2]);
  };
  return fmt::format("of {} are left {}", size(was), size(is));
}

}  // namespace bernal::cad
