#include "bed_text.hpp"

#include <vector>

#include <fmt/format.h>

#include "bernal/core/text.hpp"
#include "say.hpp"
#include "structure_text.hpp"

namespace bernal {

std::string rest_text(const Rest& rest, std::string_view unit) {
  if (rest.unsettled == 0 && rest.held_by_friction > 0)
    return fmt::format("every sphere rests, {} of them by friction, up to an angle of {:.3g} degrees",
                       grouped(rest.held_by_friction), rest.friction);
  if (rest.unsettled == 0) return "every sphere rests: it can neither fall nor roll down";
  std::string text = fmt::format("NOT at rest: {}", grouped(rest.unsettled));
  if (rest.hanging > 0)
    text += fmt::format(", of which {} hang; the farthest could fall {:.3g} {}", grouped(rest.hanging),
                        rest.farthest, unit);
  return text;
}

void print_bed(const BedProfile& bed, std::string_view unit) {
  fmt::print(
      "\nbed               {:.4g} {} high, the mean of its surface; highest point {:.4g}, roughness {:.3g}\n",
      bed.height, unit, bed.highest, bed.roughness);
  if (bed.covered < 1)
    fmt::print("  covered         {:.2f} % of the cross-section, of which the height is\n",
               100 * bed.covered);
  if (bed.covered < BedProfile::well_covered)
    fmt::print(
        "  level           none, below {:g} %: walls, pores and g(r) are those of the whole container, air "
        "included\n",
        100 * BedProfile::well_covered);
  fmt::print("  porosity        {:.4f} ± {:.4f} up to the surface, floor and top included\n", bed.porosity,
             bed.porosity_error);
  if (bed.core)
    fmt::print(
        "  core            {:.4f} from {:.4g} to {:.4g} {}, {:g} mean diameters from floor and surface\n",
        bed.core->porosity, bed.core->from, bed.core->to, unit, BedProfile::core_depth);
  say(stdout, "  rest            {}\n", rest_text(bed.rest, unit));
  fmt::print("\npacking fraction over the height, in mean diameters of {:.6g} {}\n", bed.mean_diameter, unit);
  std::vector<double> fractions;
  for (const BedProfile::Layer& layer : bed.layers) fractions.push_back(layer.packing_fraction);
  print_chart(fractions, 1, 6, fmt::format("{:.3g} diameters", bed.highest / bed.mean_diameter));
}

}  // namespace bernal
