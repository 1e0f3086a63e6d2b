#include "jam/polish.hpp"

#include <cmath>

namespace bernal {
namespace {

/// Steps of the solver grow with the number of spheres; each is some sweeps over all contacts.
constexpr double seconds_of_thousand = 7, power_of_count = 1.5, bytes_a_sphere = 1300;
/// Spheres that come loose first have a longer way to go.
constexpr double factor_in_bed = 1.5;
/// A thousand discs in a bed, and the power of their number: 150 to 1,800 of two sizes and lognormal.
constexpr double seconds_of_thousand_flat = 1.5, power_of_count_flat = 2;

}  // namespace

void add_polishing(std::vector<PlanItem>& items, const Outlook& outlook) {
  const double thousands = outlook.spheres / 1000;
  const double seconds =
      outlook.in_bed && outlook.task.dimension == 2
          ? seconds_of_thousand_flat * std::pow(thousands, power_of_count_flat)
          : seconds_of_thousand * std::pow(thousands, power_of_count) * (outlook.in_bed ? factor_in_bed : 1);
  if (!outlook.in_bed) items.back().seconds += seconds;
  items.push_back({.name = "polish",
                   .what = "contacts are closed by minimising an energy, until they just hold the spheres",
                   .cost = "some 10,000 products with the Hessian, O(N) each",
                   .seconds = seconds,
                   .bytes = bytes_a_sphere * outlook.spheres,
                   .part = !outlook.in_bed});
}

}  // namespace bernal
