#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/format.hpp"

namespace bernal {

// A packing as programs of particle transport see it: levels of spheres, each about its own origin. What a
// sphere holds are concentric shells, and within the innermost may lie another level, turned. Lengths are in
// cm. Every writer of such a program begins with this, so that all of them tell of the same.

struct LevelMaterial {
  std::string name;                    ///< letters, digits, '_' and '-' alone, unlike all others
  std::optional<double> density = {};  ///< in g/cm³, where the scene knows it
};

/// What a sphere holds, about its centre. Spheres that hold the same share one.
struct SphereContent {
  std::vector<double> outer = {};             ///< where each shell ends, from the centre out
  std::vector<std::uint32_t> materials = {};  ///< one a shell; that of the innermost stands between what
                                              ///< lies in it
  std::optional<std::uint32_t> level = {};    ///< within the innermost shell

  /// Whether it is the same material throughout.
  bool is_plain() const { return outer.size() == 1 && !level; }
  bool operator==(const SphereContent&) const = default;
};

inline constexpr std::string_view name_of_outermost = "core";

/// R of p' = R p, row by row.
using TurnMatrix = std::array<double, 9>;

struct Level {
  std::string name;  ///< "core", and for the packings that lie in its spheres "core-1-1", …
  Spheres<dynamic> spheres;
  /// So many of them are the packing's, in its order; the rest are images that reach into the box.
  std::size_t own = 0;
  std::vector<std::uint32_t> contents = {};  ///< one a sphere
  /// What lies in a sphere is turned so about its centre; one for each sphere, or none where none is.
  std::vector<TurnMatrix> turns = {};
  std::uint32_t background = 0;  ///< the material between the spheres
  Bounds<3> bounds = {};         ///< of the domain that the level fills

  std::size_t size() const { return spheres.size(); }
  Vector<3> center(std::size_t i) const { return {spheres.x[0][i], spheres.x[1][i], spheres.x[2][i]}; }
  bool is_outermost() const { return name == name_of_outermost; }
  const TurnMatrix* turn_of(std::size_t i) const { return turns.empty() ? nullptr : &turns[i]; }
};

struct LevelModel {
  std::vector<LevelMaterial> materials;
  std::vector<SphereContent> contents;
  std::vector<Level> levels;  ///< the first is the outermost; those that lie in another stand behind it

  const Level& outermost() const { return levels.front(); }
  /// What it holds besides the outermost spheres: "radii; 191,300 in 10 packings inside of them; materials
  /// background, kernel".
  std::string in_words() const;
};

/// The transpose, which takes what is turned back: p = R^T p'.
TurnMatrix transposed(const TurnMatrix&);

/// Names of materials have at most so many letters, at least 10. Throws Error{bad_scene} with one line for a
/// packing whose container is a mesh, and for a treatment of contacts where spheres hold others. Cost: O(N)
/// of all levels.
LevelModel levels_of(const Exported&, std::size_t longest_name = std::string::npos);

/// The names of the levels that it would have.
std::vector<std::string> level_names(const Packing&);

/// For programs that know one level alone: throws Error{bad_scene} where there are more.
void require_one_level(const LevelModel&, const Exported&);
/// For programs in which boxes repeat themselves and nothing else: throws Error{bad_scene} for a cylinder.
void require_boxes_repeat(const Exported&);

}  // namespace bernal
