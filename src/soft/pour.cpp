#include "soft/pour.hpp"

#include <algorithm>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "bernal/core/dimension.hpp"
#include "soft/relax.hpp"

namespace bernal {
namespace {

/// Where the spheres find no room below the level, it rises by so much of the bed, the next time twice as
/// much.
constexpr double first_rise = 0.05;
/// A level is at least so high above the ground, in largest radii.
constexpr double room_for_largest = 2.05;

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

/// Work on some of the sequence by themselves, with nothing in its place.
Work work_on(const std::vector<std::uint32_t>& tags, const Work& work) {
  return {.spheres = Spheres<dynamic>(3),
          .target = work.target,
          .attainable = work.attainable,
          .domain = work.domain,
          .exact_place = work.exact_place,
          .supply = std::make_shared<Supply>(work.supply->of(tags)),
          .seed = work.seed,
          .monitor = work.monitor,
          .effects = work.effects,
          .on_course = work.on_course,
          .streams_used = work.streams_used};
}

/// What stands in a bed.
struct Ground {
  double top = -std::numeric_limits<double>::infinity();  ///< no sphere reaches higher
  std::vector<bool> placed;                               ///< by their tags

  Ground(const Bed& bed, const Vector<3>& up) {
    for (Bed::Id i = 0; i < bed.size(); ++i) {
      top = std::max(top, up.dot(bed[i].center) + bed[i].r + bed.skin());
      if (placed.size() <= bed.tag(i)) placed.resize(bed.tag(i) + std::size_t{1}, false);
      placed[bed.tag(i)] = true;
    }
  }

  std::vector<std::uint32_t> others(std::size_t wanted) const {
    std::vector<std::uint32_t> tags;
    for (std::uint32_t tag = 0; tag < wanted; ++tag)
      if (tag >= placed.size() || !placed[tag]) tags.push_back(tag);
    return tags;
  }
};

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

StageEnd pour(Work& work, const BedTop& top, const Heights& heights, double aim) {
  const std::shared_ptr<const Container> whole = work.container;
  const Ground ground(work.bed(), top.up());
  const std::vector<std::uint32_t> tags = ground.others(work.supply->wanted());
  if (tags.empty()) return StageEnd::converged;

  const double given = work.target.bed.above_ground;
  const double height = given > 0 ? heights.ground() + given : std::numeric_limits<double>::infinity();
  const double below = heights.volume_below(ground.top), room = heights.volume_below(height) - below;
  double volume = 0, largest = 0;
  for (const std::uint32_t tag : std::span(tags).first(std::min(tags.size(), work.target_count()))) {
    volume += ball_volume(3, work.supply->radius(tag));
    largest = std::max(largest, work.supply->radius(tag));
  }
  // A layer is no shallower than its largest sphere.
  const double floor = std::max(heights.ground(), ground.top);
  volume = std::max(volume / aim, heights.volume_below(floor + room_for_largest * largest) - below);

  Work poured = work_on(tags, work);
  if (!work.target.fill && (given > 0 || volume > room)) {
    poured.target = Target{};  // as many as are expected to fit
    poured.attainable = aim;
    volume = room;
  }
  StageEnd end = StageEnd::full;
  for (double rise = first_rise; end == StageEnd::full && room > 0; volume *= 1 + rise, rise *= 2) {
    const bool to_the_brim = below + volume >= whole->volume();
    std::vector<Facet> ends;
    if (!to_the_brim) ends = top.planes(given > 0 ? height : heights.holding(below + volume));
    if (below > 0) ends.push_back({.kind = Facet::Kind::plane, .a = ground.top * top.up(), .b = top.up()});
    change_container(
        poured, ends.empty() ? whole : cut_by_planes(whole, ends, std::min(volume, whole->volume() - below)));
    end = relax_in_container(poured, {});
    if (to_the_brim || poured.target.is_open()) break;
    // What fits only touching both the level and walls is squeezed in: the level is too low.
    if (poured.is_snug(largest) && !work.is_snug(largest)) end = StageEnd::full;
  }
  work.streams_used = poured.streams_used;
  if (poured.stands_in_bed()) put_in_bed(poured.bed(), tags, ground.placed, work);
  return end;
}

}  // namespace bernal
