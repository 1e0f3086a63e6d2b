#include "bernal/sizes/size_distribution.hpp"
#include "sizes/check.hpp"
#include "sizes/power_law.hpp"

namespace bernal {

std::unique_ptr<SizeDistribution> make_uniform(double min, double max, Basis basis) {
  require_positive("the smallest radius", min);
  require_positive("the largest radius", max);
  if (min > max)
    throw Error(ErrorCode::bad_argument,
                fmt::format("the smallest radius {} is larger than the largest {}", min, max));
  if (min == max) return make_constant(min);
  return make_power_law("uniform", min, max, basis == Basis::number ? 1 : -2);
}

}  // namespace bernal
