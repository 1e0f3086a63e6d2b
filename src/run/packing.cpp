#include "bernal/run/packing.hpp"

#include <numbers>

namespace bernal {

std::string_view name_of(Outcome outcome) {
  switch (outcome) {
    case Outcome::converged:
      return "converged";
    case Outcome::full:
      return "full";
    case Outcome::hit_limit:
      return "hit_limit";
    case Outcome::cancelled:
      return "cancelled";
  }
  return "";
}

double Packing::packing_fraction() const {
  double sum = 0;
  for (const double r : spheres.r) sum += r * r * r;
  return container_volume > 0 ? 4.0 / 3.0 * std::numbers::pi * sum / container_volume : 0;
}

}  // namespace bernal
