#include "soft/pour.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "bernal/core/dimension.hpp"
#include "settle/roll_to_rest.hpp"
#include "soft/relax.hpp"

namespace bernal {
namespace {

/// Where the spheres find no room below the level, it rises by so much of the bed, the next time twice as
/// much.
constexpr double first_rise = 0.05, first_rise_tapped = 0.01;
/// Stirring hardly helps those that were tapped.
constexpr int patience_with_tapped = 2;
/// A level is at least so high above the ground, in largest radii.
constexpr double room_for_largest = 2.05;
/// Lower beds, in largest diameters, have one layer.
constexpr double one_layer = 1.0005;
/// Vessels less wide, in mean radii, hold what happens to fit.
constexpr double narrow_vessel = 3;

/// The spheres of the bed in one of another container, those that fit, with their places in the sequence.
void change_container(Work& work, std::shared_ptr<const Container> to) {
  const std::shared_ptr<Bed> before = work.bed_;
  work.container = std::move(to);
  work.roomiest_.reset();
  work.bed_ = std::make_shared<Bed>(*work.container, work.supply->smallest(), work.supply->largest(),
                                    work.supply->wanted(), work.effects);
  if (!before) return;
  std::vector<bool> placed;
  for (Bed::Id i = 0; i < before->size(); ++i) {
    const std::uint32_t tag = before->tag(i);
    if (placed.size() <= tag) placed.resize(tag + std::size_t{1}, false);
    placed[tag] = work.fits_in_bed((*before)[i].center, (*before)[i].r);
    if (placed[tag]) work.bed_->insert((*before)[i].center, (*before)[i].r, tag);
  }
  work.supply->set_placed(placed);
}

/// Of the stage's progress, what relaxation takes.
constexpr double share_of_relaxation = 0.9;

/// What is told of relaxation in a part of the container is told of the whole, and never less than before.
std::function<void(const Course&)> as_of_whole(const Work& work, const Work& poured) {
  return [&work, &poured, furthest = 0.0](const Course& of_part) mutable {
    if (!work.on_course) return;
    Course course = of_part;
    course.stage = "settle";
    course.packing_fraction *= poured.container->volume() / work.container->volume();
    furthest = std::max(furthest, share_of_relaxation * course.done.value_or(0));
    course.done = furthest;
    work.on_course(course);
  };
}

void put_in_bed(const Bed& poured, const std::vector<std::uint32_t>& tags, std::vector<bool> placed,
                Work& work) {
  for (Bed::Id i = 0; i < poured.size(); ++i) {
    const std::uint32_t tag = tags[poured.tag(i)];
    if (placed.size() <= tag) placed.resize(tag + std::size_t{1}, false);
    placed[tag] = work.fits_in_bed(poured[i].center, poured[i].r);
    if (placed[tag]) work.bed().insert(poured[i].center, poured[i].r, tag);
  }
  work.supply->set_placed(placed);
}

}  // namespace

StageEnd rest_first(Work& work, const Vector<3>& down, double still) {
  const std::vector<bool> placed = work.drawn(0).placed;
  std::vector<std::uint32_t> tags;
  for (std::uint32_t tag = 0; tag < placed.size(); ++tag)
    if (placed[tag]) tags.push_back(tag);
  Work own = work.alone(tags);
  change_container(own, work.container);
  for (Bed::Id i = 0; i < work.bed().size(); ++i) {
    const auto at = std::ranges::lower_bound(tags, work.bed().tag(i)) - tags.begin();
    own.bed().insert(work.bed()[i].center, work.bed()[i].r, static_cast<std::uint32_t>(at));
  }
  const StageEnd end = roll_to_rest(own, down, {.still = still});
  work.bed().remove_tags_from(0);
  for (Bed::Id i = 0; i < own.bed().size(); ++i)
    work.bed().insert(own.bed()[i].center, own.bed()[i].r, tags[own.bed().tag(i)]);
  return end;
}

StageEnd pour(Work& work, const BedTop& top, const std::shared_ptr<const Container>& whole,
              const Heights& heights, Laying& how) {
  const std::vector<bool> placed = work.drawn(0).placed;
  std::vector<std::uint32_t> tags;
  for (std::uint32_t tag = 0; tag < work.supply->wanted(); ++tag)
    if (tag >= placed.size() || !placed[tag]) tags.push_back(tag);
  if (tags.empty()) return StageEnd::converged;
  const double ground = heights.ground();

  double volume = 0, largest = 0;
  const std::size_t wanted =
      work.target_count() - std::min<std::size_t>(work.target_count(), work.bed().size());
  const std::span first_tags = std::span(tags).first(std::min(tags.size(), wanted));
  for (const std::uint32_t tag : first_tags) {
    volume += ball_volume(3, work.supply->radius(tag));
    largest = std::max(largest, work.supply->radius(tag));
  }
  const double mean =
      std::cbrt(volume / ball_volume(3, 1) / std::max<double>(1, static_cast<double>(first_tags.size())));
  const double given = work.target.bed.above_ground;
  // One layer lies on the floor in the end, and may lie a little higher before.
  const double height = ground + (given < one_layer * 2 * largest ? one_layer * 2 * largest : given);
  const double room = given > 0 ? heights.volume_below(height) : whole->volume();
  // A layer is no shallower than its largest sphere.
  volume = std::max(volume / how.packing_fraction, heights.volume_below(ground + room_for_largest * largest));

  Work poured = work.alone(tags);
  poured.on_course = as_of_whole(work, poured);
  if (!work.target.fill && (given > 0 || volume > room)) {
    // As many as are expected to fit; where walls are near everywhere nobody knows, and all are tried.
    const bool is_narrow = work.roomiest().radius < narrow_vessel * mean && !how.is_aimed;
    if (!is_narrow)
      poured.target = Target{}, poured.attainable = how.packing_fraction;
    else if (given > 0)
      poured.target = Target{.fill = true};
    volume = room;
  }
  poured.crowded_start = work.crowded_start;
  StageEnd end = StageEnd::full;
  how.finds_room = true;
  for (double rise = how.taps > 0 ? first_rise_tapped : first_rise; end == StageEnd::full && room > 0;
       volume *= 1 + rise, rise *= 2) {
    const bool to_the_brim = volume >= whole->volume();
    change_container(
        poured, to_the_brim
                    ? whole
                    : cut_by_planes(whole, top.planes(given > 0 ? height : heights.holding(volume)), volume));
    if (how.taps > 0 && how.finds_room) tap(poured, how.taps, how.first_tap);
    end = relax_in_container(poured, {.patience = how.taps > 0 ? patience_with_tapped : Relax{}.patience});
    how.finds_room = how.finds_room && end != StageEnd::full;
    if (to_the_brim || given > 0 || poured.target.is_open()) break;
    // What fits only touching both the level and walls is squeezed in: the level is too low.
    if (poured.is_snug(largest) && !work.is_snug(largest)) end = StageEnd::full;
  }
  work.streams_used = poured.streams_used;
  if (how.taps > 0) work.crowded_start = poured.crowded_start;
  if (poured.stands_in_bed()) put_in_bed(poured.bed(), tags, placed, work);
  return end;
}

}  // namespace bernal
