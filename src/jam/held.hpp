#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/container.hpp"

namespace bernal {

/// A contact of two spheres, or of a sphere and a wall.
struct Hold {
  std::uint32_t first, second;
  static constexpr std::uint32_t wall = 0xffffffff;
};

/// The backbone: the spheres with at least D + 1 contacts after the others (rattlers) were removed one by
/// one, and the remaining contacts. A contact of a sphere with its own image counts twice.
struct Backbone {
  std::vector<char> has;  ///< for each sphere
  std::size_t spheres = 0, holds = 0;
};
Backbone backbone_of(int dimension, std::size_t spheres, std::span<const Hold>);

/// The number of contacts that just hold frictionless spheres under pressure. The equilibrium of C forces is
/// D N - symmetries equations, where symmetries are the common motions of all spheres that no wall prevents;
/// under pressure these have exactly one solution, so
///   C = D N - symmetries + 1.
inline std::ptrdiff_t isostatic_number(int dimension, std::size_t spheres, int symmetries) {
  return dimension * static_cast<std::ptrdiff_t>(spheres) - symmetries + 1;
}

/// The contacts of spheres at their positions, independent of the engine: pairs with a gap ratio (d - ri -
/// rj) / (ri + rj) below `gap`, each image separately, and walls with (clearance - r) / r below it. In a box
/// [0, edges), periodic except along axes with walls; and in a container. Cost: O(N), and a wall query each.
template <int D>
std::vector<Hold> contacts_at(double gap, const Spheres<D>&, const Vector<D>& edges,
                              const std::vector<bool>& walls);
std::vector<Hold> contacts_at(double gap, const Spheres<3>&, const Container&);

/// Edges of a box around a container in which spheres of that radius meet no image except along periodic
/// axes.
Vector<3> edges_around(const Container&, double largest_radius);

/// If fewer contacts than the isostatic number hold the backbone, or there is no backbone, a clause that
/// states what is missing.
std::optional<std::string> what_is_open(double gap, int dimension, std::size_t spheres, int symmetries,
                                        std::span<const Hold>);

}  // namespace bernal
