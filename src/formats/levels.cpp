#include "formats/levels.hpp"

#include <algorithm>
#include <bit>
#include <cctype>
#include <map>
#include <unordered_map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/text.hpp"
#include "bernal/scene/sphere_layers.hpp"
#include "scene/scene_entries.hpp"
#include "scene/sphere_matter.hpp"

namespace bernal {
namespace {

/// What stands between the outermost spheres, of which a scene says nothing.
constexpr std::string_view name_of_background = "background";
constexpr double kg_per_m3 = 1e-3;  // in g/cm³

[[noreturn]] void refuse(const Exported& file, const std::string& why) {
  throw Error(ErrorCode::bad_scene, fmt::format("the format {} {}", file.output.format, why),
              file.output.locations.whole);
}

/// A word that every program takes.
std::string plain_name(const std::string& name) {
  std::string made;
  for (const char c : name)
    made += std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_' ? c : '_';
  const bool is_taken = made.empty() || made == "void" || made == "outside" || made == "fill";
  // Not a number, nor a half-space.
  return is_taken || !std::isalpha(static_cast<unsigned char>(made[0])) ? "m_" + made : made;
}

class MaterialList {
 public:
  explicit MaterialList(std::size_t longest_name) : longest_name_(longest_name) {}

  std::uint32_t of(const std::string& name, std::optional<double> density) {
    if (density) *density *= kg_per_m3;
    const auto [known, is_new] =
        known_.try_emplace({name, density}, static_cast<std::uint32_t>(list_.size()));
    return is_new ? add(name, density) : known->second;
  }
  /// Unlike all others, also those of that name.
  std::uint32_t add(const std::string& name, std::optional<double> density) {
    const std::string plain = plain_name(name);
    std::string unlike = plain.substr(0, longest_name_);
    for (int k = 2; std::ranges::find(list_, unlike, &LevelMaterial::name) != list_.end(); ++k) {
      const std::string ending = fmt::format("_{}", k);
      unlike = plain.substr(0, longest_name_ - ending.size()) + ending;
    }
    list_.push_back({unlike, density});
    return static_cast<std::uint32_t>(list_.size() - 1);
  }
  std::vector<LevelMaterial> take() { return std::move(list_); }

 private:
  const std::size_t longest_name_;
  std::map<std::pair<std::string, std::optional<double>>, std::uint32_t> known_;
  std::vector<LevelMaterial> list_;
};

struct ContentHash {
  std::size_t operator()(const SphereContent& content) const {
    std::uint64_t hash = content.level ? *content.level + 1 : 0;
    const auto add = [&](std::uint64_t bits) { hash = (hash ^ bits) * 0x9E3779B97F4A7C15 + (hash >> 29); };
    for (const double outer : content.outer) add(std::bit_cast<std::uint64_t>(outer));
    for (const std::uint32_t material : content.materials) add(material);
    return hash;
  }
};

/// Of a template of what lies inside the spheres of a level.
std::string inner_name(const std::string& outer, std::size_t inside, std::size_t number) {
  return fmt::format("{}-{}-{}", outer, inside + 1, number + 1);
}

void add_level_names(const Packing& packing, const std::string& name, std::vector<std::string>& names) {
  names.push_back(name);
  for (std::size_t k = 0; k < packing.inside.size(); ++k)
    for (std::size_t t = 0; t < packing.inside[k].templates.size(); ++t)
      add_level_names(*packing.inside[k].templates[t], inner_name(name, k, t), names);
}

/// As who wrote the scene knows it.
std::string container_in_words(const SceneContainer& container, const Domain& domain) {
  if (std::holds_alternative<MeshFile>(container)) return "the container, a mesh,";
  const std::string kind(schema::word_of(container, domain));
  if (!container.obstacles.empty()) return fmt::format("the container, a {} with \"obstacles\",", kind);
  if (container.rounding > 0) return fmt::format("the container, a {} with \"rounding\",", kind);
  return fmt::format("the container, of kind \"{}\",", kind);
}

TurnMatrix matrix_of(const std::array<double, 4>& quaternion) {
  const auto [w, x, y, z] = quaternion;
  return {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
          2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
          2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
}

class Builder {
 public:
  Builder(const Exported& file, std::size_t longest_name) : file_(file), materials_(longest_name) {}

  LevelModel build() {
    const std::uint32_t background = materials_.add(std::string(name_of_background), std::nullopt);
    add_level(file_.packing, std::string(name_of_outermost), background);
    Level& outermost = model_.levels.front();
    // Those numbers are the ones that were certified for this file.
    outermost.bounds = bounds_of(file_.domain);
    add_images(outermost);
    model_.materials = materials_.take();
    return std::move(model_);
  }

 private:
  std::uint32_t content_of(SphereContent content) {
    const auto next = static_cast<std::uint32_t>(model_.contents.size());
    const auto [known, is_new] = known_.try_emplace(std::move(content), next);
    if (is_new) model_.contents.push_back(known->first);
    return known->second;
  }

  std::uint32_t add_level(const Packing& packing, const std::string& name, std::uint32_t background) {
    const auto number = static_cast<std::uint32_t>(model_.levels.size());
    model_.levels.emplace_back();
    const bool is_outermost = number == 0;
    const auto converted = unit_conversion(packing.scene.unit, Unit::cm);
    Level level{.name = name, .spheres = is_outermost ? file_.spheres : packing.spheres};
    if (!is_outermost) {
      Mapping mapping{[&](double x, int) { return converted(x); },
                      [&](double r) { return 0.5 * converted(2 * r); }};
      mapping.map(level.spheres);
      level.bounds = bounds_of(mapping.of(packing.domain));
    }
    level.own = level.size();
    level.background = background;
    hold(packing, converted, level);
    model_.levels[number] = std::move(level);
    return number;
  }

  /// Says what each sphere holds.
  void hold(const Packing& packing, const std::function<double(double)>& converted, Level& level) {
    const SphereLayers layers = layers_of(packing);
    const std::size_t n = level.size();
    const auto class_of = [&](std::size_t i) {
      return packing.classes.empty() ? std::uint32_t{0} : packing.classes[i];
    };
    std::vector<std::vector<std::uint32_t>> materials;  // of each class
    for (const std::vector<SphereMatter>& of_class : matter_by_class(packing.scene)) {
      materials.emplace_back();
      for (const SphereMatter& of : of_class)
        materials.back().push_back(materials_.of(of.material, of.density));
    }

    std::vector<SphereContent> held(n);
    for (std::size_t i = 0; i < n; ++i) {
      const std::uint32_t c = class_of(i);
      const std::span<const double> outer = layers.empty() ? std::span<const double>() : layers.of(i);
      const double r = level.spheres.r[i];
      if (outer.empty()) {
        held[i] = {.outer = {r}, .materials = materials[c]};
        continue;
      }
      // Where a treatment of contacts has shrunk a sphere, its layers have shrunk with it.
      const double whole = 0.5 * converted(2 * outer.back());
      for (const double radius : outer)
        held[i].outer.push_back(whole == r ? converted(radius) : converted(radius) * (r / whole));
      held[i].outer.back() = r;
      held[i].materials = materials[c];
    }
    fill(packing, level, held);
    level.contents.resize(n);
    for (std::size_t i = 0; i < n; ++i) level.contents[i] = content_of(std::move(held[i]));
  }

  /// Puts the packings that lie inside of spheres there.
  void fill(const Packing& packing, Level& level, std::vector<SphereContent>& held) {
    for (std::size_t k = 0; k < packing.inside.size(); ++k) {
      const PackingsInside& inside = packing.inside[k];
      if (inside.spheres.empty()) continue;
      if (file_.output.contact != ContactTreatment::none)
        refuse(file_, "shrinks no spheres that hold others; leave ‹contact› out");
      if (inside.layer != 0) refuse(file_, "holds packings inside the innermost layer alone; name that one");
      if (level.turns.empty()) level.turns.assign(level.size(), {1, 0, 0, 0, 1, 0, 0, 0, 1});
      // What surrounds the inner spheres is the layer that they lie in.
      const std::uint32_t around = held[inside.spheres.front()].materials.front();
      std::vector<std::uint32_t> numbers;
      for (std::size_t t = 0; t < inside.templates.size(); ++t)
        numbers.push_back(add_level(*inside.templates[t], inner_name(level.name, k, t), around));
      for (std::size_t j = 0; j < inside.spheres.size(); ++j) {
        const std::uint32_t i = inside.spheres[j];
        held[i].level = numbers[inside.which[j]];
        level.turns[i] = matrix_of(inside.rotations[j]);
      }
    }
  }

  /// Appends the images that reach into the box, where that repeats itself.
  void add_images(Level& level) const {
    const auto periods = file_.periods();
    const Vector<3> edge = level.bounds.size();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!periods[axis]) continue;
      const int k = static_cast<int>(axis);
      const std::size_t n = level.size();
      for (std::size_t i = 0; i < n; ++i)
        for (const double side : {-1.0, 1.0}) {
          const double x = level.spheres.x[axis][i] + side * edge[k], r = level.spheres.r[i];
          if (!(x + r > level.bounds.lower[k] && x - r < level.bounds.upper[k])) continue;
          Vector<3> at = level.center(i);
          at[k] = x;
          if (!reaches(level.bounds, at, r)) continue;
          for (std::size_t c = 0; c < 3; ++c) level.spheres.x[c].push_back(at[static_cast<int>(c)]);
          level.spheres.r.push_back(r);
          level.contents.push_back(level.contents[i]);
          if (!level.turns.empty()) level.turns.push_back(TurnMatrix(level.turns[i]));
        }
    }
  }
  /// Whether it does, or an image of it along a later axis may.
  bool reaches(const Bounds<3>& box, const Vector<3>& at, double r) const {
    const auto periods = file_.periods();
    Vector<3> gap = (box.lower - at).cwiseMax(at - box.upper).cwiseMax(0);
    for (int k = 0; k < 3; ++k)
      if (periods[static_cast<std::size_t>(k)] && gap[k] >= r) return false;
    return gap.squaredNorm() < r * r;
  }

  const Exported& file_;
  LevelModel model_;
  MaterialList materials_;
  std::unordered_map<SphereContent, std::uint32_t, ContentHash> known_;
};

}  // namespace

TurnMatrix transposed(const TurnMatrix& m) { return {m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8]}; }

std::string LevelModel::in_words() const {
  std::string words = "radii";
  if (levels.size() > 1) {
    std::size_t inner = 0;
    for (std::size_t k = 1; k < levels.size(); ++k) inner += levels[k].own;
    words += fmt::format("; {} in {} packings inside of them", grouped(inner), grouped(levels.size() - 1));
  }
  std::vector<std::string_view> names;
  for (const LevelMaterial& material : materials) names.push_back(material.name);
  return words + fmt::format("; materials {}", fmt::join(names, ", "));
}

LevelModel levels_of(const Exported& file, std::size_t longest_name) {
  if (std::holds_alternative<Mesh>(file.domain))
    refuse(file, fmt::format("has no walls of triangles, of which {} is made; ‹container› of bernal import "
                             "gives the spheres another one, such as a box around them",
                             container_in_words(file.packing.scene.container, file.domain)));
  return Builder(file, longest_name).build();
}

std::vector<std::string> level_names(const Packing& packing) {
  std::vector<std::string> names;
  add_level_names(packing, std::string(name_of_outermost), names);
  return names;
}

void require_boxes_repeat(const Exported& file) {
  if (const auto* cylinder = std::get_if<Cylinder>(&file.domain); cylinder && cylinder->periodic)
    refuse(file, "repeats boxes alone, and this is a cylinder that repeats itself; openmc holds it");
}

void require_one_level(const LevelModel& model, const Exported& file) {
  if (model.levels.size() > 1)
    refuse(file, "holds one level, and spheres here hold others; openmc, serpent and scone hold all of them");
}

}  // namespace bernal
