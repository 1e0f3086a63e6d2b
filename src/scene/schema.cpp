#include "scene/schema.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "bernal/core/vector.hpp"

namespace bernal::schema {
namespace {

[[noreturn]] void refuse(const Spec& spec, std::string_view key, const std::string& message) {
  throw Error(ErrorCode::bad_scene, message, spec.location(key));
}

/// Keys of `compress`, which `shake` and `refill` pass on to the compression that they end with.
std::vector<Key> with_compression(std::vector<Key> keys) {
  const Key compression[] = {
      {.name = "direction",
       .type = Type::direction,
       .help = "where the spheres are pushed; its length is of no matter",
       .otherwise = std::vector<double>{0, 0, -1}},
      {.name = "tilt",
       .type = Type::number,
       .help = "how far a sphere's own direction leaves the common one; 0: not at all",
       .otherwise = 2.0,
       .range = {0, 100}},
      {.name = "tolerance",
       .type = Type::number,
       .help = "relative fall of the potential energy in an iteration that counts as none",
       .otherwise = 1e-2,
       .range = {0, 1, true, true}},
      {.name = "max_iterations",
       .type = Type::integer,
       .help = "after which it stops unconverged",
       .otherwise = 400,
       .range = {1, 1e9}},
      {.name = "buffer",
       .type = Type::number,
       .help = "room in a sphere's bounding box on each side, in mean radii",
       .otherwise = 0.5,
       .range = {0.01, 10}}};
  keys.insert(keys.end(), std::begin(compression), std::end(compression));
  return keys;
}

const std::vector<std::string_view> compression_protocol = {"insert", "compress", "shake", "refill"};

void periodic_rule(const Spec& spec, std::string_view where) {
  const std::int64_t dimension = spec.integer("dimension");
  if (spec.has("size") && static_cast<std::int64_t>(spec.numbers("size").size()) != dimension)
    refuse(spec, "size",
           fmt::format("\"size\" in {} must have a length for each of {} dimensions, but it has {}", where,
                       dimension, spec.numbers("size").size()));
}

/// The paper's phi0, and in other than three dimensions what is as far above random close packing.
void complete_relax(Spec& spec, const Scene& scene) {
  constexpr double phi0[] = {1.34, 1.13, 0.86, 0.62, 0.42, 0.27, 0.16, 0.093};
  spec.parameters.try_emplace("phi0", Parameter{phi0[scene.dimension() - 1], {scene.file.string()}});
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
                            .help = "stop when the spheres fill this fraction of the container",
                            .range = {0, 1, true, true}},
                           {.name = "fill",
                            .type = Type::flag,
                            .help = "true: as many spheres as the stages can place",
                            .otherwise = true},
                           {.name = "radius", .type = Type::distribution, .help = "lengths are radii"},
                           {.name = "diameter", .type = Type::distribution, .help = "lengths are diameters"},
                           {.name = "draw",
                            .type = Type::word,
                            .help = "sizes at random, or quantiles: evenly over the distribution",
                            .otherwise = "random",
                            .words = {"random", "quantiles"}}},
                  .choices = {{{"count"}, {"packing_fraction"}, {"fill"}, {"count", "packing_fraction"}},
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
            .protocol = compression_protocol},
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
                      .otherwise = std::vector<double>{0, 0, 0}}},
            .protocol = compression_protocol},
           {.name = "mesh",
            .help = "a closed surface from a CAD file",
            .keys = {{.name = "file", .type = Type::file, .help = "STL, OBJ, PLY, OFF, 3MF, glTF, …"},
                     {.name = "unit",
                      .type = Type::unit,
                      .help = "unit of the file's coordinates; the scene's if absent",
                      .optional = true}},
            .protocol = compression_protocol},
           {.name = "sphere",
            .help = "a sphere",
            .keys = {{.name = "radius", .type = Type::length, .help = "its radius"},
                     {.name = "center",
                      .type = Type::position,
                      .help = "its centre",
                      .otherwise = std::vector<double>{0, 0, 0}}},
            .protocol = compression_protocol},
           {.name = "periodic",
            .help = "a box that repeats itself in all directions",
            .keys = {{.name = "dimension",
                      .type = Type::integer,
                      .help = "of space",
                      .otherwise = 3,
                      .range = {1, max_dimension}},
                     {.name = "size", .type = Type::lengths, .help = "its edges"},
                     {.name = "edge", .type = Type::length, .help = "all its edges"},
                     {.name = "scalable",
                      .type = Type::flag,
                      .help = "the packing decides how large the box is; size only gives its proportions",
                      .otherwise = false}},
            .choices = {{{"size"}, {"edge"}, {}}},
            .rule = periodic_rule,
            .protocol = {"relax"}}},

      .distributions = size_distributions(),

      .stages =
          {{.name = "insert",
            .help = "place spheres at random where they overlap nothing",
            .keys = {{.name = "attempts",
                      .type = Type::integer,
                      .help = "random places tried for one sphere before it has to wait",
                      .otherwise = 100,
                      .range = {1, 1e9}},
                     {.name = "packing_fraction",
                      .type = Type::number,
                      .help = "where random insertion stops",
                      .otherwise = 0.30,
                      .range = {0, 1, true, true}}}},
           {.name = "compress",
            .help = "move every sphere along a direction until it touches",
            .keys = with_compression({})},
           {.name = "shake",
            .help = "move spheres across the direction, so that arches break, and compress again",
            .keys = with_compression({{.name = "rounds",
                                       .type = Type::integer,
                                       .help = "how often",
                                       .otherwise = 2,
                                       .range = {1, 1e9}},
                                      {.name = "amplitude",
                                       .type = Type::number,
                                       .help = "longest way in one sweep, in mean radii",
                                       .otherwise = 2.0,
                                       .range = {0, 100, true}}})},
           {.name = "refill",
            .help = "insert into the free space, compress and shake, until the container is full",
            .keys = with_compression(
                {{.name = "probes",
                  .type = Type::number,
                  .help = "random places to look at, for each sphere that would fill the volume",
                  .otherwise = 15.0,
                  .range = {0, 1e6, true}},
                 {.name = "max_rounds",
                  .type = Type::integer,
                  .help = "after which it stops unfilled",
                  .otherwise = 200,
                  .range = {1, 1e9}},
                 {.name = "patience",
                  .type = Type::number,
                  .help = "full when a round adds less than this share of the spheres' volume",
                  .otherwise = 3e-3,
                  .range = {0, 1}},
                 {.name = "shakes",
                  .type = Type::integer,
                  .help = "rounds of shaking after each refilling",
                  .otherwise = 1,
                  .range = {0, 1e9}},
                 {.name = "amplitude",
                  .type = Type::number,
                  .help = "longest way in one sweep of shaking, in mean radii",
                  .otherwise = 2.0,
                  .range = {0, 100, true}}})},
           {.name = "relax",
            .help = "start with overlaps in a small box; push spheres apart and let the box grow",
            .keys = {{.name = "alpha",
                      .type = Type::number,
                      .help = "sweeps between two growths of the box, in units of (log10 N)^2",
                      .otherwise = 17.0,
                      .range = {0, 1e6, true}},
                     {.name = "beta",
                      .type = Type::number,
                      .help = "the box grows by the largest overlap ratio divided by this",
                      .otherwise = 30.0,
                      .range = {0.01, 1e6}},
                     {.name = "phi0",
                      .type = Type::number,
                      .help = "packing fraction of the overlapping spheres at the start; if absent 0.86, "
                              "in other than three dimensions 1.34 of random close packing",
                      .optional = true,
                      .range = {0, 10, true}},
                     {.name = "stop",
                      .type = Type::number,
                      .help = "largest overlap ratio that counts as none; the box then grows by it",
                      .otherwise = 2e-4,
                      .range = {1e-12, 0.5}},
                     {.name = "polish",
                      .type = Type::number,
                      .help = "close the gaps and overlaps of all contacts to this ratio; 0: do not",
                      .otherwise = 0.0,
                      .range = {0, 0.5}},
                     {.name = "method",
                      .type = Type::word,
                      .help = "fast, or reference: the published loop as it stands, a hundred times slower",
                      .otherwise = "fast",
                      .words = {"fast", "reference"}},
                     {.name = "settle",
                      .type = Type::flag,
                      .help = "reference: what touches nothing moves to touch its nearest neighbour",
                      .otherwise = false}},
            .complete = complete_relax}},
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
