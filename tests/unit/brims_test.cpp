// Vessels with something that stands in them or on their brims: their hollow is what one would fill, whatever
// reaches beyond the brim, against what it holds in closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "bernal/cad/read_mesh.hpp"
#include "bernal/core/error.hpp"
#include "cad/repair/cgal_surfaces.hpp"
#include "cad/repair/hollows.hpp"
#include "support/broken_meshes.hpp"
#include "support/folder.hpp"
#include "support/meshes.hpp"
#include "support/vessels.hpp"

namespace bernal {
namespace brims_test {

using namespace test;

struct Vessel {
  std::string name;
  Mesh wall;
  double volume;  ///< of its hollow
};

bool is_in(const Vector<3>& p, const Vector<3>& lower, const Vector<3>& upper) {
  return (p.array() > lower.array()).all() && (p.array() < upper.array()).all();
}
bool is_in_pot(const Vector<3>& p) {
  return is_in(p, {0, 0, 0}, {20, 20, 20}) && !is_in(p, {1, 1, 1}, {19, 19, 21});
}

/// Radius 10 outside and 9 inside, 20 high, and what stands on its bottom about the axis.
Mesh round_pot(const std::vector<Ring>& within = {{0, 1}}, double bore = 0) {
  std::vector<Ring> profile = {{bore, 0}, {10, 0}, {10, 20}, {9, 20}, {9, 1}};
  profile.insert(profile.end(), within.begin(), within.end());
  return revolved(profile);
}
const double round_volume = revolved_volume({{9, 1}, {9, 20}});

std::vector<Vessel> with_something_in_it() {
  return {
      {"Standpipe", round_pot({{2, 1}, {2, 30}, {1, 30}}, 1),
       round_volume - revolved_volume({{2, 1}, {2, 20}})},
      {"Core", round_pot({{2, 1}, {2, 30}, {0, 30}}), round_volume - revolved_volume({{2, 1}, {2, 20}})},
      {"CoreALittleHigher", round_pot({{2, 1}, {2, 20.2}, {0, 20.2}}),
       round_volume - revolved_volume({{2, 1}, {2, 20}})},
      {"LowCore", round_pot({{2, 1}, {2, 15}, {0, 15}}), round_volume - revolved_volume({{2, 1}, {2, 15}})},
      {"Cone", round_pot({{6, 1}, {0, 30}}), round_volume - revolved_volume({{6, 1}, {60 / 29., 20}})},
      {"Mushroom", round_pot({{2, 1}, {2, 25}, {6, 25}, {6, 27}, {0, 27}}),
       round_volume - revolved_volume({{2, 1}, {2, 20}})},
      {"HighInnerCup", round_pot({{4, 1}, {4, 30}, {3, 30}, {3, 2}, {0, 2}}),
       round_volume - revolved_volume({{4, 1}, {4, 20}})},
      {"LowInnerCup", round_pot({{4, 1}, {4, 10}, {3, 10}, {3, 2}, {0, 2}}),
       round_volume - revolved_volume({{4, 1}, {4, 10}}) + revolved_volume({{3, 2}, {3, 10}})},
      {"LooseRod", joined(round_pot(), box_mesh({1, 1, 3}, {2, 2, 30})), round_volume - 4 * 17},
  };
}

std::vector<Vessel> with_something_on_it() {
  const std::vector<double> all = {0, 1, 19, 20}, across = {0, 1, 9, 11, 19, 20};
  const double pot = 18. * 18 * 19;
  const auto bail = [&](double top) {
    return box_work_mesh({all, across, {0, 1, 20, top - 1, top}}, [top](const Vector<3>& p) {
      return is_in_pot(p) ||
             (is_in(p, {0, 9, 20}, {20, 11, top}) && !is_in(p, {1, 9, 20}, {19, 11, top - 1}));
    });
  };
  return {
      {"Bail", bail(35), pot},
      {"FlatBail", bail(23), pot},
      {"FourPosts",
       box_work_mesh({all, all, {0, 1, 20, 35}},
                     [](const Vector<3>& p) {
                       const bool is_at_corner = (p[0] < 1 || p[0] > 19) && (p[1] < 1 || p[1] > 19);
                       return is_in_pot(p) || (is_at_corner && is_in(p, {0, 0, 20}, {20, 20, 35}));
                     }),
       pot},
      {"OnePost",
       box_work_mesh({across, all, {0, 1, 20, 35}},
                     [](const Vector<3>& p) {
                       return is_in_pot(p) || is_in(p, {9, 0, 20}, {11, 1, 35});
                     }),
       pot},
      {"StepInTheBrim",
       box_work_mesh({{{0, 1, 10, 19, 20}, all, {0, 1, 16, 20}}},
                     [](const Vector<3>& p) {
                       return is_in_pot(p) && !is_in(p, {10, -1, 16}, {21, 21, 21});
                     }),
       18. * 18 * 15},
      {"DeepStepInTheBrim",
       box_work_mesh({{{0, 1, 10, 19, 20}, all, {0, 1, 10, 20}}},
                     [](const Vector<3>& p) {
                       return is_in_pot(p) && !is_in(p, {10, -1, 10}, {21, 21, 21});
                     }),
       18. * 18 * 9},
      {"NotchInTheBrim",
       box_work_mesh({{{0, 1, 8, 12, 19, 20}, all, {0, 1, 17, 20}}},
                     [](const Vector<3>& p) {
                       return is_in_pot(p) && !is_in(p, {8, -1, 17}, {12, 2, 21});
                     }),
       18. * 18 * 16},
      {"PartitionBelowTheBrim",
       box_work_mesh({{{0, 1, 12, 13, 19, 20}, all, {0, 1, 15, 20}}},
                     [](const Vector<3>& p) {
                       return is_in_pot(p) || is_in(p, {12, 1, 1}, {13, 19, 15});
                     }),
       pot - 18 * 14},
      {"PartitionIntoEqualHalves",
       box_work_mesh({{{0, 1, 9.5, 10.5, 19, 20}, all, {0, 1, 20}}},
                     [](const Vector<3>& p) {
                       return is_in_pot(p) || is_in(p, {9.5, 1, 1}, {10.5, 19, 20});
                     }),
       17. * 18 * 19},
      {"ShortPipe", revolved({{9, 0}, {10, 0}, {10, 6}, {9, 6}}), revolved_volume({{9, 0}, {9, 6}})},
  };
}

/// Cut and joined with CGAL, which every listing of the tests would wait for if these were parameters.
std::vector<Vessel> with_posts_and_steps_on_round_brims() {
  Mesh tripod = round_pot();
  for (const double angle : {0., 2.1, 4.2})
    tripod = cad::combine(tripod,
                          translated(box_mesh({-.3, -.3, 0}, {.6, .6, 10}),
                                     {9.5 * std::cos(angle), 9.5 * std::sin(angle), 19}),
                          cad::Combine::unite)
                 .value();
  const Mesh stepped =
      cad::combine(round_pot(), box_mesh({-20, -20, 15}, {40, 20, 40}), cad::Combine::take_out).value();
  return {{"ThreePostsOnARoundBrim", tripod, round_volume},
          {"RoundBrimWithAStep", stepped, revolved_volume({{9, 1}, {9, 15}})}};
}

/// With a closed void in its wall, from a radius to another one.
Vessel flask(const std::string& name, double radius, double outer) {
  const Mesh wall = revolved({{0, 0}, {outer, 0}, {outer, 22}, {radius, 22}, {radius, 4}, {0, 4}});
  const Mesh jacket =
      revolved({{0, 1}, {outer - 1, 1}, {outer - 1, 21}, {radius + 1, 21}, {radius + 1, 3}, {0, 3}});
  return {name, joined(wall, inverted(jacket)), revolved_volume({{radius, 4}, {radius, 22}})};
}

class Brims : public ::testing::TestWithParam<Vessel> {
 protected:
  testing::Folder folder;
};

double hollow_of(const testing::Folder& folder, const Mesh& wall,
                 const std::variant<Interior, Vector<3>>& interior = Interior::cavity) {
  MeshFile file{.file = folder.write("vessel.stl", as_binary_stl(wall))};
  file.interior = interior;
  return read_container_mesh(file, {}).report.volume;
}

void expect_what_one_would_fill_in(const Vessel& vessel, const testing::Folder& folder) {
  const auto& [name, wall, volume] = vessel;
  const Mesh oblique = turned(wall, {1, -2, 0.7});
  for (const Mesh& mesh : {wall, oblique, inverted(turned(wall, {0, 0, -1}))}) {
    try {
      EXPECT_NEAR(hollow_of(folder, mesh), volume, 1e-5 * volume) << name;
    } catch (const Error& error) {
      ADD_FAILURE() << name << ": " << error.what();
    }
  }
}

TEST_P(Brims, HoldWhatOneWouldFillIn) { expect_what_one_would_fill_in(GetParam(), folder); }

TEST(RoundBrims, HoldWhatOneWouldFillIn) {
  for (const Vessel& vessel : with_posts_and_steps_on_round_brims())
    expect_what_one_would_fill_in(vessel, testing::Folder());
}

const auto name_of_vessel = [](const auto& vessel) { return vessel.param.name; };
INSTANTIATE_TEST_SUITE_P(In, Brims, ::testing::ValuesIn(with_something_in_it()), name_of_vessel);
INSTANTIATE_TEST_SUITE_P(On, Brims, ::testing::ValuesIn(with_something_on_it()), name_of_vessel);
INSTANTIATE_TEST_SUITE_P(Jacket, Brims, ::testing::Values(flask("Thin", 9, 12)), name_of_vessel);

// None is clearly the largest, or a void is larger that cannot be filled: every one is offered by a point
// that chooses it.
TEST(HollowsToChooseFrom, AreListedWithAPointOfEach) {
  const Vessel two{"Two",
                   box_work_mesh({{{0, 1, 12, 13, 19, 20}, {0, 1, 19, 20}, {0, 1, 20}}},
                                 [](const Vector<3>& p) {
                                   return is_in_pot(p) || is_in(p, {12, 1, 1}, {13, 19, 20});
                                 }),
                   11. * 18 * 19};
  const Vessel wide_pipe{"Pipe", round_pot({{5, 1}, {5, 30}, {4, 30}}, 4),
                         round_volume - revolved_volume({{5, 1}, {5, 20}})};
  const testing::Folder folder;
  for (const Vessel& vessel : {two, flask("Thick", 5, 12), flask("Huge", 3, 15), wide_pipe})
    for (const Mesh& wall : {vessel.wall, turned(vessel.wall, {1, -2, 0.7})}) {
      std::string said;
      try {
        EXPECT_NEAR(hollow_of(folder, wall), vessel.volume, 1e-5 * vessel.volume) << vessel.name;
        continue;
      } catch (const Error& error) {
        said = error.what();
      }
      EXPECT_NE(said.find("has 2 hollows, and none is clearly the largest"), said.npos) << said;
      EXPECT_EQ(said.find('\n'), said.npos) << said;
      std::size_t at = 0, right = 0;
      for (; (at = said.find("interior = [", at)) != said.npos; ++at) {
        Vector<3> point;
        ASSERT_EQ(
            std::sscanf(said.c_str() + at, "interior = [%lf, %lf, %lf]", &point[0], &point[1], &point[2]), 3);
        right += std::abs(hollow_of(folder, wall, point) / vessel.volume - 1) < 1e-5;
      }
      EXPECT_EQ(right, 1U) << vessel.name << ": " << said;
    }
}

// A lid that lies in no plane, where no plane closes all of the hollow, may be drawn up by a step or by what
// stands on its rim, and a bolt hole may not be meant: both are said.
TEST(HollowsToChooseFrom, AreCautionsWhereTheyMayNotBeMeant) {
  const testing::Folder folder;
  const auto caution_of = [&](const Mesh& wall) {
    MeshFile file{.file = folder.write("part.stl", as_binary_stl(wall))};
    file.interior = Interior::cavity;
    const std::vector<std::string> cautions = read_container_mesh(file, {}).report.cautions;
    return cautions.empty() ? std::string() : cautions.front();
  };
  EXPECT_EQ(caution_of(round_pot()), "");
  const Mesh stepped =
      box_work_mesh({{{0, 1, 10, 19, 20}, {0, 1, 19, 20}, {0, 1, 16, 20}}}, [](const Vector<3>& p) {
        const bool is_pipe = is_in(p, {0, 0, 0}, {20, 20, 20}) && !is_in(p, {1, 1, -1}, {19, 19, 21});
        return is_pipe && !is_in(p, {10, -1, 16}, {21, 21, 21});
      });
  EXPECT_NE(caution_of(stepped).find("not all its lids are planar"), std::string::npos)
      << caution_of(stepped);
  const Mesh spool = revolved({{1, 0}, {15, 0}, {15, 1}, {2, 1}, {2, 29}, {15, 29}, {15, 30}, {1, 30}});
  EXPECT_NE(caution_of(spool).find("% of the free volume"), std::string::npos) << caution_of(spool);
}

TEST(HollowOfShell, IsThatOfShortPipesAndNotOfRings) {
  for (const double height : {14., 10., 6., 4.}) {
    const auto hollow = cad::hollow_of_shell(revolved({{9, 0}, {10, 0}, {10, height}, {9, height}}), 1e-7);
    ASSERT_TRUE(hollow.has_value()) << height;
    EXPECT_NEAR(hollow->volume, revolved_volume({{9, 0}, {9, height}}), 1e-6) << height;
  }
  for (const double inner : {5., 8.})
    EXPECT_FALSE(
        cad::hollow_of_shell(revolved({{inner, 0}, {10, 0}, {10, 2}, {inner, 2}}), 1e-7).has_value());
}

}  // namespace brims_test
}  // namespace bernal
