// Scenes whose engine leaves its spheres to slabs, by shell scripts in the place of LAMMPS.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include <fmt/format.h>

#include "bernal/engine/engine_error.hpp"
#include "bernal/measure/measure.hpp"
#include "bernal/result/read_packing.hpp"
#include "bernal/run/run.hpp"
#include "bernal/scene/read_scene.hpp"
#include "bernal/slabs/pack_in_slabs.hpp"
#include "support/folder.hpp"

namespace bernal {
namespace engine_slabs_test {

using testing::Folder;
using testing::text_of;
namespace fs = std::filesystem;

/// Leaves every sphere where it was put, and tells its radius, as LAMMPS does.
constexpr const char* idle_engine = R"sh(#!/bin/bash
echo called >> calls
awk '/^[0-9]+ atoms/ { n = $1 }
     /lo .hi|[xyz]lo/ { box = box $1 " " $2 "\n" }
     /^Atoms/ { atoms = 1
                printf "ITEM: TIMESTEP\n1000\nITEM: NUMBER OF ATOMS\n%d\nITEM: BOX BOUNDS pp pp pp\n%s", n, box
                print "ITEM: ATOMS id x y z radius" }
     atoms && NF == 7 { printf "%s %s %s %s %.17g\n", $1, $5, $6, $7, $3 / 2 }' \
  spheres.data > places.dump
echo "Step Atoms" > log.lammps
echo "1000 200" >> log.lammps
echo "bernal: all places are written" >> log.lammps
)sh";

constexpr const char* long_box =
    "[container]\nkind = \"periodic\"\nsize = [8, 1, 1]\nscalable = true\n[spheres]\ncount = 900\n";
constexpr const char* cube = "[container]\nkind = \"periodic\"\n[spheres]\ncount = 3000\n";
constexpr const char* equal = "radius = 1.0\n";
constexpr const char* lognormal =
    "radius = { distribution = \"lognormal\", median = 1e-3, sigma = 0.15, max = 1.4e-3 }\n";

class EngineOfSlabs : public ::testing::Test {
 protected:
  const Folder folder;

  std::string engine(int slabs, const std::string& more = "", const std::string& script = idle_engine) const {
    const fs::path file = folder.write("fake", script);
    fs::permissions(file, fs::perms::owner_all);
    return fmt::format("[engine]\nkind = \"lammps\"\nexecutable = \"{}\"\nslabs = {}\n{}", file.string(),
                       slabs, more);
  }
  fs::path result() const { return folder / "result"; }
  PackedInSlabs packed(const std::string& toml, int threads = 1, const Monitor& monitor = {}) const {
    const Plan plan = build(parse_scene(toml, "scene.toml"));
    return pack_in_slabs(plan, result(), {{}, threads, monitor, result() / "engine"});
  }
  template <class E>
  std::string error_of(const std::string& toml) const {
    try {
      packed(toml);
    } catch (const E& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      return error.what();
    }
    return "";
  }
  /// What stands there beside the engine's folder.
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    if (fs::exists(result()))
      for (const auto& entry : fs::directory_iterator(result()))
        if (entry.path().filename() != "engine") names.push_back(entry.path().filename().string());
    std::ranges::sort(names);
    return names;
  }
};

bool holds(const std::string& text, std::string_view what) { return text.find(what) != std::string::npos; }

TEST_F(EngineOfSlabs, AreCertifiedAndReadAsAnyResult) {
  for (const auto& [box, sizes, slabs] : {std::tuple{long_box, equal, 2},
                                          {long_box, equal, 3},
                                          {long_box, equal, 8},
                                          {long_box, lognormal, 5},
                                          {cube, lognormal, 2},
                                          {cube, equal, 3}}) {
    SCOPED_TRACE(fmt::format("{} slabs, {}{}", slabs, box, sizes));
    const PackedInSlabs made = packed(std::string(box) + sizes + engine(slabs));
    EXPECT_EQ(made.packing.outcome, Outcome::converged) << made.packing.reason;
    EXPECT_TRUE(made.written.certificate.certified) << made.written.certificate.statement;
    EXPECT_GT(made.packing_fraction, 0.6);
    EXPECT_EQ(names(), (std::vector<std::string>{"report.json", "scene.toml", "spheres.npy"}));

    const Packing read = read_packing(result());
    EXPECT_EQ(read.spheres.size(), made.spheres);
    EXPECT_NEAR(read.packing_fraction(), made.packing_fraction, 1e-12);
    const Certificate whole = certify(read.spheres, read.domain),
                      slab_by_slab = certify_in_slabs(read.scene, result() / "spheres.npy", {});
    EXPECT_TRUE(whole.certified) << whole.statement;
    EXPECT_EQ(whole.statement, made.written.certificate.statement);
    EXPECT_EQ(whole.statement, slab_by_slab.statement);
    EXPECT_TRUE(holds(text_of(result() / "report.json"), hash_of(read.spheres)));
    EXPECT_TRUE(holds(text_of(result() / "report.json"), "\"not_measured\""));
  }
}

TEST_F(EngineOfSlabs, HaveTheSizesThatWereDrawn) {
  // The same as without slabs, in another order.
  const std::string scene = std::string(long_box) + lognormal;
  packed(scene + engine(4));
  std::vector<double> in_slabs = read_packing(result()).spheres.r;
  std::vector<double> whole =
      run(build(parse_scene(scene + "[[stage]]\ndo = \"relax\"\n", "s.toml"))).spheres.r;
  std::ranges::sort(in_slabs);
  std::ranges::sort(whole);
  EXPECT_EQ(in_slabs, whole);
}

TEST_F(EngineOfSlabs, AreOnePackingForOneSeed) {
  const std::string scene = std::string(long_box) + equal + engine(3);
  packed(scene, 1);
  const std::string once = text_of(result() / "spheres.npy");
  packed(scene, 2);
  EXPECT_EQ(text_of(result() / "spheres.npy"), once);
}

TEST_F(EngineOfSlabs, GoOnFromWhatTheEngineKeeps) {
  const std::string scene = std::string(long_box) + equal + engine(3, "keep = true\n");
  int asked = 0;
  const Monitor stops{{}, [&] { return fs::exists(result() / "engine/places.dump") && ++asked > 20; }};
  EXPECT_THROW(packed(scene, 1, stops), Cancelled);
  EXPECT_EQ(names(), std::vector<std::string>()) << "nothing is half written";
  packed(scene);
  EXPECT_EQ(text_of(result() / "engine/calls"), "called\n");
  // Other slabs of the same places.
  packed(std::string(long_box) + equal + engine(5, "keep = true\n"));
  EXPECT_EQ(text_of(result() / "engine/calls"), "called\n");
}

TEST_F(EngineOfSlabs, TakeNoResultThatIsNotWhole) {
  const std::string scene = std::string(long_box) + equal;
  const auto failure = [&](const std::string& spoil) {
    return error_of<EngineError>(scene + engine(3, "", std::string(idle_engine) + spoil));
  };
  EXPECT_TRUE(holds(failure("sed -i '$d' places.dump\n"), "before sphere 900 of 900"));
  EXPECT_TRUE(holds(failure("sed -i 's/^7 .*/8 1 1 1 1/' places.dump\n"), "twice"));
  EXPECT_TRUE(holds(failure("sed -i 's/^7 .*/7 1 1 1 1.5/' places.dump\n"), "other radii"));
  EXPECT_TRUE(
      holds(failure("sed -i 's/ radius$//' places.dump\n"), "no line \"ITEM: ATOMS id x y z radius\""));
  EXPECT_TRUE(holds(failure("exit 1\n"), "exit code 1"));
  EXPECT_EQ(names(), std::vector<std::string>());
}

TEST_F(EngineOfSlabs, NeedABoxThatIsWideEnough) {
  EXPECT_TRUE(holds(error_of<Error>(std::string(long_box) + equal + engine(50)), "give at most 9"));
  for (const int count : {1, 2})
    EXPECT_TRUE(
        holds(error_of<Error>(fmt::format("[container]\nkind = \"periodic\"\n[spheres]\ncount = {}\n{}{}",
                                          count, equal, engine(2))),
              "leave \"slabs\" out"));
  EXPECT_EQ(names(), std::vector<std::string>());
}

TEST_F(EngineOfSlabs, RefuseWhatNeedsAllSpheres) {
  const auto refusal = [&](const std::string& scene) { return error_of<Error>(scene); };
  const std::string box = std::string(long_box) + equal;
  EXPECT_TRUE(holds(refusal(box + "gap = 0.1\n" + engine(2)), "know no gaps"));
  EXPECT_TRUE(holds(refusal(box + engine(2) + "[[output]]\nformat = \"xyz\"\n"), "[[output]]"));
  EXPECT_TRUE(
      holds(refusal(box + engine(2) + "[[stage]]\ndo = \"relax\"\ndevice = \"gpu\"\n"), "\"device\""));
  EXPECT_TRUE(holds(refusal(box + engine(2) + "[[stage]]\ndo = \"relax\"\npolish = 1e-9\n"), "\"polish\""));
  EXPECT_TRUE(
      holds(refusal(box + engine(2) + "[[stage]]\ndo = \"relax\"\nexchange = true\n"), "\"exchange\""));
  EXPECT_TRUE(holds(refusal(box + engine(2) + "[[stage]]\ndo = \"relax\"\n[[stage]]\ndo = \"relax\"\n"),
                    "one stage"));
  EXPECT_TRUE(
      holds(refusal("[container]\nkind = \"periodic\"\nedge = 20\n[spheres]\ncount = 900\nradius = 1\n" +
                    engine(2)),
            "size is the result"));
  EXPECT_TRUE(
      holds(refusal("[container]\nkind = \"box\"\nsize = [9, 9, 9]\n[spheres]\ncount = 9\nradius = 1\n" +
                    engine(2)),
            "size is the result"));
  // And in memory they are not to be had.
  EXPECT_THROW(run(build(parse_scene(box + engine(2), "scene.toml"))), Error);
}

}  // namespace engine_slabs_test
}  // namespace bernal
