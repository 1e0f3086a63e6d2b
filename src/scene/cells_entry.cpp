#include "scene/cells_entry.hpp"

#include <algorithm>
#include <type_traits>

#include <fmt/format.h>

namespace bernal::schema {
namespace {

/// One of the two distributions.
Member sizes(std::optional<SceneSizes> CellSizes::*which) {
  Member member;
  member.get = [which](const void* cells) -> std::optional<Value> {
    const std::optional<SceneSizes>& of = static_cast<const CellSizes*>(cells)->*which;
    return of ? std::optional<Value>(std::vector<SceneSizes>{*of}) : std::nullopt;
  };
  member.set = [which](void* cells, const Value& value) {
    static_cast<CellSizes*>(cells)->*which = std::get<std::vector<SceneSizes>>(value).front();
  };
  return member;
}

/// Whether shares are of the number: those by the volume weigh with the cube of a length.
bool is_by_number(const SceneSizes& sizes) {
  return std::visit(
      []<class T>(const T& of) {
        if constexpr (std::is_same_v<T, Mixture>)
          return of.basis == Basis::number && std::ranges::all_of(of.of, is_by_number);
        else if constexpr (std::is_same_v<T, Histogram>)
          return of.masses.empty();
        else if constexpr (std::is_same_v<T, Constant> || std::is_same_v<T, ListedSizes>)
          return true;
        else if constexpr (std::is_same_v<T, Sieve> || std::is_same_v<T, RosinRammler> ||
                           std::is_same_v<T, Fuller> || std::is_same_v<T, Percentiles>)
          return false;
        else if constexpr (std::is_same_v<T, Lognormal>)
          return of.basis == Basis::number && !of.d43;
        else
          return of.basis == Basis::number;
      },
      sizes);
}

void cells_rule(const CellSizes& cells, const Section& section) {
  if (!cells.volume || is_by_number(*cells.volume)) return;
  section.fail("volume",
               fmt::format("the \"volume\" in {} takes distributions by number; one by volume or mass is "
                           "said of lengths: give the \"diameter\" of balls of the same volume",
                           section.name));
}

}  // namespace

const Entry& cells_entry() {
  static const Entry made = entry<CellSizes>(
      {.name = "cells",
       .help = "the sizes that the Laguerre cells of the packing are to have, in place of those of spheres",
       .keys = {required(of_quantity(Quantity::volume,
                                     key(Type::distribution, sizes(&CellSizes::volume), "volume",
                                         "of a cell, in the scene's unit to the power of three"))),
                required(key(Type::distribution, sizes(&CellSizes::diameter), "diameter",
                             "of a ball of the volume of a cell")),
                integer(&CellSizes::rounds, "rounds",
                        "how often at most the spheres are packed again, so that their own cells come nearer "
                        "before weights do the rest",
                        {0, 100})},
       .choices = {{{"volume"}, {"diameter"}}},
       .rule = rule(cells_rule)});
  return made;
}

Key cells_key() {
  return table(&Scene::cells, cells_entry, "cells",
               "in place of radius or diameter: sizes that the Laguerre cells are to have, by weights that "
               "come with the result; in boxes");
}

void require_cells(const Scene& scene) {
  if (!scene.cells) return;
  const Section section{"[spheres]", scene.locations};
  const auto fail = [&](std::string_view key, const std::string& why) {
    section.fail(key, "\"cells\" in [spheres] " + why);
  };
  const bool is_box =
      scene.is_periodic() || (std::holds_alternative<Box>(scene.container) && scene.container.rounding == 0);
  if (scene.dimension() != 3)
    fail("cells", fmt::format("are of three dimensions, and the scene has {}", scene.dimension()));
  if (!is_box || !scene.container.obstacles.empty())
    fail("cells", "need a box with plain walls, or a periodic one: kind = \"box\" or \"periodic\"");
  const auto exclude = [&](bool said, std::string_view key) {
    if (said) fail(key, fmt::format("say how large the spheres are: leave \"{}\" out", key));
  };
  exclude(scene.scale != 1 || scene.largest, "scale");
  exclude(scene.start.file || scene.start.packing, "start");
  exclude(scene.target.fill, "fill");
  exclude(scene.target.mass.has_value(), "mass");
  exclude(scene.target.bed.height.has_value(), "height");
  exclude(scene.target.bed.layers.has_value(), "bed_layers");
  exclude(scene.draw == Draw::random, "draw");
  if (!scene.zones.empty())
    throw Error(ErrorCode::bad_scene, "\"cells\" in [spheres] are of one packing: leave [[zone]] out",
                scene.zones.front().locations.whole);
  if (scene.engine)
    throw Error(ErrorCode::bad_scene, "\"cells\" in [spheres] need several packings: leave [engine] out",
                scene.engine->locations.whole);
}

}  // namespace bernal::schema
