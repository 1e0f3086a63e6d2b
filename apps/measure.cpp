#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bed_text.hpp"
#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "bernal/measure/measure.hpp"
#include "bernal/plan/plan.hpp"
#include "bernal/report/describe.hpp"
#include "bernal/report/json.hpp"
#include "bernal/result/read_packing.hpp"
#include "bernal/result/write_contacts.hpp"
#include "bernal/result/write_local.hpp"
#include "bernal/result/write_section.hpp"
#include "commands.hpp"
#include "contact_text.hpp"
#include "layer_text.hpp"
#include "progress_bar.hpp"
#include "results.hpp"
#include "say.hpp"
#include "structure_text.hpp"
#include "wall_text.hpp"

using namespace bernal;

namespace {

struct MeasureCall {
  std::filesystem::path folder;
  MeasureOptions options;
  int threads = 0;
  bool json = false;
  std::optional<std::string> plane;  ///< of a section, where no measurements are asked for
  std::filesystem::path picture;     ///< of the section
  std::optional<std::string> slab;   ///< what alone is measured of walls, pores, g(r) and contacts
  std::filesystem::path local;       ///< where the table of local packing fractions goes; empty: nowhere
  std::filesystem::path contacts;    ///< and all contacts
};

/// Draws a section, and does no measurement.
int draw_section(const MeasureCall& call) {
  if (call.picture.empty())
    throw Error(ErrorCode::bad_argument, "--section \"z = 1.5\" needs -o FILE.svg, where it is drawn");
  if (call.json)
    throw Error(ErrorCode::bad_argument,
                "--section draws a picture, and --json prints measurements; ask for one");
  const Packing packing = read_result(call.folder);
  write_section(packing, *call.plane, call.picture);
  say(stdout, "{}\n", plain_text(call.picture.string(), 5000));
  return exit_code::done;
}

/// Nearer than a diameter hardly any pair is expected.
double largest_error(const RadialDistribution& radial) {
  double largest = 0;
  for (std::size_t k = 0; k < radial.r.size(); ++k)
    if (radial.r[k] > radial.mean_diameter) largest = std::max(largest, radial.error[k]);
  return largest;
}

void print_radial(const Packing& packing, const Measurements& measured) {
  const std::optional<RadialDistribution>& radial = measured.radial;
  if (!radial) {
    say(stdout, "\ng(r)              only of two spheres or more, and between walls in three dimensions\n");
    return;
  }
  fmt::print("\ng(r), the radial distribution function; mean diameter {:.6g} {}, bins of {:.3g} {}\n",
             radial->mean_diameter, name_of(packing.scene.unit), radial->bin_width,
             name_of(packing.scene.unit));
  const double reach = radial->bin_width * static_cast<double>(radial->g.size()) / radial->mean_diameter;
  if (!radial->share.empty())
    fmt::print(
        "between walls: by the share of each shell that lies off the walls{}; standard error from a diameter "
        "on up to {:.2g}\n",
        part_text(packing, measured), largest_error(*radial));
  print_chart(radial->g, 3, 3, fmt::format("{:.3g} diameters", reach));
  for (const auto& peak : radial->peaks)
    fmt::print("peak              {:.2f} at {:.3f} diameters (± {:.2f}, ± {:.3f})\n", peak.g,
               peak.r / radial->mean_diameter, peak.error, 0.5 * radial->bin_width / radial->mean_diameter);
}

void print_size_correlation(const SizeCorrelation& correlation) {
  say(stdout, "\nsize correlation  of two spheres, 0 where their sizes know nothing of each other\n");
  if (correlation.neighbours)
    fmt::print("  neighbours      {:.4f} ± {:.4f}, nearer than {:g} times the sum of their radii\n",
               correlation.neighbours->correlation, correlation.neighbours->error, 1 + BondOrder::widest_gap);
  for (const auto& [from, to] : size_correlation_ranges)
    if (const auto mean = correlation.mean_between(from, to))
      fmt::print("  {:<15} {:.4f} ± {:.4f}, mean diameters apart\n", fmt::format("{:g} to {:g}", from, to),
                 mean->c, mean->error);
}

void print_chambers(const Packing& packing, const Chambers& found) {
  constexpr std::size_t most_rows = 20;
  const std::size_t n = found.chambers.size(), rows = std::min(n, most_rows);
  fmt::print("chambers          {}", n);
  if (n == 1)
    fmt::print("; too narrow: ");
  else
    fmt::print(", which spheres of the smallest radius, {:.4g} {}, cannot leave\ntoo narrow        ",
               found.radius, name_of(packing.scene.unit));
  fmt::print("{:.2f} % of the container for the smallest spheres, {:.2f} % for those of the mean radius\n",
             100 * found.by_smallest.share, 100 * found.by_mean.share);
  if (n > 1) fmt::print("\n{:>9} {:>9} {:>17}  {}\n", "share", "spheres", "packing fraction", "position");
  for (std::size_t k = 0; k < rows && n > 1; ++k) {
    const Chambers::Chamber& chamber = found.chambers[k];
    fmt::print("{:>8.2f}% {:>9} {:>17.4f}  {:.4g}\n", 100 * chamber.share, grouped(chamber.spheres),
               chamber.packing_fraction, fmt::join(chamber.position, ", "));
  }
  if (n > rows) fmt::print("          and {} smaller ones\n", grouped(n - rows));
  if (found.misplaced > 0)
    fmt::print("misplaced         {} spheres stick out and are in no chamber\n", grouped(found.misplaced));
  if (n > 1) fmt::print("\n");
}

void print_order(const BondOrder& order) {
  const auto percent = [](const BondOrder::Count& count) {
    return count.spheres == 0
               ? std::string("no spheres")
               : fmt::format("{:.2f} % of {} spheres", 100 * count.fraction(), grouped(count.spheres));
  };
  fmt::print("\ncrystalline       {}, by the order of their bonds; mean q6 {:.4f} ± {:.4f}\n",
             percent(order.all), order.mean_q6, order.q6_error);
  if (order.near_wall) fmt::print("  near the wall   {}\n", percent(*order.near_wall));
  if (order.core) fmt::print("  in the core     {}\n", percent(*order.core));
}

void print_drawn(const DrawnComparison& drawn) {
  if (drawn.missing == 0 && drawn.scale != 1)
    fmt::print("drawn sequence    the same sizes, all times {:.9g} and here without that, less its tail",
               drawn.scale);
  else if (drawn.missing == 0)
    fmt::print("drawn sequence    the same sizes to the bit, less its tail");
  else
    fmt::print("drawn sequence    {} of as many draws are missing; quantiles differ by up to {:.2g} %",
               grouped(drawn.missing), 100 * drawn.largest_deviation);
  if (drawn.above_largest > 0)
    fmt::print("; {} larger draw{} passed over", grouped(drawn.above_largest),
               drawn.above_largest == 1 ? "" : "s");
  fmt::print("\n");
}

void print_sizes(const Packing& packing, const SizeComparison& sizes) {
  const bool diameters = packing.scene.sizes_are_diameters;
  const double factor = diameters ? 2 : 1;
  fmt::print("\nsizes against those asked for: {} in {}\n", diameters ? "diameter" : "radius",
             name_of(packing.scene.unit));
  fmt::print("Kolmogorov        largest distance of the cumulative shares {:.5f}", sizes.ks_statistic);
  if (sizes.ks_p_value) fmt::print("; p = {:.3f}", *sizes.ks_p_value);
  fmt::print("\n");
  if (sizes.chi_squared_p_value)
    fmt::print("chi-squared       {:.4g} for {} classes; p = {:.3f}\n", sizes.chi_squared,
               sizes.classes.size(), *sizes.chi_squared_p_value);
  fmt::print("mean              {:.6g}, asked {:.6g}\n", factor * sizes.mean_radius,
             factor * sizes.asked_mean_radius);
  fmt::print("mean {}       {:.5f} of what was asked; ± {:.5f} is expected of independent draws\n",
             packing.spheres.dimension() == 2 ? "area  " : "volume", sizes.volume_ratio,
             sizes.volume_ratio_error);
  if (sizes.drawn) print_drawn(*sizes.drawn);
  if (sizes.classes.size() == 1) return;
  std::vector<std::string> there, asked;
  for (const auto& [share, realised, of_asked] : sizes.volume_quantiles) {
    there.push_back(fmt::format("D{:.0f} {:.5g}", 100 * share, 2 * realised));
    asked.push_back(fmt::format("{:.5g}", 2 * of_asked));
  }
  fmt::print("by {:<14} {} as diameters; asked {}\n", packing.spheres.dimension() == 2 ? "area" : "volume",
             fmt::join(there, ", "), fmt::join(asked, ", "));
  if (!sizes.classes.empty() && sizes.shares.size() == sizes.classes.size()) {  // few
    say(stdout, "\n{:>12} {:>12} {:>12} {:>12} {:>12} {:>12}\n", diameters ? "diameter" : "radius", "spheres",
        "by number", "asked", packing.spheres.dimension() == 2 ? "by area" : "by volume", "asked");
    for (const SizeComparison::Share& c : sizes.shares)
      fmt::print("{:>12.6g} {:>12} {:>12.5f} {:>12.5f} {:>12.5f} {:>12.5f}\n", factor * c.up_to,
                 grouped(c.count), c.number, c.asked_number, c.volume, c.asked_volume);
    return;
  }
  fmt::print("\n{:>12} {:>12} {:>12}\n", "share below", diameters ? "diameter" : "radius", "asked");
  for (const auto& q : sizes.quantiles)
    fmt::print("{:>12} {:>12.6g} {:>12.6g}\n", fmt::format("{:g} %", 100 * q.share), factor * q.realised,
               factor * q.asked);
}

/// Cells of more spheres are made only on request: each takes 240 bytes and 20 µs.
constexpr std::size_t most_cells = 20'000'000;

void print(const Packing& packing, const Measurements& measured) {
  speak_of(packing.spheres.dimension());
  say(stdout, "spheres           {}, in a {} of {:.6g} {}{}\n", grouped(packing.spheres.size()),
      name_of(packing.domain), fmt::join(bounds_of<dynamic>(packing.domain).size(), " x "),
      name_of(packing.scene.unit), tilt_in_words(packing.domain));
  fmt::print("packing fraction  {:.6f}\n", measured.packing_fraction);
  if (measured.slab)
    fmt::print("  in the slab     {:.6f}, {}\n", measured.slab->packing_fraction,
               slab_text(packing, *measured.slab));
  print_layers(stdout, packing);
  if (measured.chambers) print_chambers(packing, *measured.chambers);
  print_contacts(packing, measured);
  print_radial(packing, measured);
  if (measured.size_correlation) print_size_correlation(*measured.size_correlation);
  if (measured.bed) print_bed(*measured.bed, name_of(packing.scene.unit));
  if (measured.walls) print_walls(packing, measured);
  if (measured.column) print_column(packing, measured);
  if (measured.order && !packing.spheres.empty()) print_order(*measured.order);
  if (measured.local) print_local(packing, *measured.local);
  if (!measured.local && packing.spheres.size() > most_cells)
    say(stdout, "\nlocal packing     not of so many spheres, unless --local FILE asks for it\n");
  if (measured.pores) print_pores(packing, *measured.pores, part_text(packing, measured));
  if (measured.structure) print_structure(*measured.structure);
  if (measured.sizes) print_sizes(packing, *measured.sizes);
}

Measurements measured_of(const Packing& packing, const MeasureCall& call, const Monitor& monitor) {
  const SceneRadii radii = asked_radii_of(packing);
  const auto slab = call.slab ? std::optional(slab_in(*call.slab, packing.scene.unit)) : std::nullopt;
  try {
    MeasureOptions options = call.options;
    options.monitor = monitor;
    options.all_or_nothing = true;
    if (call.local.empty()) options.local.most_spheres = most_cells;
    options.gap = packing.scene.gap;
    options.wall_gap = packing.scene.wall_gap;
    options.bed = bed_options_of(packing.scene);
    options.slab = slab;
    return measure(packing.spheres, packing.domain, radii.asked, options);
  } catch (const Error& error) {
    throw Error(error.code(), error.what(), {spheres_of_result(call.folder).string()});
  }
}

/// The options that a call and a scene give.
ContactOptions contact_options_of(const Packing& packing, const MeasureCall& call) {
  return {call.options.contact_gap, packing.scene.gap, packing.scene.wall_gap, packing.container};
}

int measure_folder(const MeasureCall& call) try {
  if (call.plane) return draw_section(call);
  const auto limit = limited_to(call.threads);
  ProgressBar bar(call.json);
  bar.now("measure");
  const Packing packing = read_result(call.folder);
  if (!call.contacts.empty()) check_contacts_file(call.contacts, packing.spheres.dimension());
  const Measurements measured = measured_of(packing, call, bar.monitor());
  bar.clear();
  if (!call.local.empty()) {
    if (!measured.local)
      throw Error(
          ErrorCode::bad_argument,
          is_repeated_mesh(packing.domain)
              ? "--local: local packing fractions are not known in a mesh that repeats itself; leave it out"
          : is_tilted(packing.domain)
              ? "--local: local packing fractions are not known in tilted boxes; leave it out"
              : "--local: local packing fractions are those of spheres in two or three dimensions");
    write_local(packing, *measured.local, call.local);
  }
  if (!call.contacts.empty())
    write_contacts(packing, contact_list(packing.spheres, packing.domain, contact_options_of(packing, call)),
                   call.contacts);
  if (call.json)
    fmt::print("{}", measurements_as_json(packing, measured));
  else
    print(packing, measured);
  return exit_code::done;
} catch (const Cancelled&) {
  say(stderr, "bernal: stopped by the user; nothing is measured\n");
  return exit_code::not_reached;
}

}  // namespace

Command measure_command() {
  const auto call = std::make_shared<MeasureCall>();
  return {
      "measure",
      "Contacts, rattlers, g(r), S(k), local packing, pores, chambers, walls, order, sizes",
      {folder(
           required({"DIR", &call->folder, "What bernal pack wrote: its spheres and scene.toml are read"})),
       within({"--gap", &call->options.contact_gap,
               "Spheres touch below this gap over the sum of their radii; 0.002 if absent", "RATIO"},
              0.0, 1.0),
       {"--section", [call](const std::string& plane) { call->plane = plane; },
        "Draw the circles that this plane cuts of the spheres, and the outline of their container: "
        "\"z = 1.5\", \"0.6 x + 0.8 z = 2\"; nothing else is measured",
        "PLANE"},
       needs({"-o,--output", &call->picture, "The file for the section", "FILE.svg"}, "--section"),
       {"--slab", [call](const std::string& slab) { call->slab = slab; },
        "Measure the packing fraction, the porosity along and around its axis, pores, g(r) and the contacts "
        "of "
        "this slab: \"z = 10..40\", \"x = -5 mm..5 mm\", \"z < 20\"",
        "SLAB"},
       {"--local", &call->local,
        "Write the local packing fraction, the volume of the cell and the number of neighbours of every "
        "sphere into this table",
        "FILE.csv"},
       {"--contacts", &call->contacts,
        "Write all contacts into this file, .csv, .npy or .vtp by its ending: i, j (counted from 0, -1 is a "
        "wall), the distance of the surfaces, the unit normal from i to j, the place",
        "FILE"},
       threads_option(call->threads, "the answer"),
       json_option(call->json)},
      {.text =
           "Rattlers are taken out one after the other until every sphere left is held by D + 1 "
           "contacts.\n\nIn a container: the chambers that the smallest spheres cannot leave, with the "
           "packing fraction of each, and what no sphere can cover; porosity over the distance from the "
           "wall, the packing fraction of the core (more than 3 mean diameters from it) and near it; "
           "whether small spheres gather there.\n\nOf a bed, which leaves the top of its container empty or "
           "was settled last: its height, roughness, porosity up to its surface and packing fraction over "
           "the height, and whether its spheres rest; walls and pores are those below its surface then."
           "\n\nIn three dimensions: the share of the spheres whose neighbours lie as in a crystal.\n\nIn "
           "two and three: the packing fraction of every sphere in "
           "its cell of the power diagram. In periodic boxes: g(r) and the structure factor S(k). "
           "Everywhere: how far it is from points in the pores to the nearest solid.",
       .examples = {{"bernal measure out", "everything, for people"},
                    {"bernal measure out --slab \"z = 10..40\"", "of what lies between two heights"},
                    {"bernal measure out --json", "everything, for programs"},
                    {"bernal measure out --contacts contacts.csv --gap 0.001", "and every contact"},
                    {"bernal measure out --local cells.csv", "and a table of the cell of every sphere"},
                    {"bernal measure out --section \"z = 1.5\" -o section.svg", "a picture of a section"}},
       .exit_codes = {{"0", "done"}, {"2", "bad input"}, {"3", "stopped by Ctrl-C, nothing printed"}}},
      [call] { return measure_folder(*call); }};
}
