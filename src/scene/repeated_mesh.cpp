#include "scene/repeated_mesh.hpp"

#include <fmt/format.h>

namespace bernal::schema {

bool is_repeated_mesh(const Scene& scene) {
  const auto* mesh = std::get_if<MeshFile>(&scene.container);
  return mesh && mesh->repeats();
}

void require_repetition_known(const Scene& scene) {
  if (!is_repeated_mesh(scene)) return;
  const auto refuse = [&](std::string_view what, const Location& where) {
    throw Error(ErrorCode::bad_scene,
                fmt::format("{} no mesh that repeats itself; leave out \"periodic\" in [container], which "
                            "closes its ends, or that",
                            what),
                where);
  };
  if (scene.engine) refuse("[engine] knows", scene.engine->locations.whole);
  if (!scene.zones.empty()) refuse("zones know", scene.container.locations.of("periodic"));
  if (!scene.container.obstacles.empty())
    refuse("\"obstacles\" know", scene.container.locations.of("obstacles"));
  if (scene.largest) refuse("the size \"largest\" knows", scene.locations.whole);
}

}  // namespace bernal::schema
