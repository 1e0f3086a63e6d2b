#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "formats/level_marks.hpp"
#include "formats/level_walls.hpp"
#include "formats/text_file.hpp"

namespace bernal {
namespace {

using Kind = LevelSurface::Kind;
using Id = std::uint64_t;

/// Angles in degrees, each in SCONE's range, of M = Z(psi) X(theta) Z(phi) with Z(a) = (cos a, sin a; -sin a,
/// cos a): M multiplies what enters a universe.
struct EulerAngles {
  double phi = 0, theta = 0, psi = 0;
};
EulerAngles angles_of(const TurnMatrix& m) {
  const auto degrees = [](double sine, double cosine) {
    const double angle = std::atan2(sine, cosine) * (180 / std::numbers::pi);
    return angle < 0 ? std::min(angle + 360, std::nextafter(360.0, 0.0)) : angle;
  };
  const double across = std::hypot(m[2], m[5]);
  constexpr double too_small = 1e-12;  // to tell both turns about z from each other
  if (across < too_small) {
    const bool is_over = m[8] < 0;
    return {degrees(m[1], m[0]), is_over ? 180.0 : 0.0, 0};
  }
  return {degrees(m[6], -m[7]), std::atan2(across, m[8]) * (180 / std::numbers::pi), degrees(m[2], m[5])};
}

std::string scone_surface(const LevelSurface& surface) {
  const int k = surface.coordinate_axis();
  const char letter = "xyz"[std::max(k, 0)];
  switch (surface.kind) {
    case Kind::plane:
      if (k >= 0 && surface.axis[k] > 0) return fmt::format("type {0}Plane; {0}0 {1};", letter, surface.size);
      return fmt::format("type plane; coeffs ({} {});", row_of(surface.axis), surface.size);
    case Kind::sphere:
      return fmt::format("type sphere; origin ({}); radius {};", row_of(surface.at), surface.size);
    case Kind::cylinder:
      if (k < 0) break;
      return fmt::format("type {}Cylinder; origin ({}); radius {};", letter, row_of(surface.at),
                         surface.size);
    case Kind::cone:
      break;
  }
  return fmt::format("type quadric; coeffs ({});", fmt::join(surface.quadric(), " "));
}

/// Three lists that refer to each other by numbers; each goes to a text of its own while they grow together.
class SconeGeometry {
 public:
  SconeGeometry(const Exported& file, const LevelModel& model) : file_(file), model_(model) {}

  std::string text() {
    for (std::size_t c = 0; c < model_.contents.size(); ++c) content_universes_.push_back(next_universe_++);
    for (std::size_t k = 0; k < model_.levels.size(); ++k) level_universes_.push_back(next_universe_++);
    for (const Level& level : model_.levels) {
      first_surface_.push_back(next_surface_);
      surfaces_ += level_comments(level, file_, "! ", "\n");
      for (std::size_t i = 0; i < level.size(); ++i) add_sphere(level.center(i), level.spheres.r[i]);
    }
    for (std::size_t c = 0; c < model_.contents.size(); ++c) add_content(c);
    for (std::size_t k = 0; k < model_.levels.size(); ++k) add_level(k);
    const Id root = add_walls();
    add(universes_, "root {{ id {}; type rootUniverse; border {}; fill u<{}>; }}\n", next_universe_++,
        border_, root);
    const auto end = [&](std::size_t axis) { return file_.periods()[axis] ? 2 : 0; };
    std::string all = fmt::format(
        "! {}; for SCONE, lengths in cm\ngeometry {{\ntype geometryStd;\n"
        "boundary ({} {} {} {} {} {});\ngraph {{ type shrunk; }}\n",
        file_.title(), end(0), end(0), end(1), end(1), end(2), end(2));
    for (const auto& [name, list] :
         {std::pair{"surfaces", &surfaces_}, {"cells", &cells_}, {"universes", &universes_}})
      all += fmt::format("{} {{\n{}}}\n", name, *list);
    return all + "}\n" + nuclear_data();
  }

 private:
  template <class... T>
  static void add(std::string& to, fmt::format_string<T...> form, T&&... values) {
    fmt::format_to(std::back_inserter(to), form, std::forward<T>(values)...);
  }
  const std::string& material(std::uint32_t number) const { return model_.materials[number].name; }

  Id add_surface(const LevelSurface& surface) {
    add(surfaces_, "s{0} {{ id {0}; {1} }}\n", next_surface_, scone_surface(surface));
    return next_surface_++;
  }
  Id add_sphere(const Vector<3>& at, double r) {
    return add_surface({.kind = Kind::sphere, .at = at, .size = r});
  }
  /// Of half-spaces as SCONE writes them, "-1 2".
  Id add_cell(std::string_view halves, const std::string& fill) {
    add(cells_, "c{0} {{ id {0}; type simpleCell; surfaces ({1}); filltype {2}; }}\n", next_cell_, halves,
        fill);
    return next_cell_++;
  }
  std::string of_material(std::uint32_t number) const {
    return fmt::format("mat; material {}", material(number));
  }
  static std::string of_universe(Id universe) { return fmt::format("uni; universe {}", universe); }
  void add_universe(Id id, const std::vector<Id>& cells, const std::string& placed = {}) {
    add(universes_, "u{0} {{ id {0}; type cellUniverse; cells ({1});{2} }}\n", id, fmt::join(cells, " "),
        placed);
  }

  /// A surface far from everything, as a SCONE cell has to have one.
  Id everywhere() {
    if (!everywhere_)
      everywhere_ = add_sphere(Vector<3>::Zero(), 1e6 + 10 * bounds_of(file_.domain).diagonal());
    return everywhere_;
  }

  void add_content(std::size_t c) {
    const SphereContent& content = model_.contents[c];
    std::vector<Id> cells;
    Id within = 0;
    for (std::size_t k = 0; k < content.outer.size(); ++k) {
      const bool is_last = k + 1 == content.outer.size();
      const Id sphere = is_last ? 0 : add_sphere(Vector<3>::Zero(), content.outer[k]);
      std::string halves;
      if (within) halves = fmt::format("{}", within);
      if (sphere) halves += fmt::format("{}-{}", halves.empty() ? "" : " ", sphere);
      if (halves.empty()) halves = fmt::format("-{}", everywhere());
      cells.push_back(add_cell(halves, k == 0 && content.level ? of_universe(level_universes_[*content.level])
                                                               : of_material(content.materials[k])));
      within = sphere;
    }
    content_cells_.push_back(cells);
    if (content.level) add_universe(content_universes_[c], cells);
  }

  void add_level(std::size_t number) {
    const Level& level = model_.levels[number];
    std::vector<Id> cells;
    std::string around;
    for (std::size_t i = 0; i < level.size(); ++i) {
      const SphereContent& content = model_.contents[level.contents[i]];
      const Id sphere = first_surface_[number] + i;
      add(around, "{}{}", i ? " " : "", sphere);
      std::string fill;
      if (content.is_plain())
        fill = of_material(content.materials.front());
      else
        fill = of_universe(content.level ? turned(level, i) : placed(level, i));
      cells.push_back(add_cell(fmt::format("-{}", sphere), fill));
    }
    if (around.empty()) around = fmt::format("-{}", everywhere());
    cells.push_back(add_cell(around, of_material(level.background)));
    add_universe(level_universes_[number], cells);
  }

  /// SCONE moves universes, not cells: each place has one of its own, of the same cells.
  Id placed(const Level& level, std::size_t i) {
    const Id universe = next_universe_++;
    add_universe(universe, content_cells_[level.contents[i]],
                 fmt::format(" origin ({});", row_of(level.center(i))));
    return universe;
  }
  /// SCONE turns before it moves. It takes three angles, but the matrix that it makes of three is no rotation
  /// in every version; with one of the turns about z at zero it is. So two universes turn, one in the other.
  Id turned(const Level& level, std::size_t i) {
    const TurnMatrix m = transposed(*level.turn_of(i));
    const EulerAngles angles = angles_of(m);
    const Id inner = next_universe_++, outer = next_universe_++;
    const Id within =
        add_cell(fmt::format("-{}", everywhere()), of_universe(content_universes_[level.contents[i]]));
    add_universe(inner, {within}, fmt::format(" rotation ({} 0.0 0.0);", angles.psi));
    const Vector<3> at = first_turn(angles, level.center(i));
    const Id around = add_cell(fmt::format("-{}", everywhere()), of_universe(inner));
    add_universe(outer, {around},
                 fmt::format(" origin ({}); rotation ({} {} 0.0);", row_of(at), angles.phi, angles.theta));
    return outer;
  }
  static Vector<3> first_turn(const EulerAngles& angles, const Vector<3>& p) {
    constexpr double radians = std::numbers::pi / 180;
    const double c = std::cos(angles.phi * radians), s = std::sin(angles.phi * radians),
                 ct = std::cos(angles.theta * radians), st = std::sin(angles.theta * radians);
    const double x = c * p[0] + s * p[1], y = c * p[1] - s * p[0];
    return {x, ct * y + st * p[2], ct * p[2] - st * y};
  }

  /// Returns the universe within the border. A border is a box or a sphere; between it and other walls is
  /// nothing.
  Id add_walls() {
    if (const auto* box = std::get_if<Box>(&file_.domain)) {
      const Bounds<3> b = bounds_of(Domain(*box));
      add(surfaces_, "s{0} {{ id {0}; type box; origin ({1}); halfwidth ({2}); }}\n", next_surface_,
          row_of(b.center()), row_of(Vector<3>(0.5 * b.size())));
      border_ = next_surface_++;
      return level_universes_.front();
    }
    if (const auto* sphere = std::get_if<Sphere>(&file_.domain)) {
      border_ = add_sphere(sphere->center, sphere->radius);
      return level_universes_.front();
    }
    const LevelWalls walls = walls_of(file_.domain);
    const Id first = next_surface_;
    for (const LevelSurface& surface : walls.surfaces) add_surface(surface);
    std::vector<Id> cells;
    const auto add_parts = [&](const std::vector<CommonPart>& parts, const std::string& fill) {
      for (const CommonPart& part : parts) {
        std::string halves;
        for (const SurfaceSide& half : part)
          add(halves, "{}{}{}", halves.empty() ? "" : " ", half.inner ? "-" : "", first + half.surface);
        cells.push_back(add_cell(halves, fill));
      }
    };
    add_parts(walls.inside, of_universe(level_universes_.front()));
    add_parts(walls.outside, "mat; material void");
    const Bounds<3> bounds = bounds_of(file_.domain);
    border_ = add_sphere(bounds.center(), 0.6 * bounds.diagonal());
    const Id vessel = next_universe_++;
    add_universe(vessel, cells);
    return vessel;
  }

  /// Names; what materials are made of, a packing does not know.
  std::string nuclear_data() const {
    std::string text =
        "nuclearData {\nhandles { }\n! give each material its temperature and composition\nmaterials {\n";
    for (const LevelMaterial& of : model_.materials)
      text += fmt::format("{} {{ temp 300; composition {{ }} }}{}\n", of.name,
                          of.density ? fmt::format("  ! {} g/cm3", *of.density) : "");
    return text + "}\n}\n";
  }

  const Exported& file_;
  const LevelModel& model_;
  std::string surfaces_, cells_, universes_;
  Id next_surface_ = 1, next_cell_ = 1, next_universe_ = 1, everywhere_ = 0, border_ = 0;
  std::vector<Id> content_universes_, level_universes_, first_surface_;
  std::vector<std::vector<Id>> content_cells_;
};

std::string write_scone(const Exported& file, StagedFolder& staged) {
  require_boxes_repeat(file);
  constexpr std::size_t longest_name = 30;  // nameLen of SCONE, which cuts off the rest
  const LevelModel model = levels_of(file, longest_name);
  staged.write(file.output.file.string(), SconeGeometry(file, model).text());
  return model.in_words();
}

FileContents read_scone(const Reading& reading) {
  return read_level(reading, [](std::string_view line, std::vector<std::string_view>& parts) {
    constexpr std::string_view before = "type sphere; origin (", between = "); radius ";
    const std::size_t at = line.find(before);
    if (at == line.npos || line.find(between) == line.npos) return;
    line.remove_prefix(at + before.size());
    split_at(line.substr(0, line.find("; }")), "() ;radius", parts);
  });
}

constexpr LevelFormat of_scone = {.name = "scone",
                                  .file = "scone",
                                  .writes = "SCONE: geometry of all levels, and the names of the materials",
                                  .reads = "SCONE inputs that bernal wrote",
                                  .begins = "! bernal ",
                                  .says = "; for SCONE, ",
                                  .write = write_scone,
                                  .read = read_scone};

}  // namespace

Format scone_format() { return format_of_levels<of_scone>(); }

}  // namespace bernal
