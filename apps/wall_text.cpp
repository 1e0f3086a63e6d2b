#include "wall_text.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/text.hpp"
#include "structure_text.hpp"

namespace bernal {
namespace {

/// Prints layers in columns of ten: at the usual thickness a column is one mean diameter.
void print_layers(const WallProfile& profile) {
  constexpr std::size_t rows = 10, most_columns = 5;
  const std::size_t n = std::min(profile.layers.size(), rows * most_columns);
  for (std::size_t k = 0; k < n; k += rows) fmt::print("{:>9} {:>8}", "z", "porosity");
  fmt::print("\n");
  for (std::size_t row = 0; row < std::min(n, rows); ++row) {
    for (std::size_t k = row; k < n; k += rows) {
      const WallProfile::Layer& layer = profile.layers[k];
      const bool last = k + 1 == profile.layers.size();
      const double z = (last ? layer.from : 0.5 * (layer.from + layer.to)) / profile.mean_diameter;
      fmt::print("{:>9} {:>8.4f}", fmt::format("{}{:.2f}", last ? ">" : "", z), layer.porosity);
    }
    fmt::print("\n");
  }
}

void print_profile(const WallProfile& profile) {
  const std::size_t even = profile.layers.size() - 1;  // the last layer holds all that is deeper
  if (even > 1) {
    std::vector<double> porosities;
    for (std::size_t k = 0; k < even; ++k) porosities.push_back(profile.layers[k].porosity);
    print_chart(porosities, 1, 6,
                fmt::format("{:.3g} diameters", profile.layers[even].from / profile.mean_diameter));
  }
  print_layers(profile);
}

/// "0.262 at 0.487 mean diameters"
std::string minimum_text(const WallProfile::Minimum& least, double diameter) {
  return fmt::format("{:.3f} at {:.3f} mean diameters", least.porosity, least.z / diameter);
}

}  // namespace

std::string slab_text(const Packing& packing, const Slab& slab) {
  return fmt::format("from {:.4g} to {:.4g} {} along ({:.3g})", slab.part.from, slab.part.height,
                     name_of(packing.scene.unit), fmt::join(Vector<3>(-slab.part.direction), ", "));
}

std::string part_text(const Packing& packing, const Measurements& measured) {
  if (measured.slab) return "; of the slab " + slab_text(packing, *measured.slab);
  if (!measured.bed || !measured.bed->level) return {};
  return fmt::format("; of the bed below {:.4g} {}", *measured.bed->level, name_of(packing.scene.unit));
}

void print_column(const Packing& packing, const Measurements& measured) {
  const ColumnProfile& column = *measured.column;
  const double d = column.mean_diameter;
  const bool is_slab = measured.slab.has_value();
  fmt::print("\nporosity along the axis ({:.3g}), {:.3g} mean diameters{}\n", fmt::join(column.axis, ", "),
             (column.top - column.bottom) / d,
             is_slab          ? part_text(packing, measured)
             : column.has_lid ? " from the floor to the lid"
                              : " from the floor to the level of the bed");
  std::vector<double> porosities;
  for (const ColumnProfile::Layer& layer : column.along) porosities.push_back(layer.porosity);
  print_chart(porosities, 1, 6, fmt::format("{:.3g} diameters", (column.top - column.bottom) / d));
  if (const auto& side = column.side) {
    fmt::print(
        "\nporosity over the distance z from the side alone, in mean diameters; {}:\n"
        "from {:.4g} to {:.4g} {} above the floor\n",
        is_slab ? "of the slab" : "the ends are left out", side->from, side->to, name_of(packing.scene.unit));
    print_profile(side->profile);
  }
  fmt::print("\n");
  if (column.side && column.side->profile.first_minimum)
    fmt::print("first minimum     {} from the side\n", minimum_text(*column.side->profile.first_minimum, d));
  if (column.floor_minimum)
    fmt::print("                  {} from the floor\n", minimum_text(*column.floor_minimum, d));
  if (column.lid_minimum)
    fmt::print("                  {} from the lid\n", minimum_text(*column.lid_minimum, d));
}

void print_walls(const Packing& packing, const Measurements& measured) {
  const WallProfile& profile = *measured.walls;
  fmt::print("\nporosity over the distance z from the nearest wall, in mean diameters of {:.6g} {}{}\n",
             profile.mean_diameter, name_of(packing.scene.unit), part_text(packing, measured));
  print_profile(profile);
  double error = 0;
  for (const WallProfile::Layer& layer : profile.layers) error = std::max(error, layer.error);
  fmt::print("\nmean porosity     {:.6f}; standard error of a layer at most {:.2g}\n", profile.mean_porosity,
             error);
  if (profile.first_minimum)
    fmt::print("first minimum     {}, over all walls\n",
               minimum_text(*profile.first_minimum, profile.mean_diameter));
  fmt::print("near the wall     packing fraction {:.4f} within a mean diameter\n",
             profile.near_wall_packing_fraction);
  fmt::print("core              packing fraction {:.4f} ± {:.4f} beyond {:.3g} mean diameters{}\n",
             profile.core_packing_fraction, profile.core_packing_error,
             profile.core_from / profile.mean_diameter,
             profile.has_core ? "" : ", the deeper half: too narrow for a core");
  constexpr std::size_t rows_of_sizes = 10;
  if (profile.segregation && profile.segregation->error > 0) {
    fmt::print("\nmean volume of the spheres whose surface is so far from the wall, of that of all\n");
    for (std::size_t k = 0; k < std::min(profile.layers.size(), rows_of_sizes); ++k)
      if (const auto& there = profile.layers[k].segregation)
        fmt::print("{:>9.2f} {:>8.4f} ± {:.4f}, {} spheres\n", profile.layers[k].from / profile.mean_diameter,
                   there->volume_ratio, there->error, grouped(there->spheres));
  }
  if (profile.segregation)
    fmt::print("segregation       mean volume near the wall {:.4f} ± {:.4f} of that of all spheres\n",
               profile.segregation->volume_ratio, profile.segregation->error);
}

}  // namespace bernal
