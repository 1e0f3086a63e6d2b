// Scenes with an engine, by shell scripts in the place of LAMMPS that behave, and that do not.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>

#include <fmt/format.h>

#include "bernal/engine/engine_error.hpp"
#include "bernal/run/run.hpp"
#include "bernal/scene/read_scene.hpp"
#include "bernal/verify/certificate.hpp"
#include "process/child.hpp"
#include "support/folder.hpp"

namespace bernal {
namespace engine_test {

using testing::Folder;
using testing::text_of;
namespace fs = std::filesystem;

constexpr const char* in_periodic_box =
    "[container]\nkind = \"periodic\"\n[spheres]\ncount = 200\nradius = 1\n";

/// Leaves every sphere where it was put, as an engine that does nothing would, and the log of one.
constexpr const char* idle_engine = R"sh(#!/bin/bash
echo called >> calls
awk '/^[0-9]+ atoms/ { n = $1 }
     /lo .hi|[xyz]lo/ { box = box $1 " " $2 "\n" }
     atoms && NF == 7 { rows = rows $1 " " $5 " " $6 " " $7 "\n" }
     /^Atoms/ { atoms = 1 }
     END { printf "ITEM: TIMESTEP\n1000\nITEM: NUMBER OF ATOMS\n%d\nITEM: BOX BOUNDS pp pp pp\n%sITEM: ATOMS id x y z\n%s", n, box, rows }' \
  spheres.data > places.dump
echo "Step Atoms" > log.lammps
echo "1000 200" >> log.lammps
echo "bernal: all places are written" >> log.lammps
)sh";

class EngineOfScripts : public ::testing::Test {
 protected:
  const Folder folder;

  std::string engine(const std::string& script, const std::string& more = "") const {
    const fs::path file = folder.write("fake", script);
    fs::permissions(file, fs::perms::owner_all);
    return fmt::format("[engine]\nkind = \"lammps\"\nexecutable = \"{}\"\n{}", file.string(), more);
  }
  Packing packed(const std::string& toml, const Monitor& monitor = {}) const {
    return run(build(parse_scene(toml, "scene.toml")),
               {.monitor = monitor, .engine_folder = folder / "engine"});
  }
  std::string error_of(const std::string& toml) const {
    try {
      packed(toml);
    } catch (const EngineError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      return error.what();
    }
    return "";
  }
  std::size_t calls() const {
    std::size_t lines = 0;
    if (fs::exists(folder / "engine/calls"))
      for (const char c : text_of(folder / "engine/calls")) lines += c == '\n';
    return lines;
  }
};

void expect_certified(const Packing& packing) {
  const Certificate certificate = certify(packing.spheres, packing.domain,
                                          {.gap = packing.scene.gap, .wall_gap = packing.scene.wall_gap});
  EXPECT_TRUE(certificate.certified) << certificate.statement;
}

bool holds(const std::string& text, std::string_view what) { return text.find(what) != std::string::npos; }

TEST_F(EngineOfScripts, LeavesPlacesThatRelaxGoesOnFrom) {
  const Packing packing = packed(in_periodic_box + engine(idle_engine));
  expect_certified(packing);
  EXPECT_EQ(packing.spheres.size(), 200u);
  EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
  EXPECT_GT(packing.packing_fraction(), 0.6);
  EXPECT_EQ(packing.effects.front().name, "engine");
  EXPECT_EQ(packing.history.front().stage, "lammps");
  EXPECT_TRUE(fs::exists(folder / "engine/in.lammps"));
  EXPECT_TRUE(fs::exists(folder / "engine/log.lammps"));
  EXPECT_FALSE(fs::exists(folder / "engine/spheres.data"));
  EXPECT_FALSE(fs::exists(folder / "engine/places.dump"));
}

TEST_F(EngineOfScripts, WorkBetweenWalls) {
  for (const char* container :
       {"kind = \"box\"\nsize = [12, 13, 14]", "kind = \"sphere\"\nradius = 8\ncenter = [3, 1, -2]",
        "kind = \"cylinder\"\nradius = 6\nheight = 15\nbase = [1, 2, 3]",
        "kind = \"cylinder\"\nradius = 6\nheight = 15\naxis = [1, -2, 0.5]",
        "kind = \"cylinder\"\nradius = 6\nheight = 15\nperiodic = true",
        "kind = \"periodic\"\nsize = [12, 13, 14]\nwalls = [1]"}) {
    const Packing packing =
        packed(fmt::format("[container]\n{}\n[spheres]\npacking_fraction = 0.4\nradius = 1\n", container) +
               engine(idle_engine));
    expect_certified(packing);
    EXPECT_EQ(packing.outcome, Outcome::converged) << container << packing.reason;
    EXPECT_GE(packing.packing_fraction(), 0.39) << container;
  }
}

TEST_F(EngineOfScripts, WorkWithGapsAndInABoxOfGivenSize) {
  const Packing gaps =
      packed("[container]\nkind = \"periodic\"\n[spheres]\ncount = 100\nradius = 1\ngap = 0.1\n" +
             engine(idle_engine));
  expect_certified(gaps);
  EXPECT_EQ(gaps.outcome, Outcome::converged) << gaps.reason;
  for (const double phi : {0.2, 0.55, 0.62}) {
    const Packing packing = packed(
        fmt::format("[container]\nkind = \"periodic\"\nsize = [14, 15, 16]\n[spheres]\npacking_fraction = "
                    "{}\nradius = 1\n",
                    phi) +
        engine(idle_engine));
    expect_certified(packing);
    EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
    EXPECT_EQ(bounds_of<dynamic>(packing.domain).size(), Vector<3>(14, 15, 16));
  }
}

TEST_F(EngineOfScripts, PutBackWhatTheyLeaveOutside) {
  std::string away = idle_engine;  // the first sphere is left far outside
  away += "sed -i 's/^1 .*/1 90 90 90/' places.dump\n";
  const Packing packing = packed(
      "[container]\nkind = \"sphere\"\nradius = 8\n[spheres]\ncount = 50\nradius = 1\n" + engine(away));
  expect_certified(packing);
  EXPECT_EQ(packing.spheres.size(), 50u);
  EXPECT_TRUE(holds(packing.reason, "1 sphere had left the container")) << packing.reason;
}

TEST_F(EngineOfScripts, AreNotStartedAgainForWhatTheyHaveLeft) {
  const std::string scene = in_periodic_box + engine(idle_engine, "keep = true\n");
  const Packing first = packed(scene), second = packed(scene);
  EXPECT_EQ(calls(), 1u);
  EXPECT_EQ(first.spheres, second.spheres);
  packed("seed = 2\n" + scene);  // other spheres
  EXPECT_EQ(calls(), 2u);
  EXPECT_TRUE(fs::exists(folder / "engine/places.dump"));
}

TEST_F(EngineOfScripts, ThatFailSayWhyAndLeaveTheirFiles) {
  const std::string there = "its files are in " + fs::absolute(folder / "engine").string();
  const auto said = [&](const std::string& script) { return error_of(in_periodic_box + engine(script)); };
  std::string text = said(
      "#!/bin/bash\necho 'ERROR: Lost atoms: original 200 current 190 (../thermo.cpp:1)' | tee "
      "log.lammps\nexit 1\n");
  EXPECT_TRUE(holds(text, "Lost atoms: original 200 current 190") && holds(text, there)) << text;
  EXPECT_TRUE(fs::exists(folder / "engine/spheres.data"));
  EXPECT_TRUE(holds(said("#!/bin/bash\nkill -SEGV $$\n"), "Segmentation fault"));
  EXPECT_TRUE(holds(said("#!/bin/bash\nkill -9 $$\n"), "memory has run out"));
  EXPECT_TRUE(holds(said("#!/bin/bash\nexit 3\n"), "exit code 3"));
  EXPECT_TRUE(holds(said("#!/bin/bash\necho hello\n"), "before its script did"));
  const std::string idle = idle_engine;
  EXPECT_TRUE(holds(said(idle + "rm places.dump\n"), "has left no places"));
  EXPECT_TRUE(holds(said(idle + "truncate -s -100 places.dump\n"), "cut off"));
  EXPECT_TRUE(holds(said(idle + "sed -i 's/^7 .*/7 nan nan nan/' places.dump\n"), "not stable"));
  EXPECT_TRUE(holds(said(idle + "sed -i 's/^200$/150/' places.dump\n"), "150 of 200 are left"));
  EXPECT_TRUE(holds(said("not a program\n"), "cannot be started: "));
  fs::permissions(folder / "fake", fs::perms::owner_read);
  EXPECT_TRUE(holds(error_of(in_periodic_box +
                             std::string("[engine]\nkind = \"lammps\"\nexecutable = \"no-such-engine\"\n")),
                    "scene.toml:8: there is no program \"no-such-engine\""));
}

// Nobody writes into the pipes: whoever opened them to read would wait for ever.
TEST_F(EngineOfScripts, ThatLeavePipesAreNotWaitedFor) {
  const auto said = [&](const std::string& script) { return error_of(in_periodic_box + engine(script)); };
  const std::string idle = idle_engine;
  EXPECT_TRUE(holds(said(idle + "rm places.dump\nmkfifo places.dump\n"), "has left no places"));
  EXPECT_TRUE(holds(said(idle + "rm log.lammps\nmkfifo log.lammps\n"), "before its script did"));
  EXPECT_TRUE(
      holds(said("#!/bin/bash\nmkfifo log.lammps places.dump\nsleep 0.1\n"), "before its script did"));
}

TEST_F(EngineOfScripts, ThatFailInAPassingFolderLeaveItThere) {
  const Plan plan = build(parse_scene(in_periodic_box + engine("#!/bin/bash\nexit 4\n"), "scene.toml"));
  std::string said;
  try {
    run(plan);
  } catch (const Error& error) {
    said = error.what();
  }
  const std::string mark = "its files are in ";
  ASSERT_TRUE(holds(said, mark)) << said;
  std::string left = said.substr(said.find(mark) + mark.size());
  left.pop_back();
  EXPECT_TRUE(fs::exists(left + "/in.lammps")) << left;
  fs::remove_all(left);
}

TEST_F(EngineOfScripts, EndWhenTheUserStops) {
  const auto begin = std::chrono::steady_clock::now();
  int asked = 0;
  const Packing packing =
      packed(in_periodic_box + engine("#!/bin/bash\necho $$ > pid\nsleep 600 & echo $! >> pid\nwait\n"),
             {.on_progress = {}, .cancelled = [&] { return ++asked > 20; }});
  EXPECT_EQ(packing.outcome, Outcome::cancelled);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(60));
  std::istringstream pids(text_of(folder / "engine/pid"));
  for (pid_t pid = 0; pids >> pid;) {
    // What was killed is there until its new parent has looked at it.
    const auto runs = [&] {
      std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
      const std::string stat((std::istreambuf_iterator<char>(file)), {});
      const std::size_t name = stat.rfind(')');
      return name != std::string::npos && stat.compare(name, 3, ") Z") != 0;
    };
    for (int k = 0; k < 1000 && runs(); ++k) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    EXPECT_FALSE(runs()) << pid;
  }
}

TEST_F(EngineOfScripts, AreLeftToSlurmAndTakenUpAfterIt) {
  const std::string scene =
      in_periodic_box + engine(idle_engine, "launcher = \"slurm\"\ncommand = \"env\"\nranks = 3\n");
  const std::string said = error_of(scene);
  EXPECT_TRUE(holds(said, "sbatch " + fs::absolute(folder / "engine/submit.sh").string())) << said;
  EXPECT_EQ(calls(), 0u);
  EXPECT_EQ(error_of(scene), said);  // nothing has begun
  ASSERT_EQ(std::system(("bash " + (folder / "engine/submit.sh").string()).c_str()), 0);
  EXPECT_EQ(calls(), 1u);
  expect_certified(packed(scene));
  EXPECT_EQ(calls(), 1u);
}

TEST_F(EngineOfScripts, MustFindEachOther) {
  const std::string scene =
      in_periodic_box +
      engine(idle_engine + std::string("echo '  1 by 1 by 1 MPI processor grid' >> log.lammps\n"),
             "launcher = \"slurm\"\ncommand = \"env\"\nranks = 2\n");
  EXPECT_TRUE(holds(error_of(scene), "sbatch "));
  ASSERT_EQ(std::system(("bash " + (folder / "engine/submit.sh").string()).c_str()), 0);
  EXPECT_TRUE(holds(error_of(scene), "did not find each other"));
}

TEST_F(EngineOfScripts, TakeTheFolderOfTheOther) {
  packed(in_periodic_box + engine(idle_engine));
  std::string scene = in_periodic_box + engine("#!/bin/bash\nexit 5\n");
  scene.replace(scene.find("lammps"), 6, "liggghts");
  EXPECT_TRUE(holds(error_of(scene), "LIGGGHTS ended with exit code 5"));
}

TEST_F(EngineOfScripts, LeaveTheFilesOfOthersAlone) {
  fs::create_directory(folder / "engine");
  folder.write("engine/spheres.data", "mine");
  EXPECT_THROW(packed(in_periodic_box + engine(idle_engine)), Error);
  EXPECT_EQ(text_of(folder / "engine/spheres.data"), "mine");
  fs::remove_all(folder / "engine");
  folder.write("engine", "a file");
  EXPECT_THROW(packed(in_periodic_box + engine(idle_engine)), Error);
  EXPECT_EQ(text_of(folder / "engine"), "a file");
}

TEST_F(EngineOfScripts, AreRefusedForWhatTheyCannotDo) {
  const auto refusal = [&](const std::string& toml) -> std::string {
    try {
      build(parse_scene(toml, "scene.toml"));
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_scene);
      return error.what();
    }
    return "";
  };
  const std::string lammps = "[engine]\nkind = \"lammps\"\n", liggghts = "[engine]\nkind = \"liggghts\"\n";
  const std::string spheres = "[spheres]\nradius = 1\ncount = 50\n";
  const auto in = [&](const std::string& container) { return "[container]\n" + container + "\n" + spheres; };
  const std::string sphere = in("kind = \"sphere\"\nradius = 9");
  EXPECT_TRUE(holds(refusal(sphere + liggghts), "scene.toml:8: LIGGGHTS has no wall around a sphere"));
  EXPECT_EQ(refusal(sphere + lammps), "");
  EXPECT_TRUE(holds(refusal(in("kind = \"cylinder\"\nradius = 9\nheight = 9\naxis = [1, 1, 0]") + liggghts),
                    "along x, y and z only"));
  EXPECT_TRUE(
      holds(refusal(in("kind = \"periodic\"\ndimension = 2") + lammps), "three dimensions, not in 2"));
  EXPECT_TRUE(holds(refusal(in("kind = \"periodic\"\nwalls = [2]") + lammps), "give it \"size\""));
  EXPECT_TRUE(holds(refusal("[container]\nkind = \"periodic\"\nedge = 20\n[spheres]\nradius = 1\n" + lammps),
                    "needs a \"count\" or a \"packing_fraction\""));
  EXPECT_TRUE(holds(refusal(sphere + lammps + "[[stage]]\ndo = \"insert\"\n"), "begin with \"relax\""));
  EXPECT_TRUE(holds(refusal(in("kind = \"periodic\"") + lammps + "[[stage]]\ndo = \"relax\"\nphi0 = 0.7\n"),
                    "scene.toml:10: with an [engine]"));
  EXPECT_TRUE(holds(refusal(sphere + lammps + "slurm = \"--time=1\"\n"), "launcher = \"slurm\""));
  EXPECT_TRUE(holds(refusal(sphere + "[engine]\nkind = \"lamps\"\n"), "did you mean \"lammps\""));
  EXPECT_TRUE(holds(refusal(sphere + lammps + "rank = 2\n"), "did you mean \"ranks\""));
  EXPECT_TRUE(holds(refusal(sphere + lammps + "ranks = 0\n"), "a whole number"));
  EXPECT_TRUE(holds(refusal(sphere + "[engine]\nranks = 2\n"), "missing \"kind\""));
  EXPECT_TRUE(holds(refusal(sphere + lammps + "[[output]]\nformat = \"lammps\"\nfile = \"engine\"\n"),
                    "another \"file\""));
}

TEST(EngineScene, SurvivesBeingWritten) {
  const Scene scene = parse_scene(
      "[container]\nkind = \"periodic\"\n[spheres]\ncount = 9\nradius = 1\n[engine]\nkind = "
      "\"lammps\"\nranks = 3\n"
      "executable = [\"lmp\", \"-sf\", \"opt\"]\nlauncher = \"slurm\"\nslurm = \"--time=1:00\"\nkeep = "
      "true\n",
      "scene.toml");
  const std::string text = scene_as_toml(scene);
  EXPECT_EQ(scene_as_toml(parse_scene(text, "again.toml")), text);
  EXPECT_TRUE(holds(text, "[engine]\nkind = \"lammps\"\nranks = 3\nlauncher = \"slurm\"\n")) << text;
}

}  // namespace engine_test
}  // namespace bernal
