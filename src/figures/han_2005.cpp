#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/settle/compress.hpp"
#include "bernal/settle/insert.hpp"
#include "bernal/settle/refill.hpp"
#include "bernal/settle/shake.hpp"
#include "figures/drawing.hpp"
#include "figures/figure_files.hpp"
#include "figures/packings.hpp"
#include "figures/page.hpp"
#include "io/write_svg.hpp"

namespace bernal::figures {
namespace {

/// The one result in the text: a 1.4 GHz PC; radii and dimensions of the cylinder are not in it.
constexpr int printed_spheres = 26'787;
constexpr double printed_phi = 0.5289, printed_seconds = 181;

constexpr double radius = 1, height = 2;

/// What is done to spheres that were inserted at random.
struct Protocol {
  const char* name;
  bool compress;
  double tilt;  ///< of the local directions
  int shakes;   ///< rounds of shaking after each compression
  bool refill;
};
constexpr Protocol protocols[] = {{"insertion at random", false, 0, 0, false},
                                  {"compression along one direction", true, 0, 0, false},
                                  {"the same, local directions", true, 2, 0, false},
                                  {"the same, and shaking", true, 2, 1, false},
                                  {"one direction, refilling", true, 0, 0, true},
                                  {"one direction, shaking, refilling", true, 0, 1, true},
                                  {"local directions, refilling", true, 2, 0, true},
                                  {"local directions, shaking, refilling", true, 2, 1, true}};
constexpr std::size_t whole = std::size(protocols) - 1;
constexpr double tilts[] = {0, 0.5, 1, 2, 4};
constexpr int counted_for_tilts = 6000;
constexpr int counts[] = {1000, 3000, 10'000, 30'000, 100'000};

/// Of which so many equal ones are the printed packing fraction of the cylinder.
double radius_of(int spheres) {
  const double volume = printed_phi * std::numbers::pi * radius * radius * height / spheres;
  return std::cbrt(volume / (4 * std::numbers::pi / 3));
}

/// The end of a compression as the paper has it, by energy.
constexpr double tolerance = 1e-2;

std::vector<Stage> stages_of(const Protocol& p) {
  std::vector<Stage> stages = {Insert{}};
  const Compress compress{.tilt = p.tilt, .tolerance = tolerance, .max_iterations = 400};
  if (p.compress) stages.push_back(compress);
  if (p.shakes > 0) stages.push_back(Shake{.rounds = p.refill ? 2 : p.shakes, .compress = compress});
  if (p.refill) stages.push_back(Refill{.shake = {.rounds = p.shakes, .compress = compress}});
  return stages;
}

PackingTask filled(int spheres, const Protocol& protocol, const FigureOptions& options) {
  PackingTask task;
  Scene& scene = task.scene;
  scene.container = Cylinder{.radius = radius, .height = height};
  scene.sizes = Constant{radius_of(spheres)};
  scene.seed = options.seed;
  scene.target.fill = true;
  scene.stages = stages_of(protocol);
  task.cost = spheres * (protocol.refill ? 1 + 0.7 * protocol.tilt + 0.5 * protocol.shakes : 0.1);
  return task;
}

/// As many spheres as are printed, at the printed packing fraction.
PackingTask as_printed_by_han(int spheres, bool equal, const FigureOptions& options) {
  PackingTask task = filled(spheres, protocols[whole], options);
  task.scene.target = {.count = spheres};
  if (equal) return task;
  // Radii from 1 to 2, all as frequent by number, of which as many have the same volume: mean r³ is 15/4.
  const double unit = radius_of(spheres) / std::cbrt(3.75);
  task.scene.sizes = Uniform{unit, 2 * unit};
  task.scene.draw = Draw::quantiles;
  return task;
}

/// Of the bed: the spheres' volume over that of the cylinder up to twice their mean height.
double phi_of_bed(const DonePacking& done) {
  const Spheres<dynamic>& s = done.packing.spheres;
  double volume = 0, moment = 0;
  for (std::size_t i = 0; i < s.size(); ++i) {
    const double v = 4 * std::numbers::pi / 3 * std::pow(s.r[i], 3);
    volume += v;
    moment += v * s.x[2][i];
  }
  return volume / (std::numbers::pi * radius * radius * std::min(height, 2 * moment / volume));
}

/// Everything that is packed, in groups.
struct HanResults {
  std::vector<DonePacking> as_printed, by_protocol, by_tilt, by_count;
  std::vector<int> counted;  ///< what by_count was meant to have
  int spheres = 0, for_tilts = 0;
};

Protocol tilted(double tilt, bool shaken) {
  return {shaken ? "shaking, refilling" : "refilling", true, tilt, shaken ? 1 : 0, true};
}

std::string csv_of(const HanResults& r) {
  std::string csv = "group,protocol,compress,tilt,shakes,refill,spheres,phi,phi_of_bed,seconds\n";
  const auto add = [&](std::string_view group, const Protocol& p, const DonePacking& d) {
    csv += fmt::format("{},\"{}\",{},{},{},{},{},{:.6f},{:.6f},{:.3f}\n", group, p.name, p.compress ? 1 : 0,
                       p.tilt, p.shakes, p.refill ? 1 : 0, d.packing.spheres.size(), d.phi, phi_of_bed(d),
                       d.seconds);
  };
  for (const DonePacking& d : r.as_printed) add("as printed", protocols[whole], d);
  for (std::size_t k = 0; k < r.by_protocol.size(); ++k) add("protocols", protocols[k], r.by_protocol[k]);
  for (std::size_t k = 0; k < r.by_tilt.size(); ++k)
    add("tilts", tilted(tilts[k / 2], k % 2 == 1), r.by_tilt[k]);
  for (const DonePacking& d : r.by_count) add("counts", protocols[whole], d);
  return csv;
}

File protocols_figure(const HanResults& r) {
  constexpr double top = 74, step = 36, left = 300, right = 620;
  std::string body;
  for (std::size_t k = 0; k < std::size(protocols); ++k) {
    const DonePacking& d = r.by_protocol[k];
    const double y = top + step * static_cast<double>(k), bed = phi_of_bed(d);
    const auto width = [](double phi) { return (right - left) * phi / 0.65; };
    body += fmt::format(
        "<text class=\"label\" x=\"{0}\" y=\"{1}\" text-anchor=\"end\">{2}</text><rect class=\"bar\" "
        "x=\"{3}\" "
        "y=\"{4}\" width=\"{5:.1f}\" height=\"20\"/><text x=\"{6:.1f}\" y=\"{1}\">{7:.4f}, {8:.2g} "
        "s</text>\n",
        left - 12, y + 15, protocols[k].name, left, y, width(bed), right + 10, bed, d.seconds);
  }
  const double x = left + (right - left) * printed_phi / 0.65, low = top + step * std::size(protocols);
  body += fmt::format(
      "<path class=\"line four dashed\" d=\"M{0:.1f} {1}V{2}\"/><text class=\"label\" x=\"{0:.1f}\" "
      "y=\"{3}\" "
      "text-anchor=\"middle\">printed: 0.5289</text>",
      x, top - 8, low, low + 18);
  return {"han2005_protocols.svg",
          svg_document(790, low + 34, "Packing fraction of the bed, by what is done to it", body)};
}

File tilts_figure(const HanResults& r) {
  std::array<std::vector<double>, 2> phi;
  double least = 1, most = 0;
  for (std::size_t k = 0; k < r.by_tilt.size(); ++k) {
    phi[k % 2].push_back(r.by_tilt[k].phi);
    least = std::min(least, r.by_tilt[k].phi);
    most = std::max(most, r.by_tilt[k].phi);
  }
  Plot plot({78, 116, 700, 440}, {0, 4, "tilt: length of the random part of the local direction"},
            {std::floor(50 * least) / 50, std::ceil(50 * most) / 50, "packing fraction φ"});
  plot.axes();
  add_curve(plot, tilts, phi[1], "line one heavy");
  add_curve(plot, tilts, phi[0], "line two dashed");
  legend_line(plot, 100, 62, "line one heavy", "with shaking");
  legend_line(plot, 340, 62, "line two dashed", "without");
  return {"han2005_tilts.svg",
          svg_document(730, 500,
                       fmt::format("What local directions and shaking buy, about {} spheres",
                                   r.by_tilt.back().packing.spheres.size()),
                       std::move(plot).finish())};
}

File time_figure(const std::vector<double>& ns, const std::vector<double>& seconds) {
  const auto decades = [](double least, double most, std::string_view label) {
    const double from = std::pow(10, std::floor(std::log10(least))),
                 to = std::pow(10, std::ceil(std::log10(most)));
    return Axis{from, to > from ? to : 10 * from, label, Scale::logarithmic};
  };
  const auto [fewest, most] = std::ranges::minmax(ns);
  const auto [shortest, longest] = std::ranges::minmax(seconds);
  Plot plot({78, 116, 700, 440}, decades(fewest, most, "spheres N"), decades(shortest, longest, "seconds"));
  plot.axes();
  add_curve(plot, ns, seconds, "line one heavy");
  legend_line(plot, 100, 62, "line one heavy", "local directions, shaking, refilling");
  return {"han2005_time.svg",
          svg_document(730, 500, "Time to fill the cylinder, equal spheres", std::move(plot).finish())};
}

constexpr const char* page_text = R"(# Han, Feng & Owen (2005), done again

K. Han, Y. T. Feng, D. R. J. Owen: *Sphere packing with a geometric based compression algorithm*. Powder
Technology 155 (2005) 33–41. Written by `bernal reproduce han2005` in {:.0f} s on: {}. Seconds in the tables
are the processor's, of one thread a packing; all packings are certified free of overlap. `han2005.csv` has
every one of them.

## The cylinder

![packing](han2005_packing.svg)

{}
Printed is a cylinder that is filled by {} spheres on a 1.4 GHz PC; neither its dimensions nor the radii are in
the text. Here it is twice as high as its radius, and {} spheres, equal ones or with radii uniform between 1 and
2, are as large as makes them that packing fraction, and asked for. {}. Left to find places for as many as it
can, the same protocol comes to {:.4f} with equal ones.

## What each part of it buys

![protocols](han2005_protocols.svg)

The same spheres, as many as find a place. *Packing fraction*: of the cylinder. *Of the bed*: of the cylinder up
to twice the mean height of the spheres, which is what compression alone changes.

{}
The pages of the paper that we have describe compression along one global direction. A public summary of the
rest says that this leaves chains of spheres, that every sphere therefore gets a random local direction too, and
that shaking moves spheres across the global direction and breaks arches. With refilling, local directions alone
buy {}, shaking after that {}, shaking without local directions {}.
Different from the text: a sphere that has touched slides on, so that one direction alone comes to {:.4f}
already; and the end of a compression, where the potential along the global direction hardly falls, is that
summary's, with a threshold of our own.

## Local directions

![tilts](han2005_tilts.svg)

Spheres of which {} are 52.89 % of the cylinder, compressed and refilled. The tilt is the length of the random
part of the local direction; that of the global one is 1.

{}
## Time

![time](han2005_time.svg)

{}
{}The paper calls its search for contacts highly efficient; its own times over N are not in the text.
)";

/// By what the second is denser than the first, and longer at it.
std::string bought(const DonePacking& without, const DonePacking& with) {
  return fmt::format("{:+.4f} for {:.2g} times the time", with.phi - without.phi,
                     with.seconds / without.seconds);
}

std::string page_of(const HanResults& r, const PowerLaw& law, double seconds) {
  std::vector<std::vector<std::string>> printed = {{"printed", fmt::format("{}", printed_spheres),
                                                    fmt::format("{:.4f}", printed_phi),
                                                    fmt::format("{:.0f}", printed_seconds)}};
  const char* names[] = {"here, equal spheres", "here, radii from 1 to 2"};
  for (std::size_t k = 0; k < r.as_printed.size(); ++k)
    printed.push_back({names[k], std::to_string(r.as_printed[k].packing.spheres.size()),
                       fmt::format("{:.4f}", r.as_printed[k].phi),
                       fmt::format("{:.1f}", r.as_printed[k].seconds)});
  std::vector<std::vector<std::string>> by_protocol, by_tilt, by_count;
  for (std::size_t k = 0; k < r.by_protocol.size(); ++k) {
    const DonePacking& d = r.by_protocol[k];
    by_protocol.push_back({protocols[k].name, std::to_string(d.packing.spheres.size()),
                           fmt::format("{:.4f}", d.phi), fmt::format("{:.4f}", phi_of_bed(d)),
                           fmt::format("{:.2f}", d.seconds)});
  }
  for (std::size_t k = 0; k + 1 < r.by_tilt.size(); k += 2)
    by_tilt.push_back({fmt::format("{:g}", tilts[k / 2]), fmt::format("{:.4f}", r.by_tilt[k].phi),
                       fmt::format("{:.2f}", r.by_tilt[k].seconds),
                       fmt::format("{:.4f}", r.by_tilt[k + 1].phi),
                       fmt::format("{:.2f}", r.by_tilt[k + 1].seconds)});
  for (const DonePacking& d : r.by_count)
    by_count.push_back({std::to_string(d.packing.spheres.size()), fmt::format("{:.4f}", d.phi),
                        fmt::format("{:.2f}", d.seconds)});
  const auto& p = r.by_protocol;
  const bool reached = std::ranges::all_of(
      r.as_printed, [&](const DonePacking& d) { return std::ssize(d.packing.spheres.r) == r.spheres; });
  const std::string law_text = r.by_count.size() > 1
                                   ? fmt::format("Fitted: N^({:.2f} ± {:.2f}). ", law.exponent, law.error)
                                   : std::string();
  return fmt::format(
      page_text, seconds, processor_name(),
      markdown_table({"", "spheres", "packing fraction", "seconds"}, printed), printed_spheres, r.spheres,
      reached ? "Both are reached" : "Not all find a place: near walls there are too many of so few",
      p[whole].phi,
      markdown_table({"protocol", "spheres", "packing fraction", "of the bed", "seconds"}, by_protocol),
      bought(p[4], p[6]), bought(p[6], p[7]), bought(p[4], p[5]), p[4].phi, r.for_tilts,
      markdown_table({"tilt", "without shaking", "seconds", "with shaking", "seconds"}, by_tilt),
      markdown_table({"spheres", "packing fraction", "seconds"}, by_count), law_text);
}

}  // namespace

/// Han, Feng & Owen (2005): the cylinder, what local directions and shaking buy, and the time it takes.
Files han_2005(const FigureOptions& options) {
  const Stopwatch watch;
  const auto at_most = [&](int n) { return options.spheres > 0 ? std::min(n, options.spheres) : n; };
  HanResults r{.as_printed = {},
               .by_protocol = {},
               .by_tilt = {},
               .by_count = {},
               .counted = {},
               .spheres = at_most(printed_spheres),
               .for_tilts = at_most(counted_for_tilts)};
  for (const int n : counts)
    if (r.counted.empty() || n <= at_most(n)) r.counted.push_back(at_most(n));

  std::vector<PackingTask> tasks = {as_printed_by_han(r.spheres, true, options),
                                    as_printed_by_han(r.spheres, false, options)};
  for (const Protocol& p : protocols) tasks.push_back(filled(r.spheres, p, options));
  for (const double tilt : tilts)
    for (const bool shaken : {false, true})
      tasks.push_back(filled(r.for_tilts, tilted(tilt, shaken), options));
  for (const int n : r.counted) tasks.push_back(filled(n, protocols[whole], options));

  std::optional<std::vector<DonePacking>> done = pack_all(tasks, "han2005", options);
  if (!done) return {};
  auto next = std::make_move_iterator(done->begin());
  const auto take = [&](std::vector<DonePacking>& group, std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) group.push_back(*next++);
  };
  take(r.as_printed, 2);
  take(r.by_protocol, std::size(protocols));
  take(r.by_tilt, 2 * std::size(tilts));
  take(r.by_count, r.counted.size());

  std::vector<double> ns, seconds;
  for (const DonePacking& d : r.by_count) {
    ns.push_back(static_cast<double>(d.packing.spheres.size()));
    seconds.push_back(d.seconds);
  }
  const PowerLaw law = ns.size() > 1 ? fitted_power(ns, seconds) : PowerLaw{};
  const Packing& shown = r.as_printed.back().packing;
  return {{"han2005.md", page_of(r, law, watch.seconds())},
          {"han2005.csv", csv_of(r)},
          {"han2005_packing.svg", svg_of(shown.spheres, shown.domain, "")},
          protocols_figure(r),
          tilts_figure(r),
          time_figure(ns, seconds)};
}

}  // namespace bernal::figures
