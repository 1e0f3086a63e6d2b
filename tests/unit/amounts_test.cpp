// Amounts as people have them: lengths with their unit, a mass, a bulk density, a porosity.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bernal/core/dimension.hpp"
#include "bernal/core/error.hpp"
#include "bernal/report/describe.hpp"
#include "bernal/report/json.hpp"
#include "bernal/result/write_packing.hpp"
#include "bernal/run/run.hpp"
#include "bernal/scene/packing_bytes.hpp"
#include "bernal/scene/read_scene.hpp"
#include "support/folder.hpp"
#include "support/scene_texts.hpp"

namespace bernal {
namespace amounts_test {

const std::string vessel = "unit = \"mm\"\n[container]\nkind = \"cylinder\"\nradius = 20\nheight = 60\n";
const std::string cube = "unit = \"mm\"\n[container]\nkind = \"periodic\"\nedge = 20\n";

Scene scene_of(const std::string& container, const std::string& spheres) {
  return parse_scene(container + "[spheres]\n" + spheres + "\n", "test.toml");
}

void expect_refused(const std::string& text, int line, std::string_view what) {
  try {
    build(parse_scene(text, "test.toml"));
    ADD_FAILURE() << text;
  } catch (const Error& error) {
    EXPECT_NE(std::string_view(error.what()).find(what), std::string_view::npos) << error.what();
    EXPECT_EQ(error.location().line, line) << error.what();
  }
}

TEST(Lengths, MayCarryTheirUnit) {
  const Scene said = parse_scene(R"(unit = "mm"
[container]
kind = "box"
size = ["10 cm", 0.1, "1 in"]
corner = ["-5 cm", 0, "0.5 um"]
[spheres]
count = 3
gap = "10 um"
wall_gap = "0.001 cm"
diameter = { distribution = "classes", values = ["0.1 cm", 2], shares = [1, 1] }
)",
                                 "said.toml");
  const Box& box = std::get<Box>(said.container);
  EXPECT_EQ(box.size, Vector<dynamic>(Vector<3>(100, 0.1, 25.4)));
  EXPECT_EQ(box.corner, Vector<dynamic>(Vector<3>(-50, 0, 0.0005)));
  EXPECT_EQ(said.gap, 0.01);
  EXPECT_EQ(said.wall_gap, 0.01);
  EXPECT_EQ(std::get<Classes>(said.sizes).values, (std::vector<double>{1, 2}));
  testing::expect_equal(said, parse_scene(scene_as_toml(said), "again.toml"));

  const Scene mesh = parse_scene(
      "unit = \"cm\"\n[container]\nkind = \"mesh\"\nfile = \"a.stl\"\ncap = [\"z = 25 mm\", \"x < 1\"]\n"
      "fill_level = \"1 in\"\n[spheres]\nradius = 1\n",
      "mesh.toml");
  EXPECT_EQ(std::get<MeshFile>(mesh.container).cap, (std::vector<std::string>{"z = 2.5", "x < 1"}));
  EXPECT_EQ(std::get<MeshFile>(mesh.container).fill_level, 2.54);

  const Scene polygon = parse_scene(
      "unit = \"mm\"\n[container]\nkind = \"polygon\"\nvertices = [[0, 0], [\"1 cm\", 0], [0, \"1 cm\"]]\n"
      "[spheres]\ncount = 3\nradius = \"100 um\"\n",
      "polygon.toml");
  EXPECT_EQ(std::get<Polygon>(polygon.container).loops[0][1], Vector<2>(10, 0));
  EXPECT_EQ(std::get<Constant>(polygon.sizes).value, 0.1);
}

TEST(Lengths, OfGrainsMayBeOfThePhiScale) {
  const Scene sand =
      scene_of(vessel,
               "count = 9\ndiameter = { distribution = \"lognormal\", median = \"1.5 phi\", sigma = "
               "\"0.6 phi\" }");
  EXPECT_EQ(std::get<Lognormal>(sand.sizes).median, std::exp2(-1.5));
  EXPECT_EQ(std::get<Lognormal>(sand.sizes).sigma, 0.6 * std::log(2.0));
  const Scene one = scene_of(vessel, "count = 9\ndiameter = \"-1 phi\"");
  EXPECT_EQ(std::get<Constant>(one.sizes).value, 2);
  expect_refused(vessel + "[spheres]\ncount = 9\nradius = \"1 phi\"\n", 8, "diameter = …");
  expect_refused(vessel + "[spheres]\ncount = 9\ngap = \"1 phi\"\ndiameter = 1\n", 8, "diameters of grains");
  expect_refused(
      vessel +
          "[spheres]\ncount = 9\ndiameter = { distribution = \"normal\", mean = \"1 phi\", sd = \"1 "
          "phi\" }\n",
      8, "\"sd\"");
}

TEST(Lengths, OfThePhiScaleRunTheOtherWay) {
  expect_refused(
      vessel +
          "[spheres]\ndiameter = { distribution = \"percentiles\", d16 = \"0.9 phi\", d50 = "
          "\"1.5 phi\", d84 = \"2.1 phi\" }\n",
      7,
      "the scene says d16 = \"0.9 phi\", d50 = \"1.5 phi\", d84 = \"2.1 phi\": on the phi scale the "
      "larger number is the finer grain");
}

TEST(Lengths, AreRefusedInOneLineWithTheRemedy) {
  const std::string spheres = vessel + "[spheres]\ncount = 9\n";
  expect_refused(spheres + "diameter = \"25,4 mm\"\n", 8,
                 "not \"25,4 mm\": it has a decimal comma; write a point, \"25.4 mm\"");
  expect_refused(spheres + "diameter = 25,4\n", 8, "a decimal comma? write a point, 25.4");
  expect_refused(spheres + "diameter = { distribution = \"uniform\", min = 1,5, max = 2 }\n", 8,
                 "a point, 1.5");
  expect_refused(spheres + "diameter = 25.4 mm\n", 8, "stands in quotes, \"25.4 mm\"");
  expect_refused(spheres + "mass = 2 kg\ndiameter = 1\n", 8, "stands in quotes, \"2 kg\"");
  expect_refused(spheres + "diameter = \"2\"\n", 8, "names no unit; write \"2 mm\", or 2 without quotes");
  expect_refused(spheres + "diameter = \"-2 mm\"\n", 8, "positive length");
  expect_refused(
      "unit = \"mm\"\n[container]\nkind = \"box\"\nsize = [1, \"2 kg\", 3]\n[spheres]\nradius = 1\n", 4,
      "\"kg\" is unknown");
  expect_refused(
      "unit = \"mm\"\n[container]\nkind = \"cylinder\"\nradius = 1\nheight = 2\naxis = [\"1 mm\", 0, 0]\n"
      "[spheres]\nradius = 1\n",
      6, "direction");
}

double mass_of_spheres(const Packing& packing) {
  double volume = 0;
  for (const double r : packing.spheres.r) volume += ball_volume(3, r);
  return volume * 1e-9 * *packing.scene.material_density;
}

TEST(Mass, OfEqualSpheresIsACountWithItsSum) {
  const Plan plan =
      build(scene_of(vessel, "mass = \"50 g\"\nmaterial_density = 2500\ndiameter = 3\nbed = \"poured\""));
  // 0.05 / 2500 m³ over π/6 (3 mm)³
  EXPECT_EQ(plan.scene.target.count, 1415);
  EXPECT_NE(describe(plan).find("0.05 kg of 2500 kg/m3 in spheres of 3 mm: 1,415 spheres"), std::string::npos)
      << describe(plan);
  // What was run says the count, and packs the same.
  const Scene again = parse_scene(scene_as_toml(plan.scene), "again.toml");
  EXPECT_EQ(again.target.count, 1415);
  EXPECT_FALSE(again.target.mass);
  EXPECT_EQ(again.material_density, 2500);
}

/// Within half of the last sphere, however sizes are drawn, whatever the seed, with gaps and with a tail that
/// is cut off.
TEST(Mass, IsMetWithinOneSphere) {
  const std::string wide = "diameter = { distribution = \"lognormal\", median = 2, sigma = 0.6 }\n";
  for (const std::string& spheres : std::vector<std::string>{
           wide, wide + "draw = \"random\"\n", wide + "gap = 0.05\n",
           std::string("diameter = { distribution = \"classes\", values = [1, 4], shares = [20, 1] }\n")})
    for (const char* seed : {"1", "2", "77"}) {
      const Plan plan =
          build(parse_scene(std::string("seed = ") + seed + "\n" + vessel + "[spheres]\nmass = \"20 g\"\n" +
                                "material_density = 2500\n" + spheres,
                            "test.toml"));
      const Packing packing = run(plan);
      EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
      const double largest = std::ranges::max(packing.spheres.r);
      EXPECT_NEAR(mass_of_spheres(packing), 0.02, ball_volume(3, largest) * 1e-9 * 2500) << spheres;
      EXPECT_NEAR(*mass_of(packing, packing.packing_fraction()), mass_of_spheres(packing), 1e-12);
    }
}

/// One sphere of the tail weighs more than all others.
TEST(Mass, ThatDrawnSizesDoNotMeetIsACaution) {
  const std::string wide =
      "mass = \"20 g\"\nmaterial_density = 2500\ndiameter = { distribution = \"lognormal\", "
      "median = 2, sigma = 0.8 }\n";
  const std::string large = "unit = \"mm\"\n[container]\nkind = \"box\"\nsize = [150, 150, 150]\n";
  const Plan plan = build(scene_of(large, wide + "draw = \"random\""));
  EXPECT_NE(plan.caution.find("no nearer to 0.02 kg than 0.01552 kg"), std::string::npos) << plan.caution;
  EXPECT_NE(plan.caution.find("draw = \"quantiles\""), std::string::npos) << plan.caution;
  EXPECT_EQ(build(scene_of(vessel,
                           "mass = \"20 g\"\nmaterial_density = 2500\ndiameter = { distribution = "
                           "\"uniform\", min = 2, max = 3 }"))
                .caution,
            "");
  EXPECT_EQ(build(scene_of("unit = \"mm\"\n[container]\nkind = \"periodic\"\n", wide)).scene.draw,
            Draw::quantiles);
}

TEST(Mass, GivesTheSizeOfAPeriodicBox) {
  const Plan plan = build(scene_of("unit = \"mm\"\n[container]\nkind = \"periodic\"\n",
                                   "mass = \"1 g\"\nmaterial_density = \"2.5 g/cm3\"\ndiameter = 2\n"));
  EXPECT_EQ(plan.scene.target.count, 95);
  EXPECT_TRUE(plan.box_follows);
}

TEST(Mass, IsRefusedWhereItMeansNothing) {
  const std::string spheres = vessel + "[spheres]\n";
  expect_refused(spheres + "mass = 1\ndiameter = 1\n", 7, "needs the \"material_density\"");
  expect_refused(spheres + "mass = 1\nmaterial_density = 2500\ncount = 3\ndiameter = 1\n", 7,
                 "exclude each other");
  expect_refused(spheres + "mass = 0\nmaterial_density = 2500\ndiameter = 1\n", 7, "above 0");
  expect_refused(spheres + "mass = \"1 m\"\nmaterial_density = 2500\ndiameter = 1\n", 7, "use one of mg");
  expect_refused(spheres + "mass = \"0.1 mg\"\nmaterial_density = 2500\ndiameter = 1\n", 7,
                 "check the units");
  expect_refused(spheres + "mass = 1e9\nmaterial_density = 2500\ndiameter = 1e-3\n", 7, "2^31");
  expect_refused(
      "[container]\nkind = \"box\"\nsize = [9, 9]\n[spheres]\nmass = 1\nmaterial_density = 2500\n"
      "diameter = 1\n",
      5, "three dimensions");
}

TEST(BulkDensity, IsThePorosityOfABedAndElseAPackingFraction) {
  const std::string asked = "bulk_density = 1550\nmaterial_density = 2500\ndiameter = 3\n";
  const Plan bed = build(scene_of(vessel, asked));
  EXPECT_EQ(bed.scene.target.bed.porosity, 0.38);
  EXPECT_EQ(bed.scene.stages.front().name(), "settle");
  EXPECT_NE(explain(bed).find("1550 kg/m3 of spheres of 2500 kg/m3: porosity 0.38"), std::string::npos)
      << explain(bed);
  const Plan loose = build(scene_of(cube, asked));
  EXPECT_EQ(loose.scene.target.packing_fraction, 0.62);
  EXPECT_NE(explain(loose).find(": packing fraction 0.62"), std::string::npos);
  const Plan by_stage =
      build(scene_of(vessel, asked + "[[stage]]\ndo = \"insert\"\n[[stage]]\ndo = \"relax\""));
  EXPECT_EQ(by_stage.scene.target.packing_fraction, 0.62);
  const std::string spheres = vessel + "[spheres]\n";
  expect_refused(spheres + "bulk_density = 1550\ndiameter = 3\n", 7, "needs the \"material_density\"");
  expect_refused(spheres + "bulk_density = 2550\nmaterial_density = 2500\ndiameter = 3\n", 7,
                 "of the material?");
  expect_refused(spheres + "bulk_density = 1550\nmaterial_density = 2500\nporosity = 0.4\ndiameter = 3\n", 7,
                 "exclude each other");
}

TEST(Porosity, WithoutABedIsAPackingFraction) {
  EXPECT_EQ(scene_of(cube, "porosity = 0.42\ndiameter = 3").target.packing_fraction, 0.58);
  EXPECT_EQ(scene_of(vessel, "porosity = 0.42\ndiameter = 3").target.bed.porosity, 0.42);
  const Scene counted =
      scene_of("[container]\nkind = \"periodic\"\n", "porosity = 0.42\ncount = 100\ndiameter = 3");
  EXPECT_EQ(counted.target.packing_fraction, 0.58);
  testing::expect_equal(counted, parse_scene(scene_as_toml(counted), "again.toml"));
  expect_refused(cube + "[spheres]\nporosity = 0.42\npacking_fraction = 0.5\ndiameter = 3\n", 7,
                 "say the same");
  expect_refused(cube + "[spheres]\nporosity = 0.42\nbed = \"poured\"\ndiameter = 3\n", 6,
                 "exclude each other");
}

TEST(MaterialDensity, IsTheDefaultOfOutputs) {
  const auto density = [](const std::string& spheres, const std::string& output) {
    return *scene_of(vessel,
                     "count = 9\ndiameter = 1\n" + spheres + "\n[[output]]\nformat = \"lammps\"\n" + output)
                .outputs.at(0)
                .material_density;
  };
  EXPECT_EQ(density("", ""), 2500);
  EXPECT_EQ(density("material_density = 7850", ""), 7850);
  EXPECT_EQ(density("material_density = 7850", "material_density = \"1 g/cm3\""), 1000);
  EXPECT_EQ(density("material_density = 7850", "density = 1200"), 1200);
  expect_refused(vessel +
                     "[spheres]\ncount = 9\ndiameter = 1\n[[output]]\nformat = \"lammps\"\ndensity = 1\n"
                     "material_density = 1\n",
                 11, "older name");
}

/// What stands above the surface of a bed is of no matter to how many spheres are below it.
TEST(HeightOfABed, CountsTheSameUnderAnyLid) {
  const auto expected = [](double lid) {
    return build(parse_scene(
                     fmt::format("unit = \"mm\"\n[container]\nkind = \"mesh\"\nfile = \"{}/tests/golden/"
                                 "frustum.off\"\nfill_level = {}\n[spheres]\nheight = 3\ndiameter = 0.5\n",
                                 BERNAL_SOURCE, lid),
                     "test.toml"))
        .expected_count;
  };
  const double low = expected(3.2);
  for (const double lid : {4.0, 4.9}) EXPECT_NEAR(expected(lid), low, 0.02 * low);
}

TEST(Hints, SayHowASceneIsUnderstood) {
  const auto hints = [](const std::string& text) { return explain(build(parse_scene(text, "test.toml"))); };
  const auto has = [](const std::string& text, std::string_view what) {
    return text.find(what) != std::string::npos;
  };
  const std::string jar =
      "[container]\nkind = \"cylinder\"\nradius = 20\nheight = 60\n[spheres]\ndiameter = 3\n";
  EXPECT_TRUE(has(hints(jar), "no unit is said, and every length is taken to be in m"));
  EXPECT_FALSE(has(hints("unit = \"mm\"\n" + jar), "no unit"));
  EXPECT_FALSE(
      has(hints("[container]\nkind = \"periodic\"\n[spheres]\ncount = 50\nradius = 1\n"), "no unit"));

  const std::string floats = "will float in the container, dispersed";
  EXPECT_TRUE(has(hints(jar + "count = 500\n"), "500 spheres " + floats));
  EXPECT_TRUE(has(hints(jar + "count = 500\n"), "bed = \"poured\""));
  EXPECT_FALSE(has(hints(jar + "count = 500\nbed = \"poured\"\n"), floats));
  EXPECT_FALSE(has(hints(jar + "count = 3000\n"), floats));  // to the brim
  EXPECT_FALSE(has(hints(jar), floats));
  EXPECT_FALSE(has(hints(jar + "count = 500\n[[stage]]\ndo = \"insert\"\n"), floats));

  const auto two = [&](const std::string& rest) {
    return hints(
        "unit = \"mm\"\n[container]\nkind = \"periodic\"\n[spheres]\ncount = 9000\ndiameter = { distribution "
        "= \"classes\", values = [1, 2], shares = [30, 70]" +
        rest + " }\n");
  };
  EXPECT_TRUE(has(two(""), "shares 0.3 : 0.7 count spheres; by mass they are 0.0508 : 0.949")) << two("");
  EXPECT_FALSE(has(two(", basis = \"number\""), "count spheres"));
  EXPECT_FALSE(has(two(", basis = \"volume\""), "count spheres"));
}

/// They stand where they are looked for after the run, too.
TEST(Hints, AreKeptInTheReport) {
  const Plan plan = build(scene_of(vessel, "count = 50\ndiameter = 3\nmaterial_density = 2.5"));
  ASSERT_EQ(plan.hints.size(), 2U) << explain(plan);
  EXPECT_NE(plan.hints[1].find("\"material_density\" = 2.5 is in kg/m3; write \"2.5 g/cm3\""),
            std::string::npos)
      << plan.hints[1];
  EXPECT_NE(describe(plan).find("note       50 spheres will float"), std::string::npos) << describe(plan);
  const testing::Folder folder;
  write_packing(run(plan), folder.path());
  EXPECT_EQ(nlohmann::json::parse(testing::text_of(folder / "report.json")).at("notes"), plan.hints);
  const std::string page = testing::text_of(folder / "report.html");
  EXPECT_NE(page.find("Note: 50 spheres will float"), std::string::npos);
  EXPECT_EQ(
      build(scene_of(vessel, "count = 50\nbed = \"poured\"\ndiameter = 3\nmaterial_density = 25")).hints,
      std::vector<std::string>{});
}

TEST(BulkDensity, IsGivenBackBesideWhatIsReached) {
  for (const auto& [container, spheres] :
       {std::pair(cube, "bulk_density = 1500\n"), std::pair(vessel, "bulk_density = 1450\ncount = 800\n")}) {
    const Plan plan =
        build(scene_of(container, std::string(spheres) + "material_density = 2500\ndiameter = 3"));
    const Packing packing = run(plan);
    ASSERT_TRUE(packing.bulk_density) << packing.reason;
    const double asked = container == cube ? 1500 : 1450;
    EXPECT_EQ(packing.bulk_density->asked, asked);
    EXPECT_NEAR(packing.bulk_density->reached, asked, 0.005 * 2500) << packing.reason;
    EXPECT_NE(packing.reason.find(fmt::format("the bulk density is {:.5g} kg/m3, and {} was asked for",
                                              packing.bulk_density->reached, asked)),
              std::string::npos)
        << packing.reason;
    if (container == cube) EXPECT_DOUBLE_EQ(packing.bulk_density->reached, 2500 * packing.packing_fraction());
    const testing::Folder folder;
    write_packing(packing, folder.path());
    const auto json = nlohmann::json::parse(testing::text_of(folder / "report.json"));
    EXPECT_EQ(json.at("bulk_density").at("asked"), asked);
    EXPECT_EQ(json.at("bulk_density").at("reached"), packing.bulk_density->reached);
    EXPECT_NE(testing::text_of(folder / "report.html").find(fmt::format("{} kg/m³ asked", asked)),
              std::string::npos);
    EXPECT_EQ(packing_of_bytes(bytes_of(packing)).bulk_density->reached, packing.bulk_density->reached);
  }
}

TEST(BulkDensity, BeyondWhatSpheresReachIsACaution) {
  const auto caution = [](const std::string& container, const std::string& density) {
    return build(scene_of(container, density + "diameter = 3")).caution;
  };
  const std::string dense = "material_density = 2500\nbulk_density = 1800\n";  // 0.72 of it
  EXPECT_NE(caution(vessel, dense)
                .find("a porosity of 0.28 is asked for by the bulk density, and random close "
                      "packing of these sizes leaves 0.35"),
            std::string::npos)
      << caution(vessel, dense);
  EXPECT_NE(caution(cube, dense).find("a packing fraction of 0.72 is asked for by the bulk density"),
            std::string::npos)
      << caution(cube, dense);
  EXPECT_NE(caution(vessel, "porosity = 0.25\n").find("has more than 0.7405"), std::string::npos);
  EXPECT_EQ(caution(vessel, "porosity = 0.38\n"), "");
  EXPECT_EQ(caution(vessel, "material_density = 2500\nbulk_density = 1500\n"), "");
}

TEST(Densities, InGramsWithoutTheirUnitAreTold) {
  const std::string spheres = vessel + "[spheres]\ndiameter = 3\n";
  expect_refused(spheres + "bulk_density = 1.55\nmaterial_density = 2500\n", 8, "write \"1.55 g/cm3\"");
  expect_refused(spheres + "bulk_density = 1550\nmaterial_density = 2.5\n", 8, "write \"2.5 g/cm3\"");
  const auto hints = [](const std::string& density, const std::string& of_classes) {
    return build(
               scene_of(vessel, "bed = \"poured\"\ncount = 9\n" + density +
                                    "diameter = { distribution = \"classes\", basis = \"mass\", values = [2, "
                                    "3], shares = [1, 1]" +
                                    of_classes + " }"))
        .hints;
  };
  ASSERT_EQ(hints("", ", material_densities = [7.85, 2.5]").size(), 1U);
  EXPECT_NE(hints("", ", material_densities = [7.85, 2.5]")[0].find("write \"7.85 g/cm3\""),
            std::string::npos);
  EXPECT_TRUE(hints("", ", material_densities = [\"7.85 g/cm3\", 2500]").empty());
  EXPECT_TRUE(hints("material_density = \"2.5 g/cm3\"\n", "").empty());
}

}  // namespace amounts_test
}  // namespace bernal
