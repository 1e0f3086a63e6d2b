#include "bernal/scene/sphere_layers.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

#include <fmt/format.h>

#include "bernal/core/random.hpp"
#include "core/made.hpp"
#include "core/parallel.hpp"
#include "scene/layers_of_scene.hpp"
#include "scene/toml_text.hpp"
#include "sizes/standard_normal.hpp"

namespace bernal {
namespace {

constexpr double rounding = 1e-9;  ///< of layers that are to end at the surface, over the radius

double thickest(const Normal& of) { return of.max.value_or(of.mean + deviations_of_thickness * of.sd); }

/// A normal thickness, cut: one number gives one.
struct DrawnThickness {
  explicit DrawnThickness(const Normal& thickness)
      : of(thickness),
        min(of.min.value_or(std::max(rounding * of.mean, of.mean - deviations_of_thickness * of.sd))),
        max(thickest(of)),
        below(normal_below((min - of.mean) / of.sd)),
        share(normal_below((max - of.mean) / of.sd) - below) {}

  double at(double u) const {
    return std::clamp(of.mean + of.sd * normal_quantile(below + u * share), min, max);
  }

  Normal of;
  double min, max, below, share;
};

double cube(double r) { return r * r * r; }

/// It takes what the others leave.
bool is_open(const Layer& layer) { return !layer.thickness && !layer.radius && !layer.share; }

/// The layers of one class, and what is drawn for each of them.
struct ClassLayers {
  explicit ClassLayers(const std::vector<Layer>& of_class) : layers(of_class) {
    for (const Layer& layer : layers)
      if (layer.thickness && layer.thickness->sd > 0) drawn.emplace_back(*layer.thickness);
  }

  /// Of the sphere with that number.
  std::string place(double radius, std::uint64_t seed, std::size_t sphere, std::span<double> outer) const {
    std::vector<double> thickness;
    if (!drawn.empty()) {
      Random random(seed, stream(Stream::layers, sphere));
      for (const DrawnThickness& each : drawn) thickness.push_back(each.at(random.uniform()));
    }
    return place_layers(layers, radius, thickness, outer);
  }

  const std::vector<Layer>& layers;
  std::vector<DrawnThickness> drawn;
};

}  // namespace

double thickness_at(const Normal& thickness, double u) { return DrawnThickness(thickness).at(u); }

std::string place_layers(const std::vector<Layer>& layers, double radius, std::span<const double> thickness,
                         std::span<double> outer) {
  const std::size_t n = layers.size();
  std::vector<double> thick(n, 0);
  std::size_t open = n, drawn = 0;
  for (std::size_t k = 0; k < n; ++k) {
    if (const auto& of = layers[k].thickness) thick[k] = of->sd > 0 ? thickness[drawn++] : of->mean;
    if (is_open(layers[k])) open = k;
  }
  double inner = 0;
  for (std::size_t k = 0; k < open; ++k) {
    const Layer& layer = layers[k];
    outer[k] = layer.radius  ? *layer.radius
               : layer.share ? std::cbrt(cube(inner) + *layer.share * cube(radius))
                             : inner + thick[k];
    if (!(outer[k] > inner))
      return fmt::format("{} would end at {:.6g}, below what lies within it, which ends at {:.6g}",
                         toml_string(layer.name), outer[k], inner);
    inner = outer[k];
  }
  if (open == n) {
    if (std::abs(outer[n - 1] / radius - 1) > rounding)
      return fmt::format(
          "they end at {:.6g}{}; leave one of them without thickness, radius and share, which "
          "then takes what the others leave",
          outer[n - 1], outer[n - 1] > radius ? ", beyond its surface" : "");
    outer[n - 1] = radius;
    const bool ascends = n == 1 || outer[n - 2] < radius;
    return ascends ? "" : fmt::format("nothing is left for {}", toml_string(layers[n - 1].name));
  }
  double end = radius;
  for (std::size_t k = n; k-- > open;) {
    outer[k] = end;
    if (k > open)
      end = layers[k].share ? std::cbrt(std::max(0.0, cube(end) - *layers[k].share * cube(radius)))
                            : end - thick[k];
  }
  if (end > inner) return {};
  return fmt::format("they are thicker than the sphere: nothing is left for {}",
                     toml_string(layers[open].name));
}

bool has_layers(const Scene& scene) {
  const auto* classes = std::get_if<Classes>(&scene.sizes);
  return !scene.layers.empty() || (classes && !classes->layers.empty()) ||
         std::ranges::any_of(scene.zones, [](const Zone& zone) { return !zone.spheres.layers.empty(); });
}

std::vector<std::vector<Layer>> layers_by_class(const Scene& scene) {
  std::vector<std::vector<Layer>> all;
  if (!has_layers(scene)) return all;
  for (const Zone& zone : scene.zones) all.push_back(zone.spheres.layers);
  if (!scene.zones.empty()) {
    if (scene.draws()) all.push_back(scene.layers);
    return all;
  }
  const auto* classes = std::get_if<Classes>(&scene.sizes);
  if (classes && !classes->layers.empty()) return classes->layers;
  return std::vector(classes && !classes->names.empty() ? classes->values.size() : 1, scene.layers);
}

SphereLayers layers_of(const Packing& packing) {
  SphereLayers made;
  made.of_class = layers_by_class(packing.scene);
  if (made.of_class.empty()) return made;
  const Made counted("layers");
  const std::size_t n = packing.spheres.size();
  if (packing.classes.size() != n && made.of_class.size() > 1)
    throw Error(ErrorCode::bad_packing,
                "the layers are those of classes, and some spheres have sizes that no class has");
  std::vector<ClassLayers> classes(made.of_class.begin(), made.of_class.end());
  const auto class_of = [&](std::size_t i) { return packing.classes.empty() ? 0 : packing.classes[i]; };
  made.first.resize(n + 1, 0);
  for (std::size_t i = 0; i < n; ++i) made.first[i + 1] = made.first[i] + classes[class_of(i)].layers.size();
  made.outer.resize(made.first[n]);
  const auto place = [&](std::size_t i) {
    const ClassLayers& of = classes[class_of(i)];
    if (of.layers.empty()) return std::string();
    return of.place(packing.spheres.r[i], packing.seed, i,
                    {made.outer.data() + made.first[i], of.layers.size()});
  };
  std::atomic<std::size_t> wrong = n;  // the first of them, however many threads there are
  constexpr std::size_t grain = 1024;
  parallel_ranges(n, grain, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      if (place(i).empty()) continue;
      for (std::size_t before = wrong; i < before && !wrong.compare_exchange_weak(before, i);) {
      }
      return;
    }
  });
  if (wrong == n) return made;
  throw Error(ErrorCode::bad_packing,
              fmt::format("the layers do not fit into sphere {}, whose radius is {:.6g}: {}", wrong + 1,
                          packing.spheres.r[wrong], place(wrong)));
}

namespace {

[[noreturn]] void fail(const Locations& at, std::string_view key, const std::string& why) {
  throw Error(ErrorCode::bad_scene, why, at.of(key));
}

/// Throws where spheres of that radius cannot have the layers, as thick as they may be.
void require_fit(const std::vector<Layer>& layers, double radius, const Locations& at,
                 std::string_view whose) {
  if (layers.empty()) return;
  std::vector<double> thickness, outer(layers.size());
  for (const Layer& layer : layers)
    if (layer.thickness && layer.thickness->sd > 0) thickness.push_back(thickest(*layer.thickness));
  const std::string why = place_layers(layers, radius, thickness, outer);
  if (why.empty()) return;
  const bool is_cut = !thickness.empty() && why.find("leave one") == std::string::npos;
  fail(at, "layers",
       fmt::format(
           "the \"layers\"{} do not fit into spheres of radius {:.6g}: {}{}", whose, radius, why,
           is_cut ? ", where they are as thick as they may be drawn; give the thickness a \"max\"" : ""));
}

bool has_length(const Layer& layer) { return layer.thickness || layer.radius; }

void require_layers_of(const Scene& scene) {
  const auto* classes = std::get_if<Classes>(&scene.sizes);
  const bool has_own = classes && !classes->layers.empty();
  if (scene.layers.empty() && !has_own) return;
  const Locations& at = has_own ? scene.sizes.locations : scene.locations;
  if (has_own && !scene.layers.empty())
    fail(scene.locations, "layers",
         "\"layers\" of all spheres and those of classes exclude each other; give one of them");
  if (scene.dimension() != 3)
    fail(at, "layers",
         fmt::format("\"layers\" are of spheres in three dimensions, not in {}; leave them out",
                     scene.dimension()));
  if (scene.largest) {  // they are shares, which end alike in spheres of any radius
    for (const std::vector<Layer>& layers : has_own ? classes->layers : std::vector(1, scene.layers)) {
      if (std::ranges::any_of(layers, has_length))
        fail(at, "layers",
             "how large the \"largest\" spheres are is found out: give their layers each a \"share\", not a "
             "thickness or a radius");
      if (layers.empty()) continue;
      std::vector<double> outer(layers.size());
      const std::string why = place_layers(layers, 1, {}, outer);
      if (!why.empty())
        fail(at, "layers", fmt::format("the \"layers\" do not fit, of a radius of 1: {}", why));
    }
    return;
  }
  const double to_radius = scene.scale * (scene.sizes_are_diameters ? 0.5 : 1);
  for (std::size_t k = 0; has_own && k < classes->layers.size(); ++k)
    require_fit(classes->layers[k], to_radius * classes->values[k], at, fmt::format(" of class {}", k + 1));
  if (has_own) return;
  if (const auto* one = std::get_if<Constant>(&scene.sizes); one && scene.draws() && !scene.cells)
    require_layers_fit(scene, to_radius * one->value, to_radius * one->value);
  const std::vector<double>* sizes = classes ? &classes->values : nullptr;
  if (const auto* list = std::get_if<ListedSizes>(&scene.sizes)) sizes = &list->values;
  if (!sizes || sizes->empty()) return;
  const auto [least, most] = std::ranges::minmax(*sizes);
  require_layers_fit(scene, to_radius * least, to_radius * most);
}

}  // namespace

void require_layers_fit(const Scene& scene, double smallest, double largest) {
  require_fit(scene.layers, smallest, scene.locations, "");
  require_fit(scene.layers, largest, scene.locations, "");
}

void require_layers_that_stretch(const Scene& scene) {
  const auto require = [](const std::vector<Layer>& layers, const Locations& at, const std::string& whose) {
    if (std::ranges::any_of(layers, is_open) || std::ranges::none_of(layers, has_length)) return;
    fail(at, "layers",
         fmt::format("the \"layers\"{} end at one radius, and \"polish\" lets all sizes grow until the "
                     "spheres jam: leave one layer without thickness, radius and share, which then takes "
                     "what the others leave, or give all of them shares",
                     whose));
  };
  require(scene.layers, scene.locations, "");
  if (const auto* classes = std::get_if<Classes>(&scene.sizes))
    for (std::size_t k = 0; k < classes->layers.size(); ++k)
      require(classes->layers[k], scene.sizes.locations, fmt::format(" of class {}", k + 1));
}

void require_layers(const Scene& scene) {
  if (!has_layers(scene)) return;
  if (!scene.zones.empty() && !scene.draws() && !scene.layers.empty())
    fail(scene.locations, "layers",
         "\"layers\" in [spheres] are of the sizes there, and there are none: say them in each [[zone]]");
  require_layers_of(scene);
}

}  // namespace bernal
