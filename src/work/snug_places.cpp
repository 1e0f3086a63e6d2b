#include "work/snug_places.hpp"

#include <algorithm>
#include <functional>
#include <vector>

namespace bernal {
namespace {

constexpr int probes = 200, most_starts = 30;
/// So many spheres take about a tenth of a second.
constexpr std::size_t milestone_every = 64;
/// In skins: what a sphere is to be clear by, a little more than the bed asks for.
constexpr double clear = 1.01;
/// In radii: what places that only touch may seem to overlap the wall by, before they are made exact.
constexpr double seemingly = 1e-10;
/// In radii: the longest step, along an axis, of a sphere that nearly touches to where it does; it may lead
/// aside as well.
constexpr double last_step = 1e-5;

}  // namespace

SnugPlaces::SnugPlaces(SpheresInBed& in_bed, Reporter& report)
    : in_bed_(in_bed),
      report_(report),
      random_(report.seed, stream(Stream::room, 1)),
      along_(Vector<3>::Zero()) {
  int longest;
  in_bed.task.container->bounds().size().maxCoeff(&longest);
  along_[longest] = -1;
}

bool SnugPlaces::needed(double r) {
  if (r <= roomy_) return false;
  if (r >= tight_) return true;
  const Bed& bed = in_bed_.bed();
  for (int k = 0; k < probes; ++k) {
    if (!bed.container().contains(bed.places().draw(random_), r + bed.skin())) continue;
    roomy_ = r;
    return false;
  }
  tight_ = r;
  return true;
}

std::optional<Vector<3>> SnugPlaces::from(const Vector<3>& start, double r, bool touching) const {
  const Bed& bed = in_bed_.bed();
  const Container& container = bed.container();
  const double clearance = container.clearance(start);
  if (!(clearance > 0)) return {};
  const double give = touching ? clear * bed.skin() : 0;
  const double enough = r + clear * bed.skin();
  const Surroundings surroundings = bed.surroundings(give);
  const double step = 2 * r;
  const Room top =
      climb(room_at(start, 2 * clearance, surroundings), enough, step, surroundings, bed.dimension());
  if (touching) {
    if (top.radius < enough - seemingly * r || !in_bed_.task.exact_place) return {};
    // Back a little from where it would touch what is not to be touched.
    const Room end = slide(top, std::min(top.radius, enough), along_, step, surroundings, bed.dimension());
    const double way = along_.dot(end.place - top.place), back = std::min(way, 2 * give);
    for (const Vector<3>& from_here : {Vector<3>(end.place - back * along_), top.place}) {
      const std::optional<Vector<3>> place = in_bed_.task.exact_place(from_here, r);
      if (place && bed.fits_between_spheres(*place, r)) return place;
    }
    return {};
  }
  if (top.radius < enough) return {};
  const Vector<3> place = slide(top, enough, along_, step, surroundings, bed.dimension()).place;
  return bed.fits(place, r) ? std::optional(place) : std::nullopt;
}

/// A chamber may leave no room though the roomiest does.
std::optional<Vector<3>> SnugPlaces::from(const Vector<3>& start, double r) const {
  if (!in_bed_.is_snug(r + (clear - 1) * in_bed_.bed().skin()))
    if (const auto place = from(start, r, false)) return place;
  return from(start, r, true);
}

std::optional<Vector<3>> SnugPlaces::find(double r) {
  if (const auto place = from(in_bed_.roomiest().place, r)) return place;
  for (int k = 0; k < most_starts; ++k)
    if (const auto place = from(in_bed_.bed().places().draw(random_), r)) return place;
  return {};
}

bool SnugPlaces::all_touch() {
  const double smallest = in_bed_.supply->smallest();
  return needed(smallest) && in_bed_.task.exact_place && in_bed_.is_snug(smallest);
}

void SnugPlaces::move_to_touch(Spheres<3>& spheres) {
  in_bed_.put_in_bed({});
  const Bed& bed = in_bed_.bed();
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const double r = spheres.r[i];
    const Vector<3> center = spheres.center(i);
    const double reach = 2 * bed.container().clearance(center);
    if (!(reach > 0)) continue;
    const Room top = climb(room_at(center, reach, bed.surroundings()), r + bed.skin(), last_step * r,
                           bed.surroundings(), bed.dimension());
    if (const auto place = in_bed_.task.exact_place(top.place, r)) spheres.set_center(i, *place);
  }
}

bool SnugPlaces::only_some_touch() {
  const Supply& supply = *in_bed_.supply;
  return in_bed_.bed().size() == 0 && !in_bed_.task.target.is_open() && needed(supply.largest()) &&
         !needed(supply.smallest()) && in_bed_.is_snug(supply.largest());
}

void SnugPlaces::place_those_that_touch() {
  Supply& supply = *in_bed_.supply;
  std::vector<std::uint32_t> tags;
  for (std::uint32_t tag = 0; tag < supply.wanted(); ++tag)
    if (in_bed_.is_snug(supply.radius(tag))) tags.push_back(tag);
  std::ranges::stable_sort(tags, std::greater<>(), [&](std::uint32_t tag) { return supply.radius(tag); });
  std::vector<std::uint32_t> placed;
  for (const std::uint32_t tag : tags) {
    if (report_.monitor.stop()) throw Cancelled();
    const auto place = find(supply.radius(tag));
    if (!place) break;  // nor is there one for the next, which is hardly smaller
    in_bed_.bed().insert(*place, supply.radius(tag), tag);
    placed.push_back(tag);
  }
  std::ranges::sort(placed);
  supply.take_first(placed);
}

std::size_t SnugPlaces::place_waiting(double packing_fraction) {
  Supply& supply = *in_bed_.supply;
  std::size_t placed = 0, waiting = 0;
  while (waiting < supply.window().size() && in_bed_.bed().packing_fraction() < packing_fraction) {
    if (report_.monitor.stop()) throw Cancelled();
    const std::uint32_t tag = supply.window()[waiting];
    const double r = supply.radius(tag);
    const auto place = needed(r) ? find(r) : std::nullopt;
    if (!place) {
      ++waiting;
      continue;
    }
    in_bed_.bed().insert(*place, r, tag);
    supply.take(waiting);
    if (++placed % milestone_every == 0) report_.milestone("insert", in_bed_.bed());
  }
  return placed;
}

void SnugPlaces::complete(double packing_fraction) {
  place_waiting(packing_fraction);
  const Supply& supply = *in_bed_.supply;
  if (supply.window().empty() || in_bed_.bed().packing_fraction() >= packing_fraction) return;
  if (!needed(supply.smallest())) return;
  const BedKeepsake before(in_bed_);
  in_bed_.put_in_bed({});
  try {
    place_waiting(packing_fraction);
  } catch (const Cancelled&) {
    before.give_back_if_denser(in_bed_);
    throw;
  }
  before.give_back_if_denser(in_bed_);
}

}  // namespace bernal
