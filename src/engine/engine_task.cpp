#include "engine/engine_task.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>

namespace bernal::engine {
namespace {

/// Room beyond walls, in largest diameters.
constexpr double beyond_walls = 1.5;

}  // namespace

double EngineTask::mass(double r) const { return pouring ? r * r * r : std::max(1.0, r * r); }

double Pouring::gravity(const TaskSpheres& spheres) const {
  constexpr double pressed = 2e-4;
  return pressed / (layers * spheres.mean * spheres.mean);  // of mass mean³
}

double Pouring::time_step(const TaskSpheres& spheres) const {
  constexpr double share_of_contact = 0.1;
  return share_of_contact * std::numbers::pi * std::sqrt(0.5 * std::pow(spheres.least, 3));
}

int Pouring::steps_of_fall(const TaskSpheres& spheres) const {
  const double time = std::sqrt(2 * fall * 2 * spheres.mean / gravity(spheres));
  return static_cast<int>(std::clamp(std::ceil(time / time_step(spheres)), 100.0, 1e8));
}

std::size_t SizeClasses::octave(double r) const {
  return std::min(most - 1, static_cast<std::size_t>(std::log(r / least) / std::log(class_width)));
}

TaskSpheres told(TaskSpheres::Tell tell) {
  TaskSpheres spheres{.least = std::numeric_limits<double>::infinity(), .for_each = std::move(tell)};
  double sum = 0;
  spheres.for_each([&](const Vector<3>&, double r) {
    ++spheres.count;
    spheres.least = std::min(spheres.least, r);
    spheres.largest = std::max(spheres.largest, r);
    sum += r;
  });
  spheres.mean = sum / static_cast<double>(spheres.count);
  SizeClasses& classes = spheres.classes;
  classes.least = spheres.least;
  if (spheres.least == spheres.largest) return spheres;
  std::array<bool, SizeClasses::most> occurs{};
  spheres.for_each([&](const Vector<3>&, double r) { occurs[classes.octave(r)] = true; });
  classes.count = 0;
  for (std::size_t k = 0; k < occurs.size(); ++k)
    if (occurs[k]) classes.numbers[k] = classes.count++;
  return spheres;
}

TaskSpheres told(Spheres<3> spheres) {
  return told(
      [held = std::make_shared<const Spheres<3>>(std::move(spheres))](const TaskSpheres::Visit& visit) {
        for (std::size_t i = 0; i < held->size(); ++i) visit(held->center(i), held->r[i]);
      });
}

Bounds<3> region_of(const EngineTask& task) {
  Bounds<3> region = bounds_of(task.domain);
  const double margin = beyond_walls * 2 * task.spheres.largest;
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
