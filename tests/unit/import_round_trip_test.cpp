// Everything that export writes and that holds spheres comes back by import.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bernal/core/error.hpp"
#include "bernal/formats/import.hpp"
#include "bernal/result/read_packing.hpp"
#include "bernal/scene/read_scene.hpp"
#include "support/export_packings.hpp"
#include "support/exports.hpp"

namespace bernal {
namespace import_round_trip_test {

namespace fs = std::filesystem;
using namespace testing::exports;
using testing::Folder;

/// What a format leaves unsaid, and so has to be told.
ImportOptions told(const ExportFormat& format, const Packing& packing) {
  ImportOptions options;
  const bool flat = packing.spheres.dimension() == 2;
  if (format.name == "esys" || format.name == "npy") options.unit = packing.scene.unit;
  if (format.name == "npy" && flat) options.columns = "x,y,r";
  if ((format.name == "extxyz" || format.name == "liggghts") && flat) options.dimension = 2;
  // Neither has a place for how an axis ends.
  if (format.name == "gsd" || format.name == "liggghts") {
    for (int k = 0; k < packing.spheres.dimension(); ++k)
      if (const auto* box = std::get_if<Box>(&packing.domain); box && box->repeats(k))
        options.periodic += "xyz"[k];
    if (options.periodic.empty()) options.periodic = "none";
  }
  return options;
}

bool keeps_box(const ExportFormat& format, const Packing& packing) {
  for (const char* name : {"lammps", "liggghts", "esys", "extxyz", "gsd", "pfc", "serpent", "scone", "mcnp"})
    if (format.name == name) return true;
  const auto* box = std::get_if<Box>(&packing.domain);
  return format.name == "yade" && box && !box->has_walls();
}

/// Whether it says what container of any kind they lie in.
bool keeps_walls(const ExportFormat& format) {
  return format.name == "serpent" || format.name == "scone" || format.name == "mcnp";
}

bool holds_spheres(const ExportFormat& format, const Packing& packing) {
  return (format.sizes == "diameter" || format.sizes == "radius") &&
         format.least_dimension <= packing.spheres.dimension() &&
         packing.spheres.dimension() <= format.most_dimensions;
}

/// Spheres one by one, to the rounding of the format; periods, where it has any.
void expect_back(const Packing& back, const Packing& packing, const ExportFormat& format) {
  ASSERT_EQ(back.spheres.size(), packing.spheres.size());
  ASSERT_EQ(back.spheres.dimension(), packing.spheres.dimension());
  const std::string unit(name_of(back.scene.unit));
  const bool is_single = format.name == "gsd";
  const double rounding = is_single ? std::numeric_limits<float>::epsilon() : 0;
  if (const auto* cylinder = std::get_if<Cylinder>(&packing.domain); cylinder && keeps_walls(format)) {
    const auto* read = std::get_if<Cylinder>(&back.domain);
    ASSERT_TRUE(read);
    EXPECT_EQ(read->radius, in_unit(cylinder->radius, unit));
    EXPECT_EQ(read->height, in_unit(cylinder->height, unit));
    for (int k = 0; k < 3; ++k) EXPECT_EQ(read->base[k], in_unit(cylinder->base[k], unit));
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t i = 0; i < back.spheres.size(); ++i)
        EXPECT_EQ(back.spheres.x[k][i], in_unit(packing.spheres.x[k][i], unit));
    for (std::size_t i = 0; i < back.spheres.size(); ++i)
      EXPECT_EQ(back.spheres.r[i], in_unit(packing.spheres.r[i], unit));
    return;
  }
  const auto* box = std::get_if<Box>(&back.domain);
  ASSERT_TRUE(box);
  const auto* given = std::get_if<Box>(&packing.domain);
  for (std::size_t k = 0; k < back.spheres.x.size(); ++k) {
    const int axis = static_cast<int>(k);
    const bool repeats = given && given->repeats(axis) && keeps_box(format, packing);
    EXPECT_EQ(box->repeats(axis), repeats) << "axis " << k;
    const double edge = box->size[axis];
    if (repeats) {
      const double period = in_unit(given->size[axis], unit);
      EXPECT_NEAR(edge, period, rounding * period);
      EXPECT_EQ(box->corner[axis], 0);
    }
    // Along walls a box that repeats itself elsewhere begins at zero, and the whole packing is moved there,
    // as is one whose origin is in the middle.
    const double moved = back.spheres.x[k][0] - in_unit(packing.spheres.x[k][0], unit);
    const double shift = repeats || std::abs(moved) < 1e-15 ? 0 : moved;
    const double tolerance =
        shift == 0 && !is_single ? 0 : (rounding + 1e-15) * (edge + 10 * std::abs(shift) + 2);
    for (std::size_t i = 0; i < back.spheres.size(); ++i) {
      double difference = back.spheres.x[k][i] - in_unit(packing.spheres.x[k][i], unit) - shift;
      if (repeats && is_single) difference -= edge * std::round(difference / edge);
      EXPECT_LE(std::abs(difference), tolerance) << i << " axis " << k;
      if (repeats) {
        EXPECT_GE(back.spheres.x[k][i], 0);
        EXPECT_LT(back.spheres.x[k][i], edge);
      }
    }
    const double no_box_shift = box->has_walls() && !box->repeats() && !is_single ? shift : 0;
    EXPECT_EQ(no_box_shift, 0) << "where all axes have walls nothing is moved";
  }
  for (std::size_t i = 0; i < back.spheres.size(); ++i) {
    const double r = in_unit(packing.spheres.r[i], unit);
    EXPECT_NEAR(back.spheres.r[i], r, rounding * r) << i;
  }
}

TEST(ImportRoundTrip, EveryFormatThatHoldsSpheresComesBack) {
  int tried = 0;
  for (const Packing& packing : {periodic(false), between_walls(), in_cylinder(), in_plane()})
    for (const ExportFormat& format : export_formats()) {
      if (!holds_spheres(format, packing)) continue;
      SCOPED_TRACE(format.name + " of a " + name_of(packing.domain));
      const Folder folder;
      const fs::path file = write_export(packing, output_of(format.name), folder / format.file).files.front();
      const ImportedPacking imported = import_packing(file, told(format, packing));
      const std::string as = imported.notes.at(0).text;
      EXPECT_TRUE(as.starts_with(format.name == "liggghts" ? "lammps"
                                 : format.name == "flat"   ? "table"
                                                           : format.name))
          << as;
      EXPECT_EQ(imported.packing.outcome, Outcome::imported);
      expect_back(imported.packing, packing, format);
      ++tried;
    }
  EXPECT_GE(tried, 3 * 11 + 6);
}

// A result of bernal is a file of another program, too: to the bit.
TEST(ImportRoundTrip, AResultComesBackToTheBit) {
  for (const Packing& packing : {periodic(), between_walls(), in_cylinder(), in_plane()}) {
    const Folder folder;
    write_packing(packing, folder / "out");
    const ImportedPacking imported =
        import_packing(folder / "out/spheres.csv", {.container = read_scene(folder / "out/scene.toml")});
    EXPECT_EQ(imported.packing.spheres, packing.spheres);
    EXPECT_EQ(imported.packing.scene.unit, packing.scene.unit);
    EXPECT_EQ(name_of(imported.packing.domain), name_of(packing.domain));
    EXPECT_EQ(imported.packing.volume, packing.volume);
    // The same from what ParaView reads, which says unit and dimension, too.
    const ImportedPacking points =
        import_packing(folder / "out/spheres.vtp", {.container = read_scene(folder / "out/scene.toml")});
    EXPECT_EQ(points.packing.spheres, packing.spheres);
    EXPECT_EQ(import_packing(folder / "out/spheres.vtp").packing.scene.unit, packing.scene.unit);
  }
}

// What is written is a result: it is read, and its scene begins from its own spheres.
TEST(ImportRoundTrip, WhatIsWrittenIsAResultToGoOnFrom) {
  const Folder folder;
  Packing packing = periodic();
  for (double& r : packing.spheres.r) r *= 2;
  const fs::path file = write_export(packing, output_of("extxyz"), folder / "a.xyz").files.front();
  const ImportedPacking imported = import_packing(file);
  const WrittenPacking written = write_imported(imported.packing, file, folder / "out", {.list = 10});
  EXPECT_FALSE(written.certificate.certified);  // they touched before
  EXPECT_EQ(written.certificate.overlaps.size(),
            std::min<std::size_t>(10, written.certificate.overlapping_pairs));
  EXPECT_EQ(written.certificate.overlaps.front().ratio, written.certificate.max_overlap);
  const Packing back = read_packing(folder / "out");
  EXPECT_EQ(back.spheres, packing.spheres);
  ASSERT_TRUE(back.scene.start.file);
  EXPECT_EQ(fs::weakly_canonical(*back.scene.start.file), fs::weakly_canonical(folder / "out/spheres.csv"));
  EXPECT_EQ(back.volume, packing.volume);
  // Again into the same folder, of which the first result must not be what the sizes are held against.
  EXPECT_NO_THROW(write_imported(imported.packing, file, folder / "out"));
  const fs::path own = folder / "out/spheres.csv";
  EXPECT_THROW(write_imported(imported.packing, own, folder / "out"), Error);
}

}  // namespace import_round_trip_test
}  // namespace bernal
