#include "structure_text.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "bernal/core/text.hpp"
#include "say.hpp"

namespace bernal {

void print_chart(const std::vector<double>& values, int highest, int rows_a_unit, const std::string& reach) {
  constexpr int columns = 75;
  static const char* const blocks[] = {" ", "▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
  std::vector<double> heights;
  for (int k = 0; k < columns; ++k) {
    const std::size_t first = values.size() * static_cast<std::size_t>(k) / columns;
    const std::size_t end = std::max(first + 1, values.size() * (static_cast<std::size_t>(k) + 1) / columns);
    double sum = 0;
    for (std::size_t bin = first; bin < end; ++bin) sum += values[bin];
    heights.push_back(8 * rows_a_unit * sum / static_cast<double>(end - first));
  }
  for (int row = highest * rows_a_unit - 1; row >= 0; --row) {
    std::string line;
    for (const double height : heights)
      line += blocks[static_cast<int>(std::clamp(std::round(height - 8 * row), 0.0, 8.0))];
    const bool marked = (row + 1) % rows_a_unit == 0;
    fmt::print("{:>4} {}\n", marked ? fmt::format("{}", (row + 1) / rows_a_unit) : "", line);
  }
  fmt::print("     0{:>{}}\n", reach, columns - 1);
}

void print_local(const Packing& packing, const LocalPacking& local) {
  say(stdout, "\nlocal packing     {:.4f} ± {:.4f}, mean and deviation of a sphere's share of its cell\n",
      local.mean, local.deviation);
  if (!local.quantiles.empty()) {
    std::string quantiles;
    for (const auto& [share, phi] : local.quantiles)
      quantiles += fmt::format("{}{:g} % {:.4f}", quantiles.empty() ? "" : ", ", 100 * share, phi);
    fmt::print("  below           {}\n", quantiles);
  }
  fmt::print("  neighbours      {:.2f} cells share a face with a cell\n", local.mean_neighbours);
  if (local.empty > 0)
    say(stdout, "  no cell         {} spheres, hidden in others or outside\n", grouped(local.empty));
  fmt::print("  all cells       fill the {} to {:.1g} of its {}\n",
             has_walls(packing.domain) ? "container" : "box", std::max(local.volume_error, 1e-12),
             packing.spheres.dimension() == 2 ? "area" : "volume");
}

void print_structure(const StructureFactor& factor) {
  const double d = factor.mean_diameter, reach = factor.k.back() * d;
  fmt::print("\nS(k), the structure factor, over wave numbers times the mean diameter; {} wave vectors\n",
             grouped(factor.references));
  // On an even grid, each bin until half-way to the next.
  std::vector<double> even;
  constexpr std::size_t columns = 300;
  for (std::size_t column = 0, b = 0; column < columns; ++column) {
    const double at = (static_cast<double>(column) + 0.5) / columns * factor.k.back();
    while (b + 1 < factor.k.size() && factor.k[b + 1] + factor.k[b] < 2 * at) ++b;
    even.push_back(factor.s[b]);
  }
  print_chart(even, 3, 3, fmt::format("{:.3g} / d", reach));
  if (const auto peak = factor.peak())
    fmt::print("peak              {:.2f} ± {:.2f} at k d = {:.2f}\n", peak->s, peak->error, peak->k * d);
  fmt::print("smallest k        {:.2g} ± {:.1g} at k d = {:.2f}\n", factor.s.front(), factor.error.front(),
             factor.k.front() * d);
}

void print_pores(const Packing& packing, const PoreSizes& pores, const std::string& where) {
  fmt::print("\npores             porosity {:.4f} ± {:.4f}, from {} points{}\n", pores.porosity,
             pores.porosity_error, grouped(pores.points), where);
  if (pores.in_pores == 0) return;
  fmt::print("  to a solid      {:.4g} ± {:.1g} {} on average, {:.4g} at most, root mean square {:.4g}\n",
             pores.mean, pores.mean_error, name_of(packing.scene.unit), pores.largest,
             std::sqrt(pores.second_moment));
  std::string quantiles;
  for (const auto& [share, distance] : pores.quantiles)
    quantiles += fmt::format("{}{:g} % {:.4g}", quantiles.empty() ? "" : ", ", 100 * share, distance);
  fmt::print("  below           {}\n", quantiles);
}

}  // namespace bernal
