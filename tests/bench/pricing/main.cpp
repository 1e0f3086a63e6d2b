// Asks every decision of walls and pairs in all three arithmetics and prints what it cost as lines of CSV:
// bernal_arithmetic DECISIONS LARGEST, of all decisions in sum and of the triangles of the largest mesh.
// tests/bench/arithmetic makes the table.
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "bench/pricing/arithmetic.hpp"

namespace bernal::pricing {
namespace {

constexpr std::uint64_t least_decisions = 40;

/// Shares of all decisions, in parts of their sum: of an analytic container, and of meshes of 10^2, 10^3, …
/// triangles. What is dear is asked less often.
struct Share {
  PricedRow (*price)(const PricedContainer&, std::uint64_t, const Monitor&);
  double analytic;
  std::vector<double> meshes;

  double of(const std::vector<PricedContainer>& containers, std::size_t k) const {
    const auto first = std::ranges::find_if(containers, &PricedContainer::is_mesh) - containers.begin();
    if (!containers[k].is_mesh()) return analytic;
    return meshes[std::min(k - static_cast<std::size_t>(first), meshes.size() - 1)];
  }
};
constexpr double share_of_pairs = 8;

std::string text_of(const std::optional<double>& value) {
  return value ? fmt::format("{:.6g}", *value) : std::string();
}

void print(const PricedRow& row) {
  for (std::size_t level = 0; level < level_count; ++level) {
    if (!row.level[level]) continue;
    const Priced& p = *row.level[level];
    fmt::print("\"{}\",{},{},{},{},{:.1f},{:.6f},{},{},{},{}\n", row.decision, row.container, row.triangles,
               name_of_level(level), p.decisions, p.nanoseconds, p.exact_share, p.differ,
               text_of(p.worst_error), text_of(p.bound), row.ulp);
  }
  std::fflush(stdout);
}

void print_all(double wanted, std::uint64_t largest_mesh) {
  const std::vector<Share> shares = {{price_places, 8, {1, 1, 0.5, 0.25, 0.1}},
                                     {price_centres, 5, {1, 1, 1, 1, 1}},
                                     {price_distances, 1, {0.1, 0.1, 0.05, 0.03, 0.02}},
                                     {price_ways, 1.5, {0.2, 0.2, 0.1, 0.05, 0.03}},
                                     {price_certificate, 2, {1, 1, 1, 1, 1}}};
  const std::vector<PricedContainer> containers = containers_to_price(largest_mesh);
  double sum = share_of_pairs;
  for (const Share& share : shares)
    for (std::size_t k = 0; k < containers.size(); ++k) sum += share.of(containers, k);
  const auto count = [&](double share) {
    return std::max(least_decisions, static_cast<std::uint64_t>(wanted * share / sum));
  };
  fmt::print(
      "decision,container,triangles,arithmetic,decisions,ns,exact_share,differ_from_exact,worst_error,"
      "bound,ulp\n");
  print(price_pairs(count(share_of_pairs), {}));
  for (const Share& share : shares)
    for (std::size_t k = 0; k < containers.size(); ++k)
      print(share.price(containers[k], count(share.of(containers, k)), {}));
}

}  // namespace
}  // namespace bernal::pricing

int main(int argc, char** argv) {
  std::uint64_t numbers[2] = {};
  bool right = argc == 3;
  for (int k = 0; right && k < 2; ++k) {
    const std::string_view word = argv[k + 1];
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), numbers[k]);
    right = error == std::errc() && end == word.data() + word.size();
  }
  if (!right) {
    std::fputs("bernal_arithmetic DECISIONS LARGEST: two whole numbers\n", stderr);
    return 2;
  }
  bernal::pricing::print_all(static_cast<double>(numbers[0]), numbers[1]);
}
