#pragma once
#include <cstddef>
#include <string>

#include "bernal/scene/scene.hpp"

namespace bernal {

/// "[[zone]] 2", for errors about the second.
std::string section_name_of_zone(std::size_t number);

/// What stands in the column class for a zone: its name, or its material where no other zone has that, or
/// "zone 2".
std::string name_of_zone(const Scene&, std::size_t k);

/// Whether its zones are layers, one upon the other: a stage lays them as a bed.
bool lays_zones(const Scene&);

/// What a zone asks for as a scene without zones: its spheres in all of the container, by the stages, gaps,
/// arithmetic, unit and seed of the whole; of a bed as dense as that of the whole, where it says nothing.
Scene scene_of_zone(const Scene&, const Zone&);
/// The same of what lies in no zone.
Scene scene_of_rest(const Scene&);

/// Completes each zone as a scene of its own. Throws Error{bad_scene} where zones contradict each other or
/// the scene around them. Precondition: the stages of the scene are known.
void complete_zones(Scene&);

}  // namespace bernal
