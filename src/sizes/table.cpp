#include <algorithm>
#include <cmath>

#include <boost/math/tools/toms748_solve.hpp>

#include "bernal/sizes/size_distribution.hpp"
#include "sizes/check.hpp"
#include "sizes/density.hpp"

namespace bernal {
namespace {

/// y + t (b + t (c + t d)) on an interval of width h, with t from its left end.
struct Cubic {
  double x;
  double h;
  double y, b, c, d;

  double at(double t) const { return y + t * (b + t * (c + t * d)); }
};

/// The natural cubic spline: twice continuously differentiable, with no curvature at its ends. The curvatures
/// m at the points solve, with widths h and slopes s of the intervals,
///   h[i-1] m[i-1] + 2 (h[i-1] + h[i]) m[i] + h[i] m[i+1] = 6 (s[i] - s[i-1]),
/// a diagonally dominant system. Boost has no such spline on uneven points.
std::vector<Cubic> natural_spline(const std::vector<double>& x, const std::vector<double>& y) {
  const std::size_t intervals = x.size() - 1;
  const auto h = [&](std::size_t i) { return x[i + 1] - x[i]; };
  const auto slope = [&](std::size_t i) { return (y[i + 1] - y[i]) / h(i); };
  std::vector<double> m(x.size(), 0), pivot(x.size(), 1);
  for (std::size_t i = 1; i < intervals; ++i) {
    const double factor = i > 1 ? h(i - 1) / pivot[i - 1] : 0;
    pivot[i] = 2 * (h(i - 1) + h(i)) - factor * h(i - 1);
    m[i] = 6 * (slope(i) - slope(i - 1)) - factor * m[i - 1];
  }
  for (std::size_t i = intervals; i-- > 1;) m[i] = (m[i] - h(i) * m[i + 1]) / pivot[i];

  std::vector<Cubic> cubics;
  for (std::size_t i = 0; i < intervals; ++i)
    cubics.push_back({x[i], h(i), y[i], slope(i) - h(i) * (2 * m[i] + m[i + 1]) / 6, m[i] / 2,
                      (m[i + 1] - m[i]) / (6 * h(i))});
  return cubics;
}

/// Sign changes of the cubic within its interval: at most one between two of its extrema.
std::vector<double> sign_changes(const Cubic& f) {
  std::vector<double> limits = {0};
  const double square = f.c * f.c - 3 * f.b * f.d;
  if (square > 0) {
    const double q = -(f.c + std::copysign(std::sqrt(square), f.c));
    for (const double t : {q / (3 * f.d), f.b / q})
      if (t > 0 && t < f.h) limits.push_back(t);
  }
  limits.push_back(f.h);
  std::ranges::sort(limits);
  std::vector<double> found;
  for (std::size_t i = 1; i < limits.size(); ++i) {
    const double low = f.at(limits[i - 1]), high = f.at(limits[i]);
    if (!((low < 0 && high > 0) || (low > 0 && high < 0))) continue;
    std::uintmax_t most_steps = 100;
    found.push_back(f.x + boost::math::tools::toms748_solve(
                              [&](double t) { return f.at(t); }, limits[i - 1], limits[i], low, high,
                              boost::math::tools::eps_tolerance<double>(), most_steps)
                              .first);
  }
  return found;
}

}  // namespace

std::unique_ptr<SizeDistribution> make_table(std::vector<double> radii, std::vector<double> densities,
                                             Basis basis) {
  if (radii.size() < 2 || radii.size() != densities.size())
    throw Error(ErrorCode::bad_argument,
                fmt::format("a table of sizes needs as many densities as radii, at least two; got {} and {}",
                            densities.size(), radii.size()));
  require_ascending("the radii of a table", radii);
  for (const double density : densities)
    if (!(density >= 0 && std::isfinite(density)))
      throw Error(ErrorCode::bad_argument,
                  fmt::format("the densities of a table must be finite and at least 0, not {}", density));
  const double highest = std::ranges::max(densities);
  if (!(highest > 0)) throw Error(ErrorCode::bad_argument, "all densities of the table are zero");
  for (double& density : densities) density /= highest;

  std::vector<Cubic> spline = natural_spline(radii, densities);
  std::vector<double> breaks;
  for (const Cubic& cubic : spline) {
    breaks.push_back(cubic.x);
    for (const double zero : sign_changes(cubic))
      if (zero > breaks.back() && zero < cubic.x + cubic.h) breaks.push_back(zero);
  }
  breaks.push_back(radii.back());
  const double largest = radii.back();
  const auto density = [=, spline = std::move(spline)](double r) {
    // Between two adjacent radii a sample may be rounded out of the interval.
    const auto beyond = std::ranges::upper_bound(spline.begin() + 1, spline.end(), r, {}, &Cubic::x);
    const Cubic& cubic = *std::prev(beyond);
    const double f = std::max(0.0, cubic.at(r - cubic.x));
    return counts_volume(basis) ? f / cube(r / largest) : f;
  };
  return make_from_density("table", density, breaks);
}

}  // namespace bernal
