#include "formats/level_marks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/text.hpp"
#include "bernal/scene/read_scene.hpp"

namespace bernal {
namespace {

std::string list_of(const Vector<3>& v) { return fmt::format("[{}]", row_of(v, ", ")); }

/// A container of a scene, as the value of a key in TOML.
struct ContainerInToml {
  std::string operator()(const Box& box) const {
    if (!box.repeats())
      return fmt::format("{{ kind = \"box\", size = {}, corner = {} }}", list_of(Vector<3>(box.size)),
                         list_of(Vector<3>(box.corner)));
    std::vector<int> walls;
    for (int k = 0; k < 3; ++k)
      if (box.has_wall(k)) walls.push_back(k);
    return fmt::format("{{ kind = \"periodic\", size = {}{} }}", list_of(Vector<3>(box.size)),
                       walls.empty() ? "" : fmt::format(", walls = [{}]", fmt::join(walls, ", ")));
  }
  std::string operator()(const Cylinder& cylinder) const {
    return fmt::format("{{ kind = \"cylinder\", radius = {}, height = {}, axis = {}, base = {}{} }}",
                       cylinder.radius, cylinder.height, list_of(cylinder.axis), list_of(cylinder.base),
                       cylinder.periodic ? ", periodic = true" : "");
  }
  std::string operator()(const Sphere& sphere) const {
    return fmt::format("{{ kind = \"sphere\", radius = {}, center = {} }}", sphere.radius,
                       list_of(sphere.center));
  }
  std::string operator()(const Revolved& revolved) const {
    std::vector<std::string> corners;
    for (const Vector<2>& p : revolved.profile) corners.push_back(fmt::format("[{}, {}]", p[0], p[1]));
    // Repeating the first corner says that the line is closed.
    if (!corners.empty()) corners.push_back(corners.front());
    return fmt::format("{{ kind = \"revolved\", profile = [{}], axis = {}, base = {} }}",
                       fmt::join(corners, ", "), list_of(revolved.axis), list_of(revolved.base));
  }
  std::string operator()(const Mesh&) const { return {}; }
  std::string operator()(const Polygon&) const { return {}; }
};

/// The words of a line without the marks that make it a comment.
std::string_view comment_in(std::string_view line) {
  for (const std::string_view open : {"<!-- ", "c ", "% ", "! "}) {
    const std::size_t at = line.find_first_not_of(' ');
    if (at == line.npos || !line.substr(at).starts_with(open)) continue;
    line.remove_prefix(at + open.size());
    if (line.ends_with(" -->")) line.remove_suffix(4);
    return line;
  }
  return {};
}

struct LevelMark {
  std::string name;
  std::uint64_t spheres = 0;
};
std::optional<LevelMark> level_mark_in(const ForeignLines& lines) {
  std::string_view words = comment_in(lines.line());
  if (!words.starts_with(level_mark)) return std::nullopt;
  words.remove_prefix(level_mark.size());
  const std::size_t colon = words.find(": ");
  if (colon == words.npos) return std::nullopt;
  LevelMark mark{.name = std::string(words.substr(0, colon))};
  words.remove_prefix(colon + 2);
  mark.spheres = lines.whole(words.substr(0, words.find(' ')), "the number of spheres of a level");
  return mark;
}

void take_container(const ForeignLines& lines, FileContents& contents) {
  const std::string_view words = comment_in(lines.line());
  if (!words.starts_with(container_mark)) lines.fail("the container of the level is expected");
  try {
    contents.container =
        parse_scene(fmt::format("unit = \"cm\"\n{}\n[spheres]\ncount = 1\nradius = 1e-3\n", words), {});
  } catch (const Error& error) {
    lines.fail(fmt::format("the container is not as bernal wrote it: {}", error.what()));
  }
  if (!contents.container->container.meshes().empty())
    lines.fail("the container is not as bernal wrote it: it is in another file");
}

}  // namespace

std::string level_comments(const Level& level, const Exported& file, std::string_view before,
                           std::string_view after) {
  std::string text = fmt::format("{}{}{}: {} {}", before, level_mark, level.name, level.own,
                                 level.own == 1 ? "sphere" : "spheres");
  if (level.size() > level.own) text += fmt::format(", then {} images", level.size() - level.own);
  const Domain domain = level.is_outermost()
                            ? file.domain
                            : Domain(Sphere{level.bounds.center(), 0.5 * level.bounds.size().maxCoeff()});
  return text + fmt::format("{}{}{}{}{}", after, before, container_mark,
                            std::visit(ContainerInToml(), domain), after);
}

std::uint64_t find_level(ForeignLines& lines, const Reading& reading, FileContents& contents) {
  const std::string& asked = reading.options.level;
  std::vector<std::string> levels;
  while (lines.next()) {
    const std::optional<LevelMark> mark = level_mark_in(lines);
    if (!mark) continue;
    levels.push_back(mark->name);
    if (!asked.empty() && mark->name != asked) continue;
    lines.require_next("the container");
    take_container(lines, contents);
    contents.unit = Unit::cm;
    contents.note = fmt::format("level {}", mark->name);
    return mark->spheres;
  }
  if (levels.empty())
    lines.fail("no comment names a level of spheres; only files that bernal wrote are read");
  throw Error(ErrorCode::bad_argument, fmt::format("the file has no level {}; ‹level› is one of {}",
                                                   bernal::quoted(asked), fmt::join(levels, ", ")));
}

void read_spheres(ForeignLines& lines, std::uint64_t spheres, const NumbersOfLine& numbers,
                  FileContents& contents) {
  const SphereColumns columns = columns_xyzr();
  contents.spheres = columns.no_spheres();
  std::vector<std::string_view> parts;
  while (contents.size() < spheres) {
    lines.require_next("a sphere");
    parts.clear();
    numbers(lines.line(), parts);
    if (parts.empty()) continue;
    if (parts.size() < 4) lines.fail("x, y, z and r of a sphere are expected");
    add_row(lines, columns, parts, contents.spheres);
  }
}

FileContents read_level(const Reading& reading, const NumbersOfLine& numbers) {
  ForeignLines lines(reading);
  FileContents contents;
  const std::uint64_t spheres = find_level(lines, reading, contents);
  read_spheres(lines, spheres, numbers, contents);
  return contents;
}

}  // namespace bernal
