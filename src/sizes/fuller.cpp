#include "bernal/sizes/size_distribution.hpp"
#include "sizes/check.hpp"
#include "sizes/power_law.hpp"

namespace bernal {

std::unique_ptr<SizeDistribution> make_fuller(double max, double exponent, double min) {
  require_positive("the largest radius", max);
  require_positive("the exponent", exponent);
  require_interval(min, max);
  return make_power_law("fuller", min, max, exponent - 3);
}

}  // namespace bernal
