#include "bernal/verify/certificate.hpp"

#include <cmath>
#include <mutex>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/task_arena.h>

#include "bernal/core/dimension.hpp"
#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "verify/judge.hpp"
#include "verify/slabs.hpp"
#include "verify/streamed_slabs.hpp"
#include "verify/tilted.hpp"

namespace bernal {
namespace {

/// "1 sphere", "1,200 spheres".
std::string counted(std::uint64_t n, std::string_view one, std::string_view many) {
  return fmt::format("{} {}", grouped(n), n == 1 ? one : many);
}
std::string counted_spheres(std::uint64_t n) { return counted(n, "sphere", "spheres"); }

void check_arguments(int dimension, const Domain& domain, const CertifyOptions& options) {
  const double allowed_overlap = options.allowed_overlap;
  for (const double gap : {options.gap, options.wall_gap})
    if (!(std::isfinite(gap) && gap >= 0))
      throw Error(ErrorCode::bad_argument,
                  fmt::format("a gap is {}; it must be finite, and not negative", gap));
  const auto has_inset = [](const auto& shape) { return shape && shape->inset != 0; };
  if (has_inset(std::get_if<Mesh>(&domain)) || has_inset(std::get_if<Polygon>(&domain)) ||
      has_inset(std::get_if<Revolved>(&domain)))
    throw Error(ErrorCode::bad_argument, "the domain has an inset; certify with a wall_gap instead");

  if (dimension != dimension_of(domain))
    throw Error(ErrorCode::bad_argument, fmt::format("the spheres have {} coordinates, the domain has {}",
                                                     dimension, dimension_of(domain)));
  if (options.at_once == 0)
    throw Error(ErrorCode::bad_argument, "no spheres are to be looked at at once; leave at_once as it is");
  if (!(allowed_overlap >= 0 && allowed_overlap < 1))
    throw Error(ErrorCode::bad_argument,
                fmt::format("the allowed overlap ratio is {}; it must be in [0, 1)", allowed_overlap));
}

void check_columns(const Spheres<dynamic>& spheres) {
  for (const auto& column : spheres.x)
    if (column.size() != spheres.size())
      throw Error(ErrorCode::bad_argument, fmt::format("a column of coordinates has {} entries for {} radii",
                                                       column.size(), spheres.size()));
}
void check_columns(const SphereRows&) {}

int dimension_of_spheres(const Spheres<dynamic>& spheres) { return spheres.dimension(); }
int dimension_of_spheres(const SphereRows& spheres) { return spheres.dimension; }
std::uint64_t count_of(const Spheres<dynamic>& spheres) { return spheres.size(); }
std::uint64_t count_of(const SphereRows& spheres) { return spheres.count; }

/// The statement about invalid spheres.
std::string invalid_statement(std::uint64_t bad, std::uint64_t first, std::span<const double> center,
                              double r) {
  return fmt::format(
      "Not certified: {} without a finite centre and a positive finite radius (first: sphere {} at {} with "
      "radius {}); nothing else was tested.",
      counted_spheres(bad), first, fmt::join(center, ", "), r);
}

/// The statement if some spheres are invalid, else nothing.
std::optional<std::string> error_in(const SphereRows& spheres) {
  constexpr std::uint64_t piece = 4096;
  std::uint64_t bad = 0, first_bad = 0;
  std::vector<double> worst;
  const auto width = static_cast<std::size_t>(spheres.dimension) + 1;
  verify::for_each_piece(spheres, piece, [&](std::uint64_t first, std::span<const double> values) {
    for (std::size_t n = 0; n < values.size() / width; ++n) {
      const std::span<const double> row = values.subspan(n * width, width);
      if (row.back() > 0 && std::ranges::all_of(row, [](double x) { return std::isfinite(x); })) continue;
      if (bad++ > 0) continue;
      first_bad = first + n;
      worst.assign(row.begin(), row.end());
    }
  });
  if (bad == 0) return std::nullopt;
  return invalid_statement(bad, first_bad, std::span<const double>(worst).first(width - 1), worst.back());
}
std::optional<std::string> error_in(const Spheres<dynamic>& spheres) {
  std::uint64_t bad = 0, first = spheres.size();
  std::mutex adding;
  parallel_ranges(spheres.size(), 1 << 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      bool good = std::isfinite(spheres.r[i]) && spheres.r[i] > 0;
      for (const auto& column : spheres.x) good = good && std::isfinite(column[i]);
      if (good) continue;
      const std::lock_guard lock(adding);
      ++bad;
      first = std::min<std::uint64_t>(first, i);
    }
  });
  if (bad == 0) return std::nullopt;
  const Vector<dynamic> c = spheres.center(first);
  return invalid_statement(bad, first, {c.data(), static_cast<std::size_t>(c.size())}, spheres.r[first]);
}

using NotThreeDimensions = std::integer_sequence<int, 1, 2, 4, 5, 6, 7, 8>;

template <int D, class Space>
verify::Slabs<D> slabs_of(const Spheres<dynamic>& spheres, const Space& space, std::size_t at_once) {
  return {spheres, space, at_once};
}
template <int D, class Space>
verify::StreamedSlabs<D> slabs_of(const SphereRows& spheres, const Space& space, std::size_t at_once) {
  return {spheres, space, at_once};
}

/// Slab by slab, each with the parts of later slabs that reach into it.
template <int D, class Space, class Source>
verify::Tally judge_in(const Space& space, const Source& spheres, const Domain& domain,
                       const verify::Job& job) {
  const verify::Walls<D> walls = verify::walls_of<D>(domain);
  const auto slabs = slabs_of<D>(spheres, space, job.options().at_once);
  const double known = verify::distances_known_up_to(job.options().gap);
  verify::Tally tally(job.options().list);
  std::vector<verify::Ball<D>> next = slabs.balls(0, space);
  for (std::size_t s = 0; s < slabs.size() && !job.stopped(); ++s) {
    job.set_part(s, slabs.size());
    const verify::BallTree<D> balls(std::exchange(next, {}));
    tally += verify::judge_pairs(balls, space, job);
    const auto reach = space.reach_of(verify::widened(slabs.extent(s), known));
    if (s + 1 < slabs.size()) next = slabs.balls(s + 1, space);
    for (std::size_t t = s + 1; t < slabs.size() && !job.stopped(); ++t) {
      if (!touch(slabs.extent(t), reach)) continue;
      const std::vector<verify::Ball<D>> more = t > s + 1 ? slabs.balls(t, space) : decltype(next)();
      const std::span<const verify::Ball<D>> others = t > s + 1 ? more : next;
      tally += verify::judge_pairs_with(others, balls, space, job);
    }
    tally += verify::judge_walls<D>(balls.items(), walls, job);
  }
  return tally;
}

template <class Source>
verify::Tally judge_in_space(const Source& spheres, const Vector<dynamic>& periods, const Domain& domain,
                             const verify::Job& job) {
  const bool repeats = (periods.array() < verify::Box<1>::infinity).any();
  if (!repeats) return judge_in<3>(verify::OpenSpace<3>(), spheres, domain, job);
  return judge_in<3>(verify::PeriodicSpace<3>{periods}, spheres, domain, job);
}

/// All of them in memory.
Spheres<dynamic> spheres_in(const SphereRows& rows) {
  constexpr std::uint64_t piece = 4096;
  Spheres<dynamic> spheres(rows.dimension);
  spheres.resize(static_cast<std::size_t>(rows.count));
  const auto width = static_cast<std::size_t>(rows.dimension) + 1;
  verify::for_each_piece(rows, piece, [&](std::uint64_t first, std::span<const double> values) {
    for (std::size_t at = 0; at < values.size(); ++at) {
      const std::size_t i = static_cast<std::size_t>(first) + at / width;
      (at % width + 1 == width ? spheres.r : spheres.x[at % width])[i] = values[at];
    }
  });
  return spheres;
}

verify::Tally judge(const SphereRows& spheres, const Domain& domain, const verify::Job& job) {
  if (is_tilted(domain)) return verify::judge_tilted(spheres_in(spheres), std::get<Box>(domain), job);
  const Vector<dynamic> periods = verify::periods_of(domain);
  if (periods.size() == 3) return judge_in_space(spheres, periods, domain, job);
  std::optional<verify::Tally> tally;
  with_dimension(static_cast<int>(periods.size()), NotThreeDimensions{}, [&](auto dimension) {
    constexpr int D = decltype(dimension)::value;
    tally = judge_in<D>(verify::PeriodicSpace<D>{periods}, spheres, domain, job);
  });
  return *std::move(tally);
}

/// In other than three dimensions as rows, so that one kind of slabs is enough there.
verify::Tally judge(const Spheres<dynamic>& spheres, const Domain& domain, const verify::Job& job) {
  const int dimension = spheres.dimension();
  if (is_tilted(domain)) return verify::judge_tilted(spheres, std::get<Box>(domain), job);
  if (dimension == 3) return judge_in_space(spheres, verify::periods_of(domain), domain, job);
  const auto read = [&](std::uint64_t first, std::span<double> rows) {
    for (std::size_t at = 0; at < rows.size(); ++first) {
      for (const std::vector<double>& column : spheres.x) rows[at++] = column[first];
      rows[at++] = spheres.r[first];
    }
  };
  return judge(SphereRows{spheres.size(), dimension, read}, domain, job);
}

/// "1,200 spheres, 7,000 near pairs and 7,200 walls decided exactly, no overlap, no protrusion"
std::string decided_text(const Certificate& c, const Domain& domain, const std::string& limit) {
  const std::string pairs = counted(c.pairs_tested, "near pair", "near pairs");
  if (!has_walls(domain))
    return fmt::format("{} in a {}, {} decided exactly, no overlap{}", counted_spheres(c.spheres),
                       name_of(domain), pairs, limit);
  const auto* mesh = std::get_if<Mesh>(&domain);
  if (is_periodic(domain))
    return fmt::format(
        "{} in a {}, {} and {} decided exactly, no overlap{}, no protrusion", counted_spheres(c.spheres),
        name_of(domain), pairs,
        counted(c.walls_tested, mesh ? "near triangle" : "wall", mesh ? "near triangles" : "walls"), limit);
  if (mesh && mesh->surface)
    return fmt::format(
        "{}, {} decided exactly, {} of the CAD surface by proven bounds, no overlap{}, no protrusion",
        counted_spheres(c.spheres), pairs, counted(c.walls_tested, "near piece", "near pieces"), limit);
  return fmt::format(
      "{}, {} and {} decided exactly, no overlap{}, no protrusion", counted_spheres(c.spheres), pairs,
      counted(c.walls_tested, mesh ? "near triangle" : "wall", mesh ? "near triangles" : "walls"), limit);
}

std::string gaps_text(const Certificate& c) {
  if (!(c.gap + c.wall_gap > 0)) return "";
  if (!(c.wall_gap > 0)) return fmt::format(", all {} apart", c.gap);
  if (!(c.gap > 0)) return fmt::format(", all {} from the walls", c.wall_gap);
  return fmt::format(", all {} apart and {} from the walls", c.gap, c.wall_gap);
}

std::string statement_of(const Certificate& c, const Domain& domain) {
  if (c.cancelled)
    return fmt::format("Not certified: it was stopped after {} and {}.",
                       counted(c.pairs_tested, "near pair", "near pairs"),
                       counted(c.walls_tested, "wall", "walls"));
  const std::string limit = c.allowed_overlap > 0 ? fmt::format(" above {}", c.allowed_overlap) : "";
  if (c.certified) {
    if (c.spheres == 0) return "Certified: there are no spheres.";
    std::string closest;
    if (c.least_distance)
      return fmt::format("Certified: {}{}; least distance {:.9g}.", decided_text(c, domain, limit),
                         gaps_text(c), *c.least_distance);
    if (c.worst_pair && c.gap == 0)
      closest = c.max_overlap > 0 ? fmt::format("; largest overlap {:.2g}", c.max_overlap)
                                  : fmt::format("; closest pair gap {:.2g}", 0.0 - c.max_overlap);
    if (!closest.empty()) closest += " of the sum of radii";
    return fmt::format("Certified: {}{}{}.", decided_text(c, domain, limit), gaps_text(c), closest);
  }
  std::string faults;
  if (c.overlapping_pairs > 0)
    faults = c.gap > 0 ? fmt::format("{} nearer than the gap of {} (worst {}; least distance {:.9g})",
                                     counted(c.overlapping_pairs, "pair", "pairs"), c.gap, worst_pair_text(c),
                                     *c.least_distance)
                       : fmt::format("{}{} (worst {}, overlap ratio {:.2g})",
                                     counted(c.overlapping_pairs, "overlapping pair", "overlapping pairs"),
                                     limit, worst_pair_text(c), c.max_overlap);
  if (c.protruding_spheres > 0) {
    if (!faults.empty()) faults += ", ";
    faults += c.wall_gap > 0
                  ? fmt::format("{} nearer to the wall than its gap of {} (worst {}; least distance {:.9g})",
                                counted_spheres(c.protruding_spheres), c.wall_gap, *c.worst_wall,
                                *c.least_wall_distance)
                  : fmt::format("{} across or outside the wall (worst {}, gap {:.2g} of its radius)",
                                counted_spheres(c.protruding_spheres), *c.worst_wall, c.min_wall_gap);
  }
  return fmt::format("Not certified: {}.", faults);
}

}  // namespace

namespace {

template <class Source>
Certificate certificate_of(const Source& spheres, const Domain& domain, const CertifyOptions& options) {
  const Stopwatch watch;
  check_columns(spheres);
  check_arguments(dimension_of_spheres(spheres), domain, options);

  Certificate result;
  result.spheres = count_of(spheres);
  result.allowed_overlap = options.allowed_overlap;
  result.gap = options.gap;
  result.wall_gap = options.wall_gap;
  if (auto message = error_in(spheres)) {
    result.statement = *std::move(message);
  } else {
    const verify::Job job(options);
    verify::Tally tally(0);
    if (options.threads > 0)
      tbb::task_arena(options.threads).execute([&] { tally = judge(spheres, domain, job); });
    else
      tally = judge(spheres, domain, job);
    result.cancelled = job.stopped();
    result.pairs_tested = tally.pairs;
    result.walls_tested = tally.walls;
    result.centers_tested = tally.centers;
    result.decided_double = tally.decisions.by_double;
    result.decided_exact = tally.decisions.by_exact;
    result.overlapping_pairs = tally.overlapping;
    result.protruding_spheres = tally.protruding;
    if (tally.pairs > 0) {
      result.worst_pair = tally.worst_pair.pair;
      result.max_overlap = tally.worst_pair.ratio;
    }
    if (std::isfinite(tally.worst_wall.gap)) {
      result.worst_wall = tally.worst_wall.sphere;
      result.min_wall_gap = tally.worst_wall.gap;
    }
    if (tally.least_distance <= verify::distances_known_up_to(options.gap))
      result.least_distance = tally.least_distance;
    if (options.gap + options.wall_gap > 0 &&
        tally.least_wall_distance <= verify::wall_distances_known_up_to(options))
      result.least_wall_distance = tally.least_wall_distance;
    result.overlaps = std::move(tally.overlaps).sorted();
    result.protrusions = std::move(tally.protrusions).sorted();
    result.certified = !result.cancelled && tally.overlapping == 0 && tally.protruding == 0;
    result.statement = in_dimension(dimension_of_spheres(spheres), statement_of(result, domain));
  }
  result.seconds = watch.seconds();
  return result;
}

}  // namespace

Certificate certify(const Spheres<dynamic>& spheres, const Domain& domain, const CertifyOptions& options) {
  return certificate_of(spheres, domain, options);
}
Certificate certify(const SphereRows& spheres, const Domain& domain, const CertifyOptions& options) {
  return certificate_of(spheres, domain, options);
}

void refuse(Certificate& c, const std::string& fault) {
  const std::string whole = fault.ends_with('.') ? fault : fault + '.';
  c.statement =
      c.certified ? fmt::format("Not certified: {} Places and sizes of the spheres are not at fault.", whole)
                  : fmt::format("{} Not certified either: {}", c.statement, whole);
  c.certified = false;
}

bool walls_tested_are_near(const Domain& domain) {
  return std::holds_alternative<Mesh>(domain) || std::holds_alternative<Polygon>(domain) ||
         std::holds_alternative<Revolved>(domain);
}

std::string pair_text(const std::array<std::uint64_t, 2>& pair) {
  const auto [first, second] = pair;
  return first == second ? fmt::format("{} and its own image", first)
                         : fmt::format("{} and {}", first, second);
}

std::string worst_pair_text(const Certificate& c) { return c.worst_pair ? pair_text(*c.worst_pair) : "none"; }

}  // namespace bernal
