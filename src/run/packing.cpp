#include "bernal/run/packing.hpp"

#include "bernal/core/dimension.hpp"

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
  for (const double r : spheres.r) sum += ball_volume(spheres.dimension(), r);
  return volume > 0 ? sum / volume : 0;
}

}  // namespace bernal
