#include "bernal/scene/nest.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <variant>

#include "bernal/core/dimension.hpp"
#include "bernal/scene/sphere_classes.hpp"

namespace bernal {
namespace {

double volume_in_metres(double volume, Unit unit) { return volume * std::pow(metres_per(unit), 3); }

double volume_of_spheres(const Packing& packing) { return packing.packing_fraction() * packing.volume; }

/// Levels as they are found, those of one depth and name taken together.
class Levels {
 public:
  explicit Levels(const Packing& whole) : whole_(volume_in_metres(whole.volume, whole.scene.unit)) {
    levels_.push_back({.name = "spheres",
                       .packings = 1,
                       .packed = whole.spheres.size(),
                       .spheres = whole.spheres.size(),
                       .unit = whole.scene.unit,
                       .packing_fraction = whole.packing_fraction(),
                       .share = whole.packing_fraction()});
    add_insides(whole, "", 1, 1);
  }

  std::vector<NestLevel> take() { return std::move(levels_); }

 private:
  void add_insides(const Packing& around, const std::string& way, int depth, std::uint64_t times) {
    const std::vector<SphereClass> classes = classes_of(around.scene);
    for (const PackingsInside& inside : around.inside) {
      const std::string name =
          way + (inside.of_class < classes.size() ? classes[inside.of_class].name : "spheres");
      std::vector<std::uint64_t> uses(inside.templates.size(), 0);
      for (const std::uint32_t t : inside.which) uses[t] += times;
      add(name, depth, inside, uses);
      for (std::size_t t = 0; t < uses.size(); ++t)
        add_insides(*inside.templates[t], name + " / ", depth + 1, uses[t]);
    }
  }

  void add(const std::string& name, int depth, const PackingsInside& inside,
           const std::vector<std::uint64_t>& uses) {
    auto found = std::ranges::find_if(  // spheres without a class are called what the outermost are
        levels_, [&](const NestLevel& other) { return other.name == name && other.depth == depth; });
    if (found == levels_.end()) found = levels_.insert(found, NestLevel{.name = name, .depth = depth});
    NestLevel& level = *found;
    double& balls = balls_[name];
    for (std::size_t t = 0; t < uses.size(); ++t) {
      const Packing& packing = *inside.templates[t];
      const auto times = static_cast<double>(uses[t]);
      level.unit = packing.scene.unit;
      ++level.packings;
      level.packed += packing.spheres.size();
      level.filled += uses[t];
      level.spheres += uses[t] * packing.spheres.size();
      if (const auto* ball = std::get_if<Sphere>(&packing.domain))
        level.ball = std::max(level.ball, ball->radius);
      level.share += times * volume_in_metres(volume_of_spheres(packing), packing.scene.unit) / whole_;
      balls += times * volume_in_metres(packing.volume, packing.scene.unit) / whole_;
    }
    level.packing_fraction = balls > 0 ? level.share / balls : 0;
  }

  double whole_;  // volume of the outermost domain, in cubic metres
  std::vector<NestLevel> levels_;
  std::map<std::string, double> balls_;  // over that, of the balls of a level
};

}  // namespace

std::vector<NestLevel> levels_of(const Packing& packing) { return Levels(packing).take(); }

std::uint64_t spheres_of_all_levels(const Packing& packing) {
  std::uint64_t all = 0;
  for (const NestLevel& level : levels_of(packing)) all += level.spheres;
  return all;
}

Vector<3> turned(const Vector<3>& v, const std::array<double, 4>& quaternion) {
  const auto [w, x, y, z] = quaternion;
  const Vector<3> axis(x, y, z), across = axis.cross(v);
  return v + 2 / (w * w + axis.squaredNorm()) * (w * across + axis.cross(across));
}

}  // namespace bernal
