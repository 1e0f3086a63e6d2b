#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "bernal/domain/domain.hpp"
#include "bernal/scene/scene.hpp"

namespace bernal {

/// Whether the zones of a scene are solids, chambers or surfaces, each with walls of its own all around.
bool has_own_domains(const Scene&);

/// What of a container is a zone's, or lies in none: its class, see `classes_of`, says which.
struct PlaceOfZone {
  Domain domain;
  std::uint32_t sphere_class;
};
/// The zones in their order, then the pieces of what is left, if the scene has sizes for them. Throws
/// Error{bad_scene} with the zone's place where it has nothing of the container, where two overlap, and where
/// the container cannot be cut there. Notes the digests of the zones' files in the scene, or holds the files
/// to those that stand there.
std::vector<PlaceOfZone> places_of_zones(Scene&, const Domain&);

/// A layer that settles, and the height above the ground where it ends; the last one may have no end.
struct LayerOfZone {
  std::uint32_t sphere_class;
  std::optional<double> level;
};
/// From the ground up, for a container that reaches from `lowest` to `highest` against gravity. Throws
/// Error{bad_scene} as above, and where nothing lies under a layer.
std::vector<LayerOfZone> layers_of_zones(const Scene&, double lowest, double highest);

}  // namespace bernal
