#include "scene/repetition.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace bernal::schema {

bool is_tilted(const Scene& scene) {
  const auto* box = std::get_if<PeriodicBox>(&scene.container);
  return box && std::ranges::any_of(box->tilt, [](double length) { return length != 0; });
}

bool is_repeated_mesh(const Scene& scene) {
  const auto* mesh = std::get_if<MeshFile>(&scene.container);
  return mesh && mesh->repeats();
}

void tilt_rule(const PeriodicBox& box, const Section& section) {
  constexpr double most_slender = 1000;
  if (box.tilt.empty()) return;
  if (box.dimension != 2 && box.dimension != 3)
    section.refuse("tilt", "is for boxes of two or three dimensions; leave it out");
  if (const std::size_t needed = box.dimension == 3 ? 3 : 1; box.tilt.size() != needed)
    section.refuse("tilt", needed == 3 ? "must have three lengths, xy, xz and yz"
                                       : "must have one length in two dimensions, xy");
  if (!box.walls.empty())
    section.refuse("tilt",
                   "is for boxes that repeat themselves along every axis; leave out \"tilt\", or \"walls\"");
  if (box.size.empty() && !box.edge)
    section.refuse("tilt",
                   "is a length beside \"size\" or \"edge\"; where the packing decides how large the "
                   "box is, give its proportions by \"size\" and scalable = true");
  const auto [least, most] = box.edge ? std::pair{*box.edge, *box.edge}
                                      : std::pair{std::ranges::min(box.size), std::ranges::max(box.size)};
  if (!(most <= most_slender * least))
    section.refuse(
        "tilt", fmt::format("is for boxes whose longest edge is at most {} of the shortest", most_slender));
  for (const double length : box.tilt)
    if (!(std::abs(length) <= most_slender * least))
      section.refuse("tilt", fmt::format("must be at most {} of the shortest edge; one that differs by whole "
                                         "edges makes the same box",
                                         most_slender));
}

void require_repetition_known(const Scene& scene) {
  const bool tilted = is_tilted(scene), mesh = is_repeated_mesh(scene);
  if (!tilted && !mesh) return;
  const char* const key = tilted ? "tilt" : "periodic";
  const Locations& container = scene.container.locations;
  const auto refuse = [&](std::string_view what, const Location& where) {
    throw Error(ErrorCode::bad_scene,
                tilted ? fmt::format("{} upright periodic boxes only, and this one is tilted; leave out "
                                     "\"tilt\" in [container], or that",
                                     what)
                       : fmt::format("{} no mesh that repeats itself; leave out \"periodic\" in [container], "
                                     "which closes its ends, or that",
                                     what),
                where);
  };
  if (scene.engine) refuse("[engine] knows", scene.engine->locations.whole);
  if (!scene.zones.empty()) refuse("zones know", container.of(key));
  if (scene.largest) refuse("the size \"largest\" knows", scene.locations.whole);
  if (mesh && !scene.container.obstacles.empty()) refuse("\"obstacles\" know", container.of("obstacles"));
  if (tilted && scene.cells) refuse("\"cells\" of [spheres] know", scene.locations.of("cells"));
  if (tilted && !scene.inside.empty())
    refuse("what lies \"inside\" of spheres knows", scene.locations.of("inside"));
}

}  // namespace bernal::schema
