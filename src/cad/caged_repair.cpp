#include "cad/caged_repair.hpp"

#include <fmt/format.h>

#include <exception>
#include <new>

#include "bernal/core/text.hpp"
#include "cad/cage.hpp"
#include "geometry/measures.hpp"

namespace bernal::cad {

Mended mend_in_cage(const Mesh& mesh, double seconds, const std::function<Mended()>& mend) {
  const CageLimits limits{(std::uint64_t{4} << 30U) + 20'000 * mesh.triangles.size(), seconds};
  Mended mended;
  const auto mended_by_child = [&]() -> Mended {
    try {
      return mend();
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& error) {
      return {mesh, plain_text(fmt::format("not repaired: {}", error.what()))};
    }
  };
  const auto work = [&](PlainWriter& out) {
    const Mended made = mended_by_child();
    out.text(made.done);
    out.points(made.mesh.vertices);
    out.array(std::span(made.mesh.triangles));
  };
  const auto take = [&](PlainReader& in) {
    mended.done = in.text();
    mended.mesh.vertices = in.points();
    mended.mesh.triangles = in.array<decltype(mended.mesh.triangles)>();
  };
  const std::string befell = run_in_cage("CGAL", limits, work, take);
  if (befell.empty()) return mended;
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
