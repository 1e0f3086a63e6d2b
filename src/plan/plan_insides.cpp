#include "plan/plan_insides.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "bernal/core/dimension.hpp"
#include "bernal/core/text.hpp"
#include "bernal/scene/read_scene.hpp"
#include "bernal/scene/sphere_classes.hpp"
#include "bernal/scene/sphere_layers.hpp"
#include "plan/fitting.hpp"
#include "scene/insides.hpp"
#include "scene/size_kinds.hpp"
#include "scene/zones.hpp"

namespace fs = std::filesystem;

namespace bernal {
namespace {

/// Of what is held of a sphere inside: centre and radius.
constexpr double bytes_of_sphere = 32;

fs::path canonical_or_same(const fs::path& file) {
  std::error_code unknown;
  const fs::path meant = fs::canonical(file, unknown);
  return unknown ? file : meant;
}

/// The radii of a class as the scene has them, and how many of its spheres there are likely to be.
struct RadiiOfClass {
  double least, usual, largest, count;
};

RadiiOfClass of_distribution(const SizeDistribution& radii, double count) {
  constexpr double seldom = 1e-4;
  return {std::max(radii.min(), radii.quantile(0)), radii.quantile(0.5),
          std::isfinite(radii.max()) ? radii.max() : radii.quantile(1 - seldom), count};
}

RadiiOfClass radii_of_class(const Plan& plan, std::uint32_t of_class) {
  const Scene& scene = plan.scene;
  const auto* classes = std::get_if<Classes>(&scene.sizes);
  if (scene.zones.empty() && classes && !(classes->names.empty() && classes->layers.empty())) {
    const double radius = scene.scale * classes->values[of_class] / (scene.sizes_are_diameters ? 2 : 1);
    std::vector<double> shares = shares_of_one_density(*classes);
    double all = 0;
    for (std::size_t k = 0; k < shares.size(); ++k) {
      if (classes->basis != Basis::number) shares[k] /= std::pow(classes->values[k], 3);
      all += shares[k];
    }
    return {radius, radius, radius, plan.expected_count * shares[of_class] / all};
  }
  if (scene.zones.empty()) return of_distribution(*plan.radii, plan.expected_count);
  double count = 0;
  for (const PlannedPart& part : plan.parts)
    if (part.sphere_class == of_class) count += part.plan.expected_count;
  const bool is_zone = of_class < scene.zones.size();
  return of_distribution(
      *radii_of(is_zone ? scene_of_zone(scene, scene.zones[of_class]) : scene_of_rest(scene)), count);
}

/// Where the innermost layer of a sphere of that radius ends.
double ball_in(const Scene& scene, std::uint32_t of_class, double radius) {
  if (layers_in(scene, of_class).empty()) return radius;
  Packing one;
  one.scene = scene;
  one.seed = scene.seed;
  one.spheres = Spheres<dynamic>(3);
  one.spheres.push_back(Vector<dynamic>::Zero(3), radius);
  if (!classes_of(scene).empty()) one.classes = {of_class};
  return layers_of(one).of(0).front();
}

bool is_drawn(const Layer& layer) { return layer.thickness && layer.thickness->sd > 0; }

/// Whether balls of a class differ from sphere to sphere.
bool differ(const Scene& scene, std::uint32_t of_class, const RadiiOfClass& radii) {
  const std::vector<Layer> layers = layers_in(scene, of_class);
  if (layers.empty()) return radii.least < radii.largest;
  if (is_drawn(layers.front())) return true;
  if (layers.front().radius) return false;
  return radii.least < radii.largest || std::ranges::any_of(layers, is_drawn);
}

/// What lies inside one sphere, and the radius that its scene asked for, in its unit, if it did.
struct PlanOfBall {
  Plan plan;
  std::optional<double> asked_radius;
};

/// Spheres that have more volume together than the ball fit into it in no way, whoever packs them.
void require_volume(const Plan& inside) {
  const Scene& scene = inside.scene;
  if (!scene.target.count || !inside.start.spheres.empty() || scene.overlap > 0) return;
  const double least = static_cast<double>(*scene.target.count) * ball_volume(3, inside.radii->min()) /
                       volume_of(inside.domain);
  constexpr double rounding = 1e-9;
  if (least <= 1 + rounding) return;
  throw Error(
      ErrorCode::bad_scene,
      fmt::format("{} spheres of {} {:.6g} {}{} have {:.3g} times the volume of what they are to lie in: "
                  "ask for fewer or smaller ones",
                  grouped(static_cast<std::uint64_t>(*scene.target.count)),
                  scene.sizes_are_diameters ? "diameter" : "radius",
                  (scene.sizes_are_diameters ? 2 : 1) * inside.radii->min(), name_of(scene.unit),
                  inside.radii->max() > inside.radii->min() ? " or more" : "", least),
      scene.target.where);
}

/// Errors of what lies inside say so, at their own place where they have one.
PlanOfBall plan_of_ball(const Plan& around, const Inside& inside, const std::string& name, double radius,
                        const ScenesAround& scenes) {
  const Unit unit = around.scene.unit;
  try {
    const SceneInside read = read_scene_inside(inside.scene, {radius, unit});
    PlanOfBall made{build_inside(read.scene, scenes), read.asked_radius};
    require_volume(made.plan);
    return made;
  } catch (const Error& error) {
    const Location& at = error.location();
    const std::string of = at.line > 0 || at.file.empty() ? "" : at.file + ": ";
    throw Error(error.code(),
                fmt::format("{}{} (inside of {}, in a ball of radius {:.6g} {})", of, error.message(), name,
                            radius, name_of(unit)),
                at.line > 0 ? at : inside.locations.of("scene"));
  }
}

void require_no_circle(const Inside& inside, const ScenesAround& around) {
  const auto found = std::ranges::find(around, canonical_or_same(inside.scene));
  if (found == around.end()) return;
  throw Error(ErrorCode::bad_scene,
              around.size() == 1 || found + 1 == around.end()
                  ? fmt::format("{} would lie inside itself; name another scene", found->filename().string())
                  : fmt::format("{} would lie inside itself, {} scenes further in; name another scene",
                                found->filename().string(), around.end() - found),
              inside.locations.of("scene"));
}

/// Where the container of what lies inside gives way to a ball of another radius: what was asked and what is
/// used. Else nothing.
std::string hint_of_ball(const PlanOfBall& of, const Inside& inside, bool differ) {
  constexpr double rounding = 1e-9;  // of lengths in two units
  const double used = std::get<Sphere>(of.plan.domain).radius;
  if (!of.asked_radius || std::abs(*of.asked_radius / used - 1) <= rounding) return {};
  const std::string_view unit = name_of(of.plan.scene.unit);
  return fmt::format(
      "{} asks for a sphere of radius {:.10g} {} as its container; {}{:.10g} {} is used, the "
      "radius of the ball that it fills{}",
      plain_text(inside.scene.filename().string()), *of.asked_radius, unit, differ ? "about " : "", used,
      unit, differ ? ", of each sphere its own" : "");
}

/// A mass counts spheres by the density of their material, which is not all that these are made of.
void require_no_mass(const Scene& scene, const FilledClass& of, const Inside& inside) {
  const Target& target = scene.target;
  if (!(target.mass_counted || target.bulk_density_asked)) return;
  throw Error(
      ErrorCode::bad_scene,
      fmt::format("\"{}\" is of solid spheres, and those of {} are filled by others: give a \"count\" or a "
                  "\"packing_fraction\" in its place, and explain says what they weigh",
                  target.mass_counted ? "mass" : "bulk_density", of.name),
      inside.locations.of("scene"));
}

PlannedInside planned(const Plan& whole, const Inside& inside, const ScenesAround& around) {
  const Scene& scene = whole.scene;
  require_no_circle(inside, around);
  const FilledClass of = filled_class(scene, inside);
  require_no_mass(scene, of, inside);
  const RadiiOfClass radii = radii_of_class(whole, of.of_class);
  PlannedInside made{.of_class = of.of_class,
                     .layer = of.layer,
                     .name = of.name,
                     .filled = std::max(1.0, std::round(radii.count)),
                     .templates = inside.templates};
  const bool balls_differ = differ(scene, of.of_class, radii);
  if (balls_differ) {
    if (inside.templates)
      throw Error(ErrorCode::bad_scene,
                  fmt::format("the balls inside of {} have several radii, and each needs a packing of its "
                              "own: leave \"templates\" out, or give all of them one radius",
                              of.name),
                  inside.locations.of("templates"));
    plan_of_ball(whole, inside, of.name, ball_in(scene, of.of_class, radii.least), around);
  }
  made.ball = ball_in(scene, of.of_class, radii.usual);
  PlanOfBall of_ball = plan_of_ball(whole, inside, of.name, made.ball, around);
  if (std::string hint = hint_of_ball(of_ball, inside, balls_differ); !hint.empty())
    of_ball.plan.hints.push_back(std::move(hint));
  made.plan = std::move(of_ball.plan);
  return made;
}

/// What packing them brings, with what the spheres around them bring.
void add_items(Plan& whole, const Plan& inside, double packings) {
  for (PlanItem item : inside.items) {
    std::erase(whole.absent, item.name);
    item.seconds *= packings;
    const auto same = std::ranges::find(whole.items, item.name, &PlanItem::name);
    if (same == whole.items.end()) {
      whole.items.push_back(std::move(item));
      continue;
    }
    same->seconds += item.seconds;
    same->bytes = std::max(same->bytes, item.bytes);
    same->if_needed = same->if_needed && item.if_needed;
  }
  std::erase(whole.absent, inside_effect);
}

/// With what is held of those that lie further in.
double expected_count_of_packings(const Plan& plan) {
  double count = plan.expected_count;
  for (const PlannedInside& inside : plan.insides)
    count += inside.packings() * expected_count_of_packings(inside.plan);
  return count;
}

/// "inside of pebble / kernel: …", of what may be said of further levels already; of a long way in both ends.
std::string said_inside(const std::string& name, const std::string& said) {
  constexpr std::string_view begin = "inside of ", step = " / ";
  if (!said.starts_with(begin)) return fmt::format("{}{}: {}", begin, name, said);
  const std::string rest = said.substr(begin.size());
  const std::size_t colon = rest.find(": "), first = rest.find(step), last = rest.rfind(step, colon);
  if (first == rest.npos || first >= colon || first == last)
    return fmt::format("{}{}{}{}", begin, name, step, rest);
  return fmt::format("{}{}{}…{}", begin, name, step, rest.substr(last));
}

void add_costs(Plan& whole, const PlannedInside& made) {
  const Plan& inside = made.plan;
  const double packings = made.packings();
  const auto about = [](double count) {
    return fmt::format("about {}", grouped(static_cast<std::uint64_t>(std::llround(count))));
  };
  const double held = packings * bytes_of_sphere * expected_count_of_packings(inside);
  add_items(whole, inside, packings);
  whole.items.push_back(
      {.name = inside_effect,
       .what = fmt::format(
           "{} of {} each, in balls of radius {:.6g} {}, {} ({}); {} spheres stand for themselves",
           packings == 1 ? "one packing" : grouped(static_cast<std::uint64_t>(packings)) + " packings",
           std::llround(inside.expected_count) == 1 ? "one sphere"
                                                    : about(inside.expected_count) + " spheres",
           made.ball, name_of(whole.scene.unit),
           made.templates ? fmt::format("turned at random in {} spheres", about(made.filled))
                          : "one in every sphere",
           made.name, about(made.filled * expected_count_of_all_levels(inside))),
       .cost = "O(packings N)",
       .seconds = packings * inside.expected_seconds,
       .bytes = held,
       .part = true});
  whole.expected_seconds += packings * inside.expected_seconds;
  whole.expected_memory_bytes += inside.expected_memory_bytes + held;  // of one that is packed, and of all
  if (whole.caution.empty() && !inside.caution.empty())
    whole.caution = said_inside(made.name, inside.caution);
  for (const std::string& hint : inside.hints) whole.hints.push_back(said_inside(made.name, hint));
}

}  // namespace

double expected_count_of_all_levels(const Plan& plan) {
  double count = plan.expected_count;
  for (const PlannedInside& inside : plan.insides)
    count += inside.filled * expected_count_of_all_levels(inside.plan);
  return count;
}

void plan_insides(Plan& whole, const ScenesAround& around) {
  if (whole.scene.inside.empty()) return;
  ScenesAround own = around;
  if (!whole.scene.file.empty()) own.push_back(canonical_or_same(whole.scene.file));
  for (const Inside& inside : whole.scene.inside) {
    whole.insides.push_back(planned(whole, inside, own));
    add_costs(whole, whole.insides.back());
  }
  require_memory(whole);
}

Plan plan_in_ball(const Plan& around, const PlannedInside& inside, double radius) {
  const auto k = static_cast<std::size_t>(&inside - around.insides.data());
  return plan_of_ball(around, around.scene.inside[k], inside.name, radius, {}).plan;
}

}  // namespace bernal
