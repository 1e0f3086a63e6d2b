#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include "engine/engine_files.hpp"
#include "engine/script_parts.hpp"

namespace bernal::engine {
namespace {

/// Of spheres and walls: soft ones without friction, or those that are poured.
std::string_view contact_of(const EngineTask& task) {
  return task.pouring ? "hooke/stiffness tangential history" : "hooke/stiffness tangential off";
}

/// Walls have a type of their own, the last.
std::string wall_of(const EngineTask& task) {
  return fmt::format("all wall/gran model {}", contact_of(task));
}

std::string plane(const EngineTask& task, int axis, std::string_view name, double at, int type) {
  return fmt::format("fix {} {} primitive type {} {}plane {}\n", name, wall_of(task), type, "xyz"[axis], at);
}

struct LiggghtsWalls {
  const EngineTask& task;
  int type;

  std::string operator()(const Box& box) const {
    std::string lines;
    for (int k = 0; k < 3; ++k) {
      if (!box.has_wall(k)) continue;
      lines += plane(task, k, fmt::format("lower_{}", "xyz"[k]), box.corner[k], type);
      lines += plane(task, k, fmt::format("upper_{}", "xyz"[k]), box.corner[k] + box.size[k], type);
    }
    return lines;
  }
  std::string operator()(const Cylinder& cylinder) const {
    const int axis = cylinder.coordinate_axis();
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;  // as they follow it in x, y, z, x
    std::string lines = fmt::format("fix side {} primitive type {} {}cylinder {} {} {}\n", wall_of(task),
                                    type, "xyz"[axis], cylinder.radius, cylinder.base[u], cylinder.base[v]);
    if (cylinder.periodic) return lines;
    const Bounds<3> bounds = bounds_of(Domain(cylinder));
    lines += plane(task, axis, "base", bounds.lower[axis], type);
    return lines + plane(task, axis, "top", bounds.upper[axis], type);
  }
  std::string operator()(const Sphere&) const { return {}; }
  std::string operator()(const Mesh&) const {
    return fmt::format(
        "fix surface all mesh/surface file {} type {} verbose no\n"
        "fix walls {} mesh n_meshes 1 meshes surface\n",
        walls_name, type, wall_of(task));
  }
  std::string operator()(const Polygon&) const { return {}; }
  std::string operator()(const Revolved&) const { return {}; }
};

/// A number for each pair of types, the walls' being the last.
std::string of_pairs(int types, double spheres, double walls) {
  std::string text;
  for (int i = 1; i <= types; ++i)
    for (int j = 1; j <= types; ++j) text += fmt::format(" {}", i == types || j == types ? walls : spheres);
  return text;
}

/// A property of pairs: between spheres, and with walls.
struct PairProperty {
  std::string_view name, property;
  double spheres, walls;
};

std::vector<PairProperty> properties_of(const EngineTask& task) {
  if (!task.pouring)
    return {{"stiffness", "kn", 1, 4},
            {"stiffness_t", "kt", 0, 0},
            {"damping", "gamman", 1, 1},
            {"damping_t", "gammat", 0, 0},
            {"friction", "coefficientFriction", 0, 0}};
  // Of a linear spring and dashpot: restitution exp(-pi g / sqrt(4 k / m - g²)), m of two mean spheres.
  const double log = -std::log(task.pouring->restitution), mass = 0.5 * std::pow(task.spheres.mean, 3);
  const double damping = 2 * log / std::hypot(std::numbers::pi, log) / std::sqrt(mass);
  constexpr double tangential = 2.0 / 7;
  return {{"stiffness", "kn", 1, 1},
          {"stiffness_t", "kt", tangential, tangential},
          {"damping", "gamman", damping, damping},
          {"damping_t", "gammat", 0.5 * damping, 0.5 * damping},
          {"friction", "coefficientFriction", task.pouring->friction, task.pouring->friction}};
}

/// Until all are at rest; where they do not come to it, the script ends before its last words.
std::string run_until_rest(const EngineTask& task) {
  const Pouring& pouring = *task.pouring;
  const TaskSpheres& spheres = task.spheres;
  const double gravity = pouring.gravity(spheres);
  constexpr double at_rest = 1e-7;
  constexpr int most_rounds = 200;
  double mass = 0;
  spheres.for_each([&](const Vector<3>&, double r) { mass += task.mass(r); });
  const int fall = pouring.steps_of_fall(spheres);
  return fmt::format(
      "run {}\nvariable energy equal ke\nvariable rounds loop {}\nlabel again\nrun {}\n"
      "if \"${{energy}} < {}\" then \"jump SELF rest\"\nnext rounds\njump SELF again\n"
      "print \"ERROR: the spheres have not come to rest\"\nquit 1\nlabel rest\n",
      fall, most_rounds, std::max(50, fall / 4), at_rest * mass * gravity * 2 * spheres.mean);
}

}  // namespace

std::string liggghts_script(const EngineTask& task) {
  // Its lists by classes of sizes miss neighbours: all sizes are looked for in the same cells.
  const int types = task.spheres.classes.count + 1;
  std::string text = fmt::format(
      "{}\n"
      "units si\natom_style granular\natom_modify map array\nboundary {}\nnewton off\n"
      "communicate single vel yes\nhard_particles no\n"
      "read_data {}\n"
      "neighbor {} bin\nneigh_modify delay 0 every 1 check yes\n",
      about_script(task), boundary_words(task.domain), data_name, skin_of(task));
  for (const auto& [name, property, spheres, walls] : properties_of(task))
    text += fmt::format("fix {} all property/global {} peratomtypepair {}{}\n", name, property, types,
                        of_pairs(types, spheres, walls));
  text += fmt::format("pair_style gran model {}\npair_coeff * *\n", contact_of(task));
  text += std::visit(LiggghtsWalls{task, types}, task.domain) +
          guards(task, [&](int axis, double low, double high) {
            return plane(task, axis, fmt::format("guard_lower_{}", "xyz"[axis]), low, types) +
                   plane(task, axis, fmt::format("guard_upper_{}", "xyz"[axis]), high, types);
          });
  if (const auto& pouring = task.pouring)
    text += fmt::format("fix down all gravity {} vector {} {} {}\nfix motion all nve/sphere\ntimestep {}\n",
                        pouring->gravity(task.spheres), pouring->down[0], pouring->down[1], pouring->down[2],
                        pouring->time_step(task.spheres));
  else
    text += fmt::format("fix motion all nve/limit absolute {}\ntimestep 0.3\n", longest_move(task));
  text += fmt::format(
      "thermo {}\nthermo_style custom step atoms ke vol\nthermo_modify flush yes lost error norm no\n",
      steps_a_report(task));
  text += task.pouring ? run_until_rest(task) : runs_of(task);
  const auto [names, format] = columns_of_result(task);
  return text + fmt::format(
                    "dump places all custom 1 {} {}\n"
                    "dump_modify places format \"{}\"\nrun 0\nundump places\n"
                    "print \"{}\"\n",
                    places_name, names, format, last_words);
}

}  // namespace bernal::engine
