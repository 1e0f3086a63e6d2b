#include <fmt/format.h>

#include "engine/engine_files.hpp"
#include "engine/script_parts.hpp"

namespace bernal::engine {
namespace {

/// Walls have a type of their own, the last.
constexpr std::string_view liggghts_wall =
    "all wall/gran model hooke/stiffness tangential off primitive type";

std::string plane(int axis, std::string_view name, double at, int type) {
  return fmt::format("fix {} {} {} {}plane {}\n", name, liggghts_wall, type, "xyz"[axis], at);
}

struct LiggghtsWalls {
  int type;

  std::string operator()(const Box& box) const {
    std::string lines;
    for (int k = 0; k < 3; ++k) {
      if (!box.has_wall(k)) continue;
      lines += plane(k, fmt::format("lower_{}", "xyz"[k]), box.corner[k], type);
      lines += plane(k, fmt::format("upper_{}", "xyz"[k]), box.corner[k] + box.size[k], type);
    }
    return lines;
  }
  std::string operator()(const Cylinder& cylinder) const {
    const int axis = cylinder.coordinate_axis();
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;  // as they follow it in x, y, z, x
    std::string lines = fmt::format("fix side {} {} {}cylinder {} {} {}\n", liggghts_wall, type, "xyz"[axis],
                                    cylinder.radius, cylinder.base[u], cylinder.base[v]);
    if (cylinder.periodic) return lines;
    const Bounds<3> bounds = bounds_of(Domain(cylinder));
    lines += plane(axis, "base", bounds.lower[axis], type);
    return lines + plane(axis, "top", bounds.upper[axis], type);
  }
  std::string operator()(const Sphere&) const { return {}; }
  std::string operator()(const Mesh&) const {
    return fmt::format(
        "fix surface all mesh/surface file {} type {} verbose no\n"
        "fix walls all wall/gran model hooke/stiffness tangential off mesh n_meshes 1 meshes surface\n",
        walls_name, type);
  }
  std::string operator()(const Polygon&) const { return {}; }
};

/// A number for each pair of types, the walls' being the last.
std::string of_pairs(int types, double spheres, double walls) {
  std::string text;
  for (int i = 1; i <= types; ++i)
    for (int j = 1; j <= types; ++j)
      text += fmt::format(" {:.1f}", i == types || j == types ? walls : spheres);
  return text;
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
  for (const auto& [name, property, spheres, walls] : {std::tuple{"stiffness", "kn", 1.0, 4.0},
                                                       {"stiffness_t", "kt", 0.0, 0.0},
                                                       {"damping", "gamman", 1.0, 1.0},
                                                       {"damping_t", "gammat", 0.0, 0.0},
                                                       {"friction", "coefficientFriction", 0.0, 0.0}})
    text += fmt::format("fix {} all property/global {} peratomtypepair {}{}\n", name, property, types,
                        of_pairs(types, spheres, walls));
  text += "pair_style gran model hooke/stiffness tangential off\npair_coeff * *\n";
  text += std::visit(LiggghtsWalls{types}, task.domain) +
          guards(task, [types](int axis, double low, double high) {
            return plane(axis, fmt::format("guard_lower_{}", "xyz"[axis]), low, types) +
                   plane(axis, fmt::format("guard_upper_{}", "xyz"[axis]), high, types);
          });
  text += fmt::format(
      "fix motion all nve/limit absolute {}\ntimestep 0.3\n"
      "thermo {}\nthermo_style custom step atoms ke vol\nthermo_modify flush yes lost error norm no\n",
      longest_move(task), steps_a_report(task));
  text += runs_of(task);
  const auto [names, format] = columns_of_result(task);
  return text + fmt::format(
                    "dump places all custom 1 {} {}\n"
                    "dump_modify places format \"{}\"\nrun 0\nundump places\n"
                    "print \"{}\"\n",
                    places_name, names, format, last_words);
}

}  // namespace bernal::engine
