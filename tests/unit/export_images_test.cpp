// Images as an output: from a result, and of a scene.
#include <gtest/gtest.h>

#include <tuple>

#include "bernal/formats/export.hpp"
#include "bernal/plan/plan.hpp"
#include "bernal/scene/read_scene.hpp"
#include "support/export_packings.hpp"
#include "support/written_files.hpp"

namespace bernal {
namespace export_images_test {

namespace fs = std::filesystem;
using namespace testing::exports;
using testing::error_of;
using testing::Folder;
using testing::text_of;

constexpr const char* image_formats[] = {"nrrd", "vti", "tiff", "raw"};

/// The voxels of a raw file.
std::string voxels_of(const Packing& packing, const std::map<std::string, std::string>& words) {
  const Folder folder;
  return text_of(exported_to(folder, packing, "raw", words));
}

TEST(ExportImages, EveryFormatHoldsTheVoxelsOfItsPacking) {
  const std::tuple<Packing, const char*, VoxelValues> cases[] = {
      {periodic(), "labels", VoxelValues::labels},
      {between_walls(), "fraction", VoxelValues::fraction},
      {in_cylinder(), "binary", VoxelValues::binary},
      {in_plane(), "labels", VoxelValues::labels},
  };
  for (const auto& [packing, values, kind] : cases) {
    const std::map<std::string, std::string> words = {{"resolution", "24"}, {"values", values}};
    const std::string voxels = voxels_of(packing, words);
    std::string expected;
    voxelise(packing.spheres, packing.domain, voxel_grid_of(packing.domain, 24), kind,
             [&](std::string_view layers) { expected += layers; });
    EXPECT_TRUE(voxels == expected) << values;
    for (const char* format : image_formats) {
      const Folder folder;
      const std::string file = text_of(exported_to(folder, packing, format, words));
      EXPECT_NE(file.find(voxels), std::string::npos) << format << ' ' << values;
    }
  }
}

TEST(ExportImages, LengthsAreInTheUnitOfTheFile) {
  const Folder folder;
  const auto header = [&](const std::map<std::string, std::string>& words) {
    const std::string file = text_of(exported_to(folder, periodic(), "nrrd", words));
    return file.substr(0, file.find("\n\n"));
  };
  EXPECT_NE(header({{"voxel", "0.5"}, {"unit", "um"}}).find("sizes: 6 8 11\n"), std::string::npos);
  const std::string metres = header({{"voxel", "0.5"}, {"unit", "m"}});
  EXPECT_NE(metres.find("sizes: 6 8 11\n"), std::string::npos) << metres;
  EXPECT_NE(metres.find("\"m\" \"m\" \"m\""), std::string::npos) << metres;
  EXPECT_NE(metres.find("(0.0005,0,0)"), std::string::npos) << metres;
  EXPECT_EQ(voxels_of(in_cylinder(), {{"voxel", "0.3"}}),
            voxels_of(in_cylinder(), {{"voxel", "0.3"}, {"unit", "m"}}));
}

TEST(ExportImages, SayWhatTheyAre) {
  const Folder folder;
  const WrittenExport written =
      write_export(in_cylinder(), output_of("raw", {{"voxel", "0.5"}}), folder / "bed.raw");
  EXPECT_EQ(written.files, (std::vector<fs::path>{folder / "bed.raw", folder / "bed.json"}));
  EXPECT_NE(written.note.find("8 x 8 x 10 voxels of 0.5 mm, 0 pore, 1 sphere, 2 outside the container"),
            std::string::npos)
      << written.note;
  const std::string note =
      write_export(periodic(), output_of("vti", {{"voxel", "0.7"}}), folder / "b.vti").note;
  EXPECT_NE(note.find("5 x 6 x 8 voxels of 0.6 x 0.666667 x 0.6625 mm"), std::string::npos) << note;
  EXPECT_EQ(fs::file_size(exported_to(folder, in_plane(), "raw")),
            205u * 256u);  // 256 along the longest edge
}

TEST(ExportImages, WhatIsStoppedLeavesNothing) {
  const Folder folder;
  const Monitor stopped{.on_progress = {}, .cancelled = [] { return true; }};
  for (const char* format : image_formats)
    EXPECT_THROW(write_export(periodic(), output_of(format), folder / "a.image", stopped), Cancelled);
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

Scene with_image(const std::string& body) {
  return parse_scene(
      "unit = \"mm\"\n[container]\nkind = \"box\"\nsize = [10, 10, 10]\n[spheres]\ncount = 5\n"
      "radius = 0.5\n[[output]]\nformat = \"nrrd\"\n" +
          body,
      "s.toml");
}

TEST(ExportImages, OfASceneAreRefusedBeforeItsRun) {
  EXPECT_NO_THROW(build(with_image("voxel = 0.1\nvalues = \"labels\"\n")));
  const Error large = error_of([] { build(with_image("voxel = 1e-5\n")); });
  EXPECT_EQ(large.code(), ErrorCode::bad_scene);
  EXPECT_EQ(large.location().line, 10);
  EXPECT_NE(std::string(large.what()).find("2^40"), std::string::npos) << large.what();
  const Error both = error_of([] { with_image("voxel = 0.1\nresolution = 100\n"); });
  EXPECT_NE(std::string(both.what()).find("\"voxel\""), std::string::npos) << both.what();
  EXPECT_NE(std::string(error_of([] { with_image("values = \"label\"\n"); }).what()).find("\"labels\""),
            std::string::npos);
  EXPECT_EQ(with_image("").outputs[0].resolution, 256);
}

}  // namespace export_images_test
}  // namespace bernal
