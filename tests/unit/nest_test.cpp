// Packings inside of spheres: one seed gives one nest, levels are certified by themselves and with each
// other, and what cannot lie inside is refused in one line.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <tuple>

#include "bernal/core/unit.hpp"
#include "bernal/plan/plan.hpp"
#include "bernal/report/describe.hpp"
#include "bernal/result/certify_levels.hpp"
#include "bernal/result/read_packing.hpp"
#include "bernal/result/write_packing.hpp"
#include "bernal/run/run.hpp"
#include "bernal/scene/nest.hpp"
#include "bernal/scene/read_scene.hpp"
#include "support/nests.hpp"

namespace bernal {
namespace nest_test {

using testing::expect_same;
using testing::Nested;
using testing::particles;
using testing::pebbles;

TEST(Nest, LengthsInTwoUnitsAreComparedExactly) {
  EXPECT_TRUE(is_at_most(25.4, Unit::mm, 1, Unit::in));  // the double 25.4 is below 254/10
  EXPECT_TRUE(is_at_most(25, Unit::mm, 2.5, Unit::cm));
  EXPECT_TRUE(is_at_most(2.5, Unit::cm, 25, Unit::mm));
  EXPECT_FALSE(is_at_most(std::nextafter(25.0, 26.0), Unit::mm, 2.5, Unit::cm));
  EXPECT_FALSE(is_at_most(0.1, Unit::m, 10, Unit::cm));  // the double 0.1 is above 1/10
  for (const Unit from : {Unit::nm, Unit::mm, Unit::cm, Unit::m, Unit::in, Unit::ft})
    for (const Unit to : {Unit::nm, Unit::mm, Unit::cm, Unit::m, Unit::in, Unit::ft})
      for (const double length : {0.1, 0.3, 1.0, 2.5, 1 / 3.0, 1e-9, 12345.678}) {
        const double most = largest_at_most(length, from, to);
        EXPECT_TRUE(is_at_most(most, to, length, from));
        EXPECT_FALSE(is_at_most(std::nextafter(most, 2 * most), to, length, from));
      }
}

TEST(Nest, OneSeedGivesOneNestForAnyNumberOfThreads) {
  const Nested scenes;
  const Packing one = scenes.packed(1), two = scenes.packed(2);
  expect_same(one, two);
  ASSERT_EQ(one.inside.size(), 1U);
  EXPECT_EQ(one.outcome, Outcome::converged) << one.reason;
  EXPECT_EQ(one.inside[0].templates.size(), 3U);
  EXPECT_EQ(one.inside[0].spheres.size(), 10U);
  const auto& templates = one.inside[0].templates;
  EXPECT_NE(templates[0]->spheres.x, templates[1]->spheres.x);
  EXPECT_EQ(std::get<Sphere>(templates[0]->domain).radius, 25);  // in their own unit
  EXPECT_NE(one.inside[0].rotations[0], one.inside[0].rotations[1]);
  const std::vector<NestLevel> levels = levels_of(one);
  ASSERT_EQ(levels.size(), 2U);
  EXPECT_EQ(levels[1].name, "pebble");
  std::uint64_t stand = 0;
  for (const std::uint32_t t : one.inside[0].which) stand += templates[t]->spheres.size();
  EXPECT_EQ(levels[1].spheres, stand);
  EXPECT_EQ(spheres_of_all_levels(one), stand + 10);
  EXPECT_NEAR(levels[1].packing_fraction, 0.1, 0.001);
  EXPECT_NEAR(levels[1].share, levels[1].packing_fraction * 10 * std::pow(2.5, 3) * 4 / 3 * M_PI / 27000,
              1e-9);
}

TEST(Nest, RotationsAreUniform) {
  Nested scenes;
  scenes.folder.write("inner.toml",
                      "unit = \"mm\"\n[spheres]\ncount = 1\nradius = 5\n[[stage]]\ndo = \"insert\"\n");
  std::string outer = pebbles("{ scene = \"inner.toml\", templates = 1 }");
  outer.replace(outer.find("[30, 30, 30]"), 12, "[300, 300, 300]");
  outer.replace(outer.find("count = 10"), 10, "count = 2000");
  scenes.folder.write("outer.toml", outer);
  const Packing packing = scenes.packed();
  // Where a fixed vector is turned to is uniform on the sphere, and so is its square of each component.
  Vector<3> mean = Vector<3>::Zero(), squares = Vector<3>::Zero();
  for (const auto& q : packing.inside[0].rotations) {
    const Vector<3> to = turned(Vector<3>(0.6, 0, 0.8), q);
    EXPECT_NEAR(to.norm(), 1, 1e-14);
    mean += to / 2000;
    squares += to.cwiseAbs2() / 2000;
  }
  constexpr double five_errors = 5 * 0.5774 / 44.7, five_errors_of_squares = 5 * 0.2981 / 44.7;
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(mean[k], 0, five_errors);
    EXPECT_NEAR(squares[k], 1.0 / 3, five_errors_of_squares);
  }
}

TEST(Nest, WhatIsCertifiedByLevelsDoesNotOverlapFlattened) {
  const Packing packing = Nested().packed();
  const Certificate certificate = certify_levels(packing);
  EXPECT_TRUE(certificate.certified) << certificate.statement;
  EXPECT_EQ(certificate.spheres_of_all_levels, spheres_of_all_levels(packing));
  EXPECT_NE(certificate.statement.find("stand for themselves"), std::string::npos);
  Spheres<dynamic> flat(3);
  const PackingsInside& inside = packing.inside[0];
  for (std::size_t k = 0; k < inside.spheres.size(); ++k) {
    const Spheres<dynamic>& within = inside.templates[inside.which[k]]->spheres;
    for (std::size_t i = 0; i < within.size(); ++i) {
      const Vector<3> at = turned(0.1 * Vector<3>(within.center(i)), inside.rotations[k]) +
                           Vector<3>(packing.spheres.center(inside.spheres[k]));
      flat.push_back(Vector<dynamic>(at), 0.1 * within.r[i]);
    }
  }
  // To what rounding the places costs.
  EXPECT_TRUE(certify(flat, packing.domain, {.allowed_overlap = 1e-12}).certified);
}

/// The certificate of a nest that something was done to.
template <class Spoil>
Certificate certificate_of_spoiled(Spoil spoil) {
  Packing packing = Nested().packed();
  spoil(packing, packing.inside[0]);
  return certify_levels(packing);
}
std::shared_ptr<const Packing> changed(const std::shared_ptr<const Packing>& packing, auto change) {
  auto copy = std::make_shared<Packing>(*packing);
  change(*copy);
  return copy;
}

TEST(Nest, TheCertificateRefusesWhatIsWrong) {
  const auto refused = [](const Certificate& c, const char* words) {
    EXPECT_FALSE(c.certified);
    EXPECT_NE(c.statement.find(words), std::string::npos) << c.statement;
  };
  refused(certificate_of_spoiled([](Packing&, PackingsInside& inside) {
            inside.templates[1] = changed(inside.templates[1], [](Packing& p) { p.spheres.x[0][0] = 24; });
          }),
          "packing 2 inside pebble");
  refused(certificate_of_spoiled([](Packing&, PackingsInside& inside) { inside.rotations[4][0] += 1e-6; }),
          "no unit quaternion");
  refused(certificate_of_spoiled([](Packing&, PackingsInside& inside) {
            inside.templates[0] = changed(inside.templates[0], [](Packing& p) {
              std::get<Sphere>(p.domain).radius = std::nextafter(25.0, 26.0);
            });
            for (std::uint32_t& t : inside.which) t = 0;
          }),
          "has room for a ball of radius 2.5 cm");
  refused(certificate_of_spoiled([](Packing&, PackingsInside& inside) { inside.which[3] = 3; }), "not there");
  refused(certificate_of_spoiled([](Packing&, PackingsInside& inside) { inside.spheres[9] = 10; }),
          "no sphere 10");
  refused(
      certificate_of_spoiled([](Packing&, PackingsInside& inside) { inside.spheres[1] = inside.spheres[0]; }),
      "filled after");
  refused(certificate_of_spoiled([](Packing& packing, PackingsInside&) {
            packing.spheres.x[0][0] = packing.spheres.x[0][1];
            packing.spheres.x[1][0] = packing.spheres.x[1][1];
            packing.spheres.x[2][0] = packing.spheres.x[2][1];
          }),
          "overlapping");
}

TEST(Nest, ALevelOfSpheresWithoutAClassIsOne) {
  const Nested scenes;
  scenes.folder.write(
      "outer.toml",
      "unit = \"cm\"\n[container]\nkind = \"box\"\nsize = [30, 30, 30]\n[spheres]\ncount = 10\n"
      "radius = 2.5\ninside = { scene = \"inner.toml\", templates = 2 }\n[[stage]]\ndo = "
      "\"insert\"\n");
  const std::vector<NestLevel> levels = levels_of(scenes.packed());
  ASSERT_EQ(levels.size(), 2U);
  EXPECT_EQ(levels[0].spheres, 10U);
  EXPECT_EQ(levels[1].depth, 1);
  EXPECT_EQ(levels[1].filled, 10U);
  EXPECT_NEAR(levels[1].packing_fraction, 0.1, 0.01);
}

TEST(Nest, EverySphereHasItsOwnWithoutTemplates) {
  const Packing packing = Nested("{ scene = \"inner.toml\" }").packed();
  EXPECT_EQ(packing.inside[0].templates.size(), 10U);
  EXPECT_EQ(packing.inside[0].which[9], 9U);
  EXPECT_TRUE(certify_levels(packing).certified);
}

TEST(Nest, AnyDepth) {
  Nested scenes;
  scenes.folder.write("grain.toml",
                      "unit = \"um\"\n[spheres]\ncount = 5\nradius = 100\n[[stage]]\ndo = \"insert\"\n");
  scenes.folder.write(
      "inner.toml",
      "unit = \"mm\"\n[spheres]\ncount = 20\nradius = 1.5\ninside = { scene = \"grain.toml\", "
      "templates = 2 }\n[[stage]]\ndo = \"insert\"\n");
  const Packing packing = scenes.packed();
  const std::vector<NestLevel> levels = levels_of(packing);
  ASSERT_EQ(levels.size(), 3U);
  EXPECT_EQ(levels[2].name, "pebble / spheres");
  EXPECT_EQ(levels[2].spheres, 10U * 20 * 5);
  EXPECT_TRUE(certify_levels(packing).certified);
  const testing::Folder out;
  write_packing(packing, out / "nest");
  expect_same(packing, read_packing(out / "nest"));
}

TEST(Nest, BadInputIsRefusedInOneLine) {
  const auto expect_refusal = [](const std::string& inside, const char* words,
                                 const std::string& inner = particles) {
    const std::string refusal = Nested(inside, inner).refusal();
    EXPECT_NE(refusal.find(words), std::string::npos) << inside << ": " << refusal;
  };
  expect_refusal("{ scene = \"inner.toml\", class = \"peble\" }", "did you mean \"pebble\"");
  expect_refusal("{ scene = \"inner.toml\", layer = \"feul\" }", "\"fuel\"");
  expect_refusal("{ scene = \"inner.toml\", layer = \"shell\" }", "innermost");
  expect_refusal("{ scene = \"outer.toml\" }", "inside itself");
  expect_refusal("{ scene = \"missing.toml\" }", "missing.toml");
  expect_refusal("[{ scene = \"inner.toml\" }, { scene = \"inner.toml\" }]", "twice");
  expect_refusal("{ class = \"pebble\" }", "scene");
  expect_refusal("{ scene = \"inner.toml\" }", "inside of pebble, in a ball of radius 2.5 cm",
                 "unit = \"cm\"\n[spheres]\ncount = 3\nradius = 3\n");
  expect_refusal(
      "{ scene = \"inner.toml\" }", "leave [container] out",
      "unit = \"cm\"\n[container]\nkind = \"box\"\nsize = [1, 1, 1]\n[spheres]\ncount = 3\nradius = 0.1\n");
  expect_refusal("{ scene = \"inner.toml\" }", "inside itself",
                 "unit = \"cm\"\n[spheres]\ncount = 3\nradius = 0.5\ninside = { scene = \"inner.toml\" }\n");
  // More volume than the ball has is no matter of how they are packed; of sizes the least counts.
  for (const auto& [radius, words] :
       {std::pair{"0.5", "126 spheres of radius 0.5 cm have 1.01 times the volume"},
        {"{ distribution = \"uniform\", min = 0.5, max = 0.6 }",
         "126 spheres of radius 0.5 cm or more have"}})
    expect_refusal("{ scene = \"inner.toml\", templates = 1 }", words,
                   fmt::format("unit = \"cm\"\n[spheres]\ncount = 126\nradius = {}\n", radius));
  EXPECT_EQ(Nested("{ scene = \"inner.toml\", templates = 1 }",
                   "unit = \"cm\"\n[spheres]\ncount = 124\nradius = 0.5\n")
                .refusal(),
            "");
  const testing::Folder folder;
  folder.write("inner.toml", particles);
  const auto refusal_of = [&](const std::string& scene) -> std::string {
    try {
      build(read_scene(folder.write("s.toml", scene)));
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(
      refusal_of(
          "unit = \"cm\"\n[container]\nkind = \"box\"\nsize = [9, 9, 9]\n[spheres]\ncount = 5\nradius = { "
          "distribution = \"uniform\", min = 1, max = 2 }\ninside = { scene = \"inner.toml\", templates = "
          "2 }\n")
          .find("leave \"templates\" out"),
      std::string::npos);
  EXPECT_NE(
      refusal_of("[container]\nkind = \"box\"\nsize = [9, 9]\n[spheres]\ncount = 5\nradius = 1\ninside = { "
                 "scene = \"inner.toml\" }\n")
          .find("three dimensions"),
      std::string::npos);
  EXPECT_NE(
      refusal_of(
          "[container]\nkind = \"box\"\nsize = [9, 9, 9]\n[spheres]\ncount = 5\nradius = { distribution = "
          "\"classes\", values = [1, 0.5], shares = [1, 1], names = [\"a\", \"b\"] }\ninside = { scene = "
          "\"inner.toml\" }\n")
          .find("needs a \"class\""),
      std::string::npos);
}

TEST(Nest, AContainerThatGivesWayToTheBallSaysSo) {
  const auto said_of = [](const std::string& radius, const std::string& inside) {
    const Nested scenes(inside, "unit = \"mm\"\n[container]\nkind = \"sphere\"\nradius = " + radius +
                                    "\n[spheres]\npacking_fraction = 0.1\nradius = 1.5\n");
    const Plan plan = build(read_scene(scenes.folder / "outer.toml"));
    EXPECT_EQ(std::get<Sphere>(plan.insides[0].plan.domain).radius, 25);
    return describe(plan);  // by explain and by pack
  };
  const std::string templates = "{ scene = \"inner.toml\", templates = 2 }";
  for (const std::string& inside : {templates, std::string("{ scene = \"inner.toml\" }")})
    EXPECT_NE(said_of("30", inside)
                  .find("note       inside of pebble: inner.toml asks for a sphere of radius 30 mm as its "
                        "container; 25 mm is used, the radius of the ball that it fills\n"),
              std::string::npos)
        << said_of("30", inside);
  EXPECT_EQ(said_of("25", templates).find("asks for"), std::string::npos);
  EXPECT_EQ(said_of("\"2.5 cm\"", templates).find("asks for"), std::string::npos);
}

TEST(Nest, NotesOfFurtherLevelsNameTheWayInOnce) {
  const Nested scenes("{ scene = \"a.toml\", templates = 1 }");
  const auto level = [](const std::string& keys) { return "unit = \"cm\"\n" + keys; };
  for (const auto& [name, next, radius] :
       {std::tuple{"a.toml", "b.toml", 1.0}, {"b.toml", "c.toml", 0.4}, {"c.toml", "d.toml", 0.1}})
    scenes.folder.write(name,
                        level(fmt::format("[spheres]\ncount = 1\nradius = {}\ninside = {{ scene = \"{}\", "
                                          "templates = 1 }}\n",
                                          radius, next)));
  scenes.folder.write("d.toml", level("container = { kind = \"sphere\", radius = 3 }\n[spheres]\ncount = 1\n"
                                      "radius = 0.01\n"));
  const std::string said = describe(build(read_scene(scenes.folder / "outer.toml")));
  EXPECT_NE(said.find("note       inside of pebble / … / spheres: d.toml asks for"), std::string::npos)
      << said;
}

TEST(Nest, ARunThatIsStoppedFillsWhatItHas) {
  const Nested scenes;
  const Plan plan = build(read_scene(scenes.folder / "outer.toml"));
  bool inside = false;
  RunOptions options{.threads = 1};
  options.monitor.on_progress = [&](const Progress& p) {
    inside = inside || p.activity.starts_with("inside");
  };
  options.monitor.cancelled = [&] { return inside; };
  const Packing packing = run(plan, options);
  EXPECT_EQ(packing.outcome, Outcome::cancelled);
  ASSERT_EQ(packing.inside.size(), 1U);
  EXPECT_LT(packing.inside[0].templates.size(), 3U);
  const testing::Folder out;
  const Certificate written = write_packing(packing, out / "nest").certificate;
  EXPECT_TRUE(written.certified);
  if (packing.inside[0].templates.empty()) {
    EXPECT_NE(
        written.statement.find("Nothing lies in them; inside pebble: none of 10 spheres holds a packing."),
        std::string::npos)
        << written.statement;
  }
  expect_same(packing, read_packing(out / "nest"));
}

}  // namespace nest_test
}  // namespace bernal
