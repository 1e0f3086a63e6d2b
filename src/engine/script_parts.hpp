#pragma once
#include <algorithm>
#include <functional>
#include <string>

#include <fmt/format.h>

#include "engine/engine_task.hpp"

namespace bernal::engine {

// What the scripts of both engines have in common.

/// What a script prints last, when its result is whole.
inline constexpr const char* last_words = "bernal: all places are written";

/// How a script begins that bernal has written.
inline constexpr const char* script_mark = "# bernal: ";

inline std::string about_script(const EngineTask& task) {
  if (task.pouring)
    return script_mark + fmt::format("{} spheres are poured; the mean radius is {:.3g}, stiffness is 1",
                                     task.spheres.count, task.spheres.mean);
  return script_mark +
         fmt::format("{} soft spheres push each other apart; the mean radius is {:.3g}, stiffness is 1",
                     task.spheres.count, task.spheres.mean);
}

/// "p p f"
inline std::string boundary_words(const Domain& domain) {
  std::string words;
  for (int k = 0; k < 3; ++k) {
    const Box* box = std::get_if<Box>(&domain);
    const Cylinder* cylinder = std::get_if<Cylinder>(&domain);
    const bool repeats =
        (box && box->repeats(k)) || (cylinder && cylinder->periodic && cylinder->coordinate_axis() == k);
    words += k == 0 ? "" : " ";
    words += repeats ? 'p' : 'f';
  }
  return words;
}

/// Of neighbour lists: they last some tens of steps while spheres push hard, and hundreds at the end.
inline double skin_of(const EngineTask& task) { return 0.6 * task.spheres.mean; }
inline double longest_move(const EngineTask& task) { return 0.2 * task.spheres.mean; }
inline int steps_a_report(const EngineTask& task) { return std::max(1, task.steps / 100); }

/// As many small spheres as may be in reach of a large one that is `ratio` times as large, while they
/// overlap.
inline long neighbours_of_one(double ratio) {
  return static_cast<long>(std::clamp(20 * (1 + ratio) * (1 + ratio) * (1 + ratio), 2000.0, 500'000.0));
}

/// Planes about all that there is, so that what has slipped through a wall is not lost.
inline std::string guards(const EngineTask& task,
                          const std::function<std::string(int, double low, double high)>& planes) {
  if (std::holds_alternative<Box>(task.domain)) return {};
  const std::string repeats = boundary_words(task.domain);
  const Bounds<3> bounds = bounds_of(task.domain);
  const double give = task.spheres.largest;
  std::string lines;
  for (int k = 0; k < 3; ++k)
    if (repeats[static_cast<std::size_t>(2 * k)] == 'f')
      lines += planes(k, bounds.lower[k] - give, bounds.upper[k] + give);
  return lines;
}

inline std::string runs_of(const EngineTask& task) {
  if (task.growth == 1) return fmt::format("run {}\n", task.steps);
  return fmt::format(
      "run {0}\nfix growth all deform 1 x scale {1} y scale {1} z scale {1} remap x\nrun {2}\n"
      "unfix growth\nrun {3}\n",
      task.steps_before(), task.growth, task.steps_of_growth(), task.steps_after());
}

/// What the result says of each sphere.
struct ColumnsOfResult {
  std::string_view names, format;
};
inline ColumnsOfResult columns_of_result(const EngineTask& task) {
  if (task.tells_radii) return {"id x y z radius", "%d %.17g %.17g %.17g %.17g"};
  return {"id x y z", "%d %.17g %.17g %.17g"};
}

}  // namespace bernal::engine
