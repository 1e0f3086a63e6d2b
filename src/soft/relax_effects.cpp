// What relaxation brings with it, and what that costs: one core, seconds and bytes. The constants are fitted
// to runs of 300 to 30,000 spheres; tests/bench/estimates_table holds the estimates against runs.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "jam/polish.hpp"
#include "soft/device_spheres.hpp"
#include "soft/relax.hpp"
#include "soft/relax_wide.hpp"
#include "soft/soft_blocks.hpp"

namespace bernal {
namespace {

constexpr double microsecond = 1e-6;

/// A sphere and sweep against that of three dimensions, by dimension; from four on one after the other, as in
/// tilted boxes.
constexpr double by_dimension[] = {12, 0.55, 1, 5.5, 13, 17, 22, 28};
constexpr double in_tilted_box = 6;
/// Sizes that differ make longer lists: the power of their spread that a sphere costs more.
constexpr double cost_of_spread = 1, cost_of_spread_in_bed = 1.5;
/// The same in boxes where they are wide: of what equal spheres take, and the power of their spread.
constexpr double share_of_wide = 0.75, cost_of_wide_spread = 0.75;
/// More than so many take a little more each, as it takes longer until they lie as densely.
constexpr double many = 1e4, cost_of_many = 0.08;
/// A box that grows, for each sphere and (log10 N)²: at the start and the end, and for each unit of alpha.
constexpr double cycles_at_ends = 0.29 * microsecond, cycles_of_alpha = 0.57 * microsecond;
constexpr double most_in_cycles = 1e4;
/// Spheres that start in a box they soon fit into, of that.
constexpr double share_in_a_loose_box = 0.1, loose_box = 0.9;
/// Of that, what spheres take that start at phi0 = h times what is attainable: `from_loose`, and more by so
/// much from `loose_start` on; beyond that of the default with a power of it.
constexpr double loose_start = 0.9, from_loose = 0.05, cost_of_overlap = 3, default_start = 1.336,
                 power_of_start = 1.25;
/// The power of beta over its default.
constexpr double power_of_beta = 0.9, default_beta = 30;
/// The most of a sphere and sweep in a container.
constexpr double longest_sweep = 0.2 * microsecond;
/// The published loop against the fast one.
constexpr double reference_factor = 70;
/// On a GPU of 2022: until it answers, what the processor does before and after, and of what that would take
/// for the rest. From 10^5 to 10^7 spheres.
constexpr double until_gpu_answers = 0.4, beside_gpu = 0.17 * microsecond, share_on_gpu = 0.005;
/// Of a domain of fixed size, for each sphere, h being what is asked for over what is attainable:
/// first + difficulty / (limit - h)².
struct Hardness {
  double first, difficulty, limit, most;
  double of(double h) const { return first + difficulty / std::pow(limit - std::min(h, most), 2); }
};
constexpr Hardness between_walls{2, 0.25, 1.093, 1.03}, in_given_box{2, 0.1, 1.055, 1.02};
/// As many as can be placed: those for which there is no room are tried, too.
constexpr double factor_of_filling = 8;
/// A disc between walls against a sphere. Of as many as can be placed more go in than are expected, and so
/// more are tried: 150 to 20,000 of two sizes or lognormal took 320 to 840 µs each.
constexpr double disc_in_bed = 0.45, factor_of_filling_flat = 32;
/// Where all are at walls, they have so many times more to try.
constexpr double cost_of_walls = 2;
/// Lists, of the whole.
constexpr double share_of_lists = 0.2;
/// Sizes that are exchanged: each sphere; at least, from so many on; and the power of their spread.
constexpr double exchange_in_box = 680 * microsecond, exchange_in_bed = 3000 * microsecond;
constexpr double least_of_exchange = 1.5, spheres_of_least = 300, power_of_exchange = 0.85;
/// To walls, of a sphere.
constexpr double questions = 6;
constexpr double bytes_a_sphere = 130, bytes_of_lists = 200;
/// In blocks, in which the places are sorted.
constexpr double bytes_in_blocks = 85, bytes_of_lists_in_blocks = 75;

double dimension_factor(const Outlook& outlook) {
  const int dimension = outlook.task.dimension;
  return by_dimension[static_cast<std::size_t>(dimension - 1)] *
         (outlook.task.is_tilted ? in_tilted_box : 1) *
         std::pow(std::max(1.0, outlook.spheres / many), cost_of_many);
}

double seconds_in_growing_box(const Relax& options, const Outlook& outlook) {
  const double decades = std::log10(std::clamp(outlook.spheres, 2.0, most_in_cycles));
  const double alpha = options.period ? *options.period / (decades * decades) : options.alpha;
  const double cycles = cycles_at_ends + cycles_of_alpha * alpha;
  const bool wide = is_for_wide_sizes(outlook.task, options);  // these are packed densely and then parted
  const double asked = outlook.task.packing_fraction;
  const bool is_loose = !wide && asked > 0 && asked < loose_box * outlook.task.attainable;
  const double share_if_loose = is_loose ? share_in_a_loose_box : 1;
  const double h = options.phi0.value_or(0) / outlook.task.attainable;
  const double start = options.phi0 && !wide
                           ? std::clamp(from_loose + cost_of_overlap * (h - loose_start), from_loose, 1.0) *
                                 std::max(1.0, std::pow(h / default_start, power_of_start))
                           : 1;
  const double method = options.method == RelaxMethod::fast ? 1 : reference_factor;
  return method * std::pow(options.beta / default_beta, power_of_beta) *
         (start > 1 ? share_if_loose * start : std::min(share_if_loose, start)) * outlook.spheres * decades *
         decades * cycles * dimension_factor(outlook) *
         (wide ? share_of_wide * std::pow(outlook.spread, cost_of_wide_spread)
               : std::pow(outlook.spread, cost_of_spread));
}

double seconds_of_exchange(const Outlook& outlook) {
  return by_dimension[static_cast<std::size_t>(outlook.task.dimension - 1)] *
         (least_of_exchange * std::min(1.0, outlook.spheres / spheres_of_least) +
          exchange_in_box * outlook.spheres * std::pow(outlook.spread, power_of_exchange));
}

double seconds_in_bed(const Relax& options, const Outlook& outlook) {
  const double hardness = outlook.aim / outlook.task.attainable;
  const bool flat = outlook.task.dimension == 2;
  const double filling = !outlook.is_filled ? 1 : flat ? factor_of_filling_flat : factor_of_filling;
  const double seconds = microsecond * (flat ? disc_in_bed : 1) * outlook.spheres *
                         between_walls.of(hardness) * std::pow(outlook.spread, cost_of_spread_in_bed) *
                         (1 + cost_of_walls * outlook.at_walls) * filling;
  const double most = options.sweeps * longest_sweep * outlook.spheres;
  return std::min({seconds, most, options.seconds > 0 ? options.seconds : seconds});
}

/// Throws Error for what only the processor does, and where there is no GPU.
void require_gpu_suits(const Relax& options, const Outlook& outlook) {
  const auto refuse = [](const char* what) {
    throw Error(ErrorCode::bad_argument,
                fmt::format("on a GPU relax {}; leave \"device\" out, and the processor packs", what));
  };
  if (outlook.in_bed || outlook.task.has_walls) refuse("knows no walls");
  if (outlook.task.dimension != 3) refuse("knows three dimensions only");
  if (options.method != RelaxMethod::fast) refuse("knows no \"method\" but fast");
  if (is_for_wide_sizes(outlook.task, options)) refuse("knows no sizes as wide as these");
  require_gpu();
}

}  // namespace

std::vector<PlanItem> effects_of_pushing(double seconds, const Outlook& outlook, std::string what) {
  const bool in_blocks = outlook.task.dimension <= 3 && outlook.spheres >= SoftBlocks::fewest_spheres;
  return {neighbor_lists(share_of_lists * seconds,
                         (in_blocks ? bytes_of_lists_in_blocks : bytes_of_lists) * outlook.spheres),
          {.name = "relaxation",
           .what = std::move(what),
           .cost = "some 1,000 sweeps of O(N)",
           .seconds = seconds,
           .bytes = (in_blocks ? bytes_in_blocks : bytes_a_sphere) * outlook.spheres}};
}

double seconds_of_filling_box(const Outlook& outlook) {
  return microsecond * outlook.spheres * in_given_box.of(outlook.aim / outlook.task.attainable) *
         dimension_factor(outlook) * std::pow(outlook.spread, cost_of_spread);
}

std::vector<PlanItem> effects_of_relaxation(const Relax& options, const Outlook& outlook) {
  std::vector<PlanItem> items;
  if (outlook.in_bed) {
    const PlanItem walls = questions_to_walls(questions, outlook);
    const bool is_dilute =
        outlook.task.packing_fraction > 0 && outlook.aim <= dilute * outlook.task.attainable;
    items = effects_of_pushing(is_dilute ? 0 : walls.seconds + seconds_in_bed(options, outlook), outlook,
                               "spheres and walls push; what is stuck is stirred or put into holes");
    items.insert(items.begin(), {.name = "insertion",
                                 .what = is_dilute ? "random places, which are enough for so few"
                                                   : "random places for what is left over",
                                 .cost = "O(1) a trial",
                                 .seconds = is_dilute ? 2 * microsecond * outlook.spheres : 0,
                                 .if_needed = !is_dilute});
    items.push_back(walls);
    for (PlanItem& item : items)
      if (item.name != "insertion" && item.name != "walls" && is_dilute) item.if_needed = true;
  } else {
    const bool wide = is_for_wide_sizes(outlook.task, options);
    const double seconds = seconds_in_growing_box(options, outlook);
    items = effects_of_pushing(
        options.device == RelaxDevice::gpu
            ? until_gpu_answers + beside_gpu * outlook.spheres + share_on_gpu * seconds
            : seconds,
        outlook,
        wide && !outlook.placed ? "sizes are wide: the largest are relaxed first, the others come into what "
                                  "they leave; then all push while the box grows by the mean overlap"
        : wide                  ? "sizes are wide: the box grows by the mean overlap while they push"
        : options.device == RelaxDevice::gpu ? "spheres push each other apart on a GPU while the box grows"
        : options.method == RelaxMethod::fast
            ? "spheres push each other apart while the box grows"
            : "the published loop while the box grows, on linked lists in cells");
    if (options.method != RelaxMethod::fast)
      items.erase(items.begin());  // it looks into cells
    else if (outlook.placed)
      items.front().if_needed = true;  // what hardly overlaps is only let grow
  }
  if (options.device == RelaxDevice::gpu) require_gpu_suits(options, outlook);
  if (options.exchange && options.method != RelaxMethod::fast)
    throw Error(ErrorCode::bad_argument,
                "the reference method of relax knows no exchange of sizes; leave \"method\" out");
  if (options.exchange && outlook.gain > 1) {
    const double seconds = outlook.in_bed ? exchange_in_bed * outlook.spheres : seconds_of_exchange(outlook);
    items.push_back({.name = "exchange",
                     .what = "sizes are dealt anew again and again: disordered but optimised, not poured",
                     .cost = "6,000 deals and 30,000 sweeps, O(N) each",
                     .seconds = seconds,
                     .if_needed = outlook.in_bed && !outlook.is_filled});
  }
  if (options.polish > 0) add_polishing(items, outlook);
  return items;
}

}  // namespace bernal
