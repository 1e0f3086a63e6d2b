#include <gtest/gtest.h>

#include "bernal/scene/read_scene.hpp"
#include "support/folder.hpp"
#include "support/scene_texts.hpp"
#include "support/scenes.hpp"

namespace bernal {
namespace write_scene_test {

using testing::expect_equal;
using testing::with_container;
using testing::with_spheres;

TEST(ExampleScenes, AreReadAndSurviveBeingWritten) {
  EXPECT_GE(testing::example_scenes().size(), 5u);
  for (const auto& file : testing::example_scenes()) {
    SCOPED_TRACE(file.string());
    const Scene scene = read_scene(file);
    expect_equal(scene, parse_scene(scene_as_toml(scene), file));
    if (const auto* mesh = std::get_if<MeshFile>(&scene.container)) {
      EXPECT_TRUE(std::filesystem::exists(mesh->file));
    }
  }
}

TEST(WriteScene, NamesTheMeshFromItsOwnFolder) {
  const testing::Folder folder;
  std::filesystem::create_directories(folder / "parts");
  std::filesystem::create_directories(folder / "out/deep");
  const auto file = folder.write("scene.toml", with_container("kind = \"mesh\"\nfile = \"parts/a.stl\""));
  const Scene scene = read_scene(file);
  const std::string written = scene_as_toml(scene, folder / "out/deep");
  EXPECT_NE(written.find("file = \"../../parts/a.stl\""), std::string::npos) << written;
  const Scene again = read_scene(folder.write("out/deep/scene.toml", written));
  EXPECT_EQ(std::filesystem::weakly_canonical(std::get<MeshFile>(again.container).file),
            std::filesystem::weakly_canonical(folder / "parts/a.stl"));
}

TEST(WriteScene, PrintsTheProtocolReadyToBePasted) {
  const Scene scene = parse_scene(with_spheres("radius = 1"), "s.toml");
  const Scene pasted = parse_scene(with_spheres("radius = 1") + stages_as_toml(scene), "s.toml");
  EXPECT_FALSE(pasted.stages_are_default);
  expect_equal(scene, pasted);
}

TEST(WriteScene, RefusesASeedThatTomlCannotHold) {
  Scene scene = parse_scene(with_spheres("radius = 1"), "s.toml");
  scene.seed = ~std::uint64_t{0};
  EXPECT_THROW(scene_as_toml(scene), Error);
}

}  // namespace write_scene_test
}  // namespace bernal
