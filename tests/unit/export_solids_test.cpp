// Scripts for Gmsh and CAD files of packings in domains of every kind.
#include <cmath>

#include <gtest/gtest.h>

#include "bernal/cad/read_mesh.hpp"
#include "bernal/core/error.hpp"
#include "bernal/formats/export.hpp"
#include "support/export_packings.hpp"
#include "support/folder.hpp"
#include "support/meshes.hpp"

namespace bernal {
namespace export_solids_test {

using testing::Folder;
using testing::text_of;
using testing::exports::between_walls;
using testing::exports::in_cylinder;
using testing::exports::packing_in;
using testing::exports::periodic;

Packing in_mesh() {
  return packing_in(test::box_mesh({1, 2, 3}, {4, 4, 4}), "kind = \"box\"\nsize = [4, 4, 4]");
}

WrittenExport written(const Folder& folder, const Packing& packing, const std::string& format,
                      const std::string& name, const std::map<std::string, std::string>& words = {}) {
  return write_export(packing, output_of(format, words), folder / name);
}

/// What an Error says, or nothing.
std::string refusal_of(const Packing& packing, const std::string& format,
                       const std::map<std::string, std::string>& words, const std::string& name = {}) {
  const Folder folder;
  try {
    written(folder, packing, format, name.empty() ? "a." + format : name, words);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

std::size_t count_of(const std::string& text, const std::string& what) {
  std::size_t count = 0;
  for (std::size_t at = text.find(what); at != text.npos; at = text.find(what, at + 1)) ++count;
  return count;
}

TEST(ExportSolids, GmshIsWrittenForEveryDomain) {
  for (const Packing& packing : {periodic(), between_walls(), in_cylinder(), in_mesh()}) {
    const Folder folder;
    const WrittenExport made = written(folder, packing, "gmsh", "a.py", {{"contact", "gap"}});
    ASSERT_EQ(made.files.size(), 1u);
    const std::string python = text_of(folder / "a.py");
    const std::size_t from = python.find("PIECES = [\n"), to = python.find("\n]", from);
    ASSERT_NE(to, python.npos);
    EXPECT_GE(count_of(python.substr(from, to - from), "\n    ("), packing.spheres.size());
    EXPECT_EQ(count_of(python.substr(0, from), "True,") + count_of(python.substr(0, from), "True)") > 0,
              is_periodic(packing.domain));
    EXPECT_NE(python.find("def geometry"), python.npos);
    EXPECT_EQ(count_of(python, "@"), count_of(python, " @ ")) << "a name has no value";
    for (const std::string name : {"spheres_1", "spheres_2", "spheres_3"})
      EXPECT_NE(python.find("\"" + name + "\""), python.npos);
    EXPECT_NE(made.note.find("proven"), made.note.npos);
  }
}

TEST(ExportSolids, AScriptForGmshIsNoGeo) {
  EXPECT_EQ(refusal_of(periodic(), "gmsh", {}, "rve.geo"),
            "the script that Gmsh is driven by is Python; name it \"rve.py\"");
}

TEST(ExportSolids, CadFilesHoldTheVolume) {
  for (const std::string contact : {"none", "gap", "bridge", "cap"})
    for (const Packing& packing : {periodic(), in_cylinder(), in_mesh()}) {
      if (contact != "none" && !is_periodic(packing.domain)) continue;
      const Folder folder;
      std::map<std::string, std::string> words = {{"contact", contact}};
      if (contact != "none") words["contact_gap"] = "0.02";
      const WrittenExport made = written(folder, packing, "brep", "a.brep", words);
      const std::string before = "volumes in OpenCASCADE within ";
      const std::size_t at = made.note.find(before);
      ASSERT_NE(at, made.note.npos) << made.note;
      EXPECT_LT(std::stod(made.note.substr(at + before.size())), 1e-9) << contact << ": " << made.note;
      EXPECT_NE(made.note.find("the container is a solid"), made.note.npos);
    }
}

TEST(ExportSolids, StepIsReadBack) {
  Packing packing = in_cylinder();
  const Folder folder;
  written(folder, packing, "step", "a.step");
  MeshFile file;
  file.file = folder / "a.step";
  const ImportedMesh read = read_mesh(file);
  // The container is one more than the spheres, and holds them.
  EXPECT_EQ(read.report.components, packing.spheres.size() + 1);
  const std::string text = text_of(folder / "a.step");
  EXPECT_NE(text.find("SI_UNIT(.MILLI.,.METRE.)"), text.npos);
  EXPECT_EQ(count_of(text, "SPHERICAL_SURFACE"), packing.spheres.size());
  for (const std::string name : {"'spheres_1'", "'spheres_2'", "'spheres_3'", "'container'"})
    EXPECT_NE(text.find(name), text.npos) << name;
}

// A ball of 5,120 triangles with a hollow of 1,280 in it: two shells of one solid, which is read back as it
// was.
TEST(ExportSolids, AContainerOfManyFacesIsASolid) {
  const Mesh hollow = test::inverted(test::translated(test::icosphere_mesh(0.4, 3), {0, 0, 3.2}));
  const Mesh mesh = test::joined(test::icosphere_mesh(4, 4), hollow);
  const Packing packing = packing_in(mesh, "kind = \"sphere\"\nradius = 4");
  const Folder folder;
  const WrittenExport made = written(folder, packing, "step", "a.step");
  EXPECT_NE(made.note.find("the container is a solid"), made.note.npos) << made.note;
  MeshFile file;
  file.file = folder / "a.step";
  file.solids = {"container"};
  const MeshReport report = read_mesh(file).report;
  EXPECT_EQ(report.components, 2U);
  EXPECT_TRUE(report.usable()) << report.problems.front();
  EXPECT_NEAR(report.volume / volume_of(mesh), 1, 1e-9);
}

TEST(ExportSolids, GapsAreForAllFormatsAndCapsForSolids) {
  const Packing packing = periodic();
  const Folder folder;
  for (const std::string format : {"lammps", "yade", "extxyz", "gsd", "npy", "povray", "gmsh"}) {
    const WrittenExport made = written(folder, packing, format, "a." + format, {{"contact", "gap"}});
    EXPECT_NE(made.note.find("proven"), made.note.npos) << format;
    EXPECT_EQ(made.note.find("largest overlap"), made.note.npos) << format;
    try {
      written(folder, packing, format, "b." + format, {{"contact", "bridge"}});
      FAIL() << format;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("gap or shrink"), std::string::npos);
      EXPECT_NE(std::string(error.what()).find("bernal mesh"), std::string::npos);
    }
  }
}

Packing of_two(double distance, double radius = 0.5) {
  Packing packing = between_walls();
  Spheres<3> spheres;
  spheres.push_back({1, 1, 1}, radius);
  spheres.push_back({1 + distance, 1, 1}, radius);
  packing.spheres = spheres;
  return packing;
}

TEST(ExportSolids, ScriptsOfAnyUnitBuildTheSameModel) {
  const Packing packing = periodic();
  const Folder folder;
  for (const std::string unit : {"m", "mm", "nm"}) {
    written(folder, packing, "gmsh", unit + ".py", {{"contact", "gap"}, {"unit", unit}});
    const std::string python = text_of(folder / (unit + ".py"));
    const double factor = unit == "m" ? 1e-3 : unit == "nm" ? 1e6 : 1;
    const auto after = [&](const std::string& what) {
      const std::size_t at = python.find(what);
      EXPECT_NE(at, python.npos) << what;
      return python.substr(at + what.size());
    };
    const double length = std::stod(after("\nLENGTH = "));
    std::string corner_and_size = after("\nDOMAIN = (\"Box\", ");
    for (int k = 0; k < 3; ++k) corner_and_size = corner_and_size.substr(corner_and_size.find(',') + 1);
    const double edge = std::stod(corner_and_size);
    EXPECT_NEAR(edge * length, 3 * factor, 1e-12 * factor) << unit;
    EXPECT_GE(edge, 1);
    EXPECT_LE(edge, 100);
  }
}

TEST(ExportSolids, WhatIsTooSmallForOpenCascadeIsRefusedWithTheUnitThatHelps) {
  Packing packing = of_two(1.1);
  packing.scene.unit = Unit::um;  // 0.5 um are 5e-4 mm
  EXPECT_NE(refusal_of(packing, "step", {}).find("too small"), std::string::npos);
  EXPECT_NE(refusal_of(packing, "step", {}).find("brep takes the unit um"), std::string::npos);
  EXPECT_NE(refusal_of(packing, "brep", {{"unit", "m"}}).find("the unit um"), std::string::npos);
  EXPECT_EQ(refusal_of(packing, "brep", {}), "");
}

TEST(ExportSolids, NothingIsPromisedOfSpheresThatOverlapOrCrossWalls) {
  const Folder folder;
  EXPECT_NE(written(folder, of_two(1.1), "gmsh", "a.py").note.find("makes the mesh"), std::string::npos);
  const WrittenExport near = written(folder, of_two(1.0001), "gmsh", "b.py");
  EXPECT_NE(near.note.find("contact gap"), std::string::npos) << near.note;
  const WrittenExport overlap = written(folder, of_two(0.9), "gmsh", "c.py");
  EXPECT_EQ(overlap.note.find("makes the mesh"), std::string::npos) << overlap.note;
  const std::string python = text_of(folder / "c.py");
  EXPECT_NE(python.find("TROUBLE = \"spheres overlap"), python.npos);
  EXPECT_NE(python.find("EXACT = {}"), python.npos);
  Packing outside = of_two(1.1);
  outside.spheres.x[2] = {0.4, 0.4};  // of radius 0.5 at the wall z = 0
  for (const std::string format : {"gmsh", "brep", "stl", "ply"}) {
    const WrittenExport made = written(folder, outside, format, "d." + format);
    EXPECT_NE(made.note.find("2 spheres go through the walls"), std::string::npos) << made.note;
  }
  EXPECT_NE(refusal_of(of_two(0.9), "brep", {{"contact", "bridge"}}).find("overlap"), std::string::npos);
}

TEST(ExportSolids, CapsThatMeetHaveNoExactVolume) {
  Packing packing = of_two(1);
  packing.spheres.push_back(Vector<dynamic>(Vector<3>(1.5, 1 + std::sqrt(0.75), 1)), 0.5);
  const Folder folder;
  const auto fraction = [&](const std::string& gap) {
    const WrittenExport made =
        written(folder, packing, "brep", "a" + gap + ".brep", {{"contact", "cap"}, {"contact_gap", gap}});
    return made.note.find("porosity about") != std::string::npos;
  };
  EXPECT_FALSE(fraction("0.01"));
  EXPECT_TRUE(fraction("0.3"));  // caps of angles acos(0.7) beside each other at 60 degrees
}

TEST(ExportSolids, KeysThatDoNotActAreRefused) {
  for (const std::string key : {"contact_gap", "bridge_radius"}) {
    EXPECT_THROW(output_of("brep", {{key, "0.1"}}), Error);
    EXPECT_NO_THROW(output_of("brep", {{key, "0.1"}, {"contact", "bridge"}}));
    EXPECT_THROW(parse_scene("[container]\nkind = \"box\"\nsize = [4, 4, 4]\n[spheres]\ncount = 2\nradius = "
                             "1\n[[output]]\nformat = \"brep\"\n" +
                                 key + " = 0.1\n",
                             "s.toml"),
                 Error);
  }
  EXPECT_THROW(output_of("brep", {{"bridge_radius", "0.1"}, {"contact", "cap"}}), Error);
  EXPECT_THROW(output_of("gmsh", {{"mesh_gap", "1e-6"}}), Error);
}

}  // namespace export_solids_test
}  // namespace bernal
