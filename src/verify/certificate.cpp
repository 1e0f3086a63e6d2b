#include "bernal/verify/certificate.hpp"

#include <chrono>
#include <cmath>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "verify/judge_pairs.hpp"
#include "verify/judge_walls.hpp"

namespace bernal {
namespace {

/// "1 sphere", "1,200 spheres".
std::string counted(std::uint64_t n, std::string_view one, std::string_view many) {
  return fmt::format("{} {}", grouped(n), n == 1 ? one : many);
}
std::string counted_spheres(std::uint64_t n) { return counted(n, "sphere", "spheres"); }

void check_arguments(const Spheres<dynamic>& spheres, const Domain& domain, double allowed_overlap) {
  if (spheres.dimension() != dimension_of(domain))
    throw Error(ErrorCode::bad_argument, fmt::format("the spheres have {} coordinates, the domain has {}",
                                                     spheres.dimension(), dimension_of(domain)));
  for (const auto& column : spheres.x)
    if (column.size() != spheres.size())
      throw Error(ErrorCode::bad_argument, fmt::format("a column of coordinates has {} entries for {} radii",
                                                       column.size(), spheres.size()));
  if (!(allowed_overlap >= 0 && allowed_overlap < 1))
    throw Error(ErrorCode::bad_argument,
                fmt::format("the allowed overlap ratio is {}; it must be in [0, 1)", allowed_overlap));
}

/// Why there is nothing to prove: the spheres that are none.
std::optional<std::string> complaint_about(const Spheres<dynamic>& spheres) {
  std::uint64_t bad = 0, first = 0;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const bool good = spheres.center(i).allFinite() && std::isfinite(spheres.r[i]) && spheres.r[i] > 0;
    if (!good && bad++ == 0) first = i;
  }
  if (bad == 0) return std::nullopt;
  const Vector<dynamic> c = spheres.center(first);
  return fmt::format(
      "Not certified: {} without a finite centre and a positive finite radius (first: sphere {} at {} with "
      "radius {}); nothing else was tested.",
      counted_spheres(bad), first, fmt::join(c, ", "), spheres.r[first]);
}

std::vector<verify::Ball<3>> balls_of(const Spheres<dynamic>& spheres) {
  std::vector<verify::Ball<3>> balls(spheres.size());
  for (std::size_t i = 0; i < balls.size(); ++i) balls[i] = {spheres.center(i), spheres.r[i], i};
  return balls;
}

verify::Tally judge(const Spheres<dynamic>& spheres, const Domain& domain, double allowed_overlap,
                    Arithmetic arithmetic) {
  if (is_periodic(domain) || dimension_of(domain) != 3) {
    verify::Tally tally = verify::judge_pairs(spheres, domain, allowed_overlap, arithmetic);
    return tally += verify::judge_walls(spheres, domain, arithmetic);
  }
  const verify::BallTree<3> balls(balls_of(spheres));
  verify::Tally tally = verify::judge_pairs(balls, allowed_overlap, arithmetic);
  return tally += verify::judge_walls(balls, domain, arithmetic);
}

/// "1,200 spheres, 7,000 near pairs and 7,200 walls decided exactly, no overlap, no protrusion"
std::string what_was_decided(const Certificate& c, const Domain& domain, const std::string& limit) {
  const std::string pairs = counted(c.pairs_tested, "near pair", "near pairs");
  if (!has_walls(domain))
    return fmt::format("{} in a {}, {} decided exactly, no overlap{}", counted_spheres(c.spheres),
                       name_of(domain), pairs, limit);
  if (is_periodic(domain))
    return fmt::format("{} in a {}, {} and {} decided exactly, no overlap{}, no protrusion",
                       counted_spheres(c.spheres), name_of(domain), pairs,
                       counted(c.walls_tested, "wall", "walls"), limit);
  const bool mesh = std::holds_alternative<Mesh>(domain);
  return fmt::format(
      "{}, {} and {} decided exactly, no overlap{}, no protrusion", counted_spheres(c.spheres), pairs,
      counted(c.walls_tested, mesh ? "near triangle" : "wall", mesh ? "near triangles" : "walls"), limit);
}

std::string statement_of(const Certificate& c, double allowed_overlap, const Domain& domain) {
  const std::string limit = allowed_overlap > 0 ? fmt::format(" above {}", allowed_overlap) : "";
  if (c.certified) {
    if (c.spheres == 0) return "Certified: there are no spheres.";
    std::string closest;
    if (c.worst_pair)
      closest = c.max_overlap > 0 ? fmt::format("; largest overlap {:.2g}", c.max_overlap)
                                  : fmt::format("; closest pair gap {:.2g}", 0.0 - c.max_overlap);
    if (!closest.empty()) closest += " of the sum of radii";
    return fmt::format("Certified: {}{}.", what_was_decided(c, domain, limit), closest);
  }
  std::string faults;
  if (c.overlapping_pairs > 0)
    faults = fmt::format("{}{} (worst {}, overlap ratio {:.2g})",
                         counted(c.overlapping_pairs, "overlapping pair", "overlapping pairs"), limit,
                         worst_pair_text(c), c.max_overlap);
  if (c.protruding_spheres > 0)
    faults += fmt::format("{}{} across or outside the wall (worst {}, gap {:.2g} of its radius)",
                          faults.empty() ? "" : ", ", counted_spheres(c.protruding_spheres), *c.worst_wall,
                          c.min_wall_gap);
  return fmt::format("Not certified: {}.", faults);
}

}  // namespace

std::string worst_pair_text(const Certificate& c) {
  if (!c.worst_pair) return "none";
  const auto [first, second] = *c.worst_pair;
  return first == second ? fmt::format("{} and its own image", first)
                         : fmt::format("{} and {}", first, second);
}

Certificate certify(const Spheres<dynamic>& spheres, const Domain& domain, double allowed_overlap,
                    Arithmetic arithmetic) {
  const auto start = std::chrono::steady_clock::now();
  check_arguments(spheres, domain, allowed_overlap);

  Certificate result;
  result.spheres = spheres.size();
  if (auto complaint = complaint_about(spheres)) {
    result.statement = *std::move(complaint);
  } else {
    const verify::Tally tally = judge(spheres, domain, allowed_overlap, arithmetic);
    result.pairs_tested = tally.pairs;
    result.walls_tested = tally.walls;
    result.centers_tested = tally.centers;
    result.decided_double = tally.decided_double;
    result.decided_exact = tally.decided_exact;
    result.overlapping_pairs = tally.overlapping;
    result.protruding_spheres = tally.protruding;
    if (tally.pairs > 0) {
      result.worst_pair = {tally.worst_pair[0], tally.worst_pair[1]};
      result.max_overlap = tally.max_overlap;
    }
    if (std::isfinite(tally.min_wall_gap)) {
      result.worst_wall = tally.worst_wall;
      result.min_wall_gap = tally.min_wall_gap;
    }
    result.certified = tally.overlapping == 0 && tally.protruding == 0;
    result.statement = statement_of(result, allowed_overlap, domain);
  }
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace bernal
