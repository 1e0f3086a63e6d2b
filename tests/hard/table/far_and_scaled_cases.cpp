#include <cmath>

#include <fmt/format.h>

#include "hard/table/hard_case.hpp"
#include "support/meshes.hpp"

// Containers of any size and any distance from the origin: the same packing, or the reason why not.
namespace bernal::hard {

std::vector<Case> far_and_scaled_cases() {
  std::vector<Case> cases;
  const auto part = [](const Mesh& mesh) {
    return std::vector<File>{{"part.off", [mesh] { return test::as_off(mesh); }}};
  };
  const std::string mesh = "kind = \"mesh\"\nfile = \"part.off\"";

  const std::string scales = "Scales";
  for (const int power : {-15, -9, -3, 3, 9, 15}) {
    const double s = std::pow(10., power);
    const std::string why = fmt::format("lengths of 1e{}", power),
                      spheres = fmt::format("radius = {:g}", 0.11 * s);
    const std::string suffix = fmt::format("1e{}{}", power < 0 ? "Minus" : "", std::abs(power));
    cases.push_back({scales, "BoxOf" + suffix, why,
                     scene(fmt::format("kind = \"box\"\nsize = [{0:g}, {0:g}, {0:g}]", s), spheres),
                     at_least(70)});
    cases.push_back(
        {scales, "CylinderOf" + suffix, why,
         scene(fmt::format("kind = \"cylinder\"\nradius = {:g}\nheight = {:g}\naxis = [1.0, 0.0, 2.0]",
                           0.6 * s, s),
               spheres),
         at_least(75)});
    cases.push_back({scales, "SphereOf" + suffix, why,
                     scene(fmt::format("kind = \"sphere\"\nradius = {:g}", 0.7 * s), spheres),
                     at_least(100)});
    cases.push_back({scales, "LShapeOf" + suffix, why, scene(mesh, spheres), at_least(200),
                     part(test::scaled(test::l_shape_mesh(), s))});
    cases.push_back({scales, "PeriodicBoxOf" + suffix, why,
                     scene(fmt::format("kind = \"periodic\"\nedge = {:g}", s),
                           fmt::format("packing_fraction = 0.6\nradius = {:g}", 0.11 * s)),
                     at_least(90)});
  }

  const std::string far = "Far from the origin";
  for (const int power : {3, 6, 9}) {
    const std::string at = fmt::format("1e{}", power),
                      why = fmt::format("1e{} lengths away: few digits are left", power);
    const double d = std::pow(10., power);
    for (const Protocol& protocol : protocols()) {
      cases.push_back(
          {far, fmt::format("BoxAt1e{}_{}", power, protocol.name), why,
           scene(fmt::format("kind = \"box\"\ncorner = [{}, 0.0, 0.0]\nsize = [2.0, 2.0, 2.0]", at),
                 "radius = 0.2", protocol.stages),
           protocol.name == "insert" ? explained(30) : at_least(50)});
    }
    cases.push_back(
        {far, fmt::format("CylinderAt1e{}", power), why,
         scene(fmt::format("kind = \"cylinder\"\nradius = 1.0\nheight = 2.0\nbase = [0.0, {}, 1.0]", at),
               "radius = 0.2"),
         at_least(80)});
    cases.push_back(
        {far, fmt::format("SphereAt1e{}", power), why,
         scene(fmt::format("kind = \"sphere\"\nradius = 1.0\ncenter = [0.0, 1.0, -{}]", at), "radius = 0.2"),
         at_least(45)});
    cases.push_back({far, fmt::format("MeshAt1e{}", power), why, scene(mesh, "radius = 0.15"), at_least(60),
                     part(test::translated(test::l_shape_mesh(), {d, -d, d}))});
  }
  cases.push_back(
      {far, "ColumnAt3e8", "endless, and no digits to spare",
       scene("kind = \"cylinder\"\nradius = 1.0\nheight = 10.0\nbase = [3e8, 0.0, 0.0]\nperiodic = true",
             "radius = 0.2"),
       at_least(400)});
  cases.push_back({far, "TooFarForTheseSpheres", "rounding would take a share of every sphere",
                   scene("kind = \"box\"\ncorner = [1e9, 0.0, 0.0]\nsize = [2.0, 2.0, 2.0]", "radius = 0.02"),
                   refused("far from the origin")});
  cases.push_back({far, "FartherThanDoublesReach",
                   "between two neighbouring doubles there are many containers",
                   scene("kind = \"box\"\ncorner = [1e18, 0.0, 0.0]\nsize = [2.0, 2.0, 2.0]", "radius = 0.2"),
                   refused("")});
  return cases;
}

}  // namespace bernal::hard
