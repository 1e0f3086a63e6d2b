#include "scene/layer_entry.hpp"

#include <algorithm>

#include "scene/layers_of_scene.hpp"
#include "scene/toml_text.hpp"

namespace bernal::schema {
namespace {

/// A thickness that is the same everywhere is a plain length.
Member thickness() {
  Member member;
  member.get = [](const void* layer) -> std::optional<Value> {
    const std::optional<Normal>& of = static_cast<const Layer*>(layer)->thickness;
    if (!of) return std::nullopt;
    if (of->sd == 0) return of->mean;
    return std::vector{tables_of(std::vector{*of}, thickness_entry())};
  };
  member.set = [](void* layer, const Value& value) {
    Normal& of = static_cast<Layer*>(layer)->thickness.emplace();
    if (const auto* length = std::get_if<double>(&value))
      of.mean = *length;
    else
      of = items_of<Normal>(std::get<std::vector<Tables>>(value).front()).front();
  };
  return member;
}

Key thickness_key() {
  Key made = length(thickness(), "thickness",
                    "from its inner to its outer surface; drawn for each sphere where it is a table");
  made.table = thickness_entry;
  return made;
}

/// The only kind that there is.
Key normal_key() {
  Key made = key(Type::word, {}, "distribution", "of the thickness, by number");
  made.words = {"normal"};
  made.member.get = [](const void*) -> std::optional<Value> { return std::string("normal"); };
  made.member.set = [](void*, const Value&) {};
  return made;
}

void thickness_rule(const Normal& of, const Section& section) {
  if (of.min && of.max && *of.min >= *of.max)
    section.refuse("min", fmt::format("must be below \"max\", but {} is not below {}", *of.min, *of.max));
  if (of.max && *of.max <= 0.1 * of.mean)
    section.refuse("max", fmt::format("must be near the \"mean\" or above it, but {} is less than a tenth "
                                      "of {}",
                                      *of.max, of.mean));
  const double low = of.mean - deviations_of_thickness * of.sd;
  const double high = of.mean + deviations_of_thickness * of.sd;
  const auto refuse_beyond = [&](std::string_view key, double limit, std::string_view side, double given) {
    section.refuse(key, fmt::format("must be {} {:.6g}, which is {:g} standard deviations from the mean: "
                                    "nothing is drawn beyond it, but {} is asked for; change it, the "
                                    "\"mean\" or the \"sd\"",
                                    side, limit, deviations_of_thickness, given));
  };
  if (of.min && *of.min >= high) refuse_beyond("min", high, "below", *of.min);
  if (of.max && *of.max <= low) refuse_beyond("max", low, "above", *of.max);
}

}  // namespace

const Entry& thickness_entry() {
  static const Entry made = entry<Normal>(
      {.name = "thickness",
       .help = "the thickness of a layer, drawn for each sphere by its number and the seed",
       .keys = {normal_key(), required(length(&Normal::mean, "mean", "before any cut")),
                required(length(&Normal::sd, "sd", "standard deviation, before any cut")),
                length(&Normal::min, "min",
                       "cut off below; if absent, six standard deviations below the mean, or at 0"),
                length(&Normal::max, "max",
                       "cut off above; if absent, six standard deviations above the mean")},
       .rule = rule(thickness_rule)});
  return made;
}

const Entry& layer_entry() {
  static const Entry made = entry<Layer>(
      {.name = "layer",
       .help = "a concentric layer of spheres, from the centre out: the first is a ball, others are shells",
       .keys = {required(key(Type::text, &Layer::name, "name", "in reports and files: kernel, buffer, core")),
                key(Type::text, &Layer::material, "material",
                    "what it is made of, by name; if absent the layer's name"),
                of_quantity(Quantity::density, number(&Layer::material_density, "material_density",
                                                      "of the layer, in kg/m3", above(0, largest_length))),
                thickness_key(), length(&Layer::radius, "radius", "where it ends, measured from the centre"),
                number(&Layer::share, "share", "of the sphere's volume, from 0 to 1", between(0, 1))},
       .choices = {{{"thickness"}, {"radius"}, {"share"}, {}}}});
  return made;
}

void layers_rule(const std::vector<Layer>& layers, std::string_view key, const std::string& list,
                 const Section& section) {
  const auto fail = [&](const Layer& at, std::string_view key_of_layer, const std::string& why) {
    const Location& said = at.locations.of(key_of_layer);
    throw Error(ErrorCode::bad_scene, why, said.line > 0 ? said : section.locations.of(key));
  };
  const Layer* open = nullptr;
  double share = 0, last_radius = 0;
  bool all_are_shares = true;
  for (std::size_t k = 0; k < layers.size(); ++k) {
    const Layer& layer = layers[k];
    const auto has_name = [&](const Layer& other) { return other.name == layer.name; };
    if (std::any_of(layers.begin(), layers.begin() + static_cast<std::ptrdiff_t>(k), has_name))
      fail(layer, "name",
           fmt::format("two of the {} have the name {}; give each its own", list, toml_string(layer.name)));
    const bool is_open = !layer.thickness && !layer.radius && !layer.share;
    if (is_open && open)
      fail(
          layer, "name",
          fmt::format("{} and {} of the {} have no \"thickness\", \"radius\" or \"share\"; only one may take "
                      "what the others leave",
                      toml_string(open->name), toml_string(layer.name), list));
    if (layer.radius && open)
      fail(
          layer, "radius",
          fmt::format("{} of the {} lies outside of {}, which takes what is left, and so is counted from the "
                      "surface in: give it a \"thickness\" in place of a \"radius\"",
                      toml_string(layer.name), list, toml_string(open->name)));
    if (layer.radius && *layer.radius <= last_radius)
      fail(layer, "radius",
           fmt::format("the {} stand from the centre out, but the \"radius\" of {}, {}, is not above {}",
                       list, toml_string(layer.name), *layer.radius, last_radius));
    if (is_open) open = &layer;
    if (layer.radius) last_radius = *layer.radius;
    share += layer.share.value_or(0);
    all_are_shares = all_are_shares && layer.share;
    constexpr double rounding = 1e-9;
    if (share > (all_are_shares ? 1 + rounding : 1 - rounding))
      fail(layer, "share",
           fmt::format("the shares of the {} come to {:.6g} with that of {}, and nothing is left for {}; "
                       "they are parts of the sphere's volume",
                       list, share, toml_string(layer.name), open ? toml_string(open->name) : "others"));
  }
}

}  // namespace bernal::schema
