#include "domain/without_rod.hpp"

namespace bernal {
namespace {

/// The part of a profile whose coordinate `k` is at least `at`, or at most; without corners where it has no
/// area.
std::vector<Vector<2>> part_of(const std::vector<Vector<2>>& profile, int k, double at, bool at_least) {
  std::vector<Vector<2>> part;
  const auto add = [&](const Vector<2>& p) {
    if (part.empty() || (p != part.back() && p != part.front())) part.push_back(p);
  };
  bool beyond = false;
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const Vector<2>&a = profile[i], &b = profile[(i + 1) % profile.size()];
    if (at_least ? a[k] >= at : a[k] <= at) add(a);
    beyond |= at_least ? a[k] > at : a[k] < at;
    if ((a[k] - at) * (b[k] - at) < 0) {
      Vector<2> p = a + (b - a) * ((at - a[k]) / (b[k] - a[k]));
      p[k] = at;
      add(p);
    }
  }
  if (!beyond) return {};
  // Between neighbours on the cut too a corner is none, or the end of a way there and back.
  for (std::size_t i = 0; i < part.size();) {
    const std::size_t n = part.size();
    if (part[(i + n - 1) % n][k] == at && part[i][k] == at && part[(i + 1) % n][k] == at)
      part.erase(part.begin() + static_cast<std::ptrdiff_t>(i));
    else
      ++i;
  }
  return part;
}

/// The first corners of the edges along r = `radius`.
std::vector<std::size_t> edges_at(const std::vector<Vector<2>>& profile, double radius) {
  std::vector<std::size_t> edges;
  for (std::size_t i = 0; i < profile.size(); ++i)
    if (profile[i][0] == radius && profile[(i + 1) % profile.size()][0] == radius) edges.push_back(i);
  return edges;
}

/// Joins `inner`, with r <= `radius`, to `outer`, with r >= `radius`, where each has one edge along it.
bool join_at(std::vector<Vector<2>>& outer, const std::vector<Vector<2>>& inner, double radius) {
  if (inner.size() < 3) return true;
  const std::vector<std::size_t> out = edges_at(outer, radius), in = edges_at(inner, radius);
  if (out.size() != 1 || in.size() != 1) return false;
  std::vector<Vector<2>> joined;
  const auto add = [&](const Vector<2>& p) {
    if (joined.empty() || p != joined.back()) joined.push_back(p);
  };
  for (std::size_t i = 0; i < outer.size(); ++i) {
    add(outer[i]);
    if (i != out.front()) continue;
    for (std::size_t k = 1; k <= inner.size(); ++k) add(inner[(in.front() + k) % inner.size()]);
  }
  if (joined.front() == joined.back()) joined.pop_back();
  outer.clear();
  for (std::size_t i = 0; i < joined.size(); ++i) {  // corners between edges of one level are none
    const double before = joined[(i + joined.size() - 1) % joined.size()][1];
    if (before != joined[i][1] || joined[i][1] != joined[(i + 1) % joined.size()][1])
      outer.push_back(joined[i]);
  }
  return true;
}

}  // namespace

std::vector<Vector<2>> without_rod(const std::vector<Vector<2>>& profile, double radius, double from,
                                   double to) {
  const std::vector<Vector<2>> within = part_of(profile, 0, radius, false);
  std::vector<Vector<2>> rest = part_of(profile, 0, radius, true);
  const bool meets = part_of(part_of(within, 1, from, true), 1, to, false).size() >= 3;
  if (!meets || !join_at(rest, part_of(within, 1, to, true), radius) ||
      !join_at(rest, part_of(within, 1, from, false), radius))
    rest.clear();
  return rest;
}

}  // namespace bernal
