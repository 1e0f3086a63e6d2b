// Discs in containers of two dimensions: settled, certified, and the same for any number of threads.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "bernal/measure/measure.hpp"
#include "bernal/report/describe.hpp"
#include "bernal/result/read_packing.hpp"
#include "bernal/result/write_packing.hpp"
#include "bernal/run/run.hpp"
#include "bernal/scene/read_scene.hpp"
#include "support/discs.hpp"
#include "support/folder.hpp"
#include "support/refusals.hpp"
#include "support/written_files.hpp"

namespace bernal {
namespace discs_test {

using testing::Folder;
using testing::text_of;

using test::Container2;
using test::containers;
using test::equal;
using test::expect_free_of_overlap;
using test::lognormal;
using test::packed;
using test::scene_in;
using test::toml_of;

TEST(Discs, SettleInEveryContainerAndAreCertified) {
  for (const Container2& in : containers()) {
    for (const std::string& sizes : {equal, lognormal}) {
      SCOPED_TRACE(in.name + ": " + sizes);
      const Packing packing = packed(scene_in(in.toml, sizes));
      ASSERT_EQ(packing.spheres.dimension(), 2);
      const Certificate certificate = certify(packing.spheres, packing.domain);
      EXPECT_TRUE(certificate.certified) << certificate.statement;
      expect_free_of_overlap(packing, in.domain);
      double area = 0;
      for (const double r : packing.spheres.r) area += std::numbers::pi * r * r;
      EXPECT_NEAR(packing.packing_fraction(), area / volume_of(in.domain), 1e-12);
      // Random close packing of discs has 0.84, hexagonal packing 0.907; corners and walls take some.
      EXPECT_GT(packing.packing_fraction(), 0.70);
      EXPECT_LT(packing.packing_fraction(), 0.88);
      EXPECT_NEAR(packing.packing_fraction(), packing.expected_packing_fraction, 0.06);
      EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
    }
  }
}

TEST(Discs, OneSeedIsOnePackingForAnyNumberOfThreads) {
  for (const Container2& in : containers()) {
    const std::string toml = scene_in(in.toml, lognormal);
    EXPECT_EQ(hash_of(packed(toml, 1).spheres), hash_of(packed(toml, 4).spheres)) << in.name;
  }
}

TEST(Discs, ALowPacksFartherDownAndAllAreSupported) {
  // Half a box: pushed down nothing stays above, and every disc has something below it.
  const std::string box = "[container]\nkind = \"box\"\nsize = [10, 10]\n";
  for (const std::string direction : {"[0, -1]", "[-2, 0]", "[1, 1]"}) {
    const Packing packing =
        packed(scene_in(box,
                        "packing_fraction = 0.3\nradius = 0.25\n[[stage]]\ndo = \"insert\"\n"
                        "packing_fraction = 0.4\n[[stage]]\ndo = \"compress\"\ndirection = " +
                            direction));
    EXPECT_TRUE(certify(packing.spheres, packing.domain).certified);
    double mean_x = 0, mean_y = 0;
    const auto n = static_cast<double>(packing.spheres.size());
    for (std::size_t i = 0; i < packing.spheres.size(); ++i) {
      mean_x += packing.spheres.x[0][i] / n;
      mean_y += packing.spheres.x[1][i] / n;
    }
    if (direction == "[0, -1]") {
      EXPECT_LT(mean_y, 2.3);
    } else if (direction == "[-2, 0]") {
      EXPECT_LT(mean_x, 2.3);
    } else {
      EXPECT_GT(mean_x + mean_y, 12.5);
    }
  }
}

TEST(Discs, OneThatJustFitsIsPlaced) {
  const std::string one = "count = 1\nradius = ";
  EXPECT_EQ(packed(scene_in("[container]\nkind = \"box\"\nsize = [2, 2]\n", one + "1")).spheres.size(), 1u);
  EXPECT_EQ(packed(scene_in("[container]\nkind = \"polygon\"\nvertices = [[0, 0], [4, 0], [4, 2], [0, 2]]\n",
                            one + "1"))
                .spheres.size(),
            1u);
  // The circle in the triangle of sides 3, 4 and 5 has the radius 1.
  const Packing inscribed = packed(
      scene_in("[container]\nkind = \"polygon\"\nvertices = [[0, 0], [4, 0], [0, 3]]\n", one + "0.999999"));
  EXPECT_EQ(inscribed.spheres.size(), 1u) << inscribed.reason;
  EXPECT_TRUE(certify(inscribed.spheres, inscribed.domain).certified);
  EXPECT_NE(
      testing::error_of(scene_in("[container]\nkind = \"polygon\"\nvertices = [[0, 0], [4, 0], [0, 3]]\n",
                                 one + "1.000001"))
          .find("does not fit into the polygon"),
      std::string::npos);
}

TEST(Discs, FarAwayTheyAreCertifiedToo) {
  const Packing packing = packed(scene_in(toml_of(test::moved(test::with_hole(), {1e6, -1e6})), equal));
  EXPECT_TRUE(certify(packing.spheres, packing.domain).certified);
  EXPECT_GT(packing.packing_fraction(), 0.70);
}

TEST(Discs, FilesReadBackAndMeasuresAreOfTwoDimensions) {
  const Folder folder;
  const Packing packing = packed(scene_in(toml_of(test::with_hole()), lognormal));
  const WrittenPacking written = write_packing(packing, folder.path());
  EXPECT_TRUE(written.certificate.certified);
  EXPECT_TRUE(text_of(folder / "spheres.csv").starts_with("# unit: mm\nx0,x1,r\n"));
  EXPECT_TRUE(text_of(folder / "packing.svg").starts_with("<svg"));
  EXPECT_FALSE(std::filesystem::exists(folder / "section.svg"));
  // They are called discs, wherever people read of them.
  const std::string page = text_of(folder / "report.html");
  for (const std::string& text :
       {packing.reason, written.certificate.statement,
        explain(build(parse_scene(scene_in(toml_of(test::with_hole()), lognormal), "s.toml"))),
        page.substr(0, page.find("<script"))}) {
    EXPECT_NE(text.find("discs"), std::string::npos) << text.substr(0, 300);
    for (const std::string word : {" sphere ", " spheres ", ">Spheres<", " spheres,"})
      EXPECT_EQ(text.find(word), std::string::npos)
          << word << text.substr(std::min(text.size(), text.find(word)), 200);
  }
  const Packing read = read_packing(folder.path());
  EXPECT_EQ(read.spheres, packing.spheres);
  EXPECT_TRUE(certify(read.spheres, read.domain).certified);
  const Measurements measured = measure(read.spheres, read.domain, {});
  EXPECT_FALSE(measured.walls);
  EXPECT_FALSE(measured.chambers);
  EXPECT_FALSE(measured.radial);
  EXPECT_FALSE(measured.order);
  EXPECT_GT(measured.contacts.walls, 0u);
  EXPECT_GT(measured.contacts.coordination, 1.5);
  EXPECT_NEAR(measured.packing_fraction, packing.packing_fraction(), 1e-12);
}

TEST(Discs, WhatCannotBeDoneIsRefusedInOneLine) {
  const std::string box = "[container]\nkind = \"box\"\nsize = [12, 9]\n";
  const auto said = [&](const std::string& container, const std::string& rest) {
    return testing::error_of(scene_in(container, "count = 9\nradius = 0.2\n" + rest));
  };
  const std::string flown = said(box, "[[stage]]\ndo = \"fly\"");
  EXPECT_NE(flown.find("cannot work in a container of two dimensions; there, the stages are \"insert\", "
                       "\"compress\", \"shake\", \"refill\""),
            std::string::npos)
      << flown;
  EXPECT_NE(said(box, "[[stage]]\ndo = \"insert\"\n[[stage]]\ndo = \"compress\"\ndirection = [0, 0, -1]")
                .find("a component for each of 2 dimensions, but it has 3"),
            std::string::npos);
  EXPECT_NE(said("[container]\nkind = \"box\"\nsize = [2, 3]\ncorner = [0, 0, 1]\n", "")
                .find("must have 2 coordinates"),
            std::string::npos);
  EXPECT_NE(said("[container]\nkind = \"polygon\"\nvertices = [[0, 0], [9, 9], [9, 0], [0, 9]]\n", "")
                .find("meet at about (4.5, 4.5)"),
            std::string::npos);
  EXPECT_NE(said("[container]\nkind = \"polygon\"\n", "").find("needs \"vertices\""), std::string::npos);
  EXPECT_NE(said("[container]\nkind = \"polygon\"\nvertices = [[0, 0], [9, 9]]\n", "")
                .find("an array of three points [x, y] or more"),
            std::string::npos);
  // Outside and around the outline; one in a hole is an island.
  const std::string square = "[container]\nkind = \"polygon\"\nvertices = [[0, 0], [9, 0], [9, 9], [0, 9]]\n";
  for (const std::string hole : {"[[20, 0], [22, 0], [22, 2]]", "[[-9, -9], [99, -9], [0, 99]]"})
    EXPECT_NE(said(square + "holes = [[[2, 2], [6, 2], [6, 6], [2, 6]], " + hole + "]\n", "")
                  .find("must lie inside the outline, but hole 2"),
              std::string::npos)
        << hole;
  EXPECT_EQ(said(square + "holes = [[[2, 2], [6, 2], [6, 6], [2, 6]], [[3, 3], [5, 3], [5, 5]]]\n", ""), "");
  EXPECT_NE(said("[container]\nkind = \"polygon\"\nholes = [[[2, 2], [6, 2], [6, 6]]]\n", "")
                .find("needs \"vertices\", an array of three points"),
            std::string::npos);
  EXPECT_NE(
      said(square + "file = \"outline.csv\"\n", "").find("\"vertices\" and \"file\" in [container] exclude"),
      std::string::npos);
  EXPECT_NE(testing::error_of(scene_in(box, "packing_fraction = \"predicted\"\nradius = 0.2"))
                .find("in three dimensions, not in 2"),
            std::string::npos);
}

TEST(Discs, ALatticeOfThemIsHexagonal) {
  const std::string on_lattice = "[[stage]]\ndo = \"insert\"\nlayout = \"lattice\"\npacking_fraction = 0.9\n";
  const Packing packing = packed(
      scene_in("[container]\nkind = \"box\"\nsize = [10, 10]\n", "fill = true\nradius = 0.5\n" + on_lattice));
  EXPECT_TRUE(certify(packing.spheres, packing.domain).certified);
  // Centres have 9 diameters less the skins: 11 rows sqrt(3) / 2 apart, and along x 18 places half a diameter
  // apart, every other one of which is a site.
  EXPECT_EQ(packing.spheres.size(), 11u * 18 / 2);
  const Spheres<2> discs = packing.spheres.in<2>();
  for (std::size_t i = 0; i < discs.size(); ++i) {
    double nearest = 10;
    for (std::size_t j = 0; j < discs.size(); ++j)
      if (i != j) nearest = std::min(nearest, (discs.center(i) - discs.center(j)).norm());
    EXPECT_NEAR(nearest, 1, 1e-6);
  }
  for (const std::string& sizes : {equal, lognormal}) {
    const Packing in_polygon = packed(scene_in(toml_of(test::l_shape()), sizes + "\n" + on_lattice));
    EXPECT_TRUE(certify(in_polygon.spheres, in_polygon.domain).certified);
    if (sizes == equal) {
      EXPECT_GT(in_polygon.packing_fraction(), 0.7);  // 0.91 where there is no wall
    }
  }
}

TEST(Discs, MayStartFromAFile) {
  const Folder folder;
  const auto start_in = [&](const std::string& container, const std::string& discs, const std::string& rest) {
    folder.write("start.csv", discs);
    return folder.write("scene.toml", container + "[spheres]\nstart = \"start.csv\"\n" + rest);
  };
  const std::string down = "[[stage]]\ndo = \"compress\"\ntilt = 0\n";
  for (const std::string& container :
       {std::string("[container]\nkind = \"box\"\nsize = [8, 8]\n"),
        std::string("[container]\nkind = \"polygon\"\nvertices = [[0, 0], [8, 0], [8, 8], [0, 8]]\n")}) {
    const Packing fallen =
        run(build(read_scene(start_in(container, "x,y,r\n2,2,0.5\n6,6,1\n", down))), {.threads = 1});
    EXPECT_TRUE(certify(fallen.spheres, fallen.domain).certified);
    ASSERT_EQ(fallen.spheres.size(), 2u);
    EXPECT_NEAR(fallen.spheres.x[1][0], 0.5, 1e-6);
    EXPECT_NEAR(fallen.spheres.x[1][1], 1, 1e-6);
    const Packing more =
        run(build(read_scene(start_in(container, "x,y,r\n2,2,0.5\n6,6,1\n", "count = 12\nradius = 0.4\n"))),
            {.threads = 1});
    EXPECT_TRUE(certify(more.spheres, more.domain).certified);
    EXPECT_EQ(more.spheres.size(), 12u);
    const auto said = [&](const std::string& discs) {
      return testing::error_of([&] { run(build(read_scene(start_in(container, discs, down)))); });
    };
    const Error overlap = said("x,y,r\n2,2,1\n3,2,1\n");
    EXPECT_EQ(overlap.location().line, 3);
    EXPECT_NE(std::string(overlap.what()).find("overlaps that of line 2 by a ratio of 0.5"),
              std::string::npos);
    EXPECT_NE(std::string(overlap.what()).find("begin with \"relax\""), std::string::npos);
    EXPECT_NE(std::string(said("x,y,r\n7.5,2,1\n").what()).find("protrudes from the container by 0.5"),
              std::string::npos);
    EXPECT_NE(std::string(said("x,y,z,r\n2,2,2,1\n").what()).find("3 dimensions, but the scene has 2"),
              std::string::npos);
  }
}

TEST(Discs, WallsAreDecidedExactlyWhereThatIsAsked) {
  for (const Container2& in : containers()) {
    const std::string toml = scene_in(in.toml, "count = 60\nradius = 0.2");
    const Packing filtered = packed(toml), exact = packed(toml + "[accuracy]\nwalls = \"exact\"\n");
    EXPECT_TRUE(certify(exact.spheres, exact.domain).certified) << in.name;
    EXPECT_EQ(exact.spheres.size(), filtered.spheres.size()) << in.name;
    const auto asked = std::ranges::find(exact.effects, std::string("exact walls"), &Effect::name);
    ASSERT_NE(asked, exact.effects.end()) << in.name;
    EXPECT_GT(asked->calls, 60u) << in.name;
  }
}

TEST(Discs, ThePolygonMayStandInAFile) {
  const Folder folder;
  folder.write("outline.csv", "# mm\nx, y\n0, 0\n10, 0\n10, 4\n4, 4\n4, 10\n0, 10\n");
  const auto scene =
      folder.write("scene.toml", scene_in("[container]\nkind = \"polygon\"\nfile = \"outline.csv\"\n"
                                          "holes = [[[1, 1], [2, 1], [2, 2]]]\n",
                                          equal));
  const Packing packing = run(build(read_scene(scene)));
  EXPECT_DOUBLE_EQ(packing.volume, 63.5);
  EXPECT_NE(scene_as_toml(packing.scene).find("vertices = [[0, 0], [10, 0], [10, 4]"), std::string::npos);
  EXPECT_NE(scene_as_toml(packing.scene).find("holes = [[[1, 1], [2, 1], [2, 2]]]"), std::string::npos);
}

}  // namespace discs_test
}  // namespace bernal
