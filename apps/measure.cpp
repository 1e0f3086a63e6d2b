#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/global_control.h>

#include "bernal/core/text.hpp"
#include "bernal/io/measurements_json.hpp"
#include "bernal/io/read_packing.hpp"
#include "bernal/measure/measure.hpp"
#include "bernal/run/run.hpp"
#include "commands.hpp"

using namespace bernal;

namespace {

struct MeasureCall {
  std::filesystem::path folder;
  MeasureOptions options;
  int threads = 0;
  bool json = false;
};

void print_contacts(const Packing& packing, const Measurements& measured) {
  const Contacts& c = measured.contacts;
  const bool walls = std::holds_alternative<Shape>(packing.domain);
  fmt::print("contacts          {} pairs", grouped(c.pairs));
  if (walls) fmt::print(", {} with the wall", grouped(c.walls));
  fmt::print(", at a gap below {:g} of the sum of the radii\n", c.contact_gap);
  fmt::print("coordination      {:.4f}\n", c.coordination);
  fmt::print("rattlers          {} ({:.2f} %), held by fewer than {} contacts\n", grouped(c.rattlers),
             packing.spheres.empty()
                 ? 0.0
                 : 100.0 * static_cast<double>(c.rattlers) / static_cast<double>(packing.spheres.size()),
             packing.spheres.dimension() + 1);
  fmt::print("backbone          {} spheres, {} contacts, coordination {:.4f}\n", grouped(c.backbone),
             grouped(c.backbone_pairs), c.backbone_coordination);
  if (c.isostatic) {
    const double ratio = static_cast<double>(c.backbone_pairs) / static_cast<double>(*c.isostatic);
    fmt::print("isostatic         {} contacts would just hold the backbone; there are {:.3g} % {}\n",
               grouped(*c.isostatic), 100 * std::abs(ratio - 1), ratio < 1 ? "fewer" : "more");
  }

  fmt::print("\n{:>8} {:>12} {:>13} {:>10} {:>18} {:>13}\n", "gap", "contacts", "coordination", "rattlers",
             "backbone contacts", "of isostatic");
  for (const Contacts& at : measured.by_gap) {
    fmt::print("{:>8.0e} {:>12} {:>13.4f} {:>10} {:>18} {:>13}\n", at.contact_gap, grouped(at.pairs),
               at.coordination, grouped(at.rattlers), grouped(at.backbone_pairs),
               at.isostatic ? fmt::format("{:.4f}", static_cast<double>(at.backbone_pairs) /
                                                        static_cast<double>(*at.isostatic))
                            : "-");
  }
}

/// g(r) as columns of blocks; what is higher than the chart is cut.
void print_chart(const RadialDistribution& radial) {
  constexpr int columns = 75, highest = 3, rows_a_unit = 3, rows = highest * rows_a_unit;
  static const char* const blocks[] = {" ", "▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
  std::vector<double> heights;
  const std::size_t bins = radial.g.size();
  for (int k = 0; k < columns; ++k) {
    const std::size_t first = bins * static_cast<std::size_t>(k) / columns;
    const std::size_t end = std::max(first + 1, bins * (static_cast<std::size_t>(k) + 1) / columns);
    double sum = 0;
    for (std::size_t bin = first; bin < end; ++bin) sum += radial.g[bin];
    heights.push_back(8 * rows_a_unit * sum / static_cast<double>(end - first));
  }
  for (int row = rows - 1; row >= 0; --row) {
    std::string line;
    for (const double height : heights)
      line += blocks[static_cast<int>(std::clamp(std::round(height - 8 * row), 0.0, 8.0))];
    const bool marked = (row + 1) % rows_a_unit == 0;
    fmt::print("{:>4} {}\n", marked ? fmt::format("{}", (row + 1) / rows_a_unit) : "", line);
  }
  const double reach = radial.bin_width * static_cast<double>(bins) / radial.mean_diameter;
  fmt::print("     0{:>{}}\n", fmt::format("{:.3g} diameters", reach), columns - 1);
}

void print_radial(const Packing& packing, const std::optional<RadialDistribution>& radial) {
  if (!radial) {
    fmt::print("\ng(r)              only in periodic boxes of two spheres or more\n");
    return;
  }
  fmt::print("\ng(r), the radial distribution function; mean diameter {:.6g} {}, bins of {:.3g} {}\n",
             radial->mean_diameter, packing.scene.unit, radial->bin_width, packing.scene.unit);
  print_chart(*radial);
  for (const auto& peak : radial->peaks)
    fmt::print("peak              {:.2f} at {:.3f} diameters (± {:.2f}, ± {:.3f})\n", peak.g,
               peak.r / radial->mean_diameter, peak.error, 0.5 * radial->bin_width / radial->mean_diameter);
}

void print_sizes(const Packing& packing, const SizeComparison& sizes) {
  const bool diameters = packing.scene.sizes_are_diameters;
  const double factor = diameters ? 2 : 1;
  fmt::print("\nsizes against those asked for: {} in {}\n", diameters ? "diameter" : "radius",
             packing.scene.unit);
  fmt::print("Kolmogorov        largest distance of the cumulative shares {:.5f}", sizes.ks_statistic);
  if (sizes.ks_p_value) fmt::print("; p = {:.3f}", *sizes.ks_p_value);
  fmt::print("\n");
  if (sizes.chi_squared_p_value)
    fmt::print("chi-squared       {:.4g} for {} classes; p = {:.3f}\n", sizes.chi_squared,
               sizes.classes.size(), *sizes.chi_squared_p_value);
  fmt::print("mean              {:.6g}, asked {:.6g}\n", factor * sizes.mean_radius,
             factor * sizes.asked_mean_radius);
  fmt::print("mean volume       {:.5f} of what was asked; ± {:.5f} is expected of independent draws\n",
             sizes.volume_ratio, sizes.volume_ratio_error);
  if (sizes.classes.size() == 1) return;
  if (!sizes.classes.empty()) {
    fmt::print("\n{:>12} {:>12} {:>12} {:>12}\n", diameters ? "diameter" : "radius", "spheres", "share",
               "asked");
    for (const auto& c : sizes.classes)
      fmt::print("{:>12.6g} {:>12} {:>12.5f} {:>12.5f}\n", factor * c.radius, grouped(c.count),
                 static_cast<double>(c.count) / static_cast<double>(packing.spheres.size()), c.asked_share);
    return;
  }
  fmt::print("\n{:>12} {:>12} {:>12}\n", "share below", diameters ? "diameter" : "radius", "asked");
  for (const auto& q : sizes.quantiles)
    fmt::print("{:>12} {:>12.6g} {:>12.6g}\n", fmt::format("{:g} %", 100 * q.share), factor * q.realised,
               factor * q.asked);
}

void print(const Packing& packing, const Measurements& measured) {
  fmt::print("spheres           {}, in a {} of {:.6g} {}\n", grouped(packing.spheres.size()),
             std::holds_alternative<PeriodicBox>(packing.domain) ? "periodic box" : kind_of(packing.domain),
             fmt::join(extent_of(packing.domain), " x "), packing.scene.unit);
  fmt::print("packing fraction  {:.6f}\n", measured.packing_fraction);
  print_contacts(packing, measured);
  print_radial(packing, measured.radial);
  if (measured.sizes) print_sizes(packing, *measured.sizes);
}

void measure_folder(const MeasureCall& call) {
  std::optional<tbb::global_control> limit;
  if (call.threads > 0)
    limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(call.threads));
  const Packing packing = read_packing(call.folder);
  const std::unique_ptr<SizeDistribution> asked = radii_of(packing.scene);
  const Measurements measured = measure(packing, asked.get(), call.options);
  if (call.json)
    fmt::print("{}", measurements_as_json(packing, measured));
  else
    print(packing, measured);
}

}  // namespace

void add_measure(CLI::App& app, int& status) {
  auto call = std::make_shared<MeasureCall>();
  CLI::App* command =
      app.add_subcommand("measure", "Contacts, rattlers, g(r), sizes against those asked for");
  command->add_option("DIR", call->folder, "What bernal pack wrote: its spheres.csv and scene.toml are read")
      ->required();
  command
      ->add_option("--gap", call->options.contact_gap,
                   "Spheres touch below this gap over the sum of their radii; 0.002 if absent")
      ->check(CLI::Range(0.0, 1.0))
      ->type_name("RATIO");
  command
      ->add_option("--threads", call->threads, "As many as the machine has if absent; the answer is the same")
      ->check(CLI::Range(1, 1024))
      ->type_name("N");
  command->add_flag("--json", call->json, "One JSON object on standard output");
  command->footer(
      "Rattlers are taken out one after the other until every sphere left is held by D + 1 contacts.\n"
      "Exit codes: 0 done; 2 bad input.");
  command->callback([call, &status] {
    measure_folder(*call);
    status = exit_code::done;
  });
}
