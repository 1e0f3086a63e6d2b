#include "settle/insert.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>
#include <vector>

#include "work/random_insertion.hpp"
#include "work/snug_places.hpp"

namespace bernal {
namespace {

/// A milestone, and a look at whether the user wants to stop, every so many spheres.
constexpr std::size_t milestone_every = 8192;
/// For each place inside a container: in one so thin and oblique that more are beyond it, spheres wait.
constexpr double most_drawn = 1000;
/// Where random insertion ends with 100, 1,000 and 10,000 attempts, as a share of what relaxation reaches
/// there, of spheres and of discs: from fills of boxes, equal and uniform sizes, of 39 to 9,300; all met this
/// within 0.03. Fewer attempts fall short of what can be expected, which is then told.
constexpr double least_decades = 2;
constexpr std::array share_inserted = {0.335, 0.44, 0.51}, share_inserted_flat = {0.475, 0.56, 0.62};

/// Where a stage reaches less than this of what is likely to fit, insertion is tried as well.
constexpr double far_short = 0.8;
/// And with so few spheres of a count always, as it takes no time.
constexpr std::size_t few = 1000;
/// So many that are left over in the end, or with this share of the volume, may still find places by
/// themselves.
constexpr std::size_t last_few = 16;
constexpr double last_share = 0.01;

double share_of_container(const SpheresInBed& in_bed, std::size_t count) {
  return in_bed.volume_of_drawn(count) / in_bed.task.container->volume();
}

bool falls_short(const SpheresInBed& in_bed) {
  const double wanted = share_of_container(in_bed, in_bed.target_count());
  return in_bed.bed().packing_fraction() < far_short * std::min(wanted, in_bed.task.attainable);
}

bool hardly_any_left(const SpheresInBed& in_bed) {
  if (in_bed.task.target.is_open()) return in_bed.task.target.fill;
  const std::size_t wanted = in_bed.supply->wanted();
  return in_bed.bed().size() + last_few >= wanted ||
         in_bed.bed().packing_fraction() >= (1 - last_share) * share_of_container(in_bed, wanted);
}

/// From an empty bed. Where the sizes are left open they keep their order, as the largest of them would not
/// be what was drawn.
StageEnd insert_if_denser(SpheresInBed& in_bed, Reporter& report, StageEnd end) {
  const BedKeepsake packed(in_bed);
  const double before = in_bed.bed().packing_fraction();
  StageEnd inserted = StageEnd::full;
  try {
    if (in_bed.task.target.is_open()) {
      in_bed.put_in_bed({});
      inserted = insert(until_full, in_bed, report);
    } else {
      inserted = insert_largest_first(in_bed, report, before);
    }
  } catch (const Cancelled&) {
    packed.give_back_if_denser(in_bed);
    throw;
  }
  packed.give_back_if_denser(in_bed);
  if (inserted == StageEnd::cancelled) return inserted;
  return in_bed.bed().packing_fraction() > before ? inserted : end;
}

double full_at_random(const Insert& options, const EmptyBed& bed) {
  const auto& shares = bed.dimension == 2 ? share_inserted_flat : share_inserted;
  const double decades = std::clamp(std::log10(options.attempts) - least_decades, 0.0, shares.size() - 1.0);
  const auto k = std::min(static_cast<std::size_t>(decades), shares.size() - 2);
  return bed.relaxed * std::lerp(shares[k], shares[k + 1], decades - static_cast<double>(k));
}

}  // namespace

StageEnd insert(const Insert& options, SpheresInBed& in_bed, Reporter& report) {
  if (options.is_crystal()) return insert_crystal(options, in_bed, report);
  if (options.layout == Layout::lattice) return insert_on_lattice(options, in_bed, report);
  const EffectTimer timer(report.effects["insertion"]);
  Bed& bed = in_bed.bed();
  Supply& supply = *in_bed.supply;
  Random random = report.random(Stream::insert);
  // Trials are counted inside the container; places are drawn a little beyond it, too.
  const double attempts =
      options.attempts * std::clamp(bed.places().volume() / bed.container().volume(), 1.0, most_drawn);
  SnugPlaces snug(in_bed, report);
  std::size_t waiting = 0;  // so many at the head of the window found no place
  const Resumable part(report, "insert", [&](Archive& a) { a(random, waiting, snug); });
  if (!part.resumed() && snug.only_some_touch()) snug.place_those_that_touch();
  bool goes_on = part.resumed();
  do {
    if (!std::exchange(goes_on, false)) waiting = 0;
    while (waiting < supply.window().size() && bed.packing_fraction() < options.until()) {
      if (report.stop()) return StageEnd::cancelled;
      const std::uint32_t tag = supply.window()[waiting];
      const double r = supply.radius(tag);
      const auto place = find_place(
          attempts, [&] { return bed.places().draw(random); },
          [&](const Vector<3>& c) { return bed.fits(c, r); }, report.monitor);
      if (!place) {
        ++waiting;
        continue;
      }
      bed.insert(*place, r, tag);
      supply.take(waiting);
      if (bed.size() % milestone_every == 0) report.milestone("insert", bed);
    }
  } while (waiting > 0 && snug.place_waiting(options.until()) > 0);
  return waiting > 0 && waiting == supply.window().size() ? StageEnd::full : StageEnd::converged;
}

StageEnd insert_largest_first(SpheresInBed& in_bed, Reporter& report, double densest_so_far) {
  constexpr double many_attempts = 1000, few_attempts = 100;
  constexpr int many_failures = 200;  // after which every sphere gets few
  constexpr int most_searches = 10;   // in vain
  constexpr int most_in_a_row = 20;   // of one size that find no place, before the rest of it is passed over
  const EffectTimer timer(report.effects["insertion"]);
  in_bed.put_in_bed({});
  Bed& bed = in_bed.bed();
  const Supply& supply = *in_bed.supply;
  const std::size_t count = in_bed.target_count();
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::stable_sort(order, std::greater<>(), [&](std::uint32_t tag) { return supply.radius(tag); });
  double within_reach = in_bed.volume_of_drawn(count);  // if all that follow find a place
  const double enough = densest_so_far * bed.container().volume();

  Random random = report.random(Stream::insert);
  SnugPlaces snug(in_bed, report);
  std::vector<bool> placed(count, false);
  double without_place = 0;
  int in_a_row = 0, failures = 0;
  for (const std::uint32_t tag : order) {
    if (report.monitor.stop()) throw Cancelled();
    const double r = supply.radius(tag);
    if (r != without_place) in_a_row = 0;
    if (within_reach < enough) break;
    if (in_a_row == most_in_a_row) {
      within_reach -= ball_volume(bed.dimension(), r);
      continue;
    }
    std::optional<Vector<3>> place;
    if (!snug.needed(r))
      place = find_place(
          failures < many_failures ? many_attempts : few_attempts, [&] { return bed.places().draw(random); },
          [&](const Vector<3>& c) { return bed.fits(c, r); }, report.monitor);
    if (!place && failures < most_searches) place = snug.find(r);
    if (place) {
      bed.insert(*place, r, tag);
      placed[tag] = true;
    } else {
      without_place = r;
      within_reach -= ball_volume(bed.dimension(), r);
      ++in_a_row;
      ++failures;
    }
  }
  in_bed.supply->set_placed(placed, false);
  return bed.size() == count ? StageEnd::converged : StageEnd::full;
}

StageEnd insert_what_else_fits(SpheresInBed& in_bed, Reporter& report, StageEnd end) {
  if (end != StageEnd::full) return end;
  const NotResumable rest(report);
  const bool few_wanted = !in_bed.task.target.is_open() && in_bed.target_count() <= few;
  if (few_wanted || falls_short(in_bed)) end = insert_if_denser(in_bed, report, end);
  return end == StageEnd::full && hardly_any_left(in_bed) ? insert(until_full, in_bed, report) : end;
}

template <>
const StageEntry& entry_of<Insert>() {
  using namespace schema;
  static const StageEntry entry = {
      .table = stage_table<Insert>(
          {.name = "insert",
           .help = "place spheres where they overlap nothing, at random or on a lattice",
           .keys = {word(&Insert::layout, "layout",
                         "random places, or a lattice: face-centred, of discs hexagonal, as wide as holds "
                         "what is to be placed, its sites taken in random order; or a crystal from the floor "
                         "up: face-centred or body-centred cubic, hexagonal close-packed, simple cubic",
                         {"random", "lattice", "fcc", "bcc", "hcp", "sc"}),
                    length(&Insert::spacing, "spacing",
                           "of a crystal, the distance of a site from the nearest others; if absent the "
                           "largest spheres touch"),
                    buys_accuracy({1, 10, 100, 1000, 10000},
                                  integer(&Insert::attempts, "attempts",
                                          "places tried for one sphere before it has to wait, on a lattice "
                                          "for the next finer one",
                                          {1, 1e9})),
                    number(&Insert::packing_fraction, "packing_fraction",
                           "where insertion stops; if absent 0.3, of a crystal at its last site",
                           packing_fractions())},
           .complete = completion(complete_insert)},
          {.in_bed = true,
           .in_box = true,
           .in_plane = true,
           .in_repeated_mesh = true,
           .prefers_bed = true,
           .least_dimension = 2,
           .most_dimensions = 3,
           .is_default_in_plane = true,
           .reaches = Reaches::insertion}),
      .act_in_bed = of_options(insert),
      .act_in_box = of_options(insert_crystal_in_box),
      .may_bring = {"insertion"},
      .effects = of_options(effects_of_insertion),
      .reached = of_options(+[](const Insert& options) { return options.until(); }),
      .gain = of_options(gain_of_crystal),
      .full = of_options(+[](const Insert& options, const EmptyBed& bed) {
        if (options.is_crystal()) return full_crystal(options, bed);
        return options.layout == Layout::lattice ? full_lattice(bed) : full_at_random(options, bed);
      })};
  return entry;
}

}  // namespace bernal
