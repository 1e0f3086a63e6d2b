// How meshes that repeat themselves are read.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "bernal/cad/read_mesh.hpp"
#include "bernal/core/error.hpp"
#include "bernal/verify/certificate.hpp"
#include "geometry/measures.hpp"
#include "geometry/openings.hpp"
#include "result/write_off.hpp"
#include "support/channels.hpp"
#include "support/folder.hpp"
#include "support/meshes.hpp"

namespace bernal {
namespace read_channel_test {

using test::corrugated_channel;
using test::spheres;
using test::void_of_simple_cubic;

class ReadChannel : public ::testing::Test {
 protected:
  ImportedMesh read(const Mesh& mesh, const std::array<bool, 3>& axes = {false, false, true},
                    std::optional<double> weld = {}) {
    std::ofstream(folder.path() / "channel.off") << as_off_file(mesh);
    MeshFile file{.file = folder.path() / "channel.off", .weld = weld, .periodic = axes};
    return read_container_mesh(file, {});
  }
  std::string refusal(const Mesh& mesh, const std::array<bool, 3>& axes = {false, false, true},
                      std::optional<double> weld = {}) {
    try {
      read(mesh, axes, weld);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }
  testing::Folder folder;
};

TEST_F(ReadChannel, OpenOrClosedIsTheSame) {
  const Mesh closed = corrugated_channel();
  const Mesh of_closed = read(closed).mesh, of_open = read(test::open_channel(closed)).mesh;
  for (const Mesh* mesh : {&of_closed, &of_open}) {
    EXPECT_EQ(mesh->periodic, (std::array{false, false, true}));
    EXPECT_EQ(boundary_of<3>(*mesh).edges, Vector<3>(0, 0, 3));
    EXPECT_NEAR(volume_of(*mesh), signed_volume(closed), 1e-12);
    EXPECT_EQ(triangles_of_walls(*mesh).size(), 2u * 12 * 8);
    EXPECT_TRUE(certify(spheres({{0, 0, 1.5, 0.6}}), *mesh).certified);
  }
}

TEST_F(ReadChannel, MovesTheUpperRimOntoTheLower) {
  Mesh mesh = corrugated_channel();
  for (Vector<3>& v : mesh.vertices)
    if (v[2] > 1.4) v += Vector<3>(2e-6, -1e-6, 1e-6 * v[0]);
  const ImportedMesh imported = read(mesh);
  EXPECT_NO_THROW(certify(spheres({{0, 0, 0, 0.1}}), imported.mesh));
  bool told = false;
  for (const std::string& line : imported.report.repairs)
    told |= line.find("repeats itself along z every 3") != std::string::npos &&
            line.find("matched to 2.2e-06") != std::string::npos;
  EXPECT_TRUE(told);
  for (Vector<3>& v : mesh.vertices)
    if (v[2] > 1.4) v[2] = 1.5;
  EXPECT_NE(refusal(mesh, {false, false, true}, 1e-7).find("do not match"), std::string::npos);
}

TEST_F(ReadChannel, RefusesEndsThatDoNotMatch) {
  Mesh moved = corrugated_channel();
  for (Vector<3>& v : moved.vertices)
    if (v[2] == 1.5) v[0] += 0.01;
  const std::string apart = refusal(moved);
  EXPECT_NE(apart.find("the ends at z = -1.5 and 1.5 do not match"), std::string::npos) << apart;
  EXPECT_NE(apart.find("is 0.01 from the nearest"), std::string::npos) << apart;
  EXPECT_NE(apart.find("take \"periodic\" out"), std::string::npos) << apart;
  EXPECT_EQ(apart.find('\n'), std::string::npos);

  EXPECT_NE(refusal(test::icosphere_mesh(1, 1)).find("no flat end at z = "), std::string::npos);
  EXPECT_NE(refusal(corrugated_channel(), {true, false, false}).find("no flat end at x"), std::string::npos);
  // More corners on one rim.
  Mesh turned = test::box_mesh({0, 0, 0}, {1, 1, 1});
  for (Vector<3>& v : turned.vertices)
    if (v[2] == 1) v = Vector<3>(0.9 * v[0], v[1], 1);
  EXPECT_NE(refusal(turned).find("do not match"), std::string::npos) << refusal(turned);
  EXPECT_NE(refusal(corrugated_channel(0, 1.0 / 64)).find("less than a thirtieth"), std::string::npos);
  EXPECT_EQ(refusal(corrugated_channel(0, 1.0 / 8)), "");
}

/// Of a slit without its sides one rim runs around four ends, of which no lid is flat.
TEST_F(ReadChannel, SaysThatEndsAlongSeveralAxesHaveToBeThere) {
  const Mesh slit = test::box_mesh({0, 0, 0}, {3, 2, 1});
  EXPECT_EQ(refusal(slit, {true, true, false}), "");
  Mesh plates = slit;
  std::erase_if(plates.triangles, [&](const auto& t) {
    return slit.vertices[t[0]][2] != slit.vertices[t[1]][2] ||
           slit.vertices[t[1]][2] != slit.vertices[t[2]][2];
  });
  ASSERT_EQ(plates.triangles.size(), 4u);
  const std::string refused = refusal(plates, {true, true, false});
  EXPECT_NE(refused.find("give one period as a closed solid, with its ends"), std::string::npos) << refused;
}

TEST_F(ReadChannel, KnowsNoHolesBesideItsEndsAndNoObstacles) {
  std::ofstream(folder.path() / "channel.off") << as_off_file(test::open_channel(corrugated_channel()));
  MeshFile file{
      .file = folder.path() / "channel.off", .repair = {Repair::holes}, .periodic = {false, false, true}};
  const std::vector<std::string> repairs = read_container_mesh(file, {}).report.repairs;
  EXPECT_EQ(std::ranges::count(repairs, "no holes to close beside the ends that \"periodic\" means"), 1);
  file.obstacles = {folder.path() / "channel.off"};
  try {
    read_container_mesh(file, {});
    FAIL() << "accepted";
  } catch (const OptionError& error) {
    EXPECT_EQ(error.option, "obstacles");
  }
}

TEST_F(ReadChannel, KnowsLatticeUnits) {
  const Mesh mesh = read(void_of_simple_cubic(8, {0.1, 0.7, -1.3}), {true, true, true}).mesh;
  EXPECT_EQ(boundary_of<3>(mesh).edges, Vector<3>(2, 2, 2));
  const Domain domain = mesh;
  // The middle of the void is that of the cell; at the corners are balls.
  const Vector<3> middle(1.1, 1.7, -0.3);
  EXPECT_TRUE(certify(spheres({{middle[0], middle[1], middle[2], 0.6}}), domain).certified);
  EXPECT_FALSE(certify(spheres({{0.1, 0.7, -1.3, 0.1}}), domain).certified);
  // Pores go on through every face.
  EXPECT_TRUE(certify(spheres({{middle[0] + 1, middle[1], middle[2], 0.3}}), domain).certified);
  EXPECT_TRUE(certify(spheres({{middle[0], middle[1] + 5, middle[2], 0.3}}), domain).certified);
  EXPECT_FALSE(certify(spheres({{middle[0], middle[1] + 1, middle[2] + 1, 0.1}}), domain).certified);
}

}  // namespace read_channel_test
}  // namespace bernal
