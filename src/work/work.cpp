#include "work/work.hpp"

#include <algorithm>

namespace bernal {
namespace {

/// Of what is likely to fit: where it is left open how many spheres there are, and a bed holds less than
/// this, a stage that works in a box starts anew with all.
constexpr double nearly_all = 0.7;
/// A container that is smaller is not the whole domain; its middle is not its roomiest place, which matters
/// where a few of the largest radii are less than that.
constexpr double part_of_domain = 1 - 1e-9, well_within = 2;

/// Which of the drawn sequence the radii are, which come in its order but for some that are left out.
std::vector<std::uint32_t> tags_of(const std::vector<double>& radii, const Supply& supply) {
  std::vector<std::uint32_t> tags;
  std::uint32_t tag = 0;
  for (const double r : radii) {
    while (supply.radius(tag) != r) ++tag;
    tags.push_back(tag++);
  }
  return tags;
}

double packing_fraction_of(const Work& work) {
  if (work.stands_in_bed()) return work.bed().packing_fraction();
  return work.placed ? work.volume_of_spheres() / work.edges.prod() : 0;
}

}  // namespace

void Work::Drawn::extend(std::size_t count, const Supply& supply) {
  while (spheres.size() < count)
    spheres.push_back(Vector<3>::Zero(), supply.radius(static_cast<std::uint32_t>(spheres.size())));
  placed.resize(spheres.size(), false);
}

double Work::volume_of_drawn(std::size_t count) const {
  double volume = 0;
  for (const double r : drawn(count).spheres.r) volume += ball_volume(dimension(), r);
  return volume;
}

std::size_t Work::count_filling(double packing_fraction) const {
  return supply->count_filling(packing_fraction * container->volume());
}

std::size_t Work::target_count() const {
  return target.is_open() && !target.fill ? count_filling(attainable) : supply->wanted();
}

Work::Drawn Work::drawn(std::size_t count) const {
  for (Bed::Id i = 0; i < bed().size(); ++i) count = std::max<std::size_t>(count, bed().tag(i) + 1);
  Drawn drawn;
  drawn.extend(count, *supply);
  for (Bed::Id i = 0; i < bed().size(); ++i) {
    drawn.spheres.set_center(bed().tag(i), bed()[i].center);
    drawn.placed[bed().tag(i)] = true;
  }
  return drawn;
}

Work Work::alone(const std::vector<std::uint32_t>& tags) const {
  return {.spheres = Spheres<dynamic>(dimension()),
          .edges = {},
          .target = target,
          .attainable = attainable,
          .domain = domain,
          .exact_place = exact_place,
          .supply = std::make_shared<Supply>(supply->of(tags)),
          .seed = seed,
          .monitor = monitor,
          .effects = effects,
          .streams_used = streams_used};
}

const Room& Work::roomiest() const {
  if (!roomiest_) {
    // Of one place in the middle, where nothing is nearer than what bounds the largest sphere, that is known.
    const Room middle{container->bounds().center(), container->clearance(container->bounds().center())};
    roomiest_ = middle;
    const bool is_part = container->volume() < part_of_domain * volume_of(domain);
    if (is_faceted(domain) || (is_part && middle.radius < well_within * supply->largest())) {
      const LargestRoom known = largest_room(*container);
      if (is_faceted(domain) || known.radius > middle.radius) roomiest_ = Room{known.place, known.radius};
    }
  }
  return *roomiest_;
}

bool Work::fits_in_bed(const Vector<3>& place, double r) const {
  if (bed().fits(place, r)) return true;
  if (!exact_place || !is_snug(r) || !bed().fits_between_spheres(place, r)) return false;
  return exact_place(place, r) == place;
}

bool Work::put_in_bed(const Spheres<3>& first) {
  bed().remove_tags_from(0);
  std::vector<bool> fits(first.size(), true);
  if (bed().insert_if_all_fit(first)) {
    supply->set_placed(fits);
    return true;
  }
  for (std::size_t i = 0; i < first.size(); ++i) {
    fits[i] = fits_in_bed(first.center(i), first.r[i]);
    if (fits[i]) bed().insert(first.center(i), first.r[i], static_cast<std::uint32_t>(i));
  }
  supply->set_placed(fits);
  return bed().size() == first.size();
}

void Work::insert_in_bed(const Spheres<dynamic>& others,
                         const std::function<bool(const Vector<3>&, double)>& may_stand) {
  const std::vector<std::uint32_t> tags = tags_of(others.r, *supply);
  std::vector<bool> has_place(tags.empty() ? 0 : tags.back() + std::size_t{1}, false);
  for (std::size_t i = 0; i < others.size(); ++i) {
    const Vector<3> place = place_in_bed(others.center(i));
    if (may_stand && !may_stand(place, others.r[i])) continue;
    bed_->insert(place, others.r[i], tags[i]);
    has_place[tags[i]] = true;
  }
  supply->set_placed(has_place);
}

void Work::stand_in_bed() {
  if (bed_) return;
  bed_ = std::make_shared<Bed>(*container, supply->smallest(), supply->largest(), supply->wanted(), effects);
  if (!placed) {
    spheres = Spheres<dynamic>(dimension());
    return;
  }
  const Vector<dynamic> asked = bounds_of<dynamic>(domain).size();
  // In a box whose edges are not larger they overlap nothing; its walls were kept clear by a bound.
  const bool too_large = (edges.array() > asked.array()).any();
  insert_in_bed(spheres, [&](const Vector<3>& place, double r) {
    return too_large ? fits_in_bed(place, r) : container->contains(place, r);
  });
  edges = asked;
  placed = false;
  spheres = Spheres<dynamic>(dimension());
}

void Work::stand_in_box() {
  if (!bed_) return;
  spheres = bed_->spheres_as_packed();
  const double enough = nearly_all * attainable * volume_of(domain);
  placed = target.is_open() ? volume_of_spheres() >= enough && !spheres.empty()
                            : spheres.size() == supply->wanted();
  if (!placed) {  // what is to come has to find its place among the others: all start anew
    spheres = Spheres<dynamic>(dimension());
    spheres.resize(target.is_open() ? supply->count_filling(attainable * volume_of(domain))
                                    : supply->wanted());
    for (std::size_t i = 0; i < spheres.size(); ++i)
      spheres.r[i] = supply->radius(static_cast<std::uint32_t>(i));
  }
  edges = bounds_of<dynamic>(domain).size();
  target_edges = edges;
  bed_ = nullptr;
}

void Work::archive_bed(Archive& a) {
  a(*supply);
  Bed::Sizes sizes = bed_ ? bed_->made_for() : Bed::Sizes{};
  a(sizes);
  if (a.reads()) bed_ = std::make_shared<Bed>(*container, sizes.r_min, sizes.r_max, sizes.expected, effects);
  a(*bed_);
}

void Work::milestone(std::string_view stage) const {
  if (!on_course) return;
  on_course({.stage = stage,
             .spheres = bed().size(),
             .packing_fraction = bed().packing_fraction(),
             .potential = bed().potential(-Vector<3>::Unit(bed().dimension() - 1))});
}

void Work::milestone(std::string_view stage, double done, double max_overlap) const {
  if (on_course) box_milestone(stage, volume_of_spheres(), done, max_overlap);
}

void Work::box_milestone(std::string_view stage, double volume, double done, double max_overlap,
                         bool for_history) const {
  if (!on_course) return;
  on_course({.stage = stage,
             .spheres = placed_share < 1 ? placed_count : spheres.size(),
             .packing_fraction = placed_share * volume / edges.prod(),
             .max_overlap = max_overlap,
             .done = done,
             .for_history = for_history});
}

void Work::crowd_milestone(std::string_view stage, std::size_t count, double volume, double max_overlap,
                           double done) const {
  if (!on_course) return;
  on_course({.stage = stage,
             .spheres = count,
             .packing_fraction = volume / container->volume(),
             .max_overlap = max_overlap,
             .done = std::clamp(done, 0.0, 0.99)});
}

Keepsake::Keepsake(const Work& work)
    : in_bed_(work.stands_in_bed()),
      packing_fraction_(packing_fraction_of(work)),
      edges_(in_bed_ ? bounds_of<dynamic>(work.domain).size() : work.edges),
      needed_volume_(work.needed_volume) {
  if (packing_fraction_ > 0) spheres_ = work.stands_in_bed() ? work.bed().spheres_as_packed() : work.spheres;
}

void Keepsake::give_back_if_denser(Work& work) const {
  // A box that is larger than the one that was asked for is no place for what had one in that.
  const bool too_large = in_bed_ && !work.stands_in_bed() && work.edges != *work.target_edges;
  if (!too_large && packing_fraction_of(work) >= packing_fraction_) return;
  if (in_bed_) {
    work.placed = false;
    work.edges = edges_;
    work.stand_in_bed();
    work.bed().remove_tags_from(0);
    work.insert_in_bed(spheres_);
    return;
  }
  work.spheres = spheres_;
  work.edges = edges_;
  work.needed_volume = needed_volume_;
  work.placed = true;
  work.placed_share = 1;
}

}  // namespace bernal
