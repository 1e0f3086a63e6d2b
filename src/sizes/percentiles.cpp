#include "bernal/sizes/percentiles.hpp"

#include <cmath>

#include "sizes/check.hpp"
#include "sizes/standard_normal.hpp"
#include "sizes/volume_carriers.hpp"

namespace bernal {
namespace {

bool is_over_logarithm(PercentileLaw law) { return law != PercentileLaw::normal; }

/// Where a share stands on the axis over which the law is a straight line.
double score(PercentileLaw law, double share) {
  return law == PercentileLaw::rosin_rammler ? std::log(-std::log1p(-share)) : normal_quantile(share);
}

/// Where the straight line through two points (ln size, share) has that share.
double straight_on(const Percentile& a, const Percentile& b, double share) {
  const double slope = std::log(b.size / a.size) / (b.share - a.share);
  return a.size * std::exp(slope * (share - a.share));
}

}  // namespace

double FittedLaw::size_at(PercentileLaw law, double share) const {
  const double x = score(law, share);
  switch (law) {
    case PercentileLaw::rosin_rammler:
      return place * std::exp(x / spread);
    case PercentileLaw::normal:
      return place + spread * x;
    case PercentileLaw::lognormal:
    case PercentileLaw::through:
      break;
  }
  return place * std::exp(spread * x);
}

FittedLaw fit_law(const std::vector<Percentile>& percentiles, PercentileLaw law) {
  const auto n = static_cast<double>(percentiles.size());
  const double unit = percentiles.front().size;  // so that nothing overflows
  const auto ordinate = [&](const Percentile& p) {
    return is_over_logarithm(law) ? std::log(p.size / unit) : p.size / unit;
  };
  double mean_x = 0, mean_y = 0, square = 0, product = 0;
  for (const Percentile& p : percentiles) {
    mean_x += score(law, p.share) / n;
    mean_y += ordinate(p) / n;
  }
  for (const Percentile& p : percentiles) {
    const double x = score(law, p.share) - mean_x;
    square += x * x;
    product += x * (ordinate(p) - mean_y);
  }
  const double slope = product / square, at_zero = mean_y - slope * mean_x;
  if (!is_over_logarithm(law)) return {unit * at_zero, unit * slope};
  return {unit * std::exp(at_zero), law == PercentileLaw::rosin_rammler ? 1 / slope : slope};
}

std::vector<Percentile> curve_through(std::vector<Percentile> curve, double min, double max) {
  const std::size_t n = curve.size();
  const double low = min > 0 ? min : straight_on(curve[0], curve[1], 0);
  const double high = std::isfinite(max) ? max : straight_on(curve[n - 2], curve[n - 1], 1);
  curve.insert(curve.begin(), {0, low});
  curve.push_back({1, high});
  return curve;
}

std::unique_ptr<SizeDistribution> make_from_percentiles(const std::vector<Percentile>& percentiles,
                                                        PercentileLaw law, Basis basis, double min,
                                                        double max) {
  if (percentiles.size() < 2) throw Error(ErrorCode::bad_argument, "a law needs two percentiles or more");
  for (std::size_t i = 0; i < percentiles.size(); ++i) {
    require_positive("a percentile", percentiles[i].size);
    if (!(percentiles[i].share > 0 && percentiles[i].share < 1))
      throw Error(
          ErrorCode::bad_argument,
          fmt::format("the share below a percentile lies between 0 and 1, not at {}", percentiles[i].share));
    if (i > 0 &&
        !(percentiles[i].share > percentiles[i - 1].share && percentiles[i].size > percentiles[i - 1].size))
      throw Error(ErrorCode::bad_argument, "percentiles ascend with the shares below them");
  }
  if (law == PercentileLaw::through) {
    std::vector<double> radii, passing;
    for (const auto& [share, size] : curve_through(percentiles, min, max)) {
      radii.push_back(size);
      passing.push_back(share);
    }
    return make_sieve(std::move(radii), std::move(passing), basis);
  }
  const auto [place, spread] = fit_law(percentiles, law);
  if (law == PercentileLaw::rosin_rammler) return make_rosin_rammler(place, spread, min, max, basis);
  return law == PercentileLaw::normal ? make_normal(place, spread, basis, min, max)
                                      : make_lognormal(place, spread, basis, min, max);
}

double radius_below(const SizeDistribution& radii, double share, Basis basis) {
  return counts_volume(basis) ? radius_holding(radii, 1 - share, 3) : radii.quantile(share);
}

}  // namespace bernal
