#include <fmt/format.h>

#include "hard/table/hard_case.hpp"
#include "support/meshes.hpp"

// Containers with a place for exactly as many spheres as are asked for, or with hardly more.
namespace bernal::hard {
namespace {

const std::string exact_fits = "Exact fits";

Mesh tetrahedron_mesh() {  // regular, between corners of a cube; inradius 1 / sqrt(12) of the cube's edge 1
  return {{{0, 0, 0}, {1, 1, 0}, {1, 0, 1}, {0, 1, 1}}, {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}};
}
Mesh octahedron_mesh() {  // inradius 1 / sqrt(3)
  return {{{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
          {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {1, 0, 5}, {2, 1, 5}, {3, 2, 5}, {0, 3, 5}}};
}

}  // namespace

std::vector<Case> tight_cases() {
  std::vector<Case> cases;
  const auto add = [&](const std::string& name, const std::string& why, const std::string& container,
                       const std::string& spheres, std::size_t n, bool inserted,
                       std::vector<File> files = {}) {
    for (const Protocol& protocol : protocols()) {
      // Random insertion stops at its own packing fraction, after the first of several.
      if (!inserted && (protocol.name == "insert" || protocol.name == "settle")) continue;
      cases.push_back({exact_fits, name + "_" + protocol.name, why,
                       scene(container, spheres, protocol.stages), exactly(n), files});
    }
  };
  const auto mesh = [](const Mesh& made) {
    return std::vector<File>{{"part.off", [made] { return test::as_off(made); }}};
  };
  const std::string part = "kind = \"mesh\"\nfile = \"part.off\"";

  add("SphereOfHalfEdgeInACube", "its centre has one place, a point",
      "kind = \"box\"\nsize = [1.0, 1.0, 1.0]", "count = 1\nradius = 0.5", 1, true);
  add("SphereOfHalfEdgeInACubeAside", "the walls stand at numbers that are no doubles",
      "kind = \"box\"\nsize = [1.0, 1.0, 1.0]\ncorner = [0.1, 0.2, -0.3]",
      "count = 1\nradius = 0.4999999999999999", 1, true);
  add("SphereInACylinderOfItsSize", "touches side, base and lid",
      "kind = \"cylinder\"\nradius = 0.5\nheight = 1.0", "count = 1\nradius = 0.5", 1, true);
  add("SphereInASphereOfItsSize", "touches the wall everywhere",
      "kind = \"sphere\"\nradius = 0.5\ncenter = [1.0, 2.0, 3.0]", "count = 1\nradius = 0.5", 1, true);
  add("SphereOfHalfEdgeInAMesh", "touches six faces of a CAD cube", part, "count = 1\nradius = 0.5", 1, true,
      mesh(test::box_mesh({0, 0, 0}, {1, 1, 1})));
  add("SphereInATetrahedron", "its inradius is no double, and the walls lie oblique", part,
      "count = 1\nradius = 0.28867513459452", 1, true, mesh(tetrahedron_mesh()));
  add("SphereInAnOctahedron", "touches eight oblique faces", part, "count = 1\nradius = 0.57735026918906", 1,
      true, mesh(octahedron_mesh()));
  add("SphereInAPrismOfItsWidth", "touches seven of eight walls", part,
      "count = 1\nradius = 0.86602540378400", 1, true, mesh(test::prism_mesh(6, 1, 1.7320508075688772)));

  add("TwoInATubeWithAMillionthOfPlay", "each has one line to stand on",
      "kind = \"cylinder\"\nradius = 0.5000005\nheight = 2.000001", "count = 2\nradius = 0.5", 2, false);
  add("TwoInATubeOfTheirWidth", "no play across at all",
      "kind = \"cylinder\"\nradius = 0.5\nheight = 2.000001", "count = 2\nradius = 0.5", 2, false);
  add("ThreeInABoxOfTheirWidth", "no play across at all, along y",
      "kind = \"box\"\nsize = [1.0, 3.000001, 1.0]", "count = 3\nradius = 0.5", 3, false);
  add("TenInASquareTubeMesh", "one stands on the other from end to end", part, "count = 10\nradius = 0.5", 10,
      false, mesh(test::box_mesh({0, 0, 0}, {1.000001, 1.000001, 10.00001})));
  const auto among = [&](const std::string& name, const std::string& container, std::size_t n,
                         const std::string& diameters, const std::string& shares, Expected expected,
                         std::vector<File> files = {}) {
    const std::string spheres = fmt::format(
        "count = {}\ndraw = \"quantiles\"\ndiameter = {{ distribution = \"classes\", "
        "values = [{}], shares = [{}], basis = \"number\" }}",
        n, diameters, shares);
    for (const Protocol& protocol : protocols()) {
      const bool standard = protocol.name == "default";
      if (!standard && (protocol.name != "grow" || !files.empty())) continue;
      cases.push_back({exact_fits, standard ? name : name + "_grow",
                       "large ones have a place each, if no small one stands there",
                       scene(container, spheres, protocol.stages), expected, files});
    }
  };
  const std::string cube = "kind = \"box\"\nsize = [4.0, 4.0, 4.0]";
  among("OneThatFitsACubeAmongSmallOnes", cube, 30, "0.4, 4.0", "29, 1", exactly(30));
  among("OneThatNearlyFitsACubeAmongSmallOnes", cube, 30, "0.4, 3.999999", "29, 1", exactly(30));
  among("OneWithAHairOfPlayAmongSmallOnes", cube, 30, "0.4, 3.99999999", "29, 1", exactly(30));
  among("OneThatFitsACylinderAmongSmallOnes", "kind = \"cylinder\"\nradius = 2.0\nheight = 6.0", 30,
        "0.4, 4.0", "29, 1", exactly(30));
  among("AThousandInTheCornersAroundOne", "kind = \"box\"\nsize = [10.0, 10.0, 10.0]", 1000, "0.4, 10.0",
        "999, 1", exactly(1000));
  among("TwoOfWhichOneCanStand", cube, 30, "0.4, 3.9", "28, 2", {Expected::Kind::explained, 29, 29});
  among("OneInEachOfThreeChambers", part, 60, "0.4, 2.0, 3.0, 4.0", "57, 1, 1, 1", exactly(60),
        mesh(test::joined(
            test::joined(test::box_mesh({0, 0, 0}, {4, 4, 4}), test::box_mesh({5, 0, 0}, {3, 3, 3})),
            test::box_mesh({9, 0, 0}, {2, 2, 2}))));
  for (const char* thickness : {"1.0", "1.0000005"})
    add(fmt::format("FiftyInASlabOf{}", thickness[3] ? "OneAndAHair" : "One"),
        "one sphere thick, endless to the sides",
        fmt::format("kind = \"periodic\"\nsize = [10.0, 10.0, {}]\nwalls = [2]", thickness),
        "count = 50\nradius = 0.5", 50, true);
  for (const char* width : {"0.5", "0.5000005"})
    for (const char* protocol : {"default", "relax", "grow"})
      cases.push_back(
          {exact_fits,
           fmt::format("NineInAnEndlessColumnOf{}_{}", width[3] ? "AHairMore" : "TheirWidth", protocol),
           "one above the other, endless",
           scene(fmt::format("kind = \"cylinder\"\nradius = {}\nheight = 10.0\nperiodic = true", width),
                 "count = 9\nradius = 0.5", protocol == std::string("default") ? "" : stages({protocol})),
           {Expected::Kind::explained, 9, 9}});
  for (const Protocol& protocol : protocols()) {
    cases.push_back({exact_fits, "WiderThanATiltedTube_" + protocol.name,
                     "no double is the centre of a sphere as wide as this oblique tube",
                     scene("kind = \"cylinder\"\nradius = 0.5\nheight = 1.0\naxis = [1.0, 2.0, 3.0]",
                           "fill = true\nradius = 0.5", protocol.stages),
                     explained()});
  }
  return cases;
}

}  // namespace bernal::hard
