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

/// Two spheres that hold each other, or a sphere and a wall.
struct Hold {
  std::uint32_t first, second;
  static constexpr std::uint32_t wall = 0xffffffff;
};

/// What holds spheres in their places: those with D + 1 holds or more, the others (rattlers) taken out one
/// after the other, and the holds that are left. Of a sphere and its own image a hold is two.
struct Backbone {
  std::vector<char> has;  ///< each sphere
  std::size_t spheres = 0, holds = 0;
};
Backbone backbone_of(int dimension, std::size_t spheres, std::span<const Hold>);

/// Of frictionless spheres that are pressed together, how many contacts just hold them: equilibrium of C
/// forces is D N - symmetries equations, symmetries being the motions of all spheres together that no wall
/// feels, and what bears a pressure has one solution of these but no second, so
///   C = D N - symmetries + 1.
inline std::ptrdiff_t isostatic_number(int dimension, std::size_t spheres, int symmetries) {
  return dimension * static_cast<std::ptrdiff_t>(spheres) - symmetries + 1;
}

/// The contacts of spheres as they lie, whatever their engine says of them: pairs with a gap ratio
/// (d - ri - rj) / (ri + rj) below `gap`, each image for itself, and walls with (clearance - r) / r below it.
/// In a box [0, edges) that repeats itself but along axes with walls; and in a container. Cost: O(N), and a
/// question to the walls each.
template <int D>
std::vector<Hold> contacts_at(double gap, const Spheres<D>&, const Vector<D>& edges,
                              const std::vector<bool>& walls);
std::vector<Hold> contacts_at(double gap, const Spheres<3>&, const Container&);

/// A box around a container in which spheres of that radius meet no image but along axes that repeat
/// themselves.
Vector<3> edges_around(const Container&, double largest_radius);

/// Where fewer contacts than the isostatic number hold the spheres that are no rattlers, or none is held,
/// what is missing: a clause. Nothing else.
std::optional<std::string> what_is_open(double gap, int dimension, std::size_t spheres, int symmetries,
                                        std::span<const Hold>);

}  // namespace bernal
