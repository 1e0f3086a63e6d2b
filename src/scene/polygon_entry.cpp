#include <algorithm>

#include <fmt/format.h>

#include "domain/simple_polygon.hpp"
#include "scene/scene_entries.hpp"

namespace bernal::schema {
namespace {

/// One of a polygon's lines, or all but the first.
Member outline() {
  Member member;
  member.get = [](const void* polygon) -> std::optional<Value> {
    const auto& loops = static_cast<const Polygon*>(polygon)->loops;
    return loops.empty() || loops.front().empty() ? std::nullopt
                                                  : std::optional<Value>(Polygon{{loops.front()}});
  };
  member.set = [](void* polygon, const Value& value) {
    auto& loops = static_cast<Polygon*>(polygon)->loops;
    loops.resize(std::max<std::size_t>(1, loops.size()));
    loops.front() = std::get<Polygon>(value).loops.front();
  };
  return member;
}

Member holes() {
  Member member;
  member.get = [](const void* polygon) -> std::optional<Value> {
    const auto& loops = static_cast<const Polygon*>(polygon)->loops;
    return loops.size() < 2 ? std::nullopt : std::optional<Value>(Polygon{{loops.begin() + 1, loops.end()}});
  };
  member.set = [](void* polygon, const Value& value) {
    auto& loops = static_cast<Polygon*>(polygon)->loops;
    const auto& others = std::get<Polygon>(value).loops;
    loops.resize(1);
    loops.insert(loops.end(), others.begin(), others.end());
  };
  return member;
}

/// A line that is simple with the outline lies inside it as a whole if one of its corners does.
void require_holes_inside(const Polygon& polygon, const Section& section) {
  for (std::size_t k = 1; k < polygon.loops.size(); ++k) {
    const Vector<2>& corner = polygon.loops[k].front();
    if (is_inside(polygon.loops.front(), corner)) continue;
    section.refuse("holes", fmt::format("must lie inside the outline, but hole {}, which begins at ({:.6g}, "
                                        "{:.6g}), does not",
                                        k, corner[0], corner[1]));
  }
}

/// `corners`: the key that the outline stands under.
void require_polygon(const Polygon& polygon, const Section& section, std::string_view corners) {
  if (polygon.loops.empty() || polygon.loops.front().empty())
    section.fail("", fmt::format("{} needs \"{}\", an array of three points [x, y] or more, or a \"file\" "
                                 "of such",
                                 section.name, corners));
  const auto require = [&](const Polygon& lines, std::string_view key) {
    try {
      require_simple(lines);
    } catch (const Error& error) {
      section.fail(section.locations.keys.contains(key) ? key : "",
                   fmt::format("{}: {}", section.name, error.what()));
    }
  };
  require({{polygon.loops.front()}}, corners);
  if (polygon.loops.size() > 1) require(polygon, "holes");
  require_holes_inside(polygon, section);
}

void polygon_rule(const Polygon& polygon, const Section& section) {
  require_polygon(polygon, section, "vertices");
}
void extruded_rule(const Extruded& extruded, const Section& section) {
  require_polygon(extruded.polygon, section, "polygon");
}

Key file_of_points() {
  return {.name = "file", .type = Type::file, .help = "two columns, x and y: its corners in order"};
}

}  // namespace

Entry polygon_entry() {
  return entry<Polygon>(
      {.name = "polygon",
       .help = "a polygon in the plane, for discs",
       .keys = {key(Type::points, outline(), "vertices", "its corners in order, in either sense"),
                file_of_points(),
                key(Type::lines, holes(), "holes",
                    "polygons in it that are taken out; one in another is an island")},
       .choices = {{{"vertices"}, {"file"}}},
       .rule = rule(polygon_rule)});
}

Entry extruded_entry() {
  return entry<Extruded>(
      {.name = "extruded",
       .help = "a polygon in the plane, straight up along z: a prism, with shafts where it has holes",
       .keys = {key(Type::points, outline().inside(&Extruded::polygon), "polygon",
                    "its corners in order, in either sense"),
                file_of_points(),
                key(Type::lines, holes().inside(&Extruded::polygon), "holes",
                    "polygons in it that are taken out; one in another is an island"),
                required(length(&Extruded::height, "height", "its length along z")),
                key(Type::position, &Extruded::base, "base", "where the origin of the polygon lies"),
                obstacles_key()},
       .choices = {{{"polygon"}, {"file"}}},
       .rule = rule(extruded_rule)});
}

}  // namespace bernal::schema
