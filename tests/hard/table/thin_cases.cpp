#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "hard/table/hard_case.hpp"
#include "support/meshes.hpp"

// Containers that fill next to nothing of their bounds, hardly hang together, or are much longer than wide.
namespace bernal::hard {
namespace {

const std::string thin = "Thin, long and winding containers";
const std::string part = "kind = \"mesh\"\nfile = \"part.off\"";

std::vector<File> made(const Mesh& mesh) {
  return {{"part.off", [mesh] { return test::as_off(mesh); }}};
}

Mesh grid_of_boxes(int along) {
  Mesh mesh;
  for (int x = 0; x < along; ++x)
    for (int y = 0; y < along; ++y)
      for (int z = 0; z < along; ++z) test::append(mesh, test::box_mesh(1.5 * Vector<3>(x, y, z), {1, 1, 1}));
  return mesh;
}

Mesh shell(double outer, double inner, int levels) {
  return test::joined(test::icosphere_mesh(outer, levels),
                      test::inverted(test::icosphere_mesh(inner, levels)));
}

/// A star of n points between two radii.
Mesh star_mesh(std::uint32_t n, double outer, double inner, double height) {
  std::vector<std::array<double, 2>> polygon;
  std::vector<std::array<std::uint32_t, 3>> caps;
  for (std::uint32_t i = 0; i < 2 * n; ++i) {
    const double angle = std::numbers::pi * i / n, r = i % 2 ? inner : outer;
    polygon.push_back({r * std::cos(angle), r * std::sin(angle)});
  }
  for (std::uint32_t i = 0; i < n; ++i) caps.push_back({(2 * i + 2 * n - 1) % (2 * n), 2 * i, 2 * i + 1});
  for (std::uint32_t i = 2; i < n; ++i) caps.push_back({1, 2 * i - 1, 2 * i + 1});
  return test::extrude(polygon, height, caps);
}

}  // namespace

std::vector<Case> thin_cases() {
  std::vector<Case> cases;
  const std::string twenty = "count = 20\ndiameter = 0.9";
  for (const int power : {2, 4, 6, 8}) {
    const std::string aspect = fmt::format("1e{}", power),
                      times = fmt::format("1e{} times as long as wide", power),
                      wide = fmt::format("1e{} times as wide as thick", power);
    const double a = std::pow(10, power);
    const auto add = [&](const char* name, const std::string& why, const std::string& container,
                         std::vector<File> files = {}) {
      cases.push_back({thin, fmt::format("{}1e{}", name, power), why, scene(container, twenty), exactly(20),
                       std::move(files)});
    };
    add("BoxRod", times, fmt::format("kind = \"box\"\nsize = [1.0, 1.0, {}]", aspect));
    add("BoxPlate", wide, fmt::format("kind = \"box\"\nsize = [{0}, {0}, 1.0]", aspect));
    add("Pipe", times, fmt::format("kind = \"cylinder\"\nradius = 0.5\nheight = {}", aspect));
    add("Disc", wide, fmt::format("kind = \"cylinder\"\nradius = {}\nheight = 1.0", aspect));
    add("MeshRod", times, part, made(test::box_mesh({0, 0, 0}, {1, 1, a})));
    add("MeshPlate", wide, part, made(test::box_mesh({0, 0, 0}, {a, a, 1})));
  }
  const auto add = [&](const std::string& name, const std::string& why, const Mesh& mesh,
                       const std::string& spheres, Expected expected, const std::string& rest = "") {
    cases.push_back({thin, name, why, scene(part, spheres, rest), expected, made(mesh)});
  };
  const std::string settled = stages({"insert", "compress", "shake", "refill"});
  for (const double apart : {100., 1e4}) {
    add(fmt::format("TwoCubes{}Apart", apart), "next to nothing of the bounds is container",
        test::cubes_apart(apart), "diameter = 0.2", at_least(100));
    add(fmt::format("TwoCubes{}ApartSettled", apart), "the same, filled from above", test::cubes_apart(apart),
        "diameter = 0.2", at_least(100), settled);
  }
  add("TwoCubes1e6Apart", "coordinates of single precision cannot tell its spheres apart",
      test::cubes_apart(1e6), "diameter = 0.2", refused("cannot be relaxed"));
  const Mesh pipe = test::turned(test::prism_mesh(8, 1, 1000), {1, 1, 1});
  add("DiagonalPipe", "1 : 500, a millionth of its bounds", pipe, "diameter = 1.6", at_least(400));
  add("DiagonalPipeSettled", "the same, compressed along z", pipe, "count = 200\ndiameter = 1.6",
      explained(150), settled);
  cases.push_back({thin, "DiagonalCylinder", "1 : 500, oblique",
                   scene("kind = \"cylinder\"\naxis = [1.0, 1.0, 1.0]\nradius = 1.0\nheight = 1000.0",
                         "count = 500\ndiameter = 0.5"),
                   exactly(500)});
  add("ObliquePlate", "thinner than its places can be searched",
      test::turned(test::box_mesh({0, 0, 0}, {1e3, 1e3, 1}), {1, 2, 3}), "count = 20\ndiameter = 0.9",
      exactly(20));
  add("ThinShell", "a gap of 0.1 between two round walls", shell(1, 0.9, 3), "count = 300\ndiameter = 0.08",
      exactly(300));
  add("ShellOneSphereThick", "the gap is a hundredth wider than a sphere", shell(1, 0.79, 4),
      "diameter = 0.2", at_least(20));
  add("Hourglass", "a neck a tenth as wide as a sphere", test::square_tube_mesh({{0, 1}, {2, 0.02}, {4, 1}}),
      "diameter = 0.2", at_least(100));
  add("CubesWithANeck", "a neck as wide as a sphere and a thousandth", test::two_cubes_mesh(0.1001),
      "diameter = 0.2", at_least(300));
  add("Baffle", "a thin wall from both sides, and a gap under it", test::baffle_mesh(0.25, 2),
      "diameter = 0.2", at_least(500));
  add("SharpWedge", "an angle of half a degree: the tip takes nothing",
      test::extrude({{0, 0}, {10, -0.05}, {10, 0.05}}, 1, {{0, 1, 2}}), "diameter = 0.05", at_least(100));
  add("Star", "twelve sharp tips and twelve reflex edges", star_mesh(12, 1, 0.4, 1), "diameter = 0.1",
      at_least(200));
  add("StarOfNeedles", "tips of half a degree: there is room in the middle", star_mesh(60, 1, 0.2, 0.5),
      "diameter = 0.05", explained(50));
  add("ClosedHelix", "turns that come near each other", test::helix_mesh(), "diameter = 0.35", explained(100));
  add("RippledTorus", "concave and convex everywhere", test::torus_mesh(1, 0.4, 60, 24, 0.05),
      "diameter = 0.12", at_least(300));
  add("LShape", "one reflex edge", test::l_shape_mesh(1), "diameter = 0.15", at_least(500));
  add("LShapeSettled", "one reflex edge, compressed into a corner", test::l_shape_mesh(1), "diameter = 0.15",
      at_least(400),
      stages({"insert"}) +
          "[[stage]]\ndo = \"compress\"\ndirection = [-1.0, -1.0, -1.0]\n[[stage]]\ndo = "
          "\"refill\"\ndirection = [-1.0, -1.0, -1.0]\n");
  add("TwoHundredSolids", "216 chambers, each for eight spheres", grid_of_boxes(6), "diameter = 0.45",
      at_least(1000));
  add("FewInAThousandSolids", "three spheres among a thousand chambers", grid_of_boxes(10),
      "count = 3\ndiameter = 0.9", exactly(3));
  add("FineSphere", "167 spheres among 81,920 faces", test::icosphere_mesh(1, 6), "diameter = 0.3",
      at_least(150));
  add("FinePrism", "249 spheres among 2,000 sides", test::prism_mesh(2000, 1, 2), "diameter = 0.31",
      at_least(200));
  add("FinePrismFan", "two corners where 2,000 faces meet", test::prism_mesh(2000, 1, 0.5),
      "count = 20\ndiameter = 0.3", exactly(20));
  return cases;
}

}  // namespace bernal::hard
