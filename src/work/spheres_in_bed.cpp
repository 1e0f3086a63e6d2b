#include "work/spheres_in_bed.hpp"

#include <algorithm>

namespace bernal {
namespace {

/// A container that is smaller is not the whole domain; its middle is not its roomiest place, which matters
/// where a few of the largest radii are less than that.
constexpr double part_of_domain = 1 - 1e-9, well_within = 2;

}  // namespace

void FirstDrawn::extend(std::size_t count, const Supply& supply) {
  while (spheres.size() < count)
    spheres.push_back(Vector<3>::Zero(), supply.radius(static_cast<std::uint32_t>(spheres.size())));
  placed.resize(spheres.size(), false);
}

SpheresInBed::SpheresInBed(const Task& of, std::shared_ptr<Supply> drawn, EffectLog& effects)
    : task(of),
      supply(std::move(drawn)),
      bed_(std::make_unique<Bed>(*task.container, supply->smallest(), supply->largest(), supply->wanted(),
                                 effects)) {}

std::size_t SpheresInBed::target_count() const {
  const Target& target = task.target;
  return target.is_open() && !target.fill ? count_filling(task.attainable) : supply->wanted();
}

FirstDrawn SpheresInBed::drawn(std::size_t count) const {
  for (Bed::Id i = 0; i < bed().size(); ++i) count = std::max<std::size_t>(count, bed().tag(i) + 1);
  FirstDrawn drawn;
  drawn.extend(count, *supply);
  for (Bed::Id i = 0; i < bed().size(); ++i) {
    drawn.spheres.set_center(bed().tag(i), bed()[i].center);
    drawn.placed[bed().tag(i)] = true;
  }
  return drawn;
}

double SpheresInBed::volume_of(const Spheres<3>& spheres) const {
  double volume = 0;
  for (const double r : spheres.r) volume += ball_volume(bed().dimension(), r);
  return volume;
}

const Room& SpheresInBed::roomiest() const {
  if (!roomiest_) {
    const Container& container = *task.container;
    // Of one place in the middle, where nothing is nearer than what bounds the largest sphere, that is known.
    const Room middle{container.bounds().center(), container.clearance(container.bounds().center())};
    roomiest_ = middle;
    const bool is_part = container.volume() < part_of_domain * bernal::volume_of(task.domain);
    if (is_faceted(task.domain) || (is_part && middle.radius < well_within * supply->largest())) {
      const LargestRoom known = largest_room(container);
      if (is_faceted(task.domain) || known.radius > middle.radius) roomiest_ = known;
    }
  }
  return *roomiest_;
}

bool SpheresInBed::fits_in_bed(const Vector<3>& place, double r) const {
  if (bed().fits(place, r)) return true;
  if (!task.exact_place || !is_snug(r) || !bed().fits_between_spheres(place, r)) return false;
  return task.exact_place(place, r) == place;
}

bool SpheresInBed::put_in_bed(const Spheres<3>& first) {
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

void SpheresInBed::put_back(const FirstDrawn& drawn) {
  bed().remove_tags_from(0);
  for (std::uint32_t tag = 0; tag < drawn.placed.size(); ++tag)
    if (drawn.placed[tag]) bed().insert(drawn.spheres.center(tag), drawn.spheres.r[tag], tag);
  supply->set_placed(drawn.placed);
}

void SpheresInBed::archive_bed(Archive& a, EffectLog& effects) {
  a(*supply);
  Bed::Sizes sizes = bed().made_for();
  a(sizes);
  if (a.reads())
    bed_ = std::make_unique<Bed>(*task.container, sizes.r_min, sizes.r_max, sizes.expected, effects);
  a(*bed_);
}

}  // namespace bernal
