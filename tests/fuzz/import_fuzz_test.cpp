// Packings of other programs, in every format that has a reader.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <string>
#include <string_view>

#include "bernal/core/error.hpp"
#include "bernal/formats/import.hpp"
#include "support/export_packings.hpp"
#include "support/folder.hpp"
#include "support/fuzz.hpp"

namespace bernal {
namespace import_fuzz_test {

constexpr std::array<std::string_view, 22> tokens = {"nan",
                                                     "-1",
                                                     "0",
                                                     "1e999",
                                                     "5e-324",
                                                     "99999999999999999999",
                                                     "\n",
                                                     "\r\n",
                                                     ";",
                                                     ",",
                                                     "#",
                                                     "\t",
                                                     "id",
                                                     "xs",
                                                     "Atoms",
                                                     " atoms",
                                                     "ITEM: TIMESTEP\n1\n",
                                                     "xy xz yz",
                                                     "pp",
                                                     "\"",
                                                     "F",
                                                     "\xff\xff\xff\xff"};

/// Whatever the bytes: spheres in a domain, or one line that says what is wrong.
bool is_packing(const std::filesystem::path& file, const ImportOptions& options) {
  try {
    const Packing packing = import_packing(file, options).packing;
    EXPECT_GT(packing.spheres.size(), 0U);
    EXPECT_EQ(packing.spheres.dimension(), dimension_of(packing.domain));
    for (const std::vector<double>& column : packing.spheres.x) {
      EXPECT_EQ(column.size(), packing.spheres.size());
      for (const double x : column) EXPECT_TRUE(std::isfinite(x));
    }
    for (const double r : packing.spheres.r) EXPECT_TRUE(r > 0 && std::isfinite(r));
    EXPECT_TRUE(packing.volume > 0);
    return true;
  } catch (const Error& error) {
    EXPECT_EQ(std::strpbrk(error.what(), "\n\r"), nullptr) << error.what();
    EXPECT_GT(std::strlen(error.what()), 10U);
    return false;
  }
}

Packing small_packing() {
  Packing packing = testing::exports::periodic();
  packing.spheres.resize(5);
  return packing;
}

/// Files of a few spheres in every format that export writes and import reads, and one of each other kind.
std::map<std::string, std::string> valid_files() {
  const Packing packing = small_packing();
  std::map<std::string, std::string> files;
  for (const ImportFormat& format : import_formats()) {
    if (format.name == "table" || format.name == "dump" || format.name == "vtk") continue;
    const testing::Folder folder;
    files[format.name] = testing::text_of(
        write_export(packing, output_of(format.name), folder / ("a." + format.name)).files.front());
  }
  files["table"] =
      "\xEF\xBB\xBF# unit: mm\nid; x [mm]; y [mm]; z [mm]; Diameter [mm]\r\n7;1;2;3;1\r\n8;4;5;6;0.5\r\n";
  files["vtk"] =
      "# vtk DataFile Version 3.0\nbed; lengths in mm\nASCII\nDATASET POLYDATA\nPOINTS 2 float\n1 2 3 4 5 6\n"
      "POINT_DATA 2\nSCALARS radius float 1\nLOOKUP_TABLE default\n0.5 0.25\n";
  files["dump"] =
      "ITEM: UNITS\nsi\nITEM: TIMESTEP\n100\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp ff ss\n-1 7\n0 "
      "8\n0 9\n"
      "ITEM: ATOMS id type y x z diameter\n9 1 5 4 6 0.5\n3 2 2 1 3 1\n";
  return files;
}

TEST(FuzzImport, EveryMutationIsAPackingOrAnError) {
  const testing::Folder folder;
  const std::map<std::string, std::string> valid = valid_files();
  const std::size_t mutations = testing::fuzz_inputs(300);
  for (const auto& [format, text] : valid) {
    SCOPED_TRACE(format);
    // With a unit that most say themselves, and the format told, half of the time.
    ImportOptions some, more{.format = format, .unit = Unit::mm};
    if (format == "esys" || format == "npy") some.unit = Unit::mm;
    if (format == "openmc") some.radius = 0.1;
    more.radius = some.radius;
    if (format == "serpent")  // has the spheres in a file beside
      write_export(small_packing(), output_of(format), folder / ("a." + format));
    const std::filesystem::path file = folder / ("a." + format);
    std::size_t accepted = 0;
    for (std::size_t i = 0; i < mutations; ++i) {
      Random random(1, stream(Stream::test, i));
      std::filesystem::remove(file);  // some file systems wait for the disk where a file is written over
      folder.write("a." + format, testing::mutated(text, tokens, random));
      accepted += is_packing(file, i % 2 ? more : some);
    }
    if (mutations < 300) continue;
    EXPECT_GT(accepted, 0U);
    EXPECT_LT(accepted, mutations);
  }
}

// Of a trajectory or an array every beginning is a packing or an error, and no byte beyond its end is read.
TEST(FuzzImport, EveryBeginningOfABinaryFile) {
  const testing::Folder folder;
  for (const char* format : {"gsd", "npy"}) {
    const std::string text = valid_files().at(format);
    EXPECT_TRUE(is_packing(folder.write("whole", text), {.unit = Unit::mm}));
    for (std::size_t length = 0; length < text.size(); length += 3)
      EXPECT_FALSE(
          is_packing(folder.write("cut", text.substr(0, length)), {.format = format, .unit = Unit::mm}))
          << format << " of " << length;
  }
}

}  // namespace import_fuzz_test
}  // namespace bernal
