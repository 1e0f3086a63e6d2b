// What the spheres of another program are taken to lie in.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/formats/import.hpp"
#include "bernal/verify/certificate.hpp"
#include "support/folder.hpp"
#include "support/meshes.hpp"
#include "support/packings.hpp"

namespace bernal {
namespace import_domain_test {

using testing::Folder;

std::string table_of(const Spheres<3>& spheres) {
  std::string text = "# unit: mm\nx,y,z,r\n";
  for (std::size_t i = 0; i < spheres.size(); ++i)
    text += fmt::format("{},{},{},{}\n", spheres.x[0][i], spheres.x[1][i], spheres.x[2][i], spheres.r[i]);
  return text;
}

ImportedPacking imported(const std::string& text, const ImportOptions& options = {}) {
  const Folder folder;
  return import_packing(folder.write("a.txt", text), options);
}
Packing packing_of(const std::string& text, const ImportOptions& options = {}) {
  return imported(text, options).packing;
}
std::string note_of(const ImportedPacking& imported, const std::string& about) {
  for (const ImportNote& note : imported.notes)
    if (note.about == about) return note.text;
  return "";
}

// Discs of a tilted box, as export writes them, with a third axis that ends.
TEST(ImportDomain, OfDiscsInATiltedBoxTheRemedyIsNamed) {
  const std::string discs =
      "2\nLattice=\"20 0 0 6 18 0 0 0 2\" pbc=\"T T F\" Properties=pos:R:3:radius:R:1 unit=m\n"
      "4 5 1 1\n9 9 1 1\n";
  const Folder folder;
  const auto file = folder.write("a.xyz", discs);
  try {
    import_packing(file, {});
    FAIL() << "taken";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("‹dimension=2›"), std::string::npos) << error.what();
  }
  const ImportedPacking flat = import_packing(file, {.dimension = 2});
  EXPECT_EQ(std::get<Box>(flat.packing.domain).tilt, (Tilt{6, 0, 0}));
  EXPECT_NE(note_of(flat, "domain").find("20 x 18 m, tilt 6, as"), std::string::npos)
      << note_of(flat, "domain");
}

// Walls at the bounds are rounded outwards: no sphere protrudes by a last bit, and none lies far from them.
TEST(ImportDomain, TheBoundsOfTheSpheresHoldThemExactly) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const Bounds<3> bounds{{-1e3 / static_cast<double>(seed), 0.1, 7}, {0.3, 5, 1e4}};
    const Packing packing = packing_of(table_of(testing::scattered(12, 0.01, 0.1, bounds, seed)));
    const Certificate certificate = certify(packing.spheres, packing.domain);
    EXPECT_EQ(certificate.protruding_spheres, 0U) << seed << ": " << certificate.statement;
    const Box& box = std::get<Box>(packing.domain);
    for (std::size_t k = 0; k < 3; ++k) {
      double lower = 1e300, upper = -1e300;
      for (std::size_t i = 0; i < packing.spheres.size(); ++i) {
        lower = std::min(lower, packing.spheres.x[k][i] - packing.spheres.r[i]);
        upper = std::max(upper, packing.spheres.x[k][i] + packing.spheres.r[i]);
      }
      const int axis = static_cast<int>(k);
      const double rounding = 1e-15 * (std::abs(lower) + std::abs(upper));
      EXPECT_NEAR(box.corner[axis], lower, rounding);
      EXPECT_NEAR(box.corner[axis] + box.size[axis], upper, rounding);
    }
  }
}

TEST(ImportDomain, ABoxIsPeriodicUnlessItIsSaid) {
  const std::string text = "# unit: mm\nx,y,z,r\n1,1,1,0.5\n-0.25,9,4,0.5\n";
  const ImportedPacking whole = imported(text, {.box = {4, 4, 4}});
  EXPECT_FALSE(has_walls(whole.packing.domain));
  EXPECT_EQ(whole.packing.spheres.x, (std::vector<std::vector<double>>{{1, 3.75}, {1, 1}, {1, 0}}));
  EXPECT_NE(note_of(whole, "wrapped").find("1 of 2"), std::string::npos);
  const Packing slab = packing_of(text, {.box = {4, 10, 5}, .periodic = "x"});
  EXPECT_EQ(std::get<Box>(slab.domain).periodic, (std::vector<bool>{true, false, false}));
  EXPECT_EQ(slab.spheres.x[0][1], 3.75);
  const Packing walls = packing_of(text, {.box = {4, 10, 5}, .periodic = "none"});
  EXPECT_FALSE(is_periodic(walls.domain));
  EXPECT_EQ(walls.spheres.x[0][1], -0.25);
  const Packing moved = packing_of(text, {.box = {4, 10, 5}, .periodic = "none", .shift = {1, 0, -0.5}});
  EXPECT_EQ(moved.spheres.x, (std::vector<std::vector<double>>{{2, 0.75}, {1, 9}, {0.5, 3.5}}));
}

// Along an axis that a simulator shrinks around its centres, the file's bounds are no walls.
TEST(ImportDomain, ShrunkenBoundsAreThoseOfTheSpheres) {
  const std::string dump =
      "ITEM: UNITS\nsi\nITEM: TIMESTEP\n1\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp ff ss\n2 6\n0 8\n1 "
      "3\n"
      "ITEM: ATOMS id x y z radius\n1 2.5 1 1 0.5\n2 5.5 7 3 0.5\n";
  const ImportedPacking made = imported(dump);
  const Box& box = std::get<Box>(made.packing.domain);
  EXPECT_EQ(box.periodic, (std::vector<bool>{true, false, false}));
  EXPECT_EQ(box.size[0], 4);
  EXPECT_EQ(box.size[1], 8);
  EXPECT_NEAR(box.size[2], 3, 1e-14);
  EXPECT_EQ(made.packing.spheres.x[0], (std::vector<double>{0.5, 3.5}));  // the corner is at zero
  EXPECT_NE(note_of(made, "domain").find("along z the bounds of the spheres"), std::string::npos);
  EXPECT_NE(note_of(made, "moved").find("-2, 0, -0.5"), std::string::npos) << note_of(made, "moved");
  EXPECT_TRUE(certify(made.packing.spheres, made.packing.domain).certified);
}

// Of a scene whose container is a CAD part, in another unit than the file.
TEST(ImportDomain, ASceneGivesItsPart) {
  const Folder folder;
  folder.write("part.off", test::as_off(test::box_mesh({0, 0, 0}, {10, 20, 30})));
  const auto scene = folder.write("s.toml",
                                  "unit = \"mm\"\n[container]\nkind = \"mesh\"\nfile = \"part.off\"\n"
                                  "[spheres]\nradius = 1\ncount = 2\n");
  const auto table = folder.write("a.csv", "# unit: cm\nx,y,z,r\n0.5,0.5,0.5,0.1\n0.5,1.5,2.95,0.1\n");
  const Packing packing = import_packing(table, {.container = read_scene(scene)}).packing;
  EXPECT_EQ(packing.scene.unit, Unit::mm);
  EXPECT_NEAR(packing.volume, 6000, 1e-9);
  const auto& part = std::get<MeshFile>(packing.scene.container);
  EXPECT_EQ(part.sha256.size(), 1U);  // certified against this very file
  const Certificate certificate = certify(packing.spheres, packing.domain, {.list = 10});
  ASSERT_EQ(certificate.protrusions.size(), 1U);
  EXPECT_EQ(certificate.protrusions[0].sphere, 1U);
  EXPECT_NEAR(certificate.protrusions[0].gap, -0.5, 1e-12);
  const WrittenPacking written = write_imported(packing, table, folder / "out", {.with_mesh = true});
  EXPECT_EQ(written.certificate.protruding_spheres, 1U);
}

TEST(ImportDomain, SpheresManyTimesTheBoxAreAMistakeOfUnits) {
  const std::string text = "# unit: mm\nx,y,z,r\n1,1,1,0.5\n";
  EXPECT_NO_THROW(
      packing_of(text, {.box = {0.4, 0.4, 0.4}}));  // overlaps its images, and can be certified not to
  EXPECT_THROW(packing_of(text, {.box = {0.2, 0.2, 0.2}}), Error);
}

}  // namespace import_domain_test
}  // namespace bernal
