// The hollow of thick-walled vessels, closed across their openings, against what they hold in closed form.
#include "cad/repair/hollows.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "bernal/cad/read_mesh.hpp"
#include "cad/repair/cgal_surfaces.hpp"
#include "support/broken_meshes.hpp"
#include "support/folder.hpp"
#include "support/meshes.hpp"
#include "support/vessels.hpp"

namespace bernal {
namespace hollows_test {

using namespace test;

struct Vessel {
  std::string name;
  Mesh wall;
  double volume;            ///< of its hollow
  double to_within = 1e-5;  ///< of that: single precision, and corners that it moves
};

/// Radius 10 outside and 9 inside, 20 high, with that bottom and that brim between the outer and the inner
/// wall.
Vessel cup(const std::string& name, const std::vector<Ring>& brim, const std::vector<Ring>& of_hollow,
           double bottom = 1, std::uint32_t corners_inside = 48) {
  std::vector<Ring> profile = {{0, 0}, {10, 0}};
  profile.insert(profile.end(), brim.begin(), brim.end());
  profile.push_back({9, bottom, corners_inside});
  profile.push_back({0, bottom});
  std::vector<Ring> hollow = {{9, bottom, corners_inside}};
  hollow.insert(hollow.end(), of_hollow.begin(), of_hollow.end());
  return {name, revolved(profile), revolved_volume(hollow)};
}

Vessel with_rounded_brim() {
  std::vector<Ring> brim, hollow;
  for (int k = 0; k <= 8; ++k) {
    const double angle = std::numbers::pi * k / 8;
    brim.push_back({9.5 + 0.5 * std::cos(angle), 20 + 0.5 * std::sin(angle)});
    if (k >= 4) hollow.insert(hollow.begin(), brim.back());
  }
  return cup("RoundedBrim", brim, hollow);
}

/// The mouth lies oblique: what is added to the hollow on one side is missing on the other.
Vessel with_oblique_mouth() {
  Vessel vessel = cup("ObliqueMouth", {{10, 20}, {9, 20}}, {{9, 20}});
  for (Vector<3>& v : vessel.wall.vertices)
    if (v[2] == 20) v[2] += 0.6 * v[0];
  return vessel;
}

/// The brim goes up and down four times, by 0.5: the lid lies somewhere between.
Vessel with_wavy_brim() {
  Vessel vessel = cup("WavyBrim", {{10, 20}, {9, 20}}, {{9, 20}});
  for (Vector<3>& v : vessel.wall.vertices)
    if (v[2] == 20) v[2] += 0.5 * std::cos(4 * std::atan2(v[1], v[0]));
  vessel.to_within = 0.03;
  return vessel;
}

/// A cylinder about an axis through the origin, from it to so far.
Mesh rod(double radius, double length, const Vector<3>& direction) {
  return turned(revolved({{0, 0}, {radius, 0}, {radius, length}, {0, length}}), direction);
}

/// Pipes along x and -z that meet, with three round ends. The bore comes out of them a little, and what it
/// holds is that of the bore cut off there.
Vessel tee() {
  const auto pipes = [](double radius, double beyond) {
    const Mesh along = translated(rod(radius, 20 + 2 * beyond, {1, 0, 0}), {-10 - beyond, 0, 0});
    return cad::combine(along, rod(0.8 * radius, 12 + beyond, {0.01, 0.02, -1}), cad::Combine::unite).value();
  };
  return {"Tee", cad::combine(pipes(4, 0), pipes(3, 1), cad::Combine::take_out).value(),
          volume_of(Domain(pipes(3, 0)))};
}

bool is_in(const Vector<3>& p, const Vector<3>& lower, const Vector<3>& upper) {
  return (p.array() > lower.array()).all() && (p.array() < upper.array()).all();
}

/// Two legs of a square pipe side by side, joined below; the short one ends 6 below the long one.
Vessel hook_of_pipe() {
  const Mesh wall = box_work_mesh(
      {{{0, 1, 4, 5, 8, 9, 12, 13}, {0, 1, 4, 5}, {0, 1, 4, 5, 14, 20}}}, [](const Vector<3>& p) {
        const bool is_bore = is_in(p, {1, 1, 1}, {12, 4, 4}) || is_in(p, {1, 1, 1}, {4, 4, 20}) ||
                             is_in(p, {9, 1, 1}, {12, 4, 20});
        const bool is_pipe = is_in(p, {0, 0, 0}, {13, 5, 5}) || is_in(p, {0, 0, 0}, {5, 5, 20}) ||
                             is_in(p, {8, 0, 0}, {13, 5, 14});
        return is_pipe && !is_bore;
      });
  return {"HookOfPipe", wall, 3. * 3 * (11 + 16 + 10)};
}

/// A square bucket whose handle spans its mouth.
std::vector<Vessel> vessels() {
  std::vector<Vessel> all = {
      cup("FlatBrim", {{10, 20}, {9, 20}}, {{9, 20}}),
      cup("ThickBottom", {{10, 20}, {9, 20}}, {{9, 20}}, 15),
      cup("ThinBottom", {{10, 20}, {9, 20}}, {{9, 20}}, 0.01),
      cup("OtherCornersInside", {{10, 20, 61}, {9, 20, 17}}, {{9, 20, 17}}, 1, 17),
      cup("BrimHigherOutside", {{10, 20}, {9, 19.5}}, {{9, 19.5}, {10, 20}}),
      cup("BrimHigherInside", {{10, 19.5}, {9, 20}}, {{9, 20}}),
      cup("LipThatHooksOutward", {{10, 19}, {12, 19}, {12, 17}, {13, 17}, {13, 20}, {9, 20}}, {{9, 20}}),
      cup("Bottle", {{10, 12.5}, {4, 17}, {4, 22}, {3, 22}, {3, 16}, {9, 12}}, {{9, 12}, {3, 16}, {3, 22}}),
      cup("LipInward", {{10, 20}, {6, 20}, {6, 18}, {7, 18}, {7, 19}, {9, 19}},
          {{9, 19}, {7, 19}, {7, 18}, {6, 18}, {6, 20}}),
      with_rounded_brim(),
      with_oblique_mouth(),
      with_wavy_brim(),
      {"FunnelWithUprightEnds", revolved({{2, .1}, {10, 9.9}, {10, 10}, {2, .2}}),
       revolved_volume({{2, .1}, {2, .2}, {10, 10}})},
      {"Hourglass", revolved({{8, 0}, {2, 10}, {8, 20}, {8, 19.2}, {1, 10}, {8, 0.8}}),
       revolved_volume({{8, 0}, {8, 0.8}, {1, 10}, {8, 19.2}, {8, 20}})},
      {"Pipe", revolved({{9, 0}, {10, 0}, {10, 30}, {9, 30}}), revolved_volume({{9, 0}, {9, 30}})},
      {"RingMould", revolved({{2, 0}, {10, 0}, {10, 8}, {9, 8}, {9, 1}, {3, 1}, {3, 8}, {2, 8}}),
       revolved_volume({{9, 1}, {9, 8}}) - revolved_volume({{3, 1}, {3, 8}})},
      {"Bowl", revolved({{0, 0}, {6, 1}, {10, 5}, {9, 5}, {5.5, 2}, {0, 1}}),
       revolved_volume({{0, 1}, {5.5, 2}, {9, 5}})},
      hook_of_pipe(),
  };
  Vessel uneven = cup("CornersOffByRounding", {{10, 20}, {9, 20}}, {{9, 20}});
  uneven.wall = jittered(uneven.wall, 2e-5);
  all.push_back(uneven);
  return all;
}

class Hollows : public ::testing::TestWithParam<Vessel> {};

double hollow_of(const Mesh& wall) {
  const testing::Folder folder;
  MeshFile file{.file = folder.write("vessel.stl", as_binary_stl(wall))};
  file.interior = Interior::cavity;
  return read_container_mesh(file, {}).report.volume;
}

Mesh oblique(const Mesh& mesh) { return turned(mesh, {1, -2, 0.7}); }

void expect_what_its_shape_says(const Vessel& vessel) {
  const auto& [name, wall, volume, to_within] = vessel;
  ASSERT_GT(volume_of(Domain(wall)), 0);
  const auto expect = [&](const Mesh& mesh, double scale, const char* how) {
    const double expected = volume * std::pow(scale, 3);
    try {
      EXPECT_NEAR(hollow_of(mesh), expected, to_within * expected) << how;
    } catch (const Error& error) {
      ADD_FAILURE() << how << ": " << error.what();
    }
  };
  expect(wall, 1, "as it is");
  expect(inverted(wall), 1, "turned inside out");
  expect(scaled(wall, 1e-3), 1e-3, "small");
  expect(scaled(wall, 1e3), 1e3, "large");
  expect(oblique(wall), 1, "oblique");
  expect(turned(wall, {0, 0, -1}), 1, "upside down");
  expect(translated(oblique(wall), {40, -30, 70}), 1, "elsewhere");
}

TEST_P(Hollows, HoldsWhatItsShapeSays) { expect_what_its_shape_says(GetParam()); }

// No parameter, as every listing of the tests would wait for CGAL.
TEST(HollowsOf, ATeeHoldsItsBore) { expect_what_its_shape_says(tee()); }

INSTANTIATE_TEST_SUITE_P(Vessels, Hollows, ::testing::ValuesIn(vessels()),
                         [](const auto& vessel) { return vessel.param.name; });

TEST(HollowsOf, WhatHasNoHollowHasNone) {
  EXPECT_TRUE(cad::hollows_of(box_mesh({0, 0, 0}, {1, 2, 3}), 1e-9).empty());
  EXPECT_TRUE(cad::hollows_of(icosphere_mesh(1, 3), 1e-9).empty());
  const Mesh spool = revolved({{0, 0}, {5, 0}, {5, 1}, {2, 1}, {2, 9}, {5, 9}, {5, 10}, {0, 10}});
  EXPECT_TRUE(cad::hollows_of(spool, 1e-9).empty());
  EXPECT_TRUE(cad::hollows_of(oblique(spool), 1e-9).empty());
}

TEST(HollowsOf, AWallIsRefusedRatherThanFilled) {
  const testing::Folder folder;
  const Mesh spool = revolved({{0, 0}, {5, 0}, {5, 1}, {2, 1}, {2, 9}, {5, 9}, {5, 10}, {0, 10}});
  for (const Mesh& part : {spool, oblique(spool), oblique(icosphere_mesh(1, 2))}) {
    MeshFile file{.file = folder.write("part.off", as_off(part))};
    file.interior = Interior::cavity;
    try {
      ADD_FAILURE() << read_container_mesh(file, {}).report.volume;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("no hollow"), std::string::npos) << error.what();
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    }
  }
}

TEST(HollowsOf, WhatStandsInAHollowIsAWallOfIt) {
  const Vessel cup_of_it = cup("Cup", {{10, 20}, {9, 20}}, {{9, 20}});
  const Mesh with_rod = oblique(joined(cup_of_it.wall, box_mesh({1, 1, 3}, {2, 2, 10})));
  const std::vector<cad::Hollow> hollows = cad::hollows_of(with_rod, 1e-12);
  ASSERT_EQ(hollows.size(), 1U);
  EXPECT_NEAR(hollows[0].volume, cup_of_it.volume - 40, 1e-8);
  EXPECT_NEAR(volume_of(Domain(hollows[0].walls)), cup_of_it.volume + 40, 1e-8);  // not yet turned
}

TEST(HollowOfShell, IsThatOfWallsAndNotOfParts) {
  for (const Vessel& vessel : vessels())
    if (vessel.volume > 1.1 * volume_of(Domain(vessel.wall)) && vessel.name != "Bowl") {
      const auto hollow = cad::hollow_of_shell(vessel.wall, 1e-7);
      ASSERT_TRUE(hollow.has_value()) << vessel.name;
      EXPECT_NEAR(hollow->volume, vessel.volume, 2 * vessel.to_within * vessel.volume) << vessel.name;
    }
  const Mesh bored = revolved({{3, 0}, {10, 0}, {10, 15}, {3, 15}}),
             bearing = revolved({{8, 0}, {10, 0}, {10, 5}, {8, 5}});
  const Mesh flange = revolved({{4, 0}, {5, 0}, {5, 2}, {12, 2}, {12, 4}, {4, 4}});
  for (const Mesh& part : {bored, bearing, flange, l_shape_mesh(5), helix_mesh(), torus_mesh(3, 1, 24, 12),
                           box_mesh({0, 0, 0}, {1, 1, 1})})
    EXPECT_FALSE(cad::hollow_of_shell(part, 1e-9).has_value()) << part.triangles.size();
}

}  // namespace hollows_test
}  // namespace bernal
