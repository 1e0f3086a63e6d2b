#include "engine/engine_task.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace bernal::engine {
namespace {

/// So many classes at most; the last takes all that is larger.
constexpr int most_classes = 24;
/// Room beyond walls, in largest diameters.
constexpr double beyond_walls = 1.5;

}  // namespace

double EngineTask::mean_radius() const {
  return std::accumulate(spheres.r.begin(), spheres.r.end(), 0.0) / static_cast<double>(spheres.size());
}

double EngineTask::mass(double r) const { return std::max(1.0, r * r); }

SizeClasses size_classes(const std::vector<double>& radii) {
  SizeClasses classes;
  const double least = std::ranges::min(radii);
  std::vector<int> octaves;
  octaves.reserve(radii.size());
  for (const double r : radii)
    octaves.push_back(
        std::min(most_classes - 1, static_cast<int>(std::log(r / least) / std::log(class_width))));
  std::vector<int> numbers(most_classes, -1);  // of those that occur
  for (const int octave : octaves) numbers[static_cast<std::size_t>(octave)] = 0;
  classes.count = 0;
  for (int& number : numbers)
    if (number == 0) number = classes.count++;
  classes.of.reserve(radii.size());
  for (const int octave : octaves)
    classes.of.push_back(static_cast<std::uint8_t>(numbers[static_cast<std::size_t>(octave)]));
  return classes;
}

Bounds<3> region_of(const EngineTask& task) {
  Bounds<3> region = bounds_of(task.domain);
  const double margin = beyond_walls * 2 * std::ranges::max(task.spheres.r);
  const Box* box = std::get_if<Box>(&task.domain);
  const Cylinder* cylinder = std::get_if<Cylinder>(&task.domain);
  for (int k = 0; k < 3; ++k) {
    const bool repeats =
        (box && box->repeats(k)) || (cylinder && cylinder->periodic && cylinder->coordinate_axis() == k);
    if (repeats) continue;
    region.lower[k] -= margin;
    region.upper[k] += margin;
  }
  return region;
}

}  // namespace bernal::engine
