#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bernal/scene/scene.hpp"

namespace bernal {

/// The ball inside a sphere that another scene fills, in the unit of the scene of that sphere.
struct BallOfSphere {
  double radius = 0;
  Unit unit = Unit::m;
};

/// The scene of what lies inside, with the ball in the place of its container.
struct SceneInside {
  Scene scene;
  std::optional<double> asked_radius = {};  ///< of the container, in the scene's unit; none if it is left out
};

/// `read_scene` of what lies inside, whose container may be left out. Throws Error{bad_scene} where that is
/// none that a ball can take the place of.
SceneInside read_scene_inside(const std::filesystem::path& file, const BallOfSphere&);

/// The ball as the container, of the largest radius in the scene's unit that is at most the ball's, see
/// `largest_at_most`. Returns the radius of the container that gives way, if there is one. Throws
/// Error{bad_scene} at the container's place where that is no sphere, or has obstacles.
std::optional<double> put_into_ball(Scene&, const BallOfSphere&);

/// What is filled: the place of a class in `classes_of(scene)`, 0 where that is empty, and of its innermost
/// layer in its layers. Throws Error{bad_scene} for names that are not there.
struct FilledClass {
  std::uint32_t of_class = 0, layer = 0;
  std::string name;    ///< of the class; "spheres" where the scene tells none apart
  std::string folder;  ///< of a result, that holds what lies inside: the name, if it may be one of a folder
};
FilledClass filled_class(const Scene&, const Inside&);

/// The layers of the n-th class, or of all spheres where the scene tells none apart; empty without.
std::vector<Layer> layers_in(const Scene&, std::uint32_t of_class);

/// Throws Error{bad_scene} where the scene's insides contradict each other or the rest of it, as far as no
/// other file has to be read for that.
void check_insides(const Scene&);

}  // namespace bernal
