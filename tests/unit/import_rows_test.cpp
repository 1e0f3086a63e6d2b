// As many rows and columns as a file says that it has, and none that belongs to nothing.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <tuple>

#include "bernal/formats/import.hpp"
#include "support/foreign_files.hpp"

namespace bernal {
namespace import_rows_test {

using testing::expect_refusal;
using testing::frame_of_dump;
using testing::imported;

// As many spheres as a file claims, and no row left over that might have been one.
TEST(ImportRows, NoRowIsLeftOver) {
  const ImportOptions m{.unit = Unit::m};
  const std::string one = "1 1 1 1 .5\n", two = one + "2 5 5 5 .5\n";
  for (const std::string& rows : {two, two + "3 8 8 8 .5\n", one + "garbage\n", one + "\n2 5 5 5 .5\n"})
    expect_refusal({"a.dump", frame_of_dump(1, rows), m}, {"frame 1", "1 spheres", "NUMBER OF ATOMS"});
  expect_refusal({"a.dump", frame_of_dump(1, two), m}, {"a.dump:11"});
  expect_refusal({"a.dump", frame_of_dump(2, two) + "ITEM: ATOMS id x y z radius\n" + one, m},
                 {"a.dump:12", "second"});
  expect_refusal({"a.dump", "ITEM: UNITS\nsi\nITEM: UNITS\ncgs\n" + frame_of_dump(1, one), {}},
                 {"a.dump:4", "unit"});
  expect_refusal({"a.dump", frame_of_dump(0, one), m}, {"a.dump:10"});
  // In a frame that nobody asked for, since the row may be the next one's.
  expect_refusal({"a.dump", frame_of_dump(1, two) + frame_of_dump(1, one), m}, {"a.dump:11", "frame 1"});
  expect_refusal({"a.dump", frame_of_dump(1, one) + frame_of_dump(2, two + one), m},
                 {"a.dump:22", "frame 2"});
  EXPECT_EQ(imported({"a.dump", frame_of_dump(2, two) + "\n" + frame_of_dump(1, one + "\n \n"), m})
                .packing.spheres.size(),
            1U);

  const auto geometry = [](int claimed, const std::string& rows) {
    return fmt::format(
        "LSMGeometry 1.2\nBoundingBox 0 0 0 9 9 9\nPeriodicBoundaries 0 0 0\nDimension 3D\n"
        "BeginParticles\nSimple\n{}\n{}",
        claimed, rows);
  };
  const std::string first = "1 1 1 .5 4 0\n", both = first + "5 5 5 .5 2 0\n", end = "EndParticles\n";
  expect_refusal({"a.geo", geometry(1, both + end), m}, {"a.geo:9", "1 spheres", "Simple"});
  expect_refusal({"a.geo", geometry(1, both), m}, {"a.geo:9"});
  EXPECT_EQ(imported({"a.geo", geometry(2, both + end), m}).packing.spheres.size(), 2U);
  EXPECT_EQ(imported({"a.geo", geometry(2, both), m}).packing.spheres.size(), 2U);
}

TEST(ImportRows, EveryRowOfADumpBelongsToAnItem) {
  const ImportOptions m{.unit = Unit::m};
  const std::string frame = frame_of_dump(1, "1 1 1 1 0.5\n");
  const auto with = [&](std::string_view before, const std::string& more) {
    std::string text = frame;
    return text.insert(text.find(before), more);
  };
  const auto expect_row = [&](const std::string& text, const char* place) {
    expect_refusal({"a.dump", text, m}, {place, "belongs to no item"});
  };
  expect_row(with("ITEM: NUMBER", "7\n"), "a.dump:3");
  expect_row(with("ITEM: BOX", "2 5 5 5 0.5\n"), "a.dump:5");
  expect_row(with("ITEM: ATOMS", "2 5 5 5 0.5\n"), "a.dump:9");
  expect_row(with("ITEM: NUMBER", "ITEM: TIME\n0.5\n0.6\n"), "a.dump:5");
  expect_row("ITEM: UNITS\nsi\nmetal\n" + frame, "a.dump:3");
  expect_row(with("ITEM: BOX", "# a remark\n"), "a.dump:5");
  expect_row(frame + with("ITEM: BOX", "x\n"), "a.dump:15");
  expect_refusal({"a.dump", with("ITEM: BOX", "x\n") + frame, {.unit = Unit::m, .frame = 2}}, {"a.dump:5"});
  for (const char* item : {"ITEM: LABEL", "ITEM: ENTRIES id f", "ITEM: NUMBER OF ENTRIES",
                           "ITEM: atoms x y z", "ITEM: ATOM", "ITEM: "}) {
    expect_refusal({"a.dump", with("ITEM: BOX", item + std::string("\n2 5 5 5 0.5\n")), m},
                   {"a.dump:5", "no item of a dump"});
    expect_refusal({"a.dump", frame + item + "\n2 5 5 5 0.5\n", m}, {"a.dump:11", "no item of a dump"});
  }
  EXPECT_EQ(imported({"a.dump", "ITEM: UNITS\nsi\n" + with("ITEM: NUMBER", "\nITEM: TIME\n0.5\n\n")})
                .packing.spheres.size(),
            1U);
}

TEST(ImportRows, RowsOfMfixHaveTheColumnsOfTheirVariables) {
  const auto file = [](std::string_view variables, std::string_view row) {
    return fmt::format("Version 2.0\n====\nDimension:    3\nParticles:    1\n====\n{}\n====\n{}\n", variables,
                       row);
  };
  const std::string plain = "Coordinates  T\nPhase_ID  F  1\nDiameter  T\nDensity  F 2500\nVelocity  F 0 0 0";
  const std::string moving =
      "Coordinates  T\nPhase_ID  T\nDiameter  T\nDensity  T\nVelocity  T\nTemperature  F 298";
  const std::string species = plain + "\nSpecies  T";
  for (const auto& [variables, row] :
       {std::pair(plain, "1 1 1 0.5"), {moving, "1 1 1 1 0.5 2500 0 0 0"}, {species, "1 1 1 0.5 0.2 0.8"}})
    EXPECT_EQ(imported({"particle_input.dat", file(variables, row)}).packing.spheres.r,
              (std::vector<double>{0.25}));
  for (const auto& [variables, row, columns] : {std::tuple(plain, "1 1 1 0.5 7", "have 4"),
                                                {plain, "1 1 1", "have 4"},
                                                {moving, "1 1 1 1 0.5 2500 0 0", "have 9"},
                                                {moving, "1 1 1 1 0.5 2500 0 0 0 298", "have 9"},
                                                {species, "1 1 1", "have at least 4"}})
    expect_refusal({"particle_input.dat", file(variables, row)}, {"particle_input.dat:", columns, "x y z"});
}

}  // namespace import_rows_test
}  // namespace bernal
