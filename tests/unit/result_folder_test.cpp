// What a folder of results says of the scene and the CAD file that it came from.
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "bernal/result/read_packing.hpp"
#include "bernal/result/write_packing.hpp"
#include "bernal/run/run.hpp"
#include "bernal/scene/read_scene.hpp"
#include "cad/read/files_of_part.hpp"
#include "files/sha256.hpp"
#include "support/cad_formats.hpp"
#include "support/meshes.hpp"
#include "support/written_files.hpp"

namespace bernal {
namespace result_folder_test {

namespace fs = std::filesystem;
using testing::error_of;
using testing::Folder;
using testing::text_of;

const Mesh box = test::box_mesh({0, 0, 0}, {4, 5, 6});

/// Some spheres in a box from a file.
Packing packed_into(const fs::path& mesh) {
  Scene scene;
  scene.unit = Unit::mm;
  scene.container = MeshFile{.file = mesh};
  scene.sizes = Constant{0.5};
  scene.target.count = 10;
  return run(build(scene));
}

std::set<std::string> names_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename());
  return names;
}

Certificate certificate_of(const fs::path& folder) {
  const Packing packing = read_packing(folder);
  Certificate certificate = certify(packing.spheres, packing.domain);
  certificate.statement += certified_walls(packing.scene, packing.domain);
  return certificate;
}

TEST(ResultFolder, AResultOfFourDimensionsHasNoPictureOfThree) {
  const Folder folder;
  write_packing(testing::example(), folder.path());
  EXPECT_TRUE(names_in(folder.path()).contains("packing.svg"));
  Scene scene;
  scene.container = PeriodicBox{.dimension = 4, .edge = 4.0};
  scene.sizes = Constant{0.5};
  scene.target.count = 5;
  write_packing(run(build(scene)), folder.path());
  EXPECT_EQ(names_in(folder.path()), (std::set<std::string>{"report.html", "report.json", "scene.toml",
                                                            "spheres.csv", "spheres.vtp"}));
}

TEST(ResultFolder, NamesTheDigestOfTheMeshAndSaysWhenItHasChanged) {
  const Folder folder;
  const fs::path mesh = folder.write("box.obj", test::as_obj(box));
  const WrittenPacking written = write_packing(packed_into(mesh), folder / "out");
  EXPECT_EQ(written.certificate.statement.find("changed"), std::string::npos);
  const Scene scene = read_scene(folder / "out/scene.toml");
  const auto digests = std::get<MeshFile>(scene.container).sha256;
  ASSERT_EQ(digests.size(), 1u);
  EXPECT_EQ(digests[0].size(), 64u);
  EXPECT_NE(text_of(folder / "out/report.json").find(digests[0]), std::string::npos);
  EXPECT_TRUE(changed_files(scene).empty());
  EXPECT_EQ(certificate_of(folder / "out").statement, written.certificate.statement);

  folder.write("box.obj", "# revision 2\n" + test::as_obj(box));
  EXPECT_EQ(changed_files(scene).size(), 1u);
  const Certificate after = certificate_of(folder / "out");
  EXPECT_TRUE(after.certified);
  EXPECT_NE(after.statement.find("box.obj has changed since it was packed into"), std::string::npos);
  // Whoever packs that scene again means the file as it was.
  const Error refused = error_of([&] { build(scene); });
  EXPECT_NE(std::string(refused.what()).find("is not the file that is meant"), std::string::npos);
}

TEST(ResultFolder, TheDigestOfAGltfIsThatOfItAndOfItsBuffers) {
  const Folder folder;
  const fs::path mesh = folder.write("part.gltf", test::as_gltf(box));
  const fs::path numbers = folder.write("part.bin", test::as_gltf_numbers(box));
  const fs::path both = folder.write("both", text_of(mesh) + text_of(numbers));
  EXPECT_EQ(files_of_part(mesh), (std::vector<fs::path>{mesh, numbers}));
  EXPECT_EQ(sha256_of_part(mesh), sha256_of(both));
  EXPECT_EQ(sha256_of_part(numbers), sha256_of(numbers));

  write_packing(packed_into(mesh), folder / "out");
  EXPECT_TRUE(changed_files(read_scene(folder / "out/scene.toml")).empty());
  const Mesh larger = test::box_mesh({0, 0, 0}, {3, 3, 3});
  folder.write("part.bin", test::as_gltf_numbers(larger));
  EXPECT_EQ(changed_files(read_scene(folder / "out/scene.toml")).size(), 1u);
}

TEST(ResultFolder, TheMeshIsFoundThroughLinks) {
  const Folder folder;
  fs::create_directories(folder / "far/away");
  fs::create_directory_symlink("far/away", folder / "link");
  const fs::path mesh = folder.write("box.obj", test::as_obj(box));
  write_packing(packed_into(mesh), folder / "link/out");
  EXPECT_TRUE(certificate_of(folder / "link/out").certified);
  EXPECT_TRUE(certificate_of(folder / "far/away/out").certified);
  // A scene that is a link itself.
  fs::create_symlink("far/away/out/scene.toml", folder / "scene.toml");
  EXPECT_TRUE(fs::exists(std::get<MeshFile>(read_scene(folder / "scene.toml").container).file));
}

TEST(ResultFolder, WithTheMeshItStandsForItself) {
  const Folder folder;
  const fs::path mesh = folder.write("box.obj", test::as_obj(box));
  write_packing(packed_into(mesh), folder / "out", {.with_mesh = true});
  fs::remove(mesh);
  fs::rename(folder / "out", folder / "moved");
  EXPECT_TRUE(certificate_of(folder / "moved").certified);
  // The copy goes with the result, and what a user has there of that form stays.
  folder.write("moved/mine-12345678.obj", "no copy of anything");
  const std::size_t before = names_in(folder / "moved").size();
  folder.write("box.obj", test::as_obj(box));
  write_packing(packed_into(mesh), folder / "moved");
  EXPECT_EQ(names_in(folder / "moved").size(), before - 1);
  EXPECT_TRUE(names_in(folder / "moved").contains("mine-12345678.obj"));
}

// The scene of a result that is packed again in its place names the copy that stands there.
TEST(ResultFolder, PackedAgainInItsPlaceItKeepsItsMesh) {
  const Folder folder;
  const fs::path mesh = folder.write("box.obj", test::as_obj(box));
  write_packing(packed_into(mesh), folder / "out", {.with_mesh = true});
  const std::set<std::string> names = names_in(folder / "out");
  for (const bool with_mesh : {false, true, false}) {
    const Scene scene = read_scene(folder / "out/scene.toml");
    check_writable(folder / "out", scene);
    write_packing(run(build(scene)), folder / "out", {.with_mesh = with_mesh});
    EXPECT_EQ(names_in(folder / "out"), names);
    EXPECT_TRUE(certificate_of(folder / "out").certified);
  }
  write_packing(packed_into(mesh), folder / "out");
  EXPECT_EQ(names_in(folder / "out").size(), names.size() - 1) << "a result without a copy";
}

TEST(ResultFolder, WhatNoResultLeftThereIsNotReplaced) {
  for (const char* name :
       {"packing.svg", "section.svg", "container.off", "spheres.csv", "report.json", "scene.toml"}) {
    const Folder folder;
    folder.write(name, "mine");
    error_of([&] { check_writable(folder.path(), testing::example().scene); });
    EXPECT_EQ(text_of(folder / name), "mine");
  }
  // The container itself, called as bernal calls its own.
  const Folder folder;
  const fs::path mesh = folder.write("container.off", test::as_off(box));
  Scene scene;
  scene.unit = Unit::mm;
  scene.container = MeshFile{.file = mesh};
  error_of([&] { check_writable(folder.path(), scene); });
  write_packing(packed_into(mesh), folder / "out");
  EXPECT_EQ(text_of(mesh), test::as_off(box));
  // Behind a link, in a folder where that name is bernal's own.
  write_packing(packed_into(mesh), folder / "made");
  folder.write("made/container.off", test::as_off(box));
  fs::create_symlink("made/container.off", folder / "part.off");
  scene.container = MeshFile{.file = folder / "part.off"};
  EXPECT_NE(std::string(error_of([&] { check_writable(folder / "made", scene); }).what())
                .find("is the part that the scene packs, by a link,"),
            std::string::npos);
  // A file whose name ends in its own digest, as those of copies do.
  const std::string digest = std::get<MeshFile>(read_scene(folder / "out/scene.toml").container).sha256[0];
  const fs::path copy = folder.write("out/mine-" + digest.substr(0, 8) + ".off", test::as_off(box));
  write_packing(packed_into(mesh), folder / "out");
  EXPECT_TRUE(fs::exists(copy));
}

TEST(ResultFolder, AMeshThatLiesThereAlreadyIsNotCopiedOrTouched) {
  const Folder folder;
  const fs::path mesh = folder.write("box.obj", test::as_obj(box));
  const Packing packing = packed_into(mesh);
  write_packing(packing, folder.path(), {.with_mesh = true});
  write_packing(packing, folder.path());
  EXPECT_EQ(text_of(mesh), test::as_obj(box));
  EXPECT_EQ(names_in(folder.path()).size(), 8u);
}

TEST(ResultFolder, AChangeDuringTheRunIsNotArchived) {
  const Folder folder;
  const fs::path mesh = folder.write("box.obj", test::as_obj(box));
  const Packing packing = packed_into(mesh);
  folder.write("box.obj", test::as_obj(test::box_mesh({0, 0, 0}, {1, 1, 1})));
  const Error error = error_of([&] { write_packing(packing, folder / "out", {.with_mesh = true}); });
  EXPECT_EQ(error.code(), ErrorCode::cannot_write);
  EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST(ResultFolder, AUsersOwnSceneIsNotReplaced) {
  const Folder folder;
  const std::string text =
      "# mine\n[container]\nkind = \"box\"\nsize = [9, 9, 9]\n[spheres]\ncount = 3\nradius = 1\n";
  const fs::path own = folder.write("scene.toml", text);
  const Scene scene = read_scene(own);
  for (const Scene& packed : {scene, testing::example().scene}) {
    const Error error = error_of([&] { check_writable(folder.path(), packed); });
    EXPECT_EQ(error.code(), ErrorCode::cannot_write);
    EXPECT_NE(std::string(error.what()).find("is no result of bernal's"), std::string::npos) << error.what();
  }
  // A result's may be packed again in its place, until somebody writes into it.
  write_packing(run(build(scene)), folder / "out");
  const Scene as_run = read_scene(folder / "out/scene.toml");
  check_writable(folder / "out", as_run);
  check_writable(folder / "out", scene);
  std::ofstream(folder / "out/scene.toml", std::ios::app) << "# mine\n";
  error_of([&] { check_writable(folder / "out", as_run); });
}

}  // namespace result_folder_test
}  // namespace bernal
