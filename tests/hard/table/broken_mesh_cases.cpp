#include <cmath>

#include "hard/table/hard_case.hpp"
#include "support/broken_meshes.hpp"

// Surfaces that enclose nothing as they are: refused with the line that helps, and packed with that line.
namespace bernal::hard {

using namespace test;

std::vector<Case> broken_mesh_cases() {
  std::vector<Case> cases;
  const std::string group = "Parts as they come out of CAD";
  const auto add = [&](const std::string& name, const char* why, const Mesh& mesh, Expected expected,
                       const std::string& line = "") {
    cases.push_back({group,
                     name,
                     why,
                     scene("kind = \"mesh\"\nfile = \"part.off\"\n" + line, "diameter = 0.25"),
                     std::move(expected),
                     {{"part.off", [mesh] { return as_off(mesh); }}}});
  };
  const auto around = [](const Vector<3>& center, double radius) {
    return [=](const Vector<3>& v) { return (v - center).norm() < radius; };
  };

  const Mesh tank = divided(box_mesh({0, 0, 0}, {2, 2, 3}), 3), open_tank = without_top(tank, 3);
  add("OpenTop", "a tank without lid encloses nothing", open_tank, refused("cap = \"z = 3\""));
  add("OpenTopCapped", "with the line that was offered", open_tank, of_volume(at_least(500), 12),
      "{offered}");
  add("OpenTopHalfFull", "filled to a level", open_tank, of_volume(at_least(250), 6), "fill_level = 1.5");
  add("OpenTopTilted", "a surface that lies oblique", open_tank, of_volume(at_least(300), 8),
      "cap = \"x + z = 3\"");
  add("CapAboveTheBrim", "a plane that meets nothing", open_tank, refused("meets no surface"),
      "cap = \"z = 4\"");
  const Mesh pipe = without(without_top(tank, 3), [](const Vector<3>& v) { return v[2] == 0; });
  add("PipeOpenAtBothEnds", "two ends at once", pipe, refused("cap = ["));
  add("PipeCappedTwice", "with the line that was offered", pipe, of_volume(at_least(500), 12), "{offered}");

  add("TwoChimneys",
      "a plane for the lower opening would cut the taller chimney off: with the line that was offered",
      two_chimneys_mesh(), of_volume(at_least(1000), 32, 1e-9), "{offered}");
  add("WideRimThatIsNotFlat",
      "no plane closes a cube without two of its sides: with the line that was offered",
      without(divided(box_mesh({0, 0, 0}, {2, 2, 2}), 2),
              [](const Vector<3>& v) { return v[0] == 2 || v[2] == 2; }),
      at_least(200), "{offered}");
  add("SkinOfASheet", "an open vessel has no inside that could be wrapped", open_tank,
      refused("gaps wider than alpha"), "repair = [\"wrap\"]");
  Mesh both_sides = tank;
  for (const auto& [i, j, k] : tank.triangles) both_sides.triangles.push_back({k, j, i});
  add("DrawnFromBothSides", "every face in both orientations", both_sides, of_volume(at_least(500), 12));

  const Mesh cup = cup_mesh();
  add("CupAsASolid", "the wall of a cup is what is closed", cup, of_volume(at_least(1000), 26));
  add("InsideOfACup", "the hollow is meant, not the wall", cup, of_volume(at_least(250), 6),
      "interior = \"cavity\"");
  add("InsideOfACupByAPoint", "a point in the hollow", cup, of_volume(at_least(250), 6),
      "interior = [0.0, 0.0, 1.0]");
  add("CupHalfFull", "the hollow, filled to a level", cup, of_volume(at_least(80), 2),
      "interior = \"cavity\"\nfill_level = 1.0");
  add("AboveTheCup", "a point outside of everything", cup, refused("(0, 0, 5)"),
      "interior = [0.0, 0.0, 5.0]");
  add("TwoCups", "two hollows of one brim", joined(cup, translated(cup, {5, 0, 0})),
      of_volume(at_least(500), 12), "interior = \"cavity\"");

  Mesh sieve = icosphere_mesh(1, 4);
  const double whole = volume_of(Domain(sieve));
  int n = 0;
  std::erase_if(sieve.triangles, [&](const auto&) { return ++n % 40 == 0; });
  add("ManyHoles", "128 faces are missing", sieve, refused("repair = [\"holes\"]"));
  add("ManyHolesClosed", "with the line that was offered", sieve, of_volume(at_least(200), whole, 1e-3),
      "{offered}");
  add(
      "WideHolesClosed", "twelve holes, each around a corner",
      [&] {
        Mesh mesh = icosphere_mesh(1, 3);
        for (const Vector<3>& corner : icosphere_mesh(1, 0).vertices)
          mesh = without(mesh, around(corner, 0.3));
        return mesh;
      }(),
      at_least(180), "repair = [\"holes\"]");

  const Mesh crossing = joined(icosphere_mesh(1, 3), translated(icosphere_mesh(1, 3), {0.7, 0.1, 0.2}));
  add("CrossingShells", "two spheres through each other", crossing,
      refused("repair = [\"self-intersections\"]"));
  add("CrossingShellsUnited", "with the line that was offered", crossing, at_least(300), "{offered}");
  add("FigureOfEight", "a duct through itself", figure_of_eight_mesh(),
      refused("repair = [\"self-intersections\"]"));
  add("FigureOfEightUnited", "with the line that was offered: all of it, once", figure_of_eight_mesh(),
      of_volume(at_least(300), figure_of_eight_volume(), 1e-9), "{offered}");
  add("SpindleTorus", "a surface through itself along a line", torus_mesh(0.5, 1, 48, 24),
      refused("self-intersect"));
  add("SpindleTorusMended", "with the line that was offered", torus_mesh(0.5, 1, 48, 24), at_least(200),
      "{offered}");
  const Mesh box = box_mesh({0, 0, 0}, {1, 1, 1});
  const Mesh edge = joined(box, translated(box, {1, 1, 0}));
  add("CubesThatShareAnEdge", "four faces meet along it", edge, refused("more than two faces"));
  add("CubesThatShareAnEdgeWrapped", "not manifold: with the line that was offered", edge, at_least(60),
      "{offered}");
  const Mesh shared = joined(box, translated(box, {1, 0, 0}));
  add("CubesThatShareAFace", "a wall between two rooms, without thickness", shared,
      refused("more than two faces"));
  add("CubesThatShareAFaceMended", "with the line that was offered", shared, at_least(60), "{offered}");
  add(
      "ABaffleWithoutThickness", "a face across the inside",
      [&] {
        Mesh mesh = box;
        mesh.triangles.push_back({0, 2, 6});
        return mesh;
      }(),
      refused(""));
  add(
      "AFlagOnTop", "a face that hangs by one edge",
      [&] {
        Mesh mesh = box;
        mesh.vertices.emplace_back(0.5, 0.5, 2);
        mesh.triangles.push_back({4, 5, 8});
        return mesh;
      }(),
      refused(""));
  const Mesh soup = jittered(torn(divided(box_mesh({0, 0, 0}, {2, 2, 2}), 3)), 5e-3);
  add("Soup", "faces that hang together nowhere", soup, refused("bernal inspect tries a wrap"));
  add("SoupWrapped", "with the line that was offered", soup, at_least(200), "{offered}");
  add("SoupWelded", "corners half a percent of the box apart",
      jittered(torn(divided(box_mesh({0, 0, 0}, {2, 2, 2}), 3)), 1e-3), at_least(300), "weld = 5e-3");
  add(
      "OneSided", "a Möbius band has no inside",
      [] {
        Mesh mesh;
        for (int s = 0; s < 60; ++s) {
          const double u = 2 * std::numbers::pi * s / 60;
          for (const double w : {-0.3, 0.3})
            mesh.vertices.emplace_back((1 + w * std::cos(u / 2)) * std::cos(u),
                                       (1 + w * std::cos(u / 2)) * std::sin(u), w * std::sin(u / 2));
        }
        for (std::uint32_t s = 0; s < 60; ++s) {
          const std::uint32_t a = 2 * s, b = a + 1, c = s == 59 ? 1 : a + 2, d = s == 59 ? 0 : a + 3;
          mesh.triangles.insert(mesh.triangles.end(), {{a, c, b}, {b, c, d}});
        }
        return mesh;
      }(),
      refused(""));
  add("Pillow", "two sides of one triangle", Mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}}},
      refused(""));
  const Mesh tilted = turned(open_tank, {1, -2, 3});
  add("ObliqueOpening", "the open end lies across no axis: with the line that was offered", tilted,
      of_volume(at_least(450), 12, 2e-3), "{offered}");
  add("UnweldedByRounding",
      "corners differ by the last digit of a float, in a file of doubles: with the line that was offered",
      jittered(torn(tank), 2e-8), of_volume(at_least(300), 12), "{offered}");
  Mesh everything = torn(sieve);
  for (std::size_t t = 0; t < everything.triangles.size(); t += 7)
    std::swap(everything.triangles[t][1], everything.triangles[t][2]);
  add("HolesFlipsAndTears", "holes, flipped faces, corners of their own: with the line that was offered",
      jittered(everything, 1e-9), of_volume(at_least(200), whole, 1e-2), "{offered}");
  add(
      "FoldedOver", "a corner is pulled through the bottom",
      [&] {
        Mesh mesh = box_mesh({0, 0, 0}, {1, 1, 1});
        mesh.vertices[6] = {0.2, 0.2, -0.5};
        return mesh;
      }(),
      refused("self-intersect"));

  const auto with = [&](const std::string& name, const char* why, const std::string& line, Expected expected,
                        const Mesh& obstacle) {
    cases.push_back({group,
                     name,
                     why,
                     scene("kind = \"mesh\"\nfile = \"part.off\"\n" + line, "diameter = 0.25"),
                     std::move(expected),
                     {{"part.off", [tank] { return as_off(tank); }},
                      {"obstacle.off", [obstacle] { return as_off(obstacle); }}}});
  };
  const std::string obstacle = "obstacles = [\"obstacle.off\"]";
  with("AnObstacleInside", "a second file is taken out", obstacle, of_volume(at_least(300), 11),
       box_mesh({.5, .5, .5}, {1, 1, 1}));
  with("AnObstacleThroughTheWall", "a shaft that stands in wall and lid", obstacle,
       of_volume(at_least(300), 12 - .3 * .3 * 2), box_mesh({.85, .85, 1}, {.3, .3, 5}));
  with("AnObstacleThatIsAllOfIt", "nothing is left", obstacle, refused(""),
       box_mesh({-1, -1, -1}, {5, 5, 5}));
  with("AnObstacleOutside", "takes nothing away", obstacle, refused("lies outside of the container"),
       box_mesh({5, 5, 5}, {1, 1, 1}));
  return cases;
}

}  // namespace bernal::hard
