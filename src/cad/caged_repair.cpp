#include "cad/caged_repair.hpp"

#include <fmt/format.h>

#include <exception>
#include <new>

#include "bernal/core/text.hpp"
#include "cad/cage.hpp"

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

}  // namespace bernal::cad
