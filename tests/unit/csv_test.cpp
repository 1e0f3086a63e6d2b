#include "result/write_csv.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bernal/result/read_packing.hpp"
#include "support/written_files.hpp"

namespace bernal {
namespace csv_test {

using testing::error_of;
using testing::example_in;
using testing::Folder;
using testing::spheres_in;
using testing::text_of;
using testing::written;

TEST(Csv, EveryDoubleComesBackBitForBit) {
  using Limits = std::numeric_limits<double>;
  const std::vector<double> nasty = {0.0,
                                     -0.0,
                                     0.1,
                                     1.0 / 3.0,
                                     -1e300,
                                     1e-300,
                                     Limits::denorm_min(),
                                     -Limits::denorm_min(),
                                     Limits::min(),
                                     std::nextafter(Limits::min(), 0),
                                     Limits::max(),
                                     Limits::lowest(),
                                     9007199254740993.0,
                                     1e22,
                                     1e23,
                                     std::nextafter(1.0, 2),
                                     std::nextafter(1.0, 0),
                                     5e-324,
                                     123456789.123456789};
  Spheres<3> spheres;
  for (std::size_t i = 0; i < nasty.size(); ++i) {
    const double radius = nasty[i] > 0 ? nasty[i] : 1;
    spheres.push_back({nasty[i], nasty[(i + 1) % nasty.size()], nasty[(i + 7) % nasty.size()]}, radius);
  }
  Random random(1, stream(Stream::test));
  while (spheres.size() < 20'000) {  // and any other pattern of bits
    const auto any = [&] { return std::bit_cast<double>(random()); };
    const Vector<3> c(any(), any(), any());
    const double r = std::abs(any());
    if (c.allFinite() && std::isfinite(r) && r > 0) spheres.push_back(c, r);
  }
  const Folder folder;
  const SpheresFile back = read_csv(
      written(folder, "s.csv", [&](OutputFile& file) { write_csv(file, spheres_in(spheres, Unit::um)); }));
  EXPECT_EQ(back.unit, "um");
  ASSERT_EQ(back.spheres.size(), spheres.size());
  const auto bits = [](double v) { return std::bit_cast<std::uint64_t>(v); };
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    for (int k = 0; k < 3; ++k) ASSERT_EQ(bits(back.spheres.x[k][i]), bits(spheres.x[k][i])) << i;
    ASSERT_EQ(bits(back.spheres.r[i]), bits(spheres.r[i])) << i;
  }
}

TEST(Csv, IsTheTextThatTheFormatPromises) {
  const Folder folder;
  Spheres<3> spheres;
  spheres.push_back({0.1, -2, 1e-7}, 0.5);
  EXPECT_EQ(
      text_of(written(folder, "s.csv", [&](OutputFile& file) { write_csv(file, spheres_in(spheres)); })),
      "# unit: mm\nx,y,z,r\n0.1,-2,1e-07,0.5\n");
}

TEST(Csv, ComesBackInEveryDimension) {
  const Folder folder;
  for (int dimension = 1; dimension <= max_dimension; ++dimension) {
    const Spheres<dynamic> spheres = example_in(dimension);
    const auto file = written(folder, std::to_string(dimension) + ".csv",
                              [&](OutputFile& out) { write_csv(out, spheres_in(spheres)); });
    EXPECT_EQ(read_csv(file).spheres, spheres) << dimension;
    EXPECT_TRUE(read_csv(folder.write("empty.csv", csv_header(dimension) + "\n")).spheres.empty());
  }
  EXPECT_EQ(csv_header(1), "x0,r");
  EXPECT_EQ(csv_header(2), "x0,x1,r");
  EXPECT_EQ(csv_header(3), "x,y,z,r");
  EXPECT_EQ(csv_header(5), "x0,x1,x2,x3,x4,r");
}

TEST(Csv, DoesNotCareWhereItsBlocksEnd) {
  // Lines of ever other lengths, in a file that is read in many blocks; the last ones much shorter.
  const Folder folder;
  std::string text = "x0,r\n";
  Spheres<dynamic> spheres(1);
  const auto add = [&](const std::string& x, double value) {
    text += x + ",2\n";
    spheres.push_back(Vector<dynamic>::Constant(1, value), 2);
  };
  for (int i = 0; i < 3000; ++i) add(fmt::format("0.{:0<{}}1e{}", "", i % 1009, i % 1009), 0.1);
  for (int i = 0; i < 3000; ++i)
    add("0." + std::string(static_cast<std::size_t>(i % 1009), '0') + "1e" + std::to_string(i % 1009), 0.1);
  for (int i = 0; i < 300'000; ++i) add("7", 7);
  EXPECT_EQ(read_csv(folder.write("s.csv", text)).spheres, spheres);
}

TEST(Csv, ReadsWhatOthersWrite) {
  const Folder folder;
  const SpheresFile windows =
      read_csv(folder.write("w.csv", "# unit: mm\r\nx,y,z,r\r\n1,2,3,4\r\n-1,0,.5,1e2\r\n"));
  EXPECT_EQ(windows.unit, "mm");
  ASSERT_EQ(windows.spheres.size(), 2u);
  EXPECT_EQ(windows.spheres.center(1), Vector<3>(-1, 0, 0.5));
  EXPECT_EQ(windows.spheres.r[1], 100);

  for (const std::string head :
       {"\xEF\xBB\xBF# unit: m", "#unit: m", "# Unit: m", "# unit : m", "# UNITS:m "}) {
    const SpheresFile read = read_csv(folder.write("u.csv", head + "\nx,y,z,r\n1,2,3,4\n"));
    EXPECT_EQ(read.unit, "m") << head;
    EXPECT_EQ(read.spheres.size(), 1u) << head;
  }

  const SpheresFile plain = read_csv(folder.write("p.csv", "x,y,z,r\n1,2,3,4\n"));
  EXPECT_EQ(plain.unit, "");
  EXPECT_EQ(plain.spheres.size(), 1u);

  EXPECT_TRUE(read_csv(folder.write("e.csv", "# made by hand\n# unit: m\nx,y,z,r\n")).spheres.empty());
}

struct Corrupt {
  std::string text;
  int line;
  std::string says;
};

TEST(Csv, SaysWhereAndWhatIsWrong) {
  const std::string head = "# unit: mm\nx,y,z,r\n";
  const std::vector<Corrupt> cases = {
      {"", 0, "header x,y,z,r is missing"},
      {"# unit: mm\n", 1, "header x,y,z,r is missing"},
      {"# unit: mm", 1, "cut off"},
      {"# unit: parsec\nx,y,z,r\n", 1, "unknown unit \"parsec\"; use one of"},
      {"# unit: m\n#unit: mm\nx,y,z,r\n", 2, "is mm, and one before it says m"},
      {"1,2,3,4\n", 1, "expected the header x,y,z,r (or x0,x1,r and so on), found \"1,2,3,4\""},
      {"x,y,z,radius\n", 1, "found \"x,y,z,radius\""},
      {"x0,x1,x2,r\n1,2,3,4\n", 1, "found \"x0,x1,x2,r\""},
      {"x,y,r\n1,2,3\n", 1, "found \"x,y,r\""},
      {"x0,x1,x2,x3,x4,x5,x6,x7,x8,r\n", 1, "found \"x0,x1,x2,x3,x4,x5,x6,x7,x8,r\""},
      {"r\n1\n", 1, "found \"r\""},
      {"x0,x1,r\n1,2,3,4\n", 2, "4 fields, expected 3: x0,x1,r"},
      {"x0,x1,r\n1,y,3\n", 2, "x1 = \"y\" is not a number"},
      {"\xff\xfex\n", 1, "found \"\\xff\\xfex\""},
      {head + "1,2,3\n", 3, "3 fields, expected 4"},
      {head + "1,2,3,4,5\n", 3, "5 fields, expected 4"},
      {head + "1,2,3,4,\n", 3, "5 fields, expected 4"},
      {head + "1;2;3;4\n", 3, "1 field, expected 4"},
      {head + "\n1,2,3,4\n", 3, "empty line"},
      {head + "1,2,3,4\n\n", 4, "empty line"},
      {head + "1,2,3,4\n1,2,3,4", 4, "cut off"},
      {head + "1,2,3,4\n1,2", 4, "cut off"},
      {head + "1,,3,4\n", 3, "y = \"\" is not a number"},
      {head + "1, 2,3,4\n", 3, "y = \" 2\" is not a number"},
      {head + "1,2,+3,4\n", 3, "z = \"+3\" is not a number"},
      {head + "1,2,3x,4\n", 3, "z = \"3x\" is not a number"},
      {head + "0x1,2,3,4\n", 3, "x = \"0x1\" is not a number"},
      {head + "1,2,3,4 mm\n", 3, "r = \"4 mm\" is not a number"},
      {head + "nan,2,3,4\n", 3, "x = \"nan\" is not finite"},
      {head + "1,-inf,3,4\n", 3, "y = \"-inf\" is not finite"},
      {head + "1,2,1e999,4\n", 3, "z = \"1e999\" is out of the range"},
      {head + "1,2,3,0\n", 3, "radius 0 is not positive"},
      {head + "1,2,3,-0\n", 3, "radius -0 is not positive"},
      {head + "1,2,3,4\n1,2,3,-4\n", 4, "radius -4 is not positive"},
      {head + "1,2,3,nan\n", 3, "r = \"nan\" is not finite"},
      {head + std::string("1,2,3,4\0\n", 9), 3, "r = \"4\\x00\" is not a number"},
      {head + std::string(1000, '7') + "\n", 3, "1 field, expected 4"},
      {head + "1,2,3,4\n" + std::string(1'000'000, '7') + "\n", 4, "too long for a sphere"},
      {head + "1,2,3,4\r5\n", 3, "r = \"4\\x0d5\" is not a number"},
  };
  const Folder folder;
  for (const Corrupt& corrupt : cases) {
    const std::filesystem::path file = folder.write("bad.csv", corrupt.text);
    const Error error = error_of([&] { read_csv(file); });
    EXPECT_EQ(error.code(), ErrorCode::bad_packing) << corrupt.text;
    EXPECT_EQ(error.location().line, corrupt.line) << error.what();
    EXPECT_NE(std::string(error.what()).find(corrupt.says), std::string::npos) << error.what();
    EXPECT_TRUE(std::string(error.what()).starts_with(file.string())) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
  }
}

TEST(Csv, SaysWhyAFileCannotBeRead) {
  const Folder folder;
  EXPECT_NE(std::string(error_of([&] { read_csv(folder / "none.csv"); }).what()).find("No such file"),
            std::string::npos);
  EXPECT_NE(std::string(error_of([&] { read_csv(folder.path()); }).what()).find("it is a folder"),
            std::string::npos);
}

}  // namespace csv_test
}  // namespace bernal
