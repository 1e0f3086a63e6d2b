// What engines read, and what is made of what they say: without any engine.
#include <gtest/gtest.h>

#include <csignal>
#include <fstream>
#include <numbers>
#include <sstream>

#include "bernal/engine/engine_error.hpp"
#include "engine/engine_command.hpp"
#include "engine/engine_files.hpp"
#include "engine/engine_log.hpp"
#include "engine/read_places.hpp"
#include "support/folder.hpp"

namespace bernal {
namespace engine_files_test {

using namespace engine;
using testing::Folder;
using testing::text_of;

EngineTask task_in(Domain domain, std::vector<double> radii = {1, 1, 1}) {
  Spheres<3> spheres;
  for (std::size_t i = 0; i < radii.size(); ++i)
    spheres.push_back({1.0 + static_cast<double>(i), 0.5, 0.25}, radii[i]);
  return {.spheres = told(std::move(spheres)), .domain = std::move(domain)};
}
Box periodic_cube(double edge) {
  return {Vector<3>::Zero().eval(), Vector<3>::Constant(edge).eval(), {true, true, true}};
}
bool holds(const std::string& text, std::string_view what) { return text.find(what) != std::string::npos; }

TEST(LammpsScript, LetsAPeriodicBoxGrow) {
  EngineTask task = task_in(periodic_cube(6));
  task.growth = 1.03;
  const std::string text = lammps_script(task);
  for (const char* line : {"boundary p p p\n", "pair_style gran/hooke 1.0 NULL 1.0 NULL 0.0 0\n", "run 400\n",
                           "fix growth all deform 1 x scale 1.03 y scale 1.03 z scale 1.03 remap x\n",
                           "unfix growth\nrun 200\n", "neighbor 0.6 bin\n", "lost error"})
    EXPECT_TRUE(holds(text, line)) << line << text;
  EXPECT_FALSE(holds(text, "wall/gran")) << text;
  EXPECT_FALSE(holds(text, "multi")) << text;
}

TEST(LammpsScript, HasTheWallsOfTheDomainAndGuardsAroundRoundOnes) {
  const std::string box = lammps_script(task_in(Box{Vector<3>(0, 1, 2), Vector<3>(5, 6, 7), {}}));
  EXPECT_TRUE(holds(box, "boundary f f f\n"));
  EXPECT_TRUE(holds(box, "xplane 0 5\n") && holds(box, "yplane 1 7\n") && holds(box, "zplane 2 9\n")) << box;
  EXPECT_FALSE(holds(box, "guard")) << box;
  const std::string between =
      lammps_script(task_in(Box{Vector<3>(0, 0, 0), Vector<3>(5, 6, 7), {true, true, false}}));
  EXPECT_TRUE(holds(between, "boundary p p f\n") && holds(between, "zplane 0 7\n")) << between;
  EXPECT_FALSE(holds(between, "xplane"));
  const std::string cylinder = lammps_script(
      task_in(Cylinder{.base = {1, 2, 3}, .axis = {0, 1, 0}, .radius = 4, .height = 9, .periodic = false}));
  EXPECT_TRUE(holds(cylinder, "region inside cylinder y 1 3 4 2 11 side in\n")) << cylinder;
  EXPECT_TRUE(holds(cylinder, "wall/gran/region hooke")) << cylinder;
  EXPECT_TRUE(holds(cylinder, "guard_x all wall/gran")) << cylinder;
  const std::string column = lammps_script(
      task_in(Cylinder{.base = {1, 2, 3}, .axis = {1, 0, 0}, .radius = 4, .height = 9, .periodic = true}));
  EXPECT_TRUE(holds(column, "boundary p f f\n") && holds(column, "cylinder x 2 3 4 INF INF side in"))
      << column;
  const std::string sphere = lammps_script(task_in(Sphere{{1, 2, 3}, 8}));
  EXPECT_TRUE(holds(sphere, "region inside sphere 1 2 3 8 side in\n")) << sphere;
}

TEST(LiggghtsScript, TakesCadWallsAsAMesh) {
  const Mesh tetrahedron{{{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {0, 0, 9}},
                         {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  const std::string text = liggghts_script(task_in(tetrahedron));
  EXPECT_TRUE(holds(text, "fix surface all mesh/surface file walls.stl type 2")) << text;
  EXPECT_TRUE(holds(text, "kn peratomtypepair 2 1 4 4 4\n")) << text;
  EXPECT_TRUE(holds(text, "guard_lower_x") && holds(text, "guard_upper_z")) << text;
  const Folder folder;
  write_walls_stl(folder / "walls.stl", tetrahedron);
  const std::string stl = text_of(folder / "walls.stl");
  EXPECT_EQ(std::count(stl.begin(), stl.end(), '\n'), 2 + 4 * 7);
  EXPECT_TRUE(holds(stl, "  vertex 0 9 0\n"));
}

TEST(LiggghtsScript, PoursUntilAllRest) {
  EngineTask task = task_in(Cylinder{.base = {0, 0, 0}, .axis = {0, 0, 1}, .radius = 5, .height = 9});
  task.pouring = Pouring{.down = {0, 0, -1}, .friction = 0.4, .restitution = 0.5, .layers = 10, .fall = 30};
  const std::string text = liggghts_script(task);
  for (const char* line :
       {"fix friction all property/global coefficientFriction peratomtypepair 2 0.4 0.4 0.4 0.4\n",
        "pair_style gran model hooke/stiffness tangential history\n", "zcylinder 5 0 0\n",
        "fix down all gravity 2e-05 vector 0 0 -1\n", "fix motion all nve/sphere\n", "if \"${energy} < ",
        "jump SELF again\n"})
    EXPECT_TRUE(holds(text, line)) << line << text;
  EXPECT_FALSE(holds(text, "nve/limit") || holds(text, "tangential off")) << text;
  EXPECT_NEAR(task.mass(3), 27, 1e-12);
}

/// Two spheres of mass 1 and stiffness 1 that meet: what they keep of their speed, by small steps.
TEST(LiggghtsScript, DampsByTheCoefficientOfRestitution) {
  EngineTask task = task_in(Box{Vector<3>(0, 0, 0), Vector<3>(9, 9, 9), {}});
  task.pouring = Pouring{.down = {0, 0, -1}, .friction = 0, .restitution = 0.7, .layers = 3, .fall = 3};
  const std::string text = liggghts_script(task), name = "gamman peratomtypepair 2 ";
  ASSERT_TRUE(holds(text, name)) << text;
  const double damping = std::stod(text.substr(text.find(name) + name.size())), reduced_mass = 0.5;
  double depth = 0, speed = 1;
  constexpr double step = 1e-5;
  do {
    speed += step * (-depth / reduced_mass - damping * speed);
    depth += step * speed;
  } while (depth > 0);
  EXPECT_NEAR(-speed, 0.7, 1e-3);
}

TEST(EngineData, HasAnAtomASphereOfItsMassAndClass) {
  const Folder folder;
  const std::vector<double> radii = {1, 1.5, 4};
  const EngineTask task = task_in(periodic_cube(20), radii);
  write_data(folder / "data", task, dialect_of(Lammps{}));
  write_data(folder / "data", task, dialect_of(Lammps{}));  // takes the place of the first
  std::istringstream in(text_of(folder / "data"));
  std::string line;
  bool in_atoms = false;
  std::vector<std::array<double, 7>> atoms;
  while (std::getline(in, line)) {
    if (line.starts_with("Atoms")) in_atoms = true;
    std::istringstream words(line);
    std::array<double, 7> atom{};
    std::size_t k = 0;
    while (k < 7 && words >> atom[k]) ++k;
    if (in_atoms && k == 7) atoms.push_back(atom);
  }
  ASSERT_EQ(atoms.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const double d = atoms[i][2];
    EXPECT_EQ(atoms[i][0], static_cast<double>(i + 1));
    EXPECT_EQ(d, 2 * radii[i]);
    EXPECT_NEAR(std::numbers::pi / 6 * d * d * d * atoms[i][3], std::max(1.0, radii[i] * radii[i]), 1e-12);
    EXPECT_EQ(atoms[i][4], 1.0 + static_cast<double>(i));
  }
  EXPECT_EQ(atoms[0][1], 1);
  EXPECT_EQ(atoms[1][1], 1);  // within a factor of 1.6 of the smallest
  EXPECT_EQ(atoms[2][1], 2);
  EXPECT_TRUE(holds(text_of(folder / "data"), "3 atoms\n2 atom types\n"));
  EXPECT_TRUE(holds(lammps_script(task), "multi"));
}

TEST(EngineData, LeavesRoomBeyondWalls) {
  const EngineTask task =
      task_in(Cylinder{.base = {0, 0, 0}, .axis = {0, 0, 1}, .radius = 5, .height = 9, .periodic = true});
  const Bounds<3> region = region_of(task);
  EXPECT_LE(region.lower[0], -7);
  EXPECT_EQ(region.lower[2], 0);
  EXPECT_EQ(region.upper[2], 9);
}

TEST(LogWatch, SeesStepsAsTheyAreAdded) {
  const Folder folder;
  LogWatch watch(folder / "log");
  EXPECT_FALSE(watch.new_step());
  std::ofstream out(folder / "log");
  out << "LAMMPS (29 Sep 2021)\n100 atoms\nStep Atoms KinEng \n       0      100   0\n     10   1"
      << std::flush;
  EXPECT_EQ(watch.new_step(), 0);  // the last line is not whole
  EXPECT_FALSE(watch.new_step());
  out << "00  0.5\n20 100 0.4\nLoop time of 1 on 2 procs\n99 of no table\n" << std::flush;
  EXPECT_EQ(watch.new_step(), 20);
  EXPECT_FALSE(watch.new_step());
}

TEST(EngineLog, SaysWhatIsWrongAndTheRemedy) {
  const Dialect& lammps = dialect_of(Lammps{});
  const std::string whole = "Step Atoms\nbernal: all places are written\n";
  const auto said = [&](ChildEnd end, std::string_view log, std::string_view output = "") {
    return what_is_wrong(lammps, end, log, output).value_or("");
  };
  EXPECT_EQ(said({}, whole), "");
  EXPECT_EQ(
      said({.code = 1},
           "Step\nERROR: Lost atoms: original 1000 current 998 (../thermo.cpp:481)\nLast command: run"),
      "LAMMPS ended with \"ERROR: Lost atoms: original 1000 current 998\": give fewer \"ranks\", or another "
      "\"seed\"");
  EXPECT_TRUE(holds(said({.code = 1}, "", "ERROR on proc 1: Failed to allocate 9 bytes (../memory.cpp:66)"),
                    "more ranks"));
  EXPECT_TRUE(
      holds(said({.code = 1}, "ERROR: Unrecognized pair style 'gran/hooke' is part of the GRANULAR package"),
            "\"executable\""));
  EXPECT_TRUE(holds(said({.code = 1}, "", "There are not enough slots available in the system"), "ranks"));
  EXPECT_TRUE(holds(said({.code = 1}, "", "mpirun has detected an attempt to run as root."),
                    "OMPI_ALLOW_RUN_AS_ROOT"));
  EXPECT_TRUE(holds(said({.signal = SIGKILL}, "Step"), "memory has run out"));
  EXPECT_TRUE(holds(said({.signal = SIGSEGV}, "Step"), "Segmentation fault"));
  EXPECT_TRUE(holds(said({.code = 139}, "Step"), "Segmentation fault"));
  EXPECT_TRUE(holds(said({.code = 7}, "Step"), "exit code 7"));
  EXPECT_TRUE(holds(said({}, "Step\n"), "before its script did"));
  for (const std::string& one :
       {said({.code = 1}, "ERROR: a\nb (x.cpp:1)\n"), said({.code = 7}, ""), said({}, "")})
    EXPECT_EQ(one.find('\n'), std::string::npos) << one;
}

constexpr const char* dump_head =
    "ITEM: TIMESTEP\n1000\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp\n-1 7\n0 8\n0 8\nITEM: ATOMS "
    "id x y z \n";

TEST(ReadPlaces, PutsSpheresInTheirOrder) {
  const Folder folder;
  const engine::Places places =
      read_places(folder.write("d", std::string(dump_head) + "2 4 5 6\n1 1 2.5 3e-1\n"), {0.5, 0.75});
  EXPECT_EQ(places.spheres.center(0), Vector<3>(1, 2.5, 0.3));
  EXPECT_EQ(places.spheres.center(1), Vector<3>(4, 5, 6));
  EXPECT_EQ(places.spheres.r[1], 0.75);
  EXPECT_EQ(places.box.lower[0], -1);
  EXPECT_EQ(places.box.upper[0], 7);
}

TEST(ReadPlaces, RefusesWhatIsNotWhole) {
  const Folder folder;
  const auto refusal = [&](const std::string& text) -> std::string {
    try {
      read_places(folder.write("d", text), {1, 1});
    } catch (const EngineError& error) {
      return error.what();
    }
    return "";
  };
  const std::string head = dump_head;
  EXPECT_TRUE(holds(refusal(""), "cut off"));
  EXPECT_TRUE(holds(refusal(head + "1 1 2 3\n"), "before sphere 2 of 2"));
  EXPECT_TRUE(holds(refusal(head + "1 1 2 3\n2 4 5 6"), "within its last line"));
  EXPECT_TRUE(holds(refusal(head + "1 1 2 3\n2 4 5\n"), ":11: "));
  EXPECT_TRUE(holds(refusal(head + "1 1 2 3\n2 4 nan 6\n"), "not stable"));
  EXPECT_TRUE(holds(refusal(head + "1 1 2 3\n2 4 inf 6\n"), "not stable"));
  EXPECT_TRUE(holds(refusal(head + "1 1 2 3\n1 4 5 6\n"), "twice"));
  EXPECT_TRUE(holds(refusal(head + "1 1 2 3\n3 4 5 6\n"), "that is none"));
  EXPECT_TRUE(holds(refusal("ITEM: TIMESTEP\n1\nITEM: NUMBER OF ATOMS\n1\n"), "1 of 2 are left"));
  EXPECT_TRUE(holds(refusal("what is this\n"), "no line \"ITEM: TIMESTEP\""));
  EXPECT_THROW(read_places(folder / "none", {1}), Error);
}

TEST(EngineCommand, StartsRanksByALauncherAndASingleOneWithout) {
  SceneEngine engine = Lammps{};
  EXPECT_EQ(in_shell(words_of(engine)), "lmp -in in.lammps -log log.lammps");
  std::get<Lammps>(engine).process.ranks = 4;
  EXPECT_EQ(in_shell(words_of(engine)), "mpirun -np 4 lmp -in in.lammps -log log.lammps");
  std::get<Lammps>(engine).process.command = {"mpiexec", "--hostfile", "my hosts"};
  std::get<Lammps>(engine).process.executable = {"lmp_mpi", "-sf", "opt"};
  EXPECT_EQ(in_shell(words_of(engine)),
            "mpiexec --hostfile 'my hosts' -np 4 lmp_mpi -sf opt -in in.lammps -log log.lammps");
  EXPECT_EQ(in_shell({"it's"}), "'it'\\''s'");
}

TEST(EngineCommand, WritesAScriptForSlurm) {
  SceneEngine engine = Liggghts{};
  EngineProcess& process = std::get<Liggghts>(engine).process;
  process.launcher = EngineLauncher::slurm;
  process.ranks = 8;
  process.slurm = {"--time=01:00:00", "--partition=short"};
  EXPECT_EQ(slurm_script(engine, "/tmp/a b/engine"),
            "#!/bin/bash\n#SBATCH --job-name=bernal\n#SBATCH --ntasks=8\n#SBATCH --time=01:00:00\n"
            "#SBATCH --partition=short\n"
            "# LIGGGHTS finds the places; the call of bernal that wrote this script goes on from them.\n"
            "cd '/tmp/a b/engine' || exit 1\nexport OMP_NUM_THREADS=1\n"
            "exec srun liggghts -in in.liggghts -log log.liggghts > output.txt 2>&1\n");
}

}  // namespace engine_files_test
}  // namespace bernal
