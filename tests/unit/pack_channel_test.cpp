// Packings in meshes that repeat themselves, stage by stage, and what becomes of them.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "bernal/core/error.hpp"
#include "bernal/formats/export.hpp"
#include "bernal/measure/measure.hpp"
#include "bernal/plan/plan.hpp"
#include "bernal/result/read_packing.hpp"
#include "bernal/result/write_packing.hpp"
#include "bernal/run/run.hpp"
#include "bernal/scene/read_scene.hpp"
#include "bernal/verify/certificate.hpp"
#include "result/write_off.hpp"
#include "support/channels.hpp"
#include "support/exports.hpp"
#include "support/folder.hpp"
#include "support/meshes.hpp"

namespace bernal {
namespace pack_channel_test {

class PackChannel : public ::testing::Test {
 protected:
  void write(const std::string& name, const Mesh& mesh) {
    std::ofstream(folder.path() / name) << as_off_file(mesh);
  }
  /// The scene of a mesh of this folder, in its own file.
  Scene scene(const std::string& name, const std::string& spheres, const std::string& axes = "\"z\"") {
    const auto file = folder.path() / (name + ".toml");
    std::ofstream(file) << "unit = \"mm\"\n[container]\nkind = \"mesh\"\nfile = \"" << name
                        << "\"\nunit = \"mm\"\nperiodic = " << axes << "\n[spheres]\n"
                        << spheres;
    return read_scene(file);
  }
  Packing packed(const Scene& scene, int threads = 2) {
    RunOptions options;
    options.threads = threads;
    return run(build(scene), options);
  }
  Packing packed(const std::string& name, const std::string& spheres, const std::string& axes = "\"z\"") {
    return packed(scene(name, spheres, axes));
  }
  static Packing packed_in(const std::string& container, const std::string& spheres) {
    return run(build(
        parse_scene("unit = \"mm\"\n[container]\n" + container + "[spheres]\n" + spheres, "test.toml")));
  }
  std::string refusal(const std::string& name, const std::string& spheres,
                      const std::string& axes = "\"z\"") {
    try {
      build(scene(name, spheres, axes));
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }
  static void expect_certified(const Packing& packing) {
    const Certificate certificate = certify(packing.spheres, packing.domain);
    EXPECT_TRUE(certificate.certified) << certificate.statement;
  }
  /// How many spheres reach through an end of the period.
  static int through_the_end(const Packing& packing) {
    const Boundary<3> boundary = boundary_of<3>(packing.domain);
    int count = 0;
    for (std::size_t i = 0; i < packing.spheres.size(); ++i) {
      const Vector<3> p = Vector<3>(packing.spheres.center(i)) - boundary.origin;
      for (int k = 0; k < 3; ++k)
        count += boundary.repeats(k) &&
                 (p[k] < packing.spheres.r[i] || p[k] > boundary.edges[k] - packing.spheres.r[i]);
    }
    return count;
  }

  testing::Folder folder;
};

// The prism of as large a section: its walls lie half a percent of a sphere inside of the round one at most.
TEST_F(PackChannel, APrismOfManySidesIsTheColumn) {
  constexpr double turn = 2 * std::numbers::pi;
  constexpr std::uint32_t sides = 64;
  const double radius = 6 * std::sqrt(turn / (sides * std::sin(turn / sides)));
  const Mesh prism = test::closed_channel([&](double, double) { return radius; }, sides, 1, 0, 16);
  write("prism.off", prism);
  const Packing channel = packed("prism.off", "diameter = 1.0\n"),
                column = packed_in("kind = \"cylinder\"\nradius = 6\nheight = 16\nperiodic = true\n",
                                   "diameter = 1.0\n");
  EXPECT_EQ(channel.outcome, Outcome::converged) << channel.reason;
  EXPECT_GT(channel.spheres.size(), 1900u);
  EXPECT_NEAR(channel.packing_fraction(), column.packing_fraction(), 0.01);
  EXPECT_NEAR(volume_of(channel.domain), volume_of(column.domain), 1e-9 * volume_of(column.domain));
  EXPECT_GT(through_the_end(channel), 50);
  expect_certified(channel);
  expect_certified(column);

  // The certificates agree where the walls leave no doubt: in the column within the prism and around it.
  const double inner = radius * std::cos(0.5 * turn / sides);
  const auto in_column = [&](double r) {
    return certify(channel.spheres, Cylinder{.radius = r, .height = 16, .periodic = true});
  };
  EXPECT_TRUE(in_column(radius).certified);
  const Domain around = test::repeating(prism);
  for (const double shift : {0.0, 0.3, -1.0}) {
    Spheres<dynamic> moved = column.spheres;
    for (std::size_t i = 0; i < moved.size(); i += 7) moved.x[0][i] += shift;
    const Certificate in_prism = certify(moved, around);
    const Certificate within = certify(moved, Cylinder{.radius = inner, .height = 16, .periodic = true}),
                      outside = certify(moved, Cylinder{.radius = radius, .height = 16, .periodic = true});
    EXPECT_EQ(in_prism.overlapping_pairs, within.overlapping_pairs);
    EXPECT_LE(in_prism.protruding_spheres, within.protruding_spheres);
    EXPECT_GE(in_prism.protruding_spheres, outside.protruding_spheres);
    if (shift != 0) {
      EXPECT_GT(in_prism.protruding_spheres, 0u);
    }
  }
}

TEST_F(PackChannel, ASquareChannelIsTheBoxBetweenFourWalls) {
  write("square.off", test::box_mesh({0, 0, 0}, {7, 7, 9}));
  const std::string spheres =
      "diameter = { distribution = \"uniform\", min = 0.6, max = 1.0, basis = \"number\" }\n";
  const Packing channel = packed("square.off", spheres),
                box = packed_in("kind = \"periodic\"\nsize = [7, 7, 9]\nwalls = [0, 1]\n", spheres);
  EXPECT_NEAR(channel.packing_fraction(), box.packing_fraction(), 0.01);
  expect_certified(channel);
  const Certificate one = certify(channel.spheres, channel.domain),
                    other = certify(channel.spheres, box.domain);
  EXPECT_TRUE(other.certified) << other.statement;
  EXPECT_TRUE(one.certified);
  EXPECT_EQ(one.max_overlap, other.max_overlap);
  EXPECT_EQ(one.overlapping_pairs, other.overlapping_pairs);

  // What is measured is the same in both.
  const Measurements in_channel = measure(channel.spheres, channel.domain, {}),
                     in_box = measure(channel.spheres, box.domain, {});
  EXPECT_EQ(in_channel.contacts.pairs, in_box.contacts.pairs);
  EXPECT_EQ(in_channel.contacts.walls, in_box.contacts.walls);
  EXPECT_EQ(in_channel.contacts.rattlers, in_box.contacts.rattlers);
  EXPECT_EQ(in_channel.packing_fraction, in_box.packing_fraction);
  ASSERT_TRUE(in_channel.radial && in_box.radial);
  ASSERT_EQ(in_channel.radial->g.size(), in_box.radial->g.size());
  ASSERT_TRUE(in_channel.walls && in_box.walls);
  EXPECT_NEAR(in_channel.walls->mean_porosity, in_box.walls->mean_porosity, 1e-9);
  for (std::size_t k = 0; k + 1 < std::min(in_channel.walls->layers.size(), in_box.walls->layers.size()); ++k)
    EXPECT_NEAR(in_channel.walls->layers[k].porosity, in_box.walls->layers[k].porosity, 0.02);
  ASSERT_TRUE(in_channel.pores && in_box.pores);
  EXPECT_NEAR(in_channel.pores->mean, in_box.pores->mean, 0.05 * in_box.pores->mean);
  EXPECT_FALSE(in_channel.chambers);
  EXPECT_FALSE(in_channel.local);
  EXPECT_EQ(in_channel.left_out, (std::vector<std::string>{"local packing fractions", "chambers"}));
}

TEST_F(PackChannel, EveryStagePacksACorrugatedTube) {
  write("tube.off", test::open_channel(test::corrugated_channel(-30, 3)));
  const std::string few = "diameter = 0.3\n";
  struct Case {
    std::string name, stages;
  };
  for (const Case& c : std::vector<Case>{
           {"relax", "[[stage]]\ndo = \"relax\"\n"},
           {"fill", ""},
           {"insert", "[[stage]]\ndo = \"insert\"\n"},
           {"polish", "count = 300\n[[stage]]\ndo = \"relax\"\npolish = 1e-9\n"},
           {"exchange", "[[stage]]\ndo = \"relax\"\nexchange = true\n"},
           {"across",
            "count = 200\n[[stage]]\ndo = \"insert\"\n[[stage]]\ndo = \"compress\"\ndirection = [1, 0, "
            "0]\n[[stage]]\ndo "
            "= \"shake\"\ndirection = [1, 0, 0]\n[[stage]]\ndo = \"refill\"\ndirection = [1, 0, 0]\n"}}) {
    SCOPED_TRACE(c.name);
    std::string spheres = few;
    if (c.name == "fill") spheres += "fill = true\n";
    if (c.name == "exchange")
      spheres = "diameter = { distribution = \"uniform\", min = 0.2, max = 0.35, basis = \"number\" }\n";
    const Scene asked = scene("tube.off", spheres + c.stages);
    const Packing packing = packed(asked);
    EXPECT_GT(packing.spheres.size(), 100u) << packing.reason;
    expect_certified(packing);
    EXPECT_GT(through_the_end(packing), 5);
    EXPECT_EQ(hash_of(packing.spheres), hash_of(packed(asked, 1).spheres)) << "by the number of threads";
    const Boundary<3> boundary = boundary_of<3>(packing.domain);
    for (std::size_t i = 0; i < packing.spheres.size(); ++i) {
      EXPECT_GE(packing.spheres.x[2][i], boundary.origin[2]);
      EXPECT_LT(packing.spheres.x[2][i], boundary.origin[2] + boundary.edges[2]);
    }
  }
}

// As a bed in the column that lies as the prism does.
TEST_F(PackChannel, ABedInAPrismLiesAsInTheColumn) {
  write("prism.off", test::closed_channel([](double, double) { return 5.0; }, 64, 1, 0, 8));
  const std::string bed = "diameter = 1.0\ncount = 500\n[[stage]]\ndo = \"settle\"\ndirection = [1, 0, 0]\n";
  const Packing channel = packed("prism.off", bed),
                column = packed_in("kind = \"cylinder\"\nradius = 5\nheight = 8\nperiodic = true\n", bed);
  expect_certified(channel);
  EXPECT_NE(channel.reason.find("every sphere rests"), std::string::npos) << channel.reason;
  const auto height = [](const Packing& packing) {
    double sum = 0;
    for (const double x : packing.spheres.x[0]) sum += x / static_cast<double>(packing.spheres.size());
    return sum;
  };
  EXPECT_NEAR(height(channel), height(column), 0.1);
}

TEST_F(PackChannel, ALatticeUnitIsPackedThroughItsPores) {
  write("lattice.off", test::void_of_simple_cubic(8));
  const Packing packing = packed("lattice.off", "diameter = 0.25\n", "[\"x\", \"y\", \"z\"]");
  EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
  EXPECT_GT(packing.spheres.size(), 60u);
  EXPECT_GT(through_the_end(packing), 3);
  expect_certified(packing);
  write("gyroid.off", test::void_of_gyroid(10));
  const Packing along_z = packed("gyroid.off", "diameter = 0.2\n");
  EXPECT_GT(along_z.spheres.size(), 100u) << along_z.reason;
  expect_certified(along_z);
}

TEST_F(PackChannel, AResultIsReadBackAndContinued) {
  write("tube.off", test::open_channel(test::corrugated_channel(0, 3)));
  const Packing packing = packed("tube.off", "count = 150\ndiameter = 0.3\n");
  write_packing(packing, folder.path() / "out");
  const Packing back = read_packing(folder.path() / "out");
  EXPECT_EQ(hash_of(back.spheres), hash_of(packing.spheres));
  EXPECT_TRUE(is_repeated_mesh(back.domain));
  expect_certified(back);
  EXPECT_EQ(boundary_of<3>(back.domain).edges, Vector<3>(0, 0, 3));
  const std::string text = testing::text_of(folder.path() / "out" / "scene.toml");
  EXPECT_NE(text.find("periodic = [\"z\"]"), std::string::npos) << text;

  // As a start they stay, and others come beside them.
  const Packing again = packed("tube.off", "start = \"out/spheres.csv\"\ncount = 160\ndiameter = 0.3\n");
  EXPECT_EQ(again.spheres.size(), 160u) << again.reason;
  expect_certified(again);
}

TEST_F(PackChannel, IsWrittenForProgramsThatTakePeriods) {
  write("tube.off", test::open_channel(test::corrugated_channel(0, 3)));
  const Packing packing = packed("tube.off", "count = 150\ndiameter = 0.3\n");
  double density = 0;
  const auto output = [](const std::string& format) {
    Output made;
    made.format = format;
    return made;
  };
  write_export(packing, output("lammps"), folder.path() / "a.data");
  const auto read = testing::exports::read_lammps(folder.path() / "a.data", density);
  ASSERT_EQ(read.centers.size(), packing.spheres.size());
  EXPECT_EQ(read.lower[2], 0);
  EXPECT_DOUBLE_EQ(read.upper[2], 3e-3);
  EXPECT_LT(read.lower[0], -1.25e-3);
  EXPECT_NE(testing::text_of(folder.path() / "a.data").find("boundary f f p"), std::string::npos);
  for (std::size_t i = 0; i < read.centers.size(); ++i)
    EXPECT_NEAR(read.centers[i][2], 1e-3 * packing.spheres.x[2][i], 1e-18);
  write_export(packing, output("extxyz"), folder.path() / "a.xyz");
  EXPECT_NE(testing::text_of(folder.path() / "a.xyz").find("pbc=\"F F T\""), std::string::npos);
  for (const std::string format : {"npy", "gsd"})
    EXPECT_NO_THROW(write_export(packing, output(format), folder.path() / "a.x"));
  for (const ExportFormat& format : export_formats()) {
    const std::string name(format.name);
    if (name == "npy" || name == "gsd" || name == "lammps" || name == "extxyz") continue;
    try {
      write_export(packing, output(name), folder.path() / "b.x");
      ADD_FAILURE() << name;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("repeats itself"), std::string::npos)
          << name << ": " << error.what();
    }
  }
}

TEST_F(PackChannel, RefusesWhatDoesNotKnowIt) {
  write("tube.off", test::open_channel(test::corrugated_channel(0, 3)));
  const auto expect_refused = [&](const std::string& spheres, const std::string& what) {
    const std::string refused = refusal("tube.off", spheres);
    EXPECT_NE(refused.find(what), std::string::npos) << spheres << ": " << refused;
    EXPECT_EQ(refused.find('\n'), std::string::npos);
  };
  expect_refused("diameter = 0.3\n[[stage]]\ndo = \"grow\"\n",
                 "\"grow\" cannot work in a mesh that repeats itself");
  expect_refused("diameter = 0.3\ncount = 5\n[[zone]]\ncount = 3\nplace = \"z < 1\"\ndiameter = 0.3\n",
                 "zones know no mesh that repeats itself");
  expect_refused("count = 5\nradius = \"largest\"\n", "\"largest\" knows no mesh that repeats itself");
  expect_refused("diameter = 0.3\n[engine]\nkind = \"lammps\"\n",
                 "[engine] knows no mesh that repeats itself");
  expect_refused("diameter = 0.3\n[[output]]\nformat = \"stl\"\n",
                 "holds no packing in a mesh that repeats itself");
  expect_refused("diameter = 0.3\n[[output]]\nformat = \"liggghts\"\n", "\"lammps\"");
  EXPECT_NE(
      refusal("tube.off", "diameter = 0.3\n", "\"z\"\nobstacles = [{ kind = \"sphere\", radius = 0.2 }]")
          .find("\"obstacles\" know no mesh that repeats itself"),
      std::string::npos);
  // The period is too short for spheres that would meet two images of another.
  expect_refused("diameter = 1.4\n", "repeats itself every 3 mm");
  expect_refused("diameter = { distribution = \"lognormal\", median = 0.3, sigma = 0.5 }\n",
                 "or give them a \"max\" of 1 mm");
  EXPECT_NE(
      refusal("tube.off", "diameter = 0.3\n", "true").find("must be \"x\" or \"y\" or \"z\" or an array"),
      std::string::npos);
  // Along the axis nothing holds them.
  expect_refused(
      "diameter = 0.3\n[[stage]]\ndo = \"insert\"\n[[stage]]\ndo = \"compress\"\ndirection = [0, 0, -1]\n",
      "direction");
}

}  // namespace pack_channel_test
}  // namespace bernal
