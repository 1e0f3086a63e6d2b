#pragma once
#include <initializer_list>
#include <vector>

#include <gtest/gtest.h>

#include "bernal/verify/certificate.hpp"
#include "support/periodic_oracle.hpp"

namespace bernal::testing {

inline Box periodic_box(std::initializer_list<double> edges) {
  return bernal::periodic_box(Coordinates(edges));
}

/// Spheres of their coordinates and, last, their radius.
inline Spheres<dynamic> rows(std::initializer_list<std::vector<double>> rows) {
  const auto dimension = static_cast<int>(rows.begin()->size()) - 1;
  Spheres<dynamic> spheres(dimension);
  for (const auto& row : rows)
    spheres.push_back(Eigen::Map<const Eigen::VectorXd>(row.data(), dimension), row.back());
  return spheres;
}

inline void expect_same_verdict(const Certificate& a, const Certificate& b) {
  EXPECT_EQ(a.certified, b.certified);
  EXPECT_EQ(a.pairs_tested, b.pairs_tested);
  EXPECT_EQ(a.walls_tested, b.walls_tested);
  EXPECT_EQ(a.overlapping_pairs, b.overlapping_pairs);
  EXPECT_EQ(a.protruding_spheres, b.protruding_spheres);
  EXPECT_EQ(a.worst_pair, b.worst_pair);
  EXPECT_EQ(a.max_overlap, b.max_overlap);
  EXPECT_EQ(a.worst_wall, b.worst_wall);
  EXPECT_EQ(a.min_wall_gap, b.min_wall_gap);
  EXPECT_EQ(a.overlaps, b.overlaps);
  EXPECT_EQ(a.protrusions, b.protrusions);
  EXPECT_EQ(a.statement, b.statement);
}

/// Whatever the packing, the certificate says what the oracle says, in both arithmetics. Without the oracle
/// (centres too many periods away for it) only that both arithmetics agree.
inline Certificate expect_truth(const Spheres<dynamic>& s, const Domain& domain, double allowed = 0,
                                bool with_oracle = true) {
  CertifyOptions options{.allowed_overlap = allowed, .list = CertifyOptions::all};
  const Certificate filtered = certify(s, domain, options);
  options.arithmetic = Arithmetic::exact;
  const Certificate exact = certify(s, domain, options);
  expect_same_verdict(filtered, exact);
  EXPECT_EQ(exact.decided_double, 0u);
  for (const Certificate& c : {filtered, exact}) {
    EXPECT_EQ(c.decided_double + c.decided_exact, c.pairs_tested + c.walls_tested + c.centers_tested);
    EXPECT_EQ(c.worst_pair.has_value(), s.size() > (oracle::periods_of(domain).isZero(0) ? 1u : 0u));
    EXPECT_EQ(c.certified, c.overlapping_pairs == 0 && c.protruding_spheres == 0);
    EXPECT_EQ(c.overlaps.size(), c.overlapping_pairs);
    EXPECT_EQ(c.protrusions.size(), c.protruding_spheres);
    EXPECT_EQ(c.min_wall_gap<0, c.protruding_spheres> 0);
    if (!has_walls(domain)) {
      EXPECT_EQ(c.walls_tested + c.centers_tested + c.protruding_spheres, 0u);
      EXPECT_FALSE(c.worst_wall.has_value());
    }
  }
  if (!with_oracle) return filtered;
  const oracle::Verdict truth = oracle::judge(s, domain, allowed);
  EXPECT_EQ(filtered.overlapping_pairs, truth.overlapping);
  EXPECT_EQ(filtered.protruding_spheres, truth.protruding);
  std::vector<std::array<std::uint64_t, 2>> listed;
  for (const auto& overlap : filtered.overlaps) listed.push_back(overlap.pair);
  std::ranges::sort(listed);
  EXPECT_EQ(listed, truth.pairs);
  EXPECT_GE(filtered.pairs_tested, truth.near_at_least);
  EXPECT_LE(filtered.pairs_tested, truth.near_at_most);
  if (filtered.worst_pair) {
    EXPECT_NEAR(filtered.max_overlap, truth.max_overlap, 1e-13 * (1 + std::abs(truth.max_overlap)));
  }
  if (allowed == 0) {
    EXPECT_EQ(filtered.max_overlap > 0, truth.overlapping > 0);
  }
  return filtered;
}

}  // namespace bernal::testing
