#include "soft/pour.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
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

/// Of the stage's progress, what relaxation takes.
constexpr double share_of_relaxation = 0.9;

/// What is told of relaxation in a part of the container is told of the whole, and never less than before.
std::function<void(const StageProgress&)> as_of_whole(const Reporter& whole, const Task& task,
                                                      const Task& part) {
  return [&whole, &task, &part, furthest = 0.0](const StageProgress& of_part) mutable {
    if (!whole.on_progress) return;
    StageProgress progress = of_part;
    progress.stage = "settle";
    progress.packing_fraction *= part.container->volume() / task.container->volume();
    furthest = std::max(furthest, share_of_relaxation * progress.done.value_or(0));
    progress.done = furthest;
    whole.on_progress(progress);
  };
}

/// The spheres of another bed, those that fit, with their places in the sequence, in which others are
/// `placed` already.
template <class TagOf>
void take_over(SpheresInBed& in_bed, const Bed& other, TagOf&& tag_of, std::vector<bool> placed) {
  for (Bed::Id i = 0; i < other.size(); ++i) {
    const std::uint32_t tag = tag_of(other.tag(i));
    if (placed.size() <= tag) placed.resize(tag + std::size_t{1}, false);
    placed[tag] = in_bed.fits_in_bed(other[i].center, other[i].r);
    if (placed[tag]) in_bed.bed().insert(other[i].center, other[i].r, tag);
  }
  in_bed.supply->set_placed(placed);
}

/// Of spheres that were stopped while they still overlapped.
void keep_what_fits(SpheresInBed& in_bed) {
  Spheres<3> spheres = in_bed.crowded_start;
  for (std::uint32_t i = 0; i < spheres.size(); ++i) spheres.r[i] = in_bed.supply->radius(i);
  in_bed.put_in_bed(spheres);
}

}  // namespace

StageEnd rest_first(Bed& bed, const Reporter& report, const Vector<3>& down, double still) {
  if (bed.size() == 0) return StageEnd::converged;
  double smallest = bed[0].r, largest = smallest;
  for (Bed::Id i = 0; i < bed.size(); ++i) {
    smallest = std::min(smallest, bed[i].r);
    largest = std::max(largest, bed[i].r);
  }
  Bed own(bed.container(), smallest, largest, bed.size(), report.effects);
  for (Bed::Id i = 0; i < bed.size(); ++i) own.insert(bed[i].center, bed[i].r, bed.tag(i));
  Reporter of_own = report.alone();
  const StageEnd end = roll_to_rest(own, of_own, down, {.still = still});
  bed.remove_tags_from(0);
  for (Bed::Id i = 0; i < own.size(); ++i) bed.insert(own[i].center, own[i].r, own.tag(i));
  return end;
}

StageEnd pour(SpheresInBed& in_bed, Reporter& report, const BedTop& top,
              const std::shared_ptr<const Container>& whole, const Heights& heights, Laying& how) {
  const std::vector<bool> placed = in_bed.drawn(0).placed;
  std::vector<std::uint32_t> tags;
  for (std::uint32_t tag = 0; tag < in_bed.supply->wanted(); ++tag)
    if (tag >= placed.size() || !placed[tag]) tags.push_back(tag);
  if (tags.empty()) return StageEnd::converged;
  const double ground = heights.ground();

  double volume = 0, largest = 0;
  const std::size_t wanted =
      in_bed.target_count() - std::min<std::size_t>(in_bed.target_count(), in_bed.bed().size());
  const std::span first_tags = std::span(tags).first(std::min(tags.size(), wanted));
  for (const std::uint32_t tag : first_tags) {
    volume += ball_volume(3, in_bed.supply->radius(tag));
    largest = std::max(largest, in_bed.supply->radius(tag));
  }
  const double mean =
      std::cbrt(volume / ball_volume(3, 1) / std::max<double>(1, static_cast<double>(first_tags.size())));
  const double given = in_bed.task.target.bed.above_ground;
  // One layer lies on the floor in the end, and may lie a little higher before.
  const double height = ground + (given < one_layer * 2 * largest ? one_layer * 2 * largest : given);
  const double room = given > 0 ? heights.volume_below(height) : whole->volume();
  // A layer is no shallower than its largest sphere.
  volume = std::max(volume / how.packing_fraction, heights.volume_below(ground + room_for_largest * largest));

  Task part = in_bed.task;  // of the container
  Reporter of_part = report.alone();
  of_part.on_progress = as_of_whole(report, in_bed.task, part);
  if (!in_bed.task.target.fill && (given > 0 || volume > room)) {
    // As many as are expected to fit; where walls are near everywhere nobody knows, and all are tried.
    const bool is_narrow = in_bed.roomiest().radius < narrow_vessel * mean && !how.is_aimed;
    if (!is_narrow)
      part.target = Target{}, part.attainable = how.packing_fraction;
    else if (given > 0)
      part.target = Target{.fill = true};
    volume = room;
  }
  const auto supply = std::make_shared<Supply>(in_bed.supply->of(tags));
  std::optional<SpheresInBed> poured;
  StageEnd end = StageEnd::full;
  how.finds_room = true;
  for (double rise = how.taps > 0 ? first_rise_tapped : first_rise; end == StageEnd::full && room > 0;
       volume *= 1 + rise, rise *= 2) {
    const bool to_the_brim = volume >= whole->volume();
    const bool is_last = to_the_brim || given > 0 || part.target.is_open();
    const double level = given > 0 ? height : heights.holding(volume);
    part.container = to_the_brim ? whole : cut_by_planes(whole, top.planes(level), volume);
    SpheresInBed now(part, supply, report.effects);
    now.crowded_start = poured ? std::move(poured->crowded_start) : in_bed.crowded_start;
    if (poured) take_over(now, poured->bed(), std::identity(), {});
    poured.emplace(std::move(now));
    try {
      if (how.taps > 0 && how.finds_room) tap(*poured, of_part, how.taps, how.first_tap);
      end = relax_to_pour({.patience = how.taps > 0 ? patience_with_tapped : Relax{}.patience}, *poured,
                          of_part, !is_last);
    } catch (const Cancelled&) {
      end = StageEnd::cancelled;
      if (poured->bed().size() == 0) keep_what_fits(*poured);
    }
    how.finds_room = how.finds_room && end != StageEnd::full;
    if (is_last) break;
    // What fits only touching both the level and walls is squeezed in: the level is too low.
    if (poured->is_snug(largest) && !in_bed.is_snug(largest)) end = StageEnd::full;
  }
  report.streams_used = of_part.streams_used;
  if (!poured) return end;
  if (how.taps > 0) in_bed.crowded_start = poured->crowded_start;
  take_over(
      in_bed, poured->bed(), [&](std::uint32_t place) { return tags[place]; }, placed);
  return end;
}

}  // namespace bernal
