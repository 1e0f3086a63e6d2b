#include <fmt/format.h>

#include "hard/table/hard_case.hpp"

// None, one, two, three spheres; boxes hardly larger than a sphere; all dimensions.
namespace bernal::hard {

std::vector<Case> count_cases() {
  std::vector<Case> cases;
  const std::string few = "Few spheres";
  for (const int n : {1, 2, 3, 7}) {
    for (const char* stage : {"relax", "grow", "fly"}) {
      cases.push_back({few, fmt::format("{}InAPeriodicBoxBy{}", n, stage), "neighbours are mostly images",
                       scene("kind = \"periodic\"\nedge = 2.0", fmt::format("count = {}\nradius = 0.4", n),
                             stages({stage})),
                       explained(1)});
      if (stage == std::string("fly")) continue;
      cases.push_back(
          {few, fmt::format("{}JammedBy{}", n, stage), "a box that shrinks onto its images",
           scene("kind = \"periodic\"", fmt::format("count = {}\nradius = 0.5", n), stages({stage})),
           n < 7 && stage == std::string("grow") ? refused("2.5 of the largest diameters") : explained(1)});
    }
    for (const Protocol& protocol : protocols())
      cases.push_back({few, fmt::format("{}InACylinder_{}", n, protocol.name), "lists that are nearly empty",
                       scene("kind = \"cylinder\"\nradius = 1.0\nheight = 2.0",
                             fmt::format("count = {}\nradius = 0.3", n), protocol.stages),
                       exactly(static_cast<std::size_t>(n))});
  }
  cases.push_back({few, "HalfABoxWide", "a sphere nearly meets its own image",
                   scene("kind = \"periodic\"\nedge = 1.0", "count = 1\nradius = 0.4999", stages({"relax"})),
                   explained(1)});
  cases.push_back(
      {few, "NarrowPeriodicBox", "one axis as short as a sphere",
       scene("kind = \"periodic\"\nsize = [1.001, 8.0, 8.0]", "count = 40\nradius = 0.5", stages({"relax"})),
       explained(40)});

  const std::string dimensions = "All dimensions";
  for (int d = 1; d <= 8; ++d) {
    const int n = d <= 6 ? 200 + 100 * (d > 3) : 100;
    for (const char* stage : {"relax", "grow", "fly"}) {
      if (stage == std::string("grow") && (d < 2 || d > 6)) continue;
      const bool fly = stage == std::string("fly");
      const double edge = 2.0;
      cases.push_back({dimensions, fmt::format("{}DimensionsBy{}", d, stage),
                       d == 1 ? "rods on a line" : fmt::format("{} axes", d),
                       scene(fmt::format("kind = \"periodic\"\ndimension = {}\n{}", d,
                                         fly ? fmt::format("edge = {}", edge) : ""),
                             fmt::format("count = {}\nradius = {}", n, fly ? d == 1 ? 0.004 : 0.06 : 0.5),
                             stages({stage})),
                       explained(1)});
    }
    if (d >= 2 && d != 3)
      cases.push_back({dimensions, fmt::format("WallsIn{}Dimensions", d),
                       "walls along one axis, periods along the others",
                       scene(fmt::format("kind = \"periodic\"\ndimension = {}\nedge = 3.0\nwalls = [0]", d),
                             "count = 20\nradius = 0.2", stages({"fly"})),
                       explained(20)});
  }
  const std::string boxes = "Between walls and periods";
  for (const char* walls : {"[0]", "[2]", "[0, 1]", "[0, 1, 2]"})
    for (const char* stage : {"relax", "grow", "fly", "insert"})
      cases.push_back({boxes,
                       fmt::format("Walls{}_{}", std::string(walls).size() / 3, stage) +
                           (walls[1] == '2' ? "Upright" : ""),
                       "a bed with sides that repeat themselves",
                       scene(fmt::format("kind = \"periodic\"\nsize = [2.0, 2.0, 2.0]\nwalls = {}", walls),
                             fmt::format("radius = 0.2\npacking_fraction = {}",
                                         stage == std::string("insert") ? 0.2 : 0.45),
                             stages({stage})),
                       explained(20)});
  return cases;
}

}  // namespace bernal::hard
