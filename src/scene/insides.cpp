#include "scene/insides.hpp"

#include <algorithm>
#include <ranges>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/text.hpp"
#include "bernal/scene/sphere_classes.hpp"
#include "bernal/scene/sphere_layers.hpp"
#include "scene/known_words.hpp"
#include "scene/scene_entries.hpp"
#include "scene/toml_text.hpp"

namespace bernal {
namespace {

[[noreturn]] void fail(const Inside& inside, std::string_view key, const std::string& message) {
  throw Error(ErrorCode::bad_scene, message, inside.locations.of(key));
}

/// Its place among the names; throws with the nearest one for another.
std::uint32_t place_of(const std::string& name, const std::vector<std::string_view>& names,
                       const Inside& inside, std::string_view key, std::string_view what) {
  const auto found = std::ranges::find(names, name);
  if (found == names.end())
    fail(inside, key,
         fmt::format("\"inside\" names a {} {} that is not there{}", what, toml_string(name),
                     remedy(name, names)));
  return static_cast<std::uint32_t>(found - names.begin());
}

std::uint32_t class_of(const Scene& scene, const Inside& inside, const std::vector<SphereClass>& classes) {
  std::vector<std::string_view> names;
  for (const SphereClass& of : classes) names.push_back(of.name);
  if (!names.empty()) {
    if (inside.of_class.empty() && names.size() > 1)
      fail(inside, "",
           fmt::format("\"inside\" needs a \"class\", of which there are several: \"{}\"",
                       fmt::join(names, "\", \"")));
    return inside.of_class.empty() ? 0 : place_of(inside.of_class, names, inside, "class", "class");
  }
  const auto* sizes = std::get_if<Classes>(&scene.sizes);
  if (!inside.of_class.empty())
    fail(inside, "class",
         fmt::format("\"inside\" names a class {}, and no class of the scene has a name: {}",
                     toml_string(inside.of_class),
                     sizes ? "give the sizes \"names\", one a class"
                           : "leave \"class\" out, and all spheres are filled"));
  return 0;
}

std::uint32_t innermost_layer(const Scene& scene, const Inside& inside, std::uint32_t of_class) {
  const std::vector<Layer> layers = layers_in(scene, of_class);
  if (layers.empty() && !inside.layer.empty())
    fail(
        inside, "layer",
        fmt::format("\"inside\" names a layer {}, and these spheres have no layers: leave \"layer\" out, and "
                    "what lies inside fills the whole sphere",
                    toml_string(inside.layer)));
  if (layers.empty() || inside.layer.empty()) return 0;
  std::vector<std::string_view> names;
  for (const Layer& layer : layers) names.push_back(layer.name);
  const std::uint32_t layer = place_of(inside.layer, names, inside, "layer", "layer");
  if (layer > 0)
    fail(inside, "layer",
         fmt::format("a packing fills the innermost layer, {}, and {} is a shell around it",
                     toml_string(names.front()), toml_string(inside.layer)));
  return layer;
}

}  // namespace

std::vector<Layer> layers_in(const Scene& scene, std::uint32_t of_class) {
  const std::vector<std::vector<Layer>> all = layers_by_class(scene);
  return of_class < all.size() ? all[of_class] : std::vector<Layer>();
}

FilledClass filled_class(const Scene& scene, const Inside& inside) {
  const std::vector<SphereClass> classes = classes_of(scene);
  FilledClass filled;
  filled.of_class = class_of(scene, inside, classes);
  filled.layer = innermost_layer(scene, inside, filled.of_class);
  filled.name = classes.empty() ? "spheres" : classes[filled.of_class].name;
  const auto is_plain = [](unsigned char c) { return std::isalnum(c) != 0 || c == '-' || c == '_'; };
  filled.folder = std::ranges::all_of(filled.name, is_plain) && filled.name.size() <= 100
                      ? filled.name
                      : fmt::format("class-{}", filled.of_class + 1);
  return filled;
}

std::optional<double> put_into_ball(Scene& scene, const BallOfSphere& ball) {
  std::optional<double> asked;
  if (!scene.container.locations.whole.file.empty()) {
    const bool is_bare = scene.container.obstacles.empty() && scene.container.rounding == 0;
    if (!std::holds_alternative<Sphere>(scene.container) || !is_bare)
      throw Error(ErrorCode::bad_scene,
                  "what lies inside a sphere is packed into the ball there: leave [container] out of this "
                  "scene, or make it a sphere without obstacles, whose place the ball takes",
                  scene.container.locations.whole);
    asked = std::get<Sphere>(scene.container).radius;
  }
  const Locations where = scene.container.locations;
  scene.container = Sphere{.radius = largest_at_most(ball.radius, ball.unit, scene.unit)};
  scene.container.locations = where;
  return asked;
}

void check_insides(const Scene& scene) {
  if (scene.inside.empty()) return;
  if (scene.dimension() != 3)
    fail(scene.inside.front(), "",
         fmt::format("packings lie inside of spheres in three dimensions, not in {}: leave \"inside\" out",
                     scene.dimension()));
  std::set<std::uint32_t> filled;
  for (const Inside& inside : scene.inside) {
    const FilledClass of = filled_class(scene, inside);
    if (!filled.insert(of.of_class).second)
      fail(inside, "class",
           fmt::format("\"inside\" fills the spheres of {} twice; leave one of the two out",
                       toml_string(of.name)));
  }
}

}  // namespace bernal
