#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>

#include <nlohmann/json.hpp>

#include "bernal/fly/fly.hpp"
#include "bernal/formats/export.hpp"
#include "bernal/hard/grow.hpp"
#include "bernal/measure/measure.hpp"
#include "bernal/report/json.hpp"
#include "bernal/run/run.hpp"
#include "bernal/scene/read_scene.hpp"
#include "bernal/scene/scene_reference.hpp"
#include "bernal/settle/insert.hpp"
#include "bernal/settle/refill.hpp"
#include "bernal/soft/relax.hpp"
#include "bernal/verify/certificate.hpp"
#include "scene/scene_entries.hpp"
#include "scene/stage_table.hpp"

// Scenes that stand in no file.
namespace bernal {
namespace scene_in_cpp_test {

/// 200 spheres in a cylinder.
Scene in_a_cylinder() {
  Scene scene;
  scene.container = Cylinder{.radius = 3, .height = 10};
  scene.sizes = Lognormal{.median = 0.5, .sigma = 0.2};
  scene.target.count = 200;
  return scene;
}

TEST(SceneInCpp, PacksWhatTheSameTextPacks) {
  Scene scene = in_a_cylinder();
  scene.stages = {Insert{.packing_fraction = 0.1}, Relax{.patience = 9}};
  const Packing packing = run(build(scene));
  EXPECT_EQ(packing.spheres.size(), 200u);
  EXPECT_TRUE(certify(packing.spheres, packing.domain).certified);

  const Scene same = parse_scene(R"(
[container]
kind = "cylinder"
radius = 3
height = 10
[spheres]
count = 200
radius = { distribution = "lognormal", median = 0.5, sigma = 0.2 }
[[stage]]
do = "insert"
packing_fraction = 0.1
[[stage]]
do = "relax"
patience = 9
)",
                                 "s.toml");
  EXPECT_EQ(scene_as_toml(packing.scene), scene_as_toml(same));
  EXPECT_EQ(hash_of(packing.spheres), hash_of(run(build(same)).spheres));
}

TEST(SceneInCpp, IsCompletedAsTextIs) {
  Scene scene = in_a_cylinder();
  complete(scene);
  EXPECT_TRUE(scene.stages_are_default);
  ASSERT_EQ(scene.stages.size(), 1u);
  EXPECT_EQ(scene.stages[0].name(), "relax");
  EXPECT_EQ(scene.draw, Draw::quantiles);
  const std::string once = scene_as_toml(scene);
  complete(scene);
  EXPECT_EQ(scene_as_toml(scene), once);

  scene.container = PeriodicBox{.dimension = 2};
  scene.stages = {Relax{}, Grow{}};
  complete(scene);
  EXPECT_TRUE(std::get<PeriodicBox>(scene.container).scalable);
  EXPECT_EQ(scene.stages[0].as<Relax>()->phi0, 1.13);
  EXPECT_EQ(scene.stages[1].as<Grow>()->phi_init, 0.28);
  EXPECT_EQ(scene.stages[1].as<Relax>(), nullptr);
}

TEST(SceneInCpp, EveryStageHasANameThatMakesIt) {
  EXPECT_EQ(Stage(Refill{}).name(), "refill");
  for (const char* name : {"insert", "settle", "compress", "shake", "refill", "relax", "grow", "fly"})
    EXPECT_EQ(stage_named(name).name(), name);
  EXPECT_THROW(stage_named("relaks"), Error);
  EXPECT_THROW(Stage(3).name(), Error);
}

/// What `build` says of the scene after this change to it.
std::string refusal(const std::function<void(Scene&)>& change) {
  Scene scene = in_a_cylinder();
  change(scene);
  try {
    build(scene);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_scene);
    EXPECT_EQ(error.location().text(), "");
    return error.what();
  }
  return "accepted";
}

TEST(SceneInCpp, IsRefusedWhereNoTextCouldSayIt) {
  EXPECT_EQ(refusal([](Scene&) {}), "accepted");
  const auto expect = [](const std::function<void(Scene&)>& change, const std::string& words) {
    const std::string what = refusal(change);
    EXPECT_NE(what.find(words), std::string::npos) << words << "\nis not in: " << what;
    EXPECT_EQ(what.find('\n'), std::string::npos) << what;
  };
  expect([](Scene& s) { s.container = Cylinder{.radius = -1}; },
         "\"radius\" in [container] must be a positive length, not -1");
  expect([](Scene& s) { s.container = Cylinder{.axis = {0, 1, 1}, .periodic = true}; }, "along x, y or z");
  expect([](Scene& s) { s.container = Box{{0}, {1}}; }, "two or three positive lengths");
  expect([](Scene& s) { s.container = Polygon{}; }, "needs \"vertices\"");
  expect([](Scene& s) { s.container = Box{{0, 0, 0}, {1, 1, 1}, {true, true, true}}; }, "PeriodicBox");
  expect([](Scene& s) { s.container = PeriodicBox{.size = {1, 2}}; }, "each of 3 dimensions");
  expect([](Scene& s) { s.container = PeriodicBox{.size = {1, 2, 3}, .edge = 1}; }, "exclude each other");
  expect([](Scene& s) { s.container = PeriodicBox{.edge = 9, .walls = {3}}; }, "from 0 to 2");
  expect([](Scene& s) { s.container = MeshFile{}; }, "path of a file");
  expect([](Scene& s) { s.sizes = Constant{}; }, "\"value\" in radius of [spheres]");
  expect([](Scene& s) { s.sizes = Lognormal{.median = 1}; }, "missing \"sigma\"");
  expect([](Scene& s) { s.sizes = Lognormal{}; }, "exactly one of");
  expect([](Scene& s) { s.sizes = Lognormal{.d43 = 2, .d32 = 1}; }, "is a diameter");
  expect(
      [](Scene& s) {
        s.sizes = Mixture{{Constant{1}, Uniform{2, 1}}, {1, 1}};
      },
      "\"min\" in part 2 of radius of [spheres]");
  expect([](Scene& s) { s.target.count = 0; }, "\"count\" in [spheres]");
  expect([](Scene& s) { s.target.packing_fraction = 0.5; }, "exclude each other");
  expect([](Scene& s) { s.overlap = 1; }, "\"overlap\" in [accuracy]");
  expect([](Scene& s) { s.walls = static_cast<WallArithmetic>(7); }, "\"walls\" in [accuracy]");
  expect([](Scene& s) { s.stages = {Relax{.patience = -1}}; },
         "\"patience\" in [[stage]] relax must be a whole number from 0 to 1000000, not -1");
  expect([](Scene& s) { s.stages = {Relax{.alpha = 3}}; },
         "\"alpha\" in [[stage]] relax acts in periodic boxes only");
  expect([](Scene& s) { s.stages = {Compress{.direction = {0, 0, 0}}}; }, "direction");
  expect([](Scene& s) { s.stages = {Fly{}}; }, "\"fly\" cannot work in a container");
  expect([](Scene& s) { s.stages = {3}; }, "options of no stage");
  expect(
      [](Scene& s) {
        s.container = PeriodicBox{.dimension = 7};
        s.stages = {Grow{}};
      },
      "2 to 6 dimensions, not in 7");
}

TEST(SceneInFile, NamesTheLineOfAKeyThatActsElsewhere) {
  const auto refusal = [](const std::string& stage, const std::string& container) -> std::string {
    try {
      parse_scene("container = " + container + "\n[spheres]\ncount = 9\nradius = 1\n[[stage]]\n" + stage,
                  "s.toml");
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  };
  const std::string sphere = "{ kind = \"sphere\", radius = 9 }", box = "{ kind = \"periodic\" }";
  EXPECT_EQ(refusal("do = \"relax\"\nalpha = 17\n", sphere),
            "s.toml:7: \"alpha\" in [[stage]] relax acts in periodic boxes only; leave it out");
  EXPECT_EQ(refusal("do = \"relax\"\npatience = 1\n", box),
            "s.toml:7: \"patience\" in [[stage]] relax acts in containers with walls only; leave it out");
  EXPECT_EQ(refusal("do = \"grow\"\npolish = 0\n", box), "accepted");
}

TEST(Reference, NamesEveryKeyWithItsDefault) {
  const std::string all = reference(), relax = reference("relax");
  for (const char* name : {"cylinder", "lognormal", "relax", "spheres"})
    EXPECT_NE(all.find(std::string("\n  ") + name), std::string::npos) << name;
  EXPECT_NE(relax.find("alpha = 17; in periodic boxes"), std::string::npos) << relax;
  EXPECT_NE(relax.find("method = \"fast\""), std::string::npos) << relax;
  EXPECT_NE(reference("cylinder").find("radius\n"), std::string::npos);  // which has no default
  EXPECT_THROW(reference("cylindre"), Error);
}

TEST(Reference, AsDataSaysTheSame) {
  const auto json = nlohmann::json::parse(scene_reference_as_json());
  std::map<std::string, std::size_t> tables;
  for (const auto& group : json.at("groups")) {
    tables[group.at("name")] = group.at("tables").size();
    for (const auto& table : group.at("tables")) {
      const std::string text = reference(std::string(table.at("name")));
      for (const auto& key : table.at("keys")) {
        const std::string name = key.at("name");
        EXPECT_NE(text.find("\n  " + name), std::string::npos) << name;
        EXPECT_NE(text.find("      " + key.at("expectation").get<std::string>()), std::string::npos) << name;
        EXPECT_FALSE(key.at("required") && !key.at("default").is_null()) << name;
      }
      for (const auto& choice : table.at("choices"))
        for (const auto& set : choice)
          for (const auto& key : set)
            EXPECT_NE(text.find("\n  " + key.get<std::string>()), std::string::npos);
    }
  }
  EXPECT_EQ(tables, (std::map<std::string, std::size_t>{{"scene", 3},
                                                        {"container", schema::container_entries().size()},
                                                        {"diameter", schema::size_entries().size()},
                                                        {"stage", stage_tables().size()},
                                                        {"engine", schema::engine_entries().size()},
                                                        {"output", export_formats().size()},
                                                        {"table", 4},  // cells, inside, layers, thickness
                                                        {"zone", 1}}));
}

TEST(Reference, DefaultsAndLimitsAreThoseOfTheStructs) {
  const auto groups = scene_reference();
  const auto& stages = groups[3].tables;
  const auto relax = std::ranges::find(stages, "relax", &ReferenceTable::name);
  ASSERT_NE(relax, stages.end());
  const auto alpha = std::ranges::find(relax->keys, "alpha", &ReferenceKey::name);
  ASSERT_NE(alpha, relax->keys.end());
  EXPECT_EQ(alpha->type, "number");
  EXPECT_EQ(alpha->acts, "in_box");
  EXPECT_EQ(std::stod(alpha->otherwise.value()), Relax().alpha);
  const auto method = std::ranges::find(relax->keys, "method", &ReferenceKey::name);
  EXPECT_EQ(method->otherwise, "\"fast\"");
  EXPECT_EQ(method->words.front(), "fast");
}

}  // namespace scene_in_cpp_test
}  // namespace bernal
