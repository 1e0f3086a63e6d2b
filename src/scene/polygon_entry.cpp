#include <algorithm>

#include <fmt/format.h>

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

/// A line that is simple with the outline lies inside it, outside it, or around it. Inside, it takes from the
/// area.
void require_holes_inside(const Polygon& polygon, const Section& section) {
  const Polygon outline{{polygon.loops.front()}};
  const double whole = volume_of(outline);
  for (std::size_t k = 1; k < polygon.loops.size(); ++k) {
    const auto& hole = polygon.loops[k];
    if (volume_of(Polygon{{hole}}) < whole && volume_of(Polygon{{outline.loops.front(), hole}}) <= whole)
      continue;
    section.refuse("holes", fmt::format("must lie inside the outline, but hole {}, which begins at ({:.6g}, "
                                        "{:.6g}), does not",
                                        k, hole.front()[0], hole.front()[1]));
  }
}

void polygon_rule(const Polygon& polygon, const Section& section) {
  if (polygon.loops.empty() || polygon.loops.front().empty())
    section.fail("",
                 fmt::format("{} needs \"vertices\", an array of three points [x, y] or more, or a \"file\" "
                             "of such",
                             section.name));
  try {
    require_simple(polygon);
  } catch (const Error& error) {
    section.fail(section.locations.keys.contains("vertices") ? "vertices" : "",
                 fmt::format("{}: {}", section.name, error.what()));
  }
  require_holes_inside(polygon, section);
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

}  // namespace bernal::schema
