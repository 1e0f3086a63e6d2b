#include "scene/schema.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "bernal/core/vector.hpp"

namespace bernal::schema {
namespace {

[[noreturn]] void refuse(const Spec& spec, std::string_view key, const std::string& message) {
  throw Error(ErrorCode::bad_scene, message, spec.location(key));
}

void periodic_rule(const Spec& spec, std::string_view where) {
  const std::int64_t dimension = spec.integer("dimension");
  if (spec.has("size") && static_cast<std::int64_t>(spec.numbers("size").size()) != dimension)
    refuse(spec, "size",
           fmt::format("\"size\" in {} must have a length for each of {} dimensions, but it has {}", where,
                       dimension, spec.numbers("size").size()));
  if (!spec.has("walls")) return;
  std::vector<double> seen;
  for (const double axis : spec.numbers("walls")) {
    if (axis != std::floor(axis) || axis >= static_cast<double>(dimension) ||
        std::ranges::find(seen, axis) != seen.end())
      refuse(spec, "walls",
             fmt::format("\"walls\" in {} must name axes, each once, from 0 to {}", where, dimension - 1));
    seen.push_back(axis);
  }
}

Schema make_schema() {
  return {
      .scene = {.name = "scene",
                .help = "what stands at the top",
                .keys = {{.name = "unit",
                          .type = Type::unit,
                          .help = "unit of every length in the scene; required with a mesh",
                          .otherwise = "m"},
                         {.name = "seed",
                          .type = Type::integer,
                          .help = "one seed gives one packing, bit for bit",
                          .otherwise = 1,
                          .range = {0, 0x1p63}}}},

      .spheres = {.name = "spheres",
                  .help = "how many spheres there are, and how large",
                  .keys = {{.name = "count",
                            .type = Type::integer,
                            .help = "stop at this many spheres",
                            .range = {1, 0x1p31 - 1}},
                           {.name = "packing_fraction",
                            .type = Type::number,
                            .help =
                                "stop when the spheres fill this fraction of the container; \"predicted\": "
                                "as much as is predicted, less the error of that",
                            .range = {0, 1, true, true},
                            .words = {"predicted"}},
                           {.name = "fill",
                            .type = Type::flag,
                            .help = "true: as many spheres as the stages can place"},
                           {.name = "radius", .type = Type::distribution, .help = "lengths are radii"},
                           {.name = "diameter", .type = Type::distribution, .help = "lengths are diameters"},
                           {.name = "draw",
                            .type = Type::word,
                            .help = "sizes at random, or quantiles: evenly over the distribution; if absent "
                                    "quantiles where relax or grow packs a container, else random",
                            .optional = true,
                            .words = {"random", "quantiles"}}},
                  .choices = {{{"count"}, {"packing_fraction"}, {"fill"}, {"count", "packing_fraction"}, {}},
                              {{"radius"}, {"diameter"}}}},

      .accuracy =
          {.name = "accuracy",
           .help = "how walls are decided and what the result may keep",
           .keys = {{.name = "walls",
                     .type = Type::word,
                     .help = "double, filtered (certified bounds, exact where they cannot decide) or exact",
                     .otherwise = "filtered",
                     .words = {"double", "filtered", "exact"}},
                    {.name = "overlap",
                     .type = Type::number,
                     .help = "largest overlap ratio (ri + rj - d) / (ri + rj) that is allowed; 0: none",
                     .otherwise = 0.0,
                     .range = {0, 1, false, true}}}},

      .containers =
          {{.name = "box",
            .help = "a box along the axes",
            .keys = {{.name = "size", .type = Type::extents, .help = "its three edges"},
                     {.name = "corner",
                      .type = Type::position,
                      .help = "its lowest corner",
                      .otherwise = std::vector<double>{0, 0, 0}}},
            .protocol = {"relax"}},
           {.name = "cylinder",
            .help = "a circular cylinder along any axis",
            .keys = {{.name = "radius", .type = Type::length, .help = "its radius"},
                     {.name = "height", .type = Type::length, .help = "its length along the axis"},
                     {.name = "axis",
                      .type = Type::direction,
                      .help = "from the base to the top; its length is of no matter",
                      .otherwise = std::vector<double>{0, 0, 1}},
                     {.name = "base",
                      .type = Type::position,
                      .help = "the middle of its base",
                      .otherwise = std::vector<double>{0, 0, 0}},
                     {.name = "periodic",
                      .type = Type::flag,
                      .help = "true: an endless column that repeats itself every height; the axis lies along "
                              "x, y or z",
                      .otherwise = false}},
            .protocol = {"relax"}},
           {.name = "mesh",
            .help = "a closed surface from a CAD file",
            .keys = {{.name = "file", .type = Type::file, .help = "STL, OBJ, PLY, OFF, 3MF, glTF, …"},
                     {.name = "unit",
                      .type = Type::unit,
                      .help = "unit of the file's coordinates; the scene's if absent",
                      .optional = true}},
            .protocol = {"relax"}},
           {.name = "sphere",
            .help = "a sphere",
            .keys = {{.name = "radius", .type = Type::length, .help = "its radius"},
                     {.name = "center",
                      .type = Type::position,
                      .help = "its centre",
                      .otherwise = std::vector<double>{0, 0, 0}}},
            .protocol = {"relax"}},
           {.name = "periodic",
            .help = "a box that repeats itself in all directions",
            .keys = {{.name = "dimension",
                      .type = Type::integer,
                      .help = "of space",
                      .otherwise = 3,
                      .range = {1, max_dimension}},
                     {.name = "size", .type = Type::lengths, .help = "its edges"},
                     {.name = "edge", .type = Type::length, .help = "all its edges"},
                     {.name = "walls",
                      .type = Type::amounts,
                      .help = "axes, counted from 0, along which the box does not repeat itself but ends at "
                              "walls, with whole spheres between them; fly only",
                      .optional = true},
                     {.name = "scalable",
                      .type = Type::flag,
                      .help = "the packing decides how large the box is; size only gives its proportions",
                      .otherwise = false}},
            .choices = {{{"size"}, {"edge"}, {}}},
            .rule = periodic_rule,
            .protocol = {"relax"}}},

      .distributions = size_distributions(),

      .stages_in_containers = stages(true),
      .stages_in_periodic_boxes = stages(false),
  };
}

}  // namespace

const Key* Entry::find(std::string_view key) const {
  const auto found = std::ranges::find(keys, key, &Key::name);
  return found == keys.end() ? nullptr : &*found;
}

const Entry* Schema::find(const std::vector<Entry>& entries, std::string_view name) {
  const auto found = std::ranges::find(entries, name, &Entry::name);
  return found == entries.end() ? nullptr : &*found;
}

const Schema& schema() {
  static const Schema all = make_schema();
  return all;
}

}  // namespace bernal::schema
