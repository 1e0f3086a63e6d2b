#include "work/keepsake.hpp"

namespace bernal {
namespace {

double packing_fraction_of(const Work& work) {
  if (work.stands_in_bed()) return work.bed().packing_fraction();
  return work.placed ? work.volume_of_spheres() / work.edges.prod() : 0;
}

}  // namespace

Keepsake::Keepsake(const Work& work) : packing_fraction_(packing_fraction_of(work)) {
  if (!(packing_fraction_ > 0)) return;
  if (work.stands_in_bed()) {
    const Bed& bed = work.bed();
    for (Bed::Id i = 0; i < bed.size(); ++i) bed_.push_back({bed[i].center, bed[i].r, bed.tag(i)});
  } else {
    spheres_ = work.spheres;
    edges_ = work.edges;
    needed_volume_ = work.needed_volume;
  }
}

void Keepsake::give_back_if_denser(Work& work) const {
  if (packing_fraction_of(work) >= packing_fraction_) return;
  if (!work.stands_in_bed()) {
    work.spheres = spheres_;
    work.edges = edges_;
    work.needed_volume = needed_volume_;
    work.placed = true;
    work.placed_share = 1;
    return;
  }
  Bed& bed = work.bed();
  bed.remove_tags_from(0);
  std::vector<bool> placed;
  for (const Ball& ball : bed_) {
    bed.insert(ball.center, ball.r, ball.tag);
    placed.resize(std::max<std::size_t>(placed.size(), ball.tag + std::size_t{1}), false);
    placed[ball.tag] = true;
  }
  work.supply->set_placed(placed);
}

}  // namespace bernal
