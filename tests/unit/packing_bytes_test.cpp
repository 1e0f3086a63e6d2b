#include "bernal/scene/packing_bytes.hpp"

#include <gtest/gtest.h>

#include "bernal/cad/read_mesh.hpp"
#include "bernal/formats/import.hpp"
#include "bernal/result/read_packing.hpp"
#include "bernal/result/write_packing.hpp"
#include "bernal/run/run.hpp"
#include "bernal/scene/read_scene.hpp"
#include "bernal/settle/insert.hpp"
#include "bernal/verify/certificate.hpp"
#include "support/folder.hpp"

namespace bernal {
namespace packing_bytes_test {
namespace {

std::shared_ptr<const PolygonSurface> cube(double edge) {
  auto made = std::make_shared<PolygonSurface>();
  for (const double z : {0.0, edge})
    for (const double y : {0.0, edge})
      for (const double x : {0.0, edge}) made->vertices.emplace_back(x, y, z);
  made->faces = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  return made;
}

Scene of_equal(SceneContainer container, std::int64_t count) {
  Scene scene;
  scene.unit = Unit::mm;
  scene.container = std::move(container);
  scene.sizes = Constant{0.5};
  scene.target.count = count;
  return scene;
}

MeshFile given_cube() {
  return {.file = "cube.off", .unit = Unit::in, .surfaces = {{"cube.off", cube(0.5)}}};
}

std::vector<Scene> scenes() {
  std::vector<Scene> all;
  all.push_back(of_equal(Box{{0, 0, 0}, {4, 4, 4}}, 20));
  all.push_back(of_equal(Box{{0, 0}, {9, 9}}, 20));
  all.push_back(of_equal(Cylinder{.radius = 2, .height = 4}, 20));
  all.push_back(of_equal(Sphere{.radius = 3}, 20));
  all.push_back(of_equal(PeriodicBox{.dimension = 4}, 50));
  all.push_back(of_equal(Polygon{{{{0, 0}, {9, 0}, {0, 9}}}}, 10));
  all.push_back(of_equal(given_cube(), 20));  // whose corners are exact in another unit
  return all;
}

TEST(PackingBytes, HoldAllOfAPackingToTheBit) {
  for (const Scene& scene : scenes()) {
    const Packing packing = run(build(scene), {.seed = 7});
    const std::string bytes = bytes_of(packing);
    const Packing again = packing_of_bytes(bytes);
    EXPECT_EQ(again.spheres.x, packing.spheres.x) << name_of(packing.domain);
    EXPECT_EQ(again.spheres.r, packing.spheres.r);
    EXPECT_EQ(again.seed, 7u);
    EXPECT_EQ(again.history.size(), packing.history.size());
    EXPECT_EQ(bytes_of(again), bytes) << name_of(packing.domain);
    EXPECT_TRUE(certify(again.spheres, again.domain).certified);
  }
}

std::string refusal_of(const std::string& bytes) {
  try {
    packing_of_bytes(bytes);
    return "";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_packing);
    return error.what();
  }
}

TEST(PackingBytes, AreThoseOfOnePackingsNumberAndOneLayout) {
  const std::string bytes = bytes_of(run(build(of_equal(Box{{0, 0, 0}, {4, 4, 4}}, 2)))),
                    program = "bernal " + text_of(this_program());
  const std::size_t name = sizeof(std::uint64_t), number = name + program.size();
  ASSERT_EQ(bytes.substr(name, program.size()), program);
  std::string changed = bytes;
  changed[name + 7] = '9';  // another version with the same packings
  EXPECT_EQ(refusal_of(changed), "");
  ++changed[number];
  EXPECT_NE(refusal_of(changed).find("a packing of bernal 9"), std::string::npos);
  EXPECT_NE(refusal_of(changed).find("this is " + program), std::string::npos);
  changed = bytes;
  ++changed.back();  // other members
  EXPECT_NE(refusal_of(changed).find("write it to a folder"), std::string::npos);
  EXPECT_NE(refusal_of(bytes.substr(0, bytes.size() / 2)), "");
  const std::string earlier = std::string(
                                  "\5\0\0\0\0\0\0\0"
                                  "0.1.0",
                                  13) +
                              bytes.substr(number);
  EXPECT_NE(refusal_of(earlier).find("a packing of 0.1.0"), std::string::npos);
}

// What a scene holds itself is written beside it, and read from there.
TEST(GivenFiles, AreWrittenBesideResultsAndScenes) {
  const testing::Folder folder;
  const Packing first = run(build(of_equal(given_cube(), 20)));
  Scene scene = of_equal(given_cube(), 22);
  scene.start.file = "first.npy";
  scene.start.packing = std::make_shared<const Packing>(first);
  scene.stages = {Insert{}};  // which leaves the others where they are
  const Packing second = run(build(scene));
  ASSERT_EQ(second.spheres.size(), 22u);
  for (std::size_t i = 0; i < 20; ++i) EXPECT_EQ(second.spheres.x[0][i], first.spheres.x[0][i]);
  EXPECT_TRUE(write_packing(second, folder / "out").certificate.certified);
  EXPECT_EQ(read_packing(folder / "out").spheres.x, second.spheres.x);
  EXPECT_EQ(run(build(read_scene(folder / "out/scene.toml"))).spheres.x, second.spheres.x);
  complete(scene);
  write_scene(scene, folder / "scene.toml");
  EXPECT_EQ(run(build(read_scene(folder / "scene.toml"))).spheres.x, second.spheres.x);
}

TEST(GivenFiles, SurfacesAreRefusedAsThoseOfFilesAre) {
  auto broken = *cube(1);
  broken.faces[0] = {0, 1, 8};
  const auto refusal = [&] {
    try {
      read_mesh({.file = "a.off", .surfaces = {{"a.off", std::make_shared<PolygonSurface>(broken)}}});
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refusal(), "a.off: a face has three or more of the vertices 0 to 7, not [0, 1, 8]");
  broken.faces.clear();
  EXPECT_NE(refusal().find("holds no faces"), std::string::npos);
}

Spheres<dynamic> discs(const std::vector<double>& x, const std::vector<double>& y,
                       const std::vector<double>& r) {
  Spheres<dynamic> made;
  made.x = {x, y};
  made.r = r;
  return made;
}

TEST(ImportSpheres, ThatStandInNoFile) {
  const ImportOptions options{.unit = Unit::mm, .box = {3, 3}, .periodic = "x"};
  const Packing packing = import_spheres(discs({1, 3.5}, {1, 2}, {0.5, 0.25}), options).packing;
  EXPECT_EQ(packing.spheres.x, (std::vector<std::vector<double>>{{1, 0.5}, {1, 2}}));  // within a period
  EXPECT_EQ(bytes_of(packing_of_bytes(bytes_of(packing))), bytes_of(packing));
  const testing::Folder folder;
  write_imported(packing, {}, folder / "out");
  EXPECT_EQ(read_packing(folder / "out").outcome, Outcome::imported);
  EXPECT_THROW(import_spheres(discs({1, 2}, {1}, {0.5, 0.5}), options), Error);
  EXPECT_THROW(import_spheres(discs({1}, {1}, {-0.5}), options), Error);
  EXPECT_THROW(import_spheres(discs({1e300}, {1}, {0.5}), options), Error);
}

}  // namespace
}  // namespace packing_bytes_test
}  // namespace bernal
