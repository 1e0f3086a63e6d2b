#include "settle/crystal.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/error.hpp"

namespace bernal {

CrystalCell cell_of(Layout layout, int dimension) {
  constexpr double sqrt2 = std::numbers::sqrt2, sqrt3 = std::numbers::sqrt3;
  if (dimension == 2) {
    if (layout == Layout::sc) return {{1, 1, 1}, {{0, 0, 0}}, 0.7854};
    return {{1, sqrt3, 1}, {{0, 0, 0}, {0.5, 0.5, 0}}, 0.9069};
  }
  if (layout == Layout::sc) return {{1, 1, 1}, {{0, 0, 0}}, 0.5236};
  if (layout == Layout::bcc) return {Vector<3>::Constant(2 / sqrt3), {{0, 0, 0}, {0.5, 0.5, 0.5}}, 0.6802};
  if (layout == Layout::fcc)
    return {Vector<3>::Constant(sqrt2), {{0, 0, 0}, {0, 0.5, 0.5}, {0.5, 0, 0.5}, {0.5, 0.5, 0}}, 0.7405};
  return {{1, sqrt3, std::sqrt(8.0 / 3)},
          {{0, 0, 0}, {0.5, 0.5, 0}, {0.5, 1.0 / 6, 0.5}, {0, 2.0 / 3, 0.5}},
          0.7405};
}

std::optional<double> spacing_dividing(const CrystalGround& ground, const CrystalCell& cell, double least,
                                       double stretch) {
  std::optional<double> spacing;
  for (int k = 0; k < ground.dimension; ++k) {
    if (!ground.boundary.repeats(k)) continue;
    const double wanted = ground.period(k) / (least * cell.edges[k]);
    double cells = std::round(wanted);
    if (std::abs(wanted - cells) > roundings_of_periods * cells) cells = std::floor(wanted);
    if (!(cells >= 1)) return {};
    const double own = ground.period(k) / (cells * cell.edges[k]);
    if (own > (1 + stretch) * least) return {};
    if (spacing && std::abs(own - *spacing) > roundings_of_periods * own) return {};
    if (!spacing) spacing = own;
  }
  return spacing.value_or(least);
}

void refuse_periods(Layout layout, const CrystalGround& ground, const CrystalCell& cell, double spacing) {
  constexpr double upwards = 1e-11;  // more than twelve digits round off
  constexpr const char* names[] = {"random", "lattice", "fcc", "bcc", "hcp", "sc"};
  std::vector<std::string> periods, nearest;
  for (int k = 0; k < ground.dimension; ++k) {
    if (!ground.boundary.repeats(k)) continue;
    const double edge = spacing * cell.edges[k], cells = std::max(1.0, std::round(ground.period(k) / edge));
    periods.push_back(fmt::format("{:.12g}", ground.period(k)));
    nearest.push_back(fmt::format("{:.12g}", cells * edge * (1 + upwards)));
  }
  throw Error(
      ErrorCode::bad_scene,
      fmt::format(
          "a crystal \"{}\" with sites {:.10g} apart does not fit into periods of {}; it fits into {}",
          names[static_cast<int>(layout)], spacing, fmt::join(periods, ", "), fmt::join(nearest, ", ")));
}

Planes::Planes(const std::vector<double>& fractions, double from, double edge, int count, double period,
               double origin, double scale)
    : period_(period) {
  for (const double fraction : fractions) {
    std::vector<double>& local = local_.emplace_back();
    std::vector<double>& at = at_.emplace_back();
    for (int k = 0; k < count; ++k) {
      local.push_back((from + (k + fraction) * edge - origin) / scale);
      at.push_back(origin + scale * local.back());
    }
  }
}

long double Planes::least_gap(std::size_t fraction, std::size_t other, int cells_on) const {
  const auto n = static_cast<int>(cells());
  long double least = std::numeric_limits<long double>::infinity();
  for (int k = 0; k < n; ++k) {
    const int to = k + cells_on, turns = period_ > 0 ? (to >= n) - (to < 0) : 0, image = to - turns * n;
    if (image < 0 || image >= n) continue;
    const long double there = static_cast<long double>(at_[other][static_cast<std::size_t>(image)]) +
                              turns * static_cast<long double>(period_);
    const long double own = at_[fraction][static_cast<std::size_t>(k)];
    least = std::min(least, std::abs(there - own));
  }
  return least;
}

std::size_t Crystal::fraction_of(const Vector<3>& site, int axis) const {
  const auto& all = fractions[static_cast<std::size_t>(axis)];
  return static_cast<std::size_t>(std::ranges::find(all, site[axis]) - all.begin());
}

bool Crystal::keeps(double distance) const {
  constexpr double near = 1.2;
  // A sum of squares in long doubles is off by less.
  const long double square = static_cast<long double>(distance) * distance * (1 + 0x1p-60L);
  for (const Vector<3>& one : cell.sites)
    for (const Vector<3>& other : cell.sites)
      for (int n = 0; n < 27; ++n) {
        const std::array<int, 3> on = {n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
        const Vector<3> way = (other - one + Vector<3>(on[0], on[1], on[2])).cwiseProduct(cell.edges);
        if (way.isZero(0) || way.norm() > near) continue;
        long double sum = 0, longest_gap = 0;
        int apart = 0;  // axes along which the two differ
        for (int k = 0; k < 3; ++k) {
          const long double gap = planes[static_cast<std::size_t>(k)].least_gap(
              fraction_of(one, k), fraction_of(other, k), on[static_cast<std::size_t>(k)]);
          sum += gap * gap;
          longest_gap = std::max(longest_gap, gap);
          apart += gap > 0;
        }
        if (apart == 1 ? longest_gap < distance : sum < square) return false;
      }
  return true;
}

Ways::Ways(const CrystalGround& ground, const CrystalCell& cell, double spacing, double r)
    : cell_(cell),
      ground_(ground),
      room_{ground.frame.to_scene(ground.bounds.lower) + Vector<3>::Constant(r),
            ground.frame.to_scene(ground.bounds.upper) - Vector<3>::Constant(r)},
      edges_(spacing * cell.edges) {
  for (int k = 0; k < 3; ++k) {
    auto& fractions = fractions_[static_cast<std::size_t>(k)];
    auto& shifts = shifts_[static_cast<std::size_t>(k)];
    for (const Vector<3>& site : cell.sites) fractions.push_back(site[k]);
    std::ranges::sort(fractions);
    const auto repeated = std::ranges::unique(fractions);
    fractions.erase(repeated.begin(), repeated.end());
    if (k >= ground.dimension) {
      shifts = {ground.frame.origin[k]};
    } else if (ground.boundary.repeats(k)) {
      shifts = {ground.frame.to_scene(ground.boundary.origin)[k]};
    } else {
      // A plane of sites as near the lower end as a sphere may be, to the bit or by roundings; where walls
      // are not flat, also the middle on planes and between them.
      const double roundings = 8 * ground.frame.scale * ground.frame.resolution;
      shifts.push_back(room_.lower[k]);
      for (const double f : fractions) shifts.push_back(room_.lower[k] + roundings - f * edges_[k]);
      if (!ground.is_box)
        for (const double f : {0.0, 0.5, 0.25, 0.75}) shifts.push_back(room_.center()[k] - f * edges_[k]);
    }
  }
}

Crystal Ways::crystal(std::size_t way) const {
  const std::size_t x = way % shifts_[0].size(), y = (way / shifts_[0].size() + way) % shifts_[1].size(),
                    z = (way / (shifts_[0].size() * shifts_[1].size()) + way) % shifts_[2].size();
  const std::array<double, 3> shift = {shifts_[0][x], shifts_[1][y], shifts_[2][z]};
  Crystal laid{cell_, fractions_, {}};
  for (int k = 0; k < 3; ++k) {
    const auto at = static_cast<std::size_t>(k);
    const double origin = ground_.frame.origin[k], scale = ground_.frame.scale;
    if (k >= ground_.dimension) {
      laid.planes.emplace_back(fractions_[at], shift[at], 0.0, 1, 0.0, origin, scale);
    } else if (ground_.boundary.repeats(k)) {
      const double period = ground_.period(k);
      const int cells = std::max(1, static_cast<int>(std::lround(period / edges_[k])));
      laid.planes.emplace_back(fractions_[at], shift[at], period / cells, cells, period, origin, scale);
    } else {
      const double before =
          std::max(0.0, std::ceil((shift[at] - room_.lower[k]) / edges_[k] - roundings_of_periods));
      const double after = std::max(0.0, std::floor((room_.upper[k] - shift[at]) / edges_[k])) + 2;
      laid.planes.emplace_back(fractions_[at], shift[at] - before * edges_[k], edges_[k],
                               static_cast<int>(before + after), 0.0, origin, scale);
    }
  }
  return laid;
}

}  // namespace bernal
