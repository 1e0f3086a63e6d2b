#include <fmt/format.h>

#include "engine/engine_files.hpp"
#include "engine/script_parts.hpp"

namespace bernal::engine {
namespace {

/// A fix wall/gran or wall/gran/region begins so: stiffness 4, damping 1, no friction.
constexpr std::string_view wall = "hooke 4.0 NULL 1.0 NULL 0.0 0";

std::string planes(int axis, std::string_view name, double low, double high) {
  return fmt::format("fix {} all wall/gran {} {}plane {} {}\n", name, wall, "xyz"[axis], low, high);
}

struct LammpsWalls {
  std::string operator()(const Box& box) const {
    std::string lines;
    for (int k = 0; k < 3; ++k)
      if (box.has_wall(k))
        lines += planes(k, fmt::format("walls_{}", "xyz"[k]), box.corner[k], box.corner[k] + box.size[k]);
    return lines;
  }
  std::string operator()(const Cylinder& cylinder) const {
    const int axis = cylinder.coordinate_axis(), u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
    const Bounds<3> bounds = bounds_of(Domain(cylinder));
    const std::string ends =
        cylinder.periodic ? "INF INF" : fmt::format("{} {}", bounds.lower[axis], bounds.upper[axis]);
    return fmt::format("region inside cylinder {} {} {} {} {} side in\n", "xyz"[axis], cylinder.base[u],
                       cylinder.base[v], cylinder.radius, ends) +
           around();
  }
  std::string operator()(const Sphere& sphere) const {
    return fmt::format("region inside sphere {} {} {} {} side in\n", sphere.center[0], sphere.center[1],
                       sphere.center[2], sphere.radius) +
           around();
  }
  std::string operator()(const Mesh&) const { return {}; }
  std::string operator()(const Polygon&) const { return {}; }
  std::string operator()(const Revolved&) const { return {}; }

  static std::string around() {
    return fmt::format("fix walls all wall/gran/region {} region inside\n", wall);
  }
};

}  // namespace

std::string lammps_script(const EngineTask& task) {
  const bool wide = task.spheres.classes.count > 1;
  const double reach = task.spheres.largest / task.spheres.least;
  const long most = neighbours_of_one(reach);
  std::string text = fmt::format(
      "{}\n"
      "units lj\natom_style sphere\nboundary {}\nnewton off\n"
      "read_data {}\n"
      "neighbor {} {}\n"
      "neigh_modify delay 0 every 1 check yes one {} page {}\n"
      "comm_modify {}vel yes\n"
      "pair_style gran/hooke 1.0 NULL 1.0 NULL 0.0 0\npair_coeff * *\n",
      about_script(task), boundary_words(task.domain), data_name, skin_of(task), wide ? "multi" : "bin", most,
      20 * most, wide ? "mode multi " : "");
  text += std::visit(LammpsWalls{}, task.domain) + guards(task, [](int axis, double low, double high) {
            return planes(axis, fmt::format("guard_{}", "xyz"[axis]), low, high);
          });
  text += fmt::format(
      "fix motion all nve/limit {}\ntimestep 0.3\n"
      "thermo {}\nthermo_style custom step atoms ke press vol\nthermo_modify flush yes lost error norm no\n",
      longest_move(task), steps_a_report(task));
  text += runs_of(task);
  const auto [names, format] = columns_of_result(task);
  return text + fmt::format(
                    "write_dump all custom {} {} modify format line \"{}\"\n"
                    "print \"{}\"\n",
                    places_name, names, format, last_words);
}

}  // namespace bernal::engine
