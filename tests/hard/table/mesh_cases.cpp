#include <cmath>

#include <fmt/format.h>

#include "bernal/core/random.hpp"
#include "hard/table/hard_case.hpp"
#include "support/broken_meshes.hpp"

// Closed surfaces that other programs stumble over: they are containers as they are.
namespace bernal::hard {

using namespace test;

std::vector<Case> mesh_cases() {
  std::vector<Case> cases;
  const Mesh box = box_mesh({0, 0, 0}, {1, 1, 1});
  const std::string quarter = "diameter = 0.25";
  const auto add = [&](const std::string& name, const char* why, std::string content, double volume,
                       std::size_t least, const char* file = "part.off", const std::string& spheres = "") {
    cases.push_back(
        {"Meshes that are sound",
         name,
         why,
         scene(fmt::format("kind = \"mesh\"\nfile = \"{}\"", file), spheres.empty() ? quarter : spheres),
         of_volume(at_least(least), volume),
         {{file, [content = std::move(content)] { return content; }}}});
  };
  add("InsideOut", "every face is turned inward", as_off(inverted(box)), 1, 50);
  Mesh flipped = icosphere_mesh(1, 3);
  const double ball = volume_of(Domain(flipped));
  Random random(1, 0);
  for (auto& t : flipped.triangles)
    if (random.uniform() < 0.3) std::swap(t[0], t[1]);
  add("RandomFlips", "three faces in ten are turned inward", as_off(flipped), ball, 200);
  add("EveryFaceTwice", "two skins on one another", as_off(joined(box, box)), 1, 50);
  Mesh reverse = box;
  const auto [i, j, k] = reverse.triangles[0];
  reverse.triangles.push_back({i, k, j});
  add("AFaceAndItsReverse", "a face that encloses nothing", as_off(reverse), 1, 50);
  Mesh point = box;
  point.triangles.push_back({0, 0, 1});
  add("AFaceThatIsAnEdge", "two of its corners are one", as_off(point), 1, 50);
  Mesh split = box;
  const auto [a, b, c] = split.triangles.back();
  const auto middle = index(split.vertices.size());
  split.vertices.push_back(0.5 * (split.vertices[a] + split.vertices[b]));
  split.triangles.back() = {a, middle, c};
  split.triangles.push_back({middle, b, c});
  add("TJunction", "a corner in the middle of a neighbour's edge", as_off(split), 1, 50);
  split.triangles.push_back({a, b, middle});
  add("ACollinearFace", "closes that edge, without area", as_off(split), 1, 50);
  add("Unwelded", "every face has corners of its own", as_off(torn(box)), 1, 50);
  add("SixDigits", "a text STL of a sphere with six digits", as_text_stl(icosphere_mesh(1, 3), "part", 6),
      ball, 200, "part.stl");
  add(
      "MinusZero", "-0 and 0 are one corner",
      [&] {
        std::string stl = as_text_stl(box);
        stl.replace(stl.find("vertex 0 0 0"), 12, "vertex -0.0 -0.0 0");
        return stl;
      }(),
      1, 50, "part.stl");
  add("CubesThatShareACorner", "no sphere passes through a point",
      as_off(joined(box, translated(box, {1, 1, 1}))), 2, 100);
  const Mesh outer = box_mesh({-1, -1, -1}, {2, 2, 2}), cavity = box_mesh({-.5, -.5, -.5}, {1, 1, 1}),
             island = box_mesh({-.3, -.3, -.3}, {.6, .6, .6});
  add("ACavity", "a wall within the wall", as_off(joined(outer, inverted(cavity))), 7, 300);
  add("ACavityTurnedWrong", "its faces look outward", as_off(joined(outer, cavity)), 7, 300);
  add("AnIslandInACavity", "an inside in a hole in an inside", as_off(joined(joined(outer, cavity), island)),
      7.216, 300);
  add("ChambersThatDoNotMeet", "two solids, one inside out",
      as_off(joined(box, inverted(translated(box, {3, 0, 0})))), 2, 100);
  for (const int power : {3, 6, 9}) {
    const double thin = std::pow(10, -power);
    // A fin as thin as this stands on the box, part of its surface.
    Mesh fin = extrude({{0, 0}, {1, 0}, {1, 1}, {.5 + thin, 1}, {.5 + thin, 2}, {.5, 2}, {.5, 1}, {0, 1}}, 1,
                       {{0, 6, 7}, {0, 1, 6}, {1, 3, 6}, {1, 2, 3}, {3, 4, 6}, {4, 5, 6}});
    add(fmt::format("AFinOf1eMinus{}", power), "two walls that nearly touch", as_off(fin), 1 + thin, 50);
  }
  for (const int power : {3, 7, 12}) {
    const double sliver = std::pow(10, -power);
    Mesh slivers = box;
    slivers.vertices.emplace_back(0.5, sliver, 0);
    for (auto& t : box.triangles)
      if (t[0] == 0 && t[1] == 2 && t[2] == 1) {
        *std::ranges::find(slivers.triangles, t) = {0, 2, 8};
        slivers.triangles.push_back({2, 1, 8});
        slivers.triangles.push_back({1, 0, 8});
      }
    add(fmt::format("ASliverOf1eMinus{}", power), "a face far longer than wide", as_off(slivers), 1, 50);
  }
  const Mesh hundred = divided(box, 4);
  add("CoplanarNeighbours", "faces that continue each other", as_off(hundred), 1, 50);
  return cases;
}

}  // namespace bernal::hard
