#include "bench/pricing/arithmetic.hpp"

#include <time.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "bernal/core/tolerance.hpp"
#include "bernal/verify/certificate.hpp"
#include "domain/exact_analytic.hpp"
#include "domain/exact_way.hpp"
#include "domain/free_path.hpp"
#include "domain/frustum.hpp"
#include "verify/bounded.hpp"
#include "verify/exact.hpp"
#include "verify/predicates.hpp"
#include "verify/space.hpp"

namespace bernal::pricing {
namespace {

constexpr std::size_t plain_level = 0, filtered_level = 1, exact_level = 2;
/// So many queries are put to one level before the next has its turn, so that a machine that slows down hurts
/// all alike.
constexpr std::size_t block = 128;
/// Beyond a ball, in its way, what is looked at to measure a gap.
constexpr double near_contact = 1e-6;

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// What a level has said so far.
struct Account {
  std::uint64_t asked = 0, by_exact = 0, differ = 0;
  double seconds = 0, worst = 0;
  double bound = std::numeric_limits<double>::infinity();

  Priced priced(bool has_error) const {
    const auto n = static_cast<double>(asked);
    Priced p{.decisions = asked,
             .nanoseconds = 1e9 * seconds / n,
             .exact_share = static_cast<double>(by_exact) / n,
             .differ = differ};
    if (has_error) p.worst_error = worst;
    if (has_error && std::isfinite(bound)) p.bound = bound;
    return p;
  }
};

/// Draws queries, puts each to all levels, times them and judges what they said: judge(query, answers,
/// accounts) adds to differ, worst and bound of the plain and the filtered level.
template <class Draw, class Ask, class Judge>
PricedRow price(std::string decision, const PricedContainer* container, std::uint64_t count,
                const Monitor& monitor, const Draw& draw, const Ask& ask, const Judge& judge) {
  PricedRow row{.decision = std::move(decision)};
  if (container != nullptr) {
    row.container = container->name;
    row.triangles = container->triangles;
    row.ulp = container->ulp;
  }
  Random random(1, stream(Stream::test, count));
  Account accounts[level_count];
  using Drawn = decltype(draw(Population::tie, random));
  using Answer = decltype(ask(std::size_t{0}, std::declval<const Drawn&>()));
  std::vector<Drawn> queries;
  std::vector<Answer> answers[level_count];
  for (std::uint64_t done = 0; done < count; done += queries.size()) {
    if (monitor.stop()) throw Cancelled();
    queries.clear();
    for (std::uint64_t k = done; k < std::min(count, done + block); ++k)
      queries.push_back(draw(static_cast<Population>(k % population_count), random));
    for (std::size_t level = 0; level < level_count; ++level) {
      Account& account = accounts[level];
      answers[level].clear();
      const double start = thread_seconds();
      for (const Drawn& query : queries) {
        const std::uint64_t before = exact_decisions;
        answers[level].push_back(ask(level, query));
        account.by_exact += exact_decisions != before;
      }
      account.seconds += thread_seconds() - start;
      account.asked += queries.size();
    }
    for (std::size_t k = 0; k < queries.size(); ++k)
      judge(queries[k], std::array<Answer, level_count>{answers[0][k], answers[1][k], answers[2][k]},
            accounts);
  }
  row.level[plain_level] = accounts[plain_level].priced(true);
  row.level[filtered_level] = accounts[filtered_level].priced(accounts[filtered_level].bound < 1);
  row.level[exact_level] = accounts[exact_level].priced(false);
  return row;
}

std::vector<AnalyticWall> walls_of_analytic(const Domain& shape) {
  return std::visit(
      [](const auto& kind) -> std::vector<AnalyticWall> {
        if constexpr (requires { walls_of(kind); }) return walls_of(kind);
        return {};
      },
      shape);
}

using Gap = std::function<long double(long double)>;

/// The gap of the ball after a way of t, in long double: a function for each piece of wall; of a mesh for
/// those that are nearly in contact after a way of `touch`.
std::vector<Gap> gaps_near(const PricedContainer& container, const Motion& m, double touch) {
  std::vector<Gap> gaps;
  if (const auto* solid = std::get_if<Revolved>(&container.shape)) {
    solid->for_each_edge([&](const Vector<2>& a, const Vector<2>& b) {
      const FrustumWay way({solid->base, solid->axis, a, b}, m.c, m.direction);
      gaps.emplace_back([way, r = m.r](long double t) { return way.distance(t) - r; });
    });
  } else if (container.is_mesh()) {
    std::vector<NearFacet> near;
    container.exact().facets_near(m.c + touch * m.direction, m.r + near_contact, near);
    for (const NearFacet& n : near)
      gaps.emplace_back([facet = n.facet, m](long double t) { return gap_after(facet, m, t); });
  } else {
    for (const AnalyticWall& wall : walls_of_analytic(container.shape))
      gaps.emplace_back([wall, m](long double t) { return gap_after(wall, m, t); });
  }
  return gaps;
}

long double least_gap(const PricedContainer& container, const Motion& m, double t) {
  long double least = std::numeric_limits<long double>::infinity();
  for (const Gap& gap : gaps_near(container, m, t)) least = std::min(least, gap(t));
  return least;
}

/// The same on the whole way up to t, of which the contact at `touch` is the deepest place or near it.
long double least_gap_on_way(const PricedContainer& container, const Motion& m, double touch, double t) {
  long double least = std::min(least_gap(container, m, t), least_gap(container, m, touch));
  if (!container.is_mesh() && !std::holds_alternative<Revolved>(container.shape)) return least;
  for (const Gap& gap : gaps_near(container, m, touch)) {
    long double low = 0, high = t;
    for (int k = 0; k < 120; ++k) {
      const long double a = low + (high - low) / 3, b = high - (high - low) / 3;
      (gap(a) < gap(b) ? high : low) = gap(a) < gap(b) ? b : a;
    }
    least = std::min(least, gap(low));
  }
  return least;
}

PricedRow price_insides(std::string name, const PricedContainer& container, std::uint64_t count,
                        const Monitor& monitor, Query (*draw)(const PricedContainer&, Population, Random&)) {
  return price(
      std::move(name), &container, count, monitor,
      [&](Population population, Random& random) { return draw(container, population, random); },
      [&](std::size_t level, const Query& q) -> char { return container.at[level]->contains(q.c, q.r); },
      [&](const Query& q, const auto& said, Account* accounts) {
        accounts[plain_level].bound =
            std::min(accounts[plain_level].bound, container.exact().free_path_bound(q.c, q.r));
        accounts[filtered_level].differ += said[filtered_level] != said[exact_level];
        if (said[plain_level] == said[exact_level]) return;
        ++accounts[plain_level].differ;
        const auto gap = static_cast<double>(least_gap(container, {q.c, q.r, Vector<3>::Zero(), 0}, 0));
        accounts[plain_level].worst = std::max(accounts[plain_level].worst, std::abs(gap));
      });
}

/// Touching spheres in a cubic lattice, which touch flat walls as well; every other one of the upper half is
/// larger by a double, so that some overlap by that. None where the container is thinner than the edge.
Spheres<dynamic> touching_lattice(const PricedContainer& container, double edge) {
  const Bounds<3> bounds = container.exact().bounds();
  Spheres<dynamic> spheres(3);
  Vector<dynamic> c(3);
  for (c[2] = bounds.lower[2] + edge / 2; c[2] < bounds.upper[2]; c[2] += edge)
    for (c[1] = bounds.lower[1] + edge / 2; c[1] < bounds.upper[1]; c[1] += edge)
      for (c[0] = bounds.lower[0] + edge / 2; c[0] < bounds.upper[0]; c[0] += edge) {
        const bool larger = spheres.size() % 2 == 1 && c[2] > bounds.center()[2];
        if (container.at[filtered_level]->contains(Vector<3>(c), edge / 2))
          spheres.push_back(c, larger ? std::nextafter(edge / 2, 1.0) : edge / 2);
      }
  return spheres;
}

}  // namespace

PricedRow price_places(const PricedContainer& container, std::uint64_t count, const Monitor& monitor) {
  return price_insides("may a ball stand here", container, count, monitor, query_of_place);
}

PricedRow price_centres(const PricedContainer& container, std::uint64_t count, const Monitor& monitor) {
  return price_insides("is a point inside", container, count, monitor, query_of_centre);
}

PricedRow price_distances(const PricedContainer& container, std::uint64_t count, const Monitor& monitor) {
  return price(
      "distance, up to a bound", &container, count, monitor,
      [&](Population population, Random& random) {
        Query q = query_of_place(container, population, random);
        q.limit = q.r * random.uniform(0.9, 1.5);
        return q;
      },
      [&](std::size_t level, const Query& q) { return clear_radius(*container.at[level], q.c, q.limit); },
      [&](const Query& q, const auto& said, Account* accounts) {
        accounts[plain_level].bound =
            std::min(accounts[plain_level].bound, container.exact().free_path_bound(q.c, q.r));
        accounts[plain_level].differ += said[plain_level] != said[exact_level];
        accounts[filtered_level].differ += said[filtered_level] != said[exact_level];
        accounts[plain_level].worst =
            std::max(accounts[plain_level].worst, std::abs(said[plain_level] - said[exact_level]));
      });
}

PricedRow price_ways(const PricedContainer& container, std::uint64_t count, const Monitor& monitor) {
  return price(
      "move limit", &container, count, monitor,
      [&](Population population, Random& random) { return query_of_way(container, population, random); },
      [&](std::size_t level, const Query& q) {
        return container.at[level]->free_path(q.c, q.r, q.direction, q.limit);
      },
      [&](const Query& q, const auto& said, Account* accounts) {
        const double exact = said[exact_level], speed = q.direction.norm();
        const double bound = container.exact().free_path_bound(q.c, q.r);
        const bool all_the_way = exact == q.limit;
        // 4 of the 64 roundoffs of the same lengths, and two doubles
        const double of_filter = bound / 16 + 2 * speed * (std::nextafter(exact, 9.0) - exact);
        accounts[filtered_level].differ +=
            said[filtered_level] > exact || (said[filtered_level] == q.limit) != all_the_way;
        accounts[filtered_level].worst =
            std::max(accounts[filtered_level].worst, speed * (exact - said[filtered_level]));
        accounts[filtered_level].bound = std::min(accounts[filtered_level].bound, of_filter);

        const Motion motion{q.c, q.r, q.direction, q.limit};
        accounts[plain_level].differ += (said[plain_level] == q.limit) != all_the_way;
        accounts[plain_level].bound = std::min(accounts[plain_level].bound, 2 * bound);
        long double gap = 0;
        if (said[plain_level] > exact)
          gap = least_gap_on_way(container, motion, exact, said[plain_level]);
        else if (said[plain_level] < q.limit)
          gap = least_gap(container, motion, said[plain_level]);
        if (gap > 0 && said[plain_level] > exact) gap = 0;
        accounts[plain_level].worst =
            std::max(accounts[plain_level].worst, std::abs(static_cast<double>(gap)));
      });
}

PricedRow price_pairs(std::uint64_t count, const Monitor& monitor) {
  using verify::Ball;
  using verify::Truth;
  using Pair = std::array<Ball<3>, 2>;
  constexpr double unbounded = std::numeric_limits<double>::infinity();
  const verify::OpenSpace<3> space;
  PricedRow row = price(
      "do two balls overlap", nullptr, count, monitor,
      [&](Population population, Random& random) {
        constexpr double grain = 0x1p-24;
        Ball<3> a{uniform_point<3>(random, {{-1, -1, -1}, {1, 1, 1}}), 0, 0}, b = a;
        if (population == Population::tie) {
          const double s = std::round(random.uniform(0.01, 0.1) / grain) * grain;
          for (double& x : a.c) x = std::round(x / grain) * grain;
          b.c = a.c + s * Vector<3>(2, -3, 6);
          a.r = std::round(random.uniform(1, 6) * s / grain) * grain;
          b.r = 7 * s - a.r;
          return Pair{a, b};
        }
        b.c = uniform_point<3>(random, {{-1, -1, -1}, {1, 1, 1}});
        const double d = (a.c - b.c).norm();
        double sum = d;
        if (population == Population::anywhere) sum *= random.uniform(0.8, 1.2);
        if (population == Population::near) sum *= 1 + 1e-12 * random.uniform(-1, 1);
        a.r = sum * random.uniform(0.1, 0.9);
        b.r = sum - a.r;
        if (population == Population::nearest)
          b.r = std::nextafter(b.r, random.uniform() < 0.5 ? 0 : unbounded);
        return Pair{a, b};
      },
      [&](std::size_t level, const Pair& p) -> char {
        if (level == plain_level) {
          const double sum = p[0].r + p[1].r;
          return (p[0].c - p[1].c).squaredNorm() >= sum * sum;
        }
        if (level == filtered_level) {
          const Truth clear = verify::balls_clear<verify::Bounded>(space, p[0], p[1], 0);
          if (clear != Truth::unknown) return clear == Truth::yes;
        }
        ++exact_decisions;
        return verify::balls_clear<verify::Exact>(space, p[0], p[1], 0) == Truth::yes;
      },
      [&](const Pair& p, const auto& said, Account* accounts) {
        // Of the squares: three differences and products, two sums, and the square of a sum: 8 roundoffs.
        const double sum = p[0].r + p[1].r;
        accounts[plain_level].bound = std::min(accounts[plain_level].bound, 8 * tolerance::roundoff * sum);
        accounts[filtered_level].differ += said[filtered_level] != said[exact_level];
        if (said[plain_level] == said[exact_level]) return;
        ++accounts[plain_level].differ;
        const auto wide = (p[0].c.cast<long double>() - p[1].c.cast<long double>()).eval();
        const long double gap = wide.norm() - (static_cast<long double>(p[0].r) + p[1].r);
        // In units of a pair whose radii add up to 1, as pairs have no container.
        accounts[plain_level].worst =
            std::max(accounts[plain_level].worst, static_cast<double>(std::abs(gap) / sum));
      });
  row.ulp = std::numeric_limits<double>::epsilon();
  row.level[plain_level]->bound = 8 * tolerance::roundoff;
  return row;
}

PricedRow price_certificate(const PricedContainer& container, std::uint64_t count, const Monitor& monitor) {
  PricedRow row{.decision = "certificate",
                .container = container.name,
                .triangles = container.triangles,
                .ulp = container.ulp};
  constexpr double decisions_a_sphere = 8;
  const double wanted = std::max(1.0, static_cast<double>(count) / decisions_a_sphere);
  double edge = std::exp2(std::floor(std::log2(std::cbrt(container.exact().volume() / wanted))));
  Spheres<dynamic> spheres = touching_lattice(container, edge);
  for (; spheres.size() == 0; edge /= 2) spheres = touching_lattice(container, edge / 2);
  Certificate certificates[2];
  for (const std::size_t level : {filtered_level, exact_level}) {
    const double start = thread_seconds();
    const Certificate certificate =
        certify(spheres, container.shape,
                {.arithmetic = level == filtered_level ? Arithmetic::filtered : Arithmetic::exact,
                 .list = CertifyOptions::all,
                 .threads = 1,
                 .monitor = {{}, monitor.cancelled}});
    const double seconds = thread_seconds() - start;
    if (certificate.cancelled) throw Cancelled();
    const std::uint64_t decisions =
        certificate.pairs_tested + certificate.walls_tested + certificate.centers_tested;
    row.level[level] = Priced{
        .decisions = decisions,
        .nanoseconds = 1e9 * seconds / static_cast<double>(std::max<std::uint64_t>(1, decisions)),
        .exact_share = static_cast<double>(certificate.decided_exact) / static_cast<double>(decisions)};
    certificates[level - filtered_level] = certificate;
  }
  const auto& [one, other] = certificates;
  const auto unlike = [](const auto& some, const auto& others) {
    std::uint64_t count_unlike = 0;
    for (const auto& item : some) count_unlike += std::ranges::find(others, item) == others.end();
    return count_unlike;
  };
  if (one.overlaps != other.overlaps || one.protrusions != other.protrusions)
    row.level[filtered_level]->differ =
        unlike(one.overlaps, other.overlaps) + unlike(other.overlaps, one.overlaps) +
        unlike(one.protrusions, other.protrusions) + unlike(other.protrusions, one.protrusions);
  return row;
}

}  // namespace bernal::pricing
