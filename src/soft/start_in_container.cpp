#include "soft/start_in_container.hpp"

#include <algorithm>

#include "core/parallel.hpp"
#include "work/clear_place.hpp"

namespace bernal {
namespace {

/// More than what is likely to fit, in shares of it, is not tried at once.
constexpr double most_of_attainable = 1.1;
constexpr std::size_t places_a_task = 1024;

}  // namespace

Spheres<3> spheres_to_start_from(const SpheresInBed& in_bed, const Relax& options, double larger_by,
                                 Random& random, const Monitor& monitor) {
  const Task& task = in_bed.task;
  const double attainable = options.exchange ? task.fill_task.attainable : task.attainable;
  const double most = (task.target.fill ? 1 : most_of_attainable) * attainable;
  const std::size_t count = std::min(in_bed.target_count(), in_bed.count_filling(most));
  auto [spheres, placed] = in_bed.drawn(std::max<std::size_t>(1, count));
  const Spheres<3>& begun = in_bed.crowded_start;
  const Bed& bed = in_bed.bed();
  const std::uint64_t seed = random();
  const Interruptible listening(monitor);
  parallel_ranges(spheres.size(), places_a_task, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      if (placed[i]) continue;
      Random own(seed, i);
      spheres.set_center(i, i < begun.size()
                                ? begun.center(i)
                                : clear_place(spheres.r[i], bed.container(), bed.places(), own, monitor));
    }
  });
  for (double& r : spheres.r) r += larger_by;
  return spheres;
}

}  // namespace bernal
