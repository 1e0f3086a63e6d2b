#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "bernal/core/random.hpp"
#include "bernal/verify/certificate.hpp"
#include "support/containers.hpp"
#include "support/gap_oracle.hpp"
#include "support/polygons.hpp"

// The closest pair and the sphere closest to a wall, however far apart they are: against all pairs, all
// images and all walls.
namespace bernal {
namespace least_gap_test {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The least (d - ri - rj) / (ri + rj) over all pairs and images, those of a sphere itself among them.
double least_pair_ratio(const Spheres<dynamic>& s, const Domain& domain) {
  const std::vector<double> periods = testing::periods_of(domain);
  double least = infinity;
  for (std::size_t i = 0; i < s.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      long double squared = 0;
      for (std::size_t k = 0; k < periods.size(); ++k) {
        long double d = std::abs(static_cast<long double>(s.x[k][i]) - s.x[k][j]);
        if (std::isfinite(periods[k]))
          d = std::min(std::fmod(d, periods[k]), periods[k] - std::fmod(d, periods[k]));
        squared += d * d;
      }
      least = std::min(least, static_cast<double>(std::sqrt(squared) / (s.r[i] + s.r[j]) - 1));
    }
    for (const double period : periods) least = std::min(least, period / (2 * s.r[i]) - 1);
  }
  return least;
}

double clearance(const Vector<dynamic>& c, const Domain& domain) {
  if (dimension_of(domain) == 2)
    return static_cast<double>(test::precise_clearance_flat(domain, Vector<2>(c)));
  return static_cast<double>(test::precise_clearance(domain, Vector<3>(c)));
}

/// So many spheres anywhere inside, of radii up to `ratio` times the least, which is `share` of the size.
Spheres<dynamic> anywhere_in(const Domain& domain, std::size_t count, double share, double ratio,
                             std::uint64_t seed) {
  const Bounds<dynamic> bounds = bounds_of<dynamic>(domain);
  const Vector<dynamic> size = bounds.size();
  Random random(seed, stream(Stream::test));
  Spheres<dynamic> spheres(dimension_of(domain));
  while (spheres.size() < count) {
    Vector<dynamic> c(spheres.dimension());
    for (int k = 0; k < spheres.dimension(); ++k) c[k] = bounds.lower[k] + size[k] * random.uniform();
    if ((spheres.dimension() == 2 || spheres.dimension() == 3) && has_walls(domain) &&
        !(clearance(c, domain) > 1e-6 * size.maxCoeff()))
      continue;
    spheres.push_back(c, share * size.maxCoeff() * std::pow(ratio, std::pow(random.uniform(), 4)));
  }
  return spheres;
}

/// Figures of the certificate, filtered and exact, of all spheres together and in slabs, by any number of
/// threads, are to be these.
void expect_least(const Spheres<dynamic>& spheres, const Domain& domain, double pair, double wall) {
  const double size = std::max(bounds_of<dynamic>(domain).lower.cwiseAbs().maxCoeff(),
                               bounds_of<dynamic>(domain).upper.cwiseAbs().maxCoeff());
  const double rounding = 1e-13 * size / *std::ranges::min_element(spheres.r);
  const Certificate c = certify(spheres, domain);
  ASSERT_EQ(c.worst_pair.has_value(), pair < infinity);
  if (pair < infinity) {
    EXPECT_NEAR(-c.max_overlap, pair, 1e-14 * (1 + pair) + rounding);
  }
  ASSERT_EQ(c.worst_wall.has_value(), wall < infinity);
  if (wall < infinity) {
    EXPECT_NEAR(c.min_wall_gap, wall, 1e-13 * (1 + std::abs(wall)) + rounding);
  }
  for (const Certificate& other :
       {certify(spheres, domain, {.arithmetic = Arithmetic::exact}), certify(spheres, domain, {.threads = 2}),
        certify(spheres, domain, {.at_once = spheres.size() / 5 + 1})}) {
    EXPECT_EQ(other.worst_pair, c.worst_pair);
    EXPECT_EQ(other.max_overlap, c.max_overlap);
    EXPECT_EQ(other.worst_wall, c.worst_wall);
    EXPECT_EQ(other.min_wall_gap, c.min_wall_gap);
    EXPECT_EQ(other.statement, c.statement);
  }
}

double least_wall_ratio(const Spheres<dynamic>& s, const Domain& domain) {
  double least = infinity;
  for (std::size_t i = 0; i < s.size(); ++i)
    least = std::min(least, clearance(s.center(i), domain) / s.r[i] - 1);
  return least;
}

TEST(LeastGap, OfWallsAndPairsInEveryContainer) {
  std::vector<std::pair<std::string, Domain>> domains = test::flat_domains();
  for (const auto& tested : test::containers_under_test()) domains.emplace_back(tested.name, tested.shape);
  for (const auto& [name, domain] : domains)
    for (const double share : {1e-2, 1e-6})
      for (const double ratio : {1.0, 50.0})
        for (const std::size_t count : {1, 2, 60}) {
          SCOPED_TRACE(name + " " + std::to_string(share) + " " + std::to_string(count));
          const Spheres<dynamic> s = anywhere_in(domain, count, share, ratio, count);
          expect_least(s, domain, least_pair_ratio(s, domain), least_wall_ratio(s, domain));
        }
}

// Only few touch, or none, so that most is search.
TEST(LeastGap, OfPairsInEveryDimensionAndAcrossEveryPeriod) {
  for (int dimension = 1; dimension <= 8; ++dimension)
    for (const std::string_view kind : {"periodic", "walls", "mixed"})
      for (const double share : {0.03, 1e-3, 1e-9})
        for (const double ratio : {1.0, 300.0}) {
          SCOPED_TRACE(std::string(kind) + " " + std::to_string(dimension) + " " + std::to_string(share));
          Box box{Vector<dynamic>::Zero(dimension), Vector<dynamic>::Constant(dimension, 3),
                  std::vector<bool>(static_cast<std::size_t>(dimension), kind != "walls")};
          box.size[0] = 1.7;
          if (kind == "mixed") box.periodic[0] = false;
          const Spheres<dynamic> s = anywhere_in(box, 150, share, ratio, 17);
          double wall = infinity;
          for (std::size_t i = 0; i < s.size(); ++i)
            for (int k = 0; k < dimension; ++k) {
              const double x = s.x[static_cast<std::size_t>(k)][i];
              if (box.has_wall(k)) wall = std::min({wall, x / s.r[i] - 1, (box.size[k] - x) / s.r[i] - 1});
            }
          expect_least(s, box, least_pair_ratio(s, box), wall);
        }
}

// The case that was reported: the nearest two are side by side along an axis, the only ones whose boxes touch
// are farther apart.
TEST(LeastGap, IsThatOfAPairWhoseBoxesAreApart) {
  const Box box{Vector<3>(0, 0, 0), Vector<3>(10, 10, 10)};
  Spheres<dynamic> s(3);
  s.push_back(Vector<3>(2, 2, 2), 1);
  s.push_back(Vector<3>(4.0006, 2, 2), 1);
  s.push_back(Vector<3>(7, 7, 7), 1);
  s.push_back(Vector<3>(8.4, 8.4, 8.4), 1);
  const Certificate c = certify(s, box);
  EXPECT_EQ(c.pairs_tested, 1u);
  EXPECT_EQ(c.worst_pair, (std::array<std::uint64_t, 2>{0, 1}));
  EXPECT_NEAR(c.max_overlap, -3e-4, 1e-15);
  EXPECT_NE(c.statement.find("closest pair gap 0.0003 of"), std::string::npos) << c.statement;
}

TEST(LeastGap, IsUnknownOnlyWhereThereIsNone) {
  Spheres<dynamic> one(3);
  one.push_back(Vector<3>(2, 2, 2), 0.5);
  const Box walls{Vector<3>(0, 0, 0), Vector<3>(9, 9, 9)};
  EXPECT_FALSE(certify(one, walls).worst_pair);
  EXPECT_EQ(certify(one, walls).min_wall_gap, 3);
  const Certificate periodic = certify(one, periodic_box(Vector<3>(9, 8, 9)));
  EXPECT_EQ(periodic.worst_pair, (std::array<std::uint64_t, 2>{0, 0}));
  EXPECT_EQ(periodic.max_overlap, -7);
  EXPECT_FALSE(periodic.worst_wall);
  EXPECT_FALSE(certify(Spheres<dynamic>(3), walls).worst_wall);
}

// Ratios are those of spheres with the gaps around them.
TEST(LeastGap, WithGapsThatAreAskedFor) {
  for (const double gap : {1e-3, 0.2}) {
    const Box box{Vector<3>(0, 0, 0), Vector<3>(10, 10, 10), {true, false, true}};
    const Spheres<dynamic> s = anywhere_in(box, 100, 1e-4, 20, 5);
    Spheres<dynamic> enlarged = s;
    for (double& r : enlarged.r) r += 0.5 * gap;
    const Certificate c = certify(s, box, {.gap = gap, .wall_gap = 0.5 * gap});
    EXPECT_NEAR(-c.max_overlap, least_pair_ratio(enlarged, box), 1e-9);
    EXPECT_NEAR(c.min_wall_gap, least_wall_ratio(enlarged, box), 1e-9);
  }
}

// Extremes of the arithmetic: nothing that is found may depend on overflow.
TEST(LeastGap, OfLengthsNearTheEndsOfDoubles) {
  for (const double scale : {1e-290, 1e-150, 1e150, 1e290}) {
    const Box box{Vector<3>(0, 0, 0), Vector<3>::Constant(9 * scale)};
    Spheres<dynamic> s(3);
    for (int i = 0; i < 30; ++i)
      s.push_back(Vector<3>(0.3 * i + 0.1, 4 + std::sin(i), 4 + std::cos(2 * i)) * scale, 0.01 * scale);
    Spheres<dynamic> plain = s;
    for (std::size_t i = 0; i < s.size(); ++i) {
      plain.set_center(i, s.center(i) / scale);
      plain.r[i] = s.r[i] / scale;
    }
    const Certificate c = certify(s, box);
    EXPECT_NEAR(-c.max_overlap, least_pair_ratio(plain, Box{Vector<3>(0, 0, 0), Vector<3>(9, 9, 9)}), 1e-12)
        << scale;
    EXPECT_NEAR(c.min_wall_gap, 9, 1e-12) << scale;
  }
}

}  // namespace least_gap_test
}  // namespace bernal
