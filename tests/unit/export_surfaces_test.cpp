// Files of triangles: every format holds the same surfaces, in the unit that its readers expect.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "bernal/cad/read_mesh.hpp"
#include "bernal/formats/export.hpp"
#include "support/export_packings.hpp"
#include "support/written_files.hpp"

namespace bernal {
namespace export_surfaces_test {

namespace fs = std::filesystem;
using namespace testing::exports;
using testing::error_of;
using testing::Folder;
using testing::text_of;

constexpr const char* formats_of_triangles[] = {"stl", "obj", "ply", "3mf", "gltf"};

fs::path written(const Folder& folder, const Packing& packing, const std::string& format,
                 std::map<std::string, std::string> words) {
  const std::string name = format == "gltf" ? "a.glb" : "a." + format;
  return write_export(packing, output_of(format, words), folder / name).files.front();
}

/// Spheres across faces, edges and corners of a periodic box.
Packing crossing() {
  Packing packing = periodic();
  const Boundary<3> boundary = boundary_of<3>(packing.domain);
  for (std::size_t k = 0; k < 3; ++k)
    for (double& x : packing.spheres.x[k]) x += 0.5 * boundary.edges[static_cast<int>(k)];
  wrap(packing.spheres, packing.domain);
  return packing;
}

double volume_of_triangles(const Mesh& mesh) {
  double volume = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    volume += mesh.vertices[a].dot(mesh.vertices[b].cross(mesh.vertices[c])) / 6;
  return volume;
}

TEST(ExportSurfaces, EveryFormatHoldsTheSameTriangles) {
  for (const char* surface : {"spheres", "container", "all", "pores"})
    for (const bool repeats : {false, true}) {
      const Packing packing = repeats ? crossing() : in_cylinder();
      std::uint64_t faces = 0;
      double volume = 0;
      for (const std::string format : formats_of_triangles) {
        const Folder folder;
        const fs::path file = written(folder, packing, format, {{"surface", surface}, {"deflection", "0.1"}});
        ImportedMesh read = read_mesh(
            {.file = file, .unit = format == "gltf" || format == "3mf" ? std::optional<Unit>() : Unit::mm},
            {.unit = Unit::mm});
        EXPECT_TRUE(read.report.closed) << format << ' ' << surface;
        EXPECT_EQ(read.report.non_manifold_edges, 0U) << format << ' ' << surface;
        EXPECT_EQ(read.report.misoriented_edges, 0U) << format << ' ' << surface;
        EXPECT_EQ(read.report.degenerate_faces, 0U) << format << ' ' << surface;
        if (!repeats || std::string(surface) != "all") {  // caps lie in the faces of the box
          EXPECT_EQ(read.report.self_intersections, 0U) << format << surface;
        }
        const double read_volume = std::abs(volume_of_triangles(read.mesh));
        if (faces == 0) {
          faces = read.report.faces;
          volume = read_volume;
          EXPECT_GT(faces, 10U);
        }
        EXPECT_EQ(read.report.faces, faces) << format << ' ' << surface;
        EXPECT_NEAR(read_volume, volume, 1e-4 * volume) << format << ' ' << surface;
      }
    }
}

TEST(ExportSurfaces, StlIsBinaryAndSaysItsUnit) {
  const Folder folder;
  const WrittenExport made = write_export(
      in_cylinder(), output_of("stl", {{"deflection", "0.1"}, {"unit", "um"}}), folder / "a.stl");
  const std::string file = text_of(made.files.front());
  EXPECT_EQ(file.find("lengths in um"), 0U);
  std::uint32_t triangles = 0;
  std::memcpy(&triangles, file.data() + 80, 4);
  EXPECT_EQ(file.size(), 84 + 50U * triangles);
  EXPECT_EQ(triangles, 60 * 80U);
  EXPECT_NE(made.note.find("no two of them touch"), std::string::npos) << made.note;
  EXPECT_NE(made.note.find("lengths in um"), std::string::npos) << made.note;
}

TEST(ExportSurfaces, PlyKnowsTheSphereOfEveryTriangle) {
  const Folder folder;
  const std::string file =
      text_of(written(folder, in_cylinder(), "ply", {{"deflection", "0.1"}, {"surface", "all"}}));
  const std::size_t end = file.find("end_header\n") + 11;
  std::size_t vertices = 0, faces = 0;
  std::sscanf(file.data() + file.find("element vertex"), "element vertex %zu", &vertices);
  std::sscanf(file.data() + file.find("element face"), "element face %zu", &faces);
  ASSERT_EQ(file.size(), end + 12 * vertices + 17 * faces);
  std::vector<int> times(61);
  for (std::size_t f = 0; f < faces; ++f) {
    std::int32_t sphere = 0;
    std::memcpy(&sphere, file.data() + end + 12 * vertices + 17 * f + 13, 4);
    ++times.at(static_cast<std::size_t>(sphere + 1));
  }
  EXPECT_GT(times[0], 20);
  for (std::size_t i = 1; i < times.size(); ++i) EXPECT_EQ(times[i], 80) << i;
}

TEST(ExportSurfaces, UnitsThatReadersExpect) {
  const Folder folder;
  const ImportedMesh printed = read_mesh({.file = written(folder, in_cylinder(), "3mf", {{"unit", "um"}})});
  EXPECT_EQ(printed.report.unit, "micron");
  EXPECT_GT(printed.report.bounds.size().maxCoeff(), 1000);
  const ImportedMesh seen = read_mesh({.file = written(folder, in_cylinder(), "gltf", {})});
  EXPECT_EQ(seen.report.unit, "meter");
  EXPECT_LT(seen.report.bounds.size().maxCoeff(), 0.006);
  const Error none = error_of([&] { written(folder, in_cylinder(), "3mf", {{"unit", "nm"}}); });
  EXPECT_NE(std::string(none.what()).find("um or mm"), std::string::npos) << none.what();
}

TEST(ExportSurfaces, AFileOfManySpheresIsSmallWhereNodesMoveOne) {
  const Folder folder;
  const auto size = [&](const std::string& format) {
    return fs::file_size(written(folder, in_cylinder(), format, {{"deflection", "0.01"}}));
  };
  EXPECT_LT(10 * size("gltf"), size("stl"));
}

TEST(ExportSurfaces, WhatIsStoppedLeavesNothing) {
  const Folder folder;
  const Monitor stopped{.on_progress = {}, .cancelled = [] { return true; }};
  for (const std::string format : {"stl", "obj", "ply", "3mf", "gltf", "snappy"})
    EXPECT_THROW(write_export(in_cylinder(), output_of(format), folder / "a.file", stopped), Cancelled)
        << format;
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

std::string words_after(const std::string& text, const std::string& key) {
  const std::size_t at = text.find(key) + key.size();
  return text.substr(at, text.find(';', at) - at);
}

TEST(ExportSurfaces, SnappyIsACaseWithAPointInThePores) {
  for (const Packing& packing : {in_cylinder(), crossing(), between_walls()}) {
    const Folder folder;
    const WrittenExport made =
        write_export(packing, output_of("snappy", {{"deflection", "0.1"}}), folder / "case");
    for (const fs::path& file : made.files)
      EXPECT_EQ(file.string().rfind((folder / "case/").string(), 0), 0u) << file;
    for (const char* name :
         {"system/controlDict", "system/fvSchemes", "system/fvSolution", "system/blockMeshDict",
          "system/snappyHexMeshDict", "Allmesh", "constant/triSurface/spheres_1.stl"})
      EXPECT_TRUE(fs::is_regular_file(folder / "case" / name)) << name;
    const std::string dict = text_of(folder / "case/system/snappyHexMeshDict");
    Vector<3> p;
    ASSERT_EQ(std::sscanf(words_after(dict, "locationInMesh").c_str(), " (%lf %lf %lf)", &p[0], &p[1], &p[2]),
              3);
    p *= 1000;  // the scene is in mm
    const Boundary<3> boundary = boundary_of<3>(packing.domain);
    for (std::size_t i = 0; i < packing.spheres.size(); ++i)
      EXPECT_GT(boundary.minimum_image(packing.spheres.center(i) - p).norm(), packing.spheres.r[i] + 1e-3);
    for (const char c : {'{', '('})
      EXPECT_EQ(std::ranges::count(dict, c), std::ranges::count(dict, c == '{' ? '}' : ')'));
    const bool cyclic = is_periodic(packing.domain);
    EXPECT_EQ(text_of(folder / "case/system/blockMeshDict").find("cyclic") != std::string::npos, cyclic);
    EXPECT_EQ(fs::exists(folder / "case/constant/triSurface/container.stl"), !cyclic);
    // Once more: somebody may have worked in it.
    EXPECT_THROW(write_export(packing, output_of("snappy", {{"deflection", "0.1"}}), folder / "case"), Error);
    EXPECT_EQ(text_of(folder / "case/system/snappyHexMeshDict"), dict);
  }
}

TEST(ExportSurfaces, KeysAreChecked) {
  EXPECT_NE(std::string(error_of([] {
                          output_of("stl", {{"surface", "pore"}});
                        }).what())
                .find("pores"),
            std::string::npos);
  EXPECT_THROW(output_of("stl", {{"deflection", "0.6"}}), Error);
  EXPECT_THROW(output_of("gltf", {{"unit", "mm"}}), Error);
}

}  // namespace export_surfaces_test
}  // namespace bernal
