#include "report/nest_json.hpp"

#include <cmath>
#include <optional>
#include <string_view>
#include <variant>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/measure/measure.hpp"
#include "bernal/scene/nest.hpp"
#include "bernal/scene/sphere_classes.hpp"
#include "bernal/scene/sphere_layers.hpp"
#include "report/measured_json.hpp"
#include "report/nest_levels.hpp"

namespace bernal {
namespace {

Json ball_json(const PackingsInside& inside, Unit around) {
  if (inside.templates.empty()) return {};
  const Packing& packing = *inside.templates.front();
  const auto* ball = std::get_if<Sphere>(&packing.domain);
  if (!ball) return {};
  const Unit unit = packing.scene.unit;
  return {{"radius", ball->radius},
          {"unit", name_of(unit)},
          {"radius_around", ball->radius * conversion_factor(unit, around)},
          {"unit_around", name_of(around)}};
}

Json packings_json(const PackingsInside& inside, const InsideFiles& files) {
  std::vector<std::uint64_t> uses(inside.templates.size(), 0);
  for (const std::uint32_t t : inside.which) ++uses[t];
  Json all = Json::array();
  for (std::size_t t = 0; t < uses.size(); ++t) {
    const Packing& packing = *inside.templates[t];
    all.push_back({{"folder", files.packings[t]},
                   {"seed", packing.seed},
                   {"spheres", packing.spheres.size()},
                   {"phi", packing.packing_fraction()},
                   {"outcome", name_of(packing.outcome)},
                   {"hash", hash_of(packing.spheres)},
                   {"in_spheres", uses[t]}});
  }
  return all;
}

/// Without files where the tree goes on below a packing, whose folder has them in a nest.json of its own.
Json insides_json(const Packing& around, const std::vector<InsideFiles>& files) {
  const std::vector<SphereClass> classes = classes_of(around.scene);
  const std::vector<std::vector<Layer>> layers = layers_by_class(around.scene);
  Json all = Json::array();
  for (std::size_t k = 0; k < around.inside.size(); ++k) {
    const PackingsInside& inside = around.inside[k];
    const bool has_layers = inside.of_class < layers.size() && !layers[inside.of_class].empty();
    Json one = {{"class", inside.of_class < classes.size() ? Json(classes[inside.of_class].name) : Json()},
                {"layer", has_layers ? Json(layers[inside.of_class][inside.layer].name) : Json()},
                {"ball", ball_json(inside, around.scene.unit)},
                {"filled", inside.spheres.size()},
                {"packings", inside.templates.size()}};
    if (k < files.size()) {
      one["folder"] = files[k].folder;
      one["table"] = files[k].table;
      one["packings"] = packings_json(inside, files[k]);
    }
    if (!inside.templates.empty() && !inside.templates.front()->inside.empty())
      one["inside"] = insides_json(*inside.templates.front(), {});
    all.push_back(std::move(one));
  }
  return all;
}

/// The place of the first difference, from `at` on; nothing where there is none.
std::string difference(const Json& said, const Json& found, const std::string& at) {
  constexpr double rounding = 1e-9;
  if (found.is_object() && said.is_object()) {
    for (const auto& [key, value] : found.items()) {
      const std::string place = (at.empty() ? "" : at + ".") + key;
      if (!said.contains(key)) return place;
      if (std::string deeper = difference(said.at(key), value, place); !deeper.empty()) return deeper;
    }
    return {};
  }
  if (found.is_array() && said.is_array() && found.size() == said.size()) {
    for (std::size_t i = 0; i < found.size(); ++i)
      if (std::string deeper = difference(said[i], found[i], fmt::format("{}[{}]", at, i)); !deeper.empty())
        return deeper;
    return {};
  }
  if (found.is_number_float() && said.is_number()) {
    const double a = said.get<double>(), b = found.get<double>();
    return std::abs(a - b) <= rounding * std::abs(b) ? "" : at;
  }
  return said == found ? "" : at;
}

std::optional<Outcome> outcome_named(std::string_view name) {
  for (const Outcome outcome : {Outcome::converged, Outcome::loose, Outcome::full, Outcome::hit_limit,
                                Outcome::cancelled, Outcome::imported})
    if (name == name_of(outcome)) return outcome;
  return {};
}

std::string text_in(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_string() ? found->get<std::string>() : std::string();
}

}  // namespace

Json levels_json(const Packing& packing) {
  Json all = Json::array();
  for (const NestLevel& level : levels_of(packing))
    all.push_back({{"name", level.name},
                   {"depth", level.depth},
                   {"packings", level.packings},
                   {"packed", level.packed},
                   {"filled", level.filled},
                   {"spheres", level.spheres},
                   {"ball", level.depth > 0 ? Json(level.ball) : Json()},
                   {"unit", name_of(level.unit)},
                   {"phi", level.packing_fraction},
                   {"share", level.share}});
  return all;
}

namespace {

Json nest_json(const Packing& packing, const std::vector<InsideFiles>& files) {
  return {{"unit", name_of(packing.scene.unit)},
          {"spheres", packing.spheres.size()},
          {"spheres_of_all_levels", spheres_of_all_levels(packing)},
          {"levels", levels_json(packing)},
          {"inside", insides_json(packing, files)}};
}

}  // namespace

std::string nest_as_json(const Packing& packing, const std::vector<InsideFiles>& files) {
  return text_of(nest_json(packing, files));
}

std::string nest_differs(const std::string& json, const Packing& packing,
                         const std::vector<InsideFiles>& files) {
  return difference(Json::parse(json, nullptr, false), nest_json(packing, files), "");
}

std::vector<InsideFiles> files_in_nest(const std::string& text, const std::filesystem::path& file) {
  const Json json = Json::parse(text, nullptr, false);
  const auto fail = [&] {
    throw Error(ErrorCode::bad_packing,
                "does not say which packings lie inside the spheres, as bernal writes it", {file.string()});
  };
  if (!json.is_object() || !json.contains("inside") || !json.at("inside").is_array()) fail();
  std::vector<InsideFiles> all;
  for (const Json& one : json.at("inside")) {
    if (!one.is_object() || !one.contains("packings") || !one.at("packings").is_array()) fail();
    InsideFiles& files =
        all.emplace_back(InsideFiles{.folder = text_in(one, "folder"), .table = text_in(one, "table")});
    if (files.table.empty()) fail();
    for (const Json& packing : one.at("packings")) {
      files.packings.push_back(packing.is_object() ? text_in(packing, "folder") : "");
      const std::optional<Outcome> outcome =
          outcome_named(packing.is_object() ? text_in(packing, "outcome") : "");
      if (files.packings.back().empty() || !outcome) fail();
      files.outcomes.push_back(*outcome);
    }
  }
  return all;
}

}  // namespace bernal
