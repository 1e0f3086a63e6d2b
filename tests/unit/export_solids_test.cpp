// Scripts for Gmsh and CAD files of packings in domains of every kind.
#include <gtest/gtest.h>

#include "bernal/cad/read_mesh.hpp"
#include "bernal/core/error.hpp"
#include "bernal/export/export.hpp"
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

std::size_t count_of(const std::string& text, const std::string& what) {
  std::size_t count = 0;
  for (std::size_t at = text.find(what); at != text.npos; at = text.find(what, at + 1)) ++count;
  return count;
}

TEST(ExportSolids, GmshIsWrittenForEveryDomain) {
  for (const Packing& packing : {periodic(), between_walls(), in_cylinder(), in_mesh()}) {
    const Folder folder;
    const WrittenExport made = written(folder, packing, "gmsh", "a.geo", {{"contact", "gap"}});
    ASSERT_EQ(made.files.size(), 2u);
    const std::string geo = text_of(folder / "a.geo"), python = text_of(folder / "a.py");
    const std::size_t wall_is_sphere = std::holds_alternative<Sphere>(packing.domain);
    EXPECT_GE(count_of(geo, "\nSphere("), packing.spheres.size() + wall_is_sphere);
    EXPECT_EQ(count_of(geo, "Periodic Surface") > 0, is_periodic(packing.domain));
    EXPECT_NE(python.find("def geometry"), python.npos);
    for (const std::string name : {"spheres_1", "spheres_2", "spheres_3"}) {
      EXPECT_NE(geo.find("\"" + name + "\""), geo.npos);
      EXPECT_NE(python.find("\"" + name + "\""), python.npos);
    }
    EXPECT_NE(made.note.find("proven"), made.note.npos);
  }
}

TEST(ExportSolids, CadFilesHoldTheVolume) {
  for (const std::string contact : {"none", "gap", "bridge", "cap"})
    for (const Packing& packing : {periodic(), in_cylinder(), in_mesh()}) {
      if (contact != "none" && !is_periodic(packing.domain)) continue;
      const Folder folder;
      const WrittenExport made =
          written(folder, packing, "brep", "a.brep", {{"contact", contact}, {"contact_gap", "0.02"}});
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

TEST(ExportSolids, GapsAreForAllFormatsAndCapsForSolids) {
  const Packing packing = periodic();
  const Folder folder;
  for (const std::string format : {"lammps", "yade", "extxyz", "gsd", "npy", "povray"}) {
    const WrittenExport made = written(folder, packing, format, "a." + format, {{"contact", "gap"}});
    EXPECT_NE(made.note.find("proven"), made.note.npos) << format;
    EXPECT_EQ(made.note.find("largest overlap"), made.note.npos) << format;
    try {
      written(folder, packing, format, "b." + format, {{"contact", "bridge"}});
      FAIL() << format;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("gap or shrink"), std::string::npos);
      EXPECT_NE(std::string(error.what()).find("gmsh"), std::string::npos);
    }
  }
}

}  // namespace export_solids_test
}  // namespace bernal
