#include <algorithm>
#include <chrono>

#include "bernal/predict/mixtures.hpp"
#include "figures/drawing.hpp"
#include "figures/figure_files.hpp"

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

}  // namespace

/// Farr's table 1: what the rod model costs. Milliseconds here: the median of several, on one core.
Files table_1(const FigureOptions& options) {
  std::string csv = "sigma,rods,phi,phi_published,milliseconds,milliseconds_published\n";
  for (const Row& row : rows) {
    if (options.monitor.stop()) return {};
    Prediction prediction;
    std::vector<double> milliseconds;
    for (int k = 0; k < repeats; ++k) {
      const auto start = std::chrono::steady_clock::now();
      prediction =
          predict_packing_fraction(*make_two_populations({.sigma_a = row.sigma, .share = 0}), row.rods);
      milliseconds.push_back(
          std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    }
    std::ranges::nth_element(milliseconds, milliseconds.begin() + repeats / 2);
    csv += fmt::format("{},{},{:.7f},{:.6f},{:.3f},{}\n", row.sigma, row.rods, prediction.phi, row.phi,
                       milliseconds[repeats / 2], row.milliseconds);
  }
  return {{"table1.csv", csv}};
}

}  // namespace bernal::figures
