#include <algorithm>
#include <cmath>
#include <limits>

#include "bernal/predict/mixtures.hpp"
#include "figures/drawing.hpp"
#include "figures/figure_files.hpp"
#include "predict/rods.hpp"

namespace bernal::figures {
namespace {

struct Row {
  double sigma;
  int rods;
  double phi, milliseconds;  ///< as published; 3.2 GHz Pentium
};

constexpr Row rows[] = {{0, 16000, 0.643485, 40},  {0.5, 16000, 0.707259, 479},  {1, 16000, 0.801339, 507},
                        {0, 64000, 0.643485, 331}, {0.5, 64000, 0.707262, 2151}, {1, 64000, 0.801368, 2644}};
constexpr int repeats = 9;

/// As the published program has it: Abramowitz & Stegun 7.1.26, right to 1.5e-7.
double published_erfc(double x) {
  const double t = 1 / (1 + 0.3275911 * std::abs(x));
  const double tail =
      t * (0.254829592 + t * (-0.284496736 + t * (1.421413741 + t * (-1.453152027 + t * 1.061405429)))) *
      std::exp(-x * x);
  return x < 0 ? 2 - tail : tail;
}

/// The share of the chords, of spheres of mean diameter 1, that are shorter than `length`: eq. 34.
double published_share_below(double length, double sigma) {
  if (sigma == 0) return std::min(length * length, 1.0);
  const double s = sigma, below = (std::log(length) + 1.5 * s * s) / (s * std::sqrt(2.0));
  const double above = below + s * std::sqrt(2.0);
  return 1 - 0.5 * published_erfc(below) +
         0.5 * length * length * std::exp(5 * s * s) * published_erfc(above);
}

/// The model with that erfc, by bisection: the digits that were printed.
double published_packing_fraction(double sigma, int rods) {
  std::vector<double> lengths;
  for (int i = 0; i < rods; ++i) {
    double low = -40, high = 40;  // of ln L
    while (high - low > 16 * std::numeric_limits<double>::epsilon() * std::max(1.0, std::abs(low))) {
      const double middle = 0.5 * (low + high);
      (published_share_below(std::exp(middle), sigma) < (rods - i - 0.5) / rods ? low : high) = middle;
    }
    lengths.push_back(std::exp(low));
  }
  return predict::covered_fraction(lengths);
}

}  // namespace

/// Farr's table 1: what the rod model costs. Milliseconds here: the median of several, on one core. The
/// digits that he prints are those of an approximate erfc; phi is that of the exact one, up to 1.2e-5 more.
Files table_1(const FigureOptions& options) {
  std::string csv =
      "sigma,rods,phi,phi_with_published_erfc,phi_published,milliseconds,milliseconds_published\n";
  for (const Row& row : rows) {
    if (options.monitor.stop()) return {};
    Prediction prediction;
    std::vector<double> milliseconds;
    for (int k = 0; k < repeats; ++k) {
      const Stopwatch watch;
      prediction =
          predict_packing_fraction(*make_two_populations({.sigma_a = row.sigma, .share = 0}), row.rods);
      milliseconds.push_back(1e3 * watch.seconds());
    }
    std::ranges::nth_element(milliseconds, milliseconds.begin() + repeats / 2);
    csv += fmt::format("{},{},{:.7f},{:.6f},{:.6f},{:.3f},{}\n", row.sigma, row.rods, prediction.phi,
                       published_packing_fraction(row.sigma, row.rods), row.phi, milliseconds[repeats / 2],
                       row.milliseconds);
  }
  return {{"table1.csv", csv}};
}

}  // namespace bernal::figures
