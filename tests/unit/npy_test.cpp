#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "bernal/core/error.hpp"
#include "bernal/result/read_packing.hpp"
#include "bernal/result/write_packing.hpp"
#include "files/npy_file.hpp"
#include "files/npy_rows.hpp"
#include "result/write_spheres.hpp"
#include "scene/read_npy_spheres.hpp"
#include "scene/read_spheres.hpp"
#include "support/written_files.hpp"

// Spheres as arrays of NumPy's: what is written is what is read, to the bit; what is none is refused.
namespace bernal {
namespace npy_test {

namespace fs = std::filesystem;
using testing::error_of;
using testing::example;
using testing::example_in;
using testing::Folder;
using testing::spheres_in;
using testing::text_of;

std::string header(const std::string& dictionary, int version = 1) {
  std::string text = dictionary + "\n", lead = "\x93NUMPY";
  lead += {static_cast<char>(version), '\0', static_cast<char>(text.size() & 0xFF),
           static_cast<char>(text.size() >> 8)};
  if (version > 1) lead += std::string(2, '\0');
  return lead + text;
}

std::string described(const std::string& descr, const std::string& order, const std::string& shape) {
  return header("{'descr': " + descr + ", 'fortran_order': " + order + ", 'shape': (" + shape + "), }");
}

/// The numbers as they lie in a file.
template <class Number>
std::string bytes_of(const std::vector<double>& values, bool turned = false) {
  std::string bytes;
  for (const double value : values) {
    const auto number = static_cast<Number>(value);
    char raw[sizeof number];
    std::memcpy(raw, &number, sizeof raw);
    if (turned) std::reverse(raw, raw + sizeof raw);
    bytes.append(raw, sizeof raw);
  }
  return bytes;
}

const std::vector<double> rows = {1, 2, 3, 0.5, 4, 5, 6, 0.25};     // two spheres, row by row
const std::vector<double> columns = {1, 4, 2, 5, 3, 6, 0.5, 0.25};  // the same, column by column

Spheres<dynamic> two() {
  Spheres<dynamic> spheres(3);
  spheres.push_back(Vector<3>(1, 2, 3), 0.5);
  spheres.push_back(Vector<3>(4, 5, 6), 0.25);
  return spheres;
}

Spheres<dynamic> read(const std::string& bytes) {
  const Folder folder;
  return read_npy_spheres(folder.write("s.npy", bytes));
}

TEST(Npy, HoldsEveryDoubleToTheBit) {
  for (const int dimension : {1, 2, 3, 8}) {
    const Folder folder;
    Spheres<dynamic> spheres = example_in(dimension, 20'000);
    spheres.x[0][0] = -0.0;
    spheres.x[0][1] = std::numeric_limits<double>::denorm_min();
    spheres.x[0][2] = std::nextafter(1.0, 2.0);
    spheres.r[3] = std::numeric_limits<double>::max();
    spheres.r[4] = std::numeric_limits<double>::denorm_min();
    write_spheres(folder / "s.npy", spheres_in(spheres), true);
    const Spheres<dynamic> back = read_npy_spheres(folder / "s.npy");
    EXPECT_EQ(back, spheres);
    EXPECT_TRUE(std::signbit(back.x[0][0]));
    EXPECT_NO_THROW(require_written(folder / "s.npy", spheres_in(spheres), true));
    spheres.x[0][0] = 0.0;  // equal, and other bits
    EXPECT_EQ(error_of([&] { require_written(folder / "s.npy", spheres_in(spheres), true); }).code(),
              ErrorCode::cannot_write);
  }
}

TEST(Npy, IsWhatNumPyWrites) {
  const Folder folder;
  write_spheres(folder / "s.npy", spheres_in(two()), true);
  const std::string text = text_of(folder / "s.npy");
  EXPECT_EQ(text.substr(0, 10), std::string("\x93NUMPY\x01\0v\0", 10));
  EXPECT_EQ(text.substr(10, 59), "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 4), }");
  EXPECT_EQ(text.size(), 128 + 64u);
  EXPECT_EQ(text[127], '\n');
  EXPECT_EQ(text.substr(128), bytes_of<double>(rows));
  write_spheres(folder / "none.npy", spheres_in(Spheres<dynamic>(2)), true);
  EXPECT_EQ(read_npy_spheres(folder / "none.npy"), Spheres<dynamic>(2));
}

TEST(Npy, ReadsOtherOrdersAndTypes) {
  EXPECT_EQ(read(described("'<f8'", "False", "2, 4") + bytes_of<double>(rows)), two());
  EXPECT_EQ(read(described("'>f8'", "False", "2, 4") + bytes_of<double>(rows, true)), two());
  EXPECT_EQ(read(described("'<f8'", "True", "2, 4") + bytes_of<double>(columns)), two());
  EXPECT_EQ(read(described("'>f4'", "True", "2, 4") + bytes_of<float>(columns, true)), two());
  EXPECT_EQ(read(described("\"<f4\"", "False", "2L, 4L,") + bytes_of<float>(rows)), two());
  for (const int version : {2, 3})
    EXPECT_EQ(read(header("{'shape': (2, 4), 'fortran_order': False, 'descr': '<f8'}", version) +
                   bytes_of<double>(rows)),
              two());
}

TEST(Npy, ReadsStructuresByTheirNames) {
  const std::string named = "[('x', '<f8'), ('y', '<f8'), ('z', '<f8'), ('r', '<f8')]";
  EXPECT_EQ(read(described(named, "False", "2,") + bytes_of<double>(rows)), two());
  EXPECT_EQ(read(described(named, "True", "2,") + bytes_of<double>(rows)), two());
  const std::string other = "[('Diameter', '>f4'), ('id', '<f8'), ('Z', '<f8'), ('Y', '<f8'), ('X', '<f8')]";
  std::string bytes;
  for (const std::vector<double>& row : {std::vector<double>{1, 3, 2, 1}, {0.5, 6, 5, 4}}) {
    bytes += bytes_of<float>({row[0]}, true) + bytes_of<double>({7});
    bytes += bytes_of<double>({row[1], row[2], row[3]});
  }
  EXPECT_EQ(read(described(other, "False", "2,") + bytes), two());
}

TEST(Npy, RefusesWhatIsNoTableOfSpheresInOneLine) {
  const std::string body = bytes_of<double>(rows);
  const auto refused = [](const std::string& bytes, const std::vector<std::string>& words) {
    const Error error = error_of([&] { read(bytes); });
    EXPECT_EQ(error.code(), ErrorCode::bad_packing);
    const std::string what = error.what();
    EXPECT_EQ(std::ranges::count(what, '\n'), 0) << what;
    for (const std::string& word : words) EXPECT_NE(what.find(word), what.npos) << what;
  };
  refused("", {"cut off"});
  refused("x,y,z,r\n1,2,3,4\n", {"no .npy"});
  refused("\x93NUMPY", {"cut off"});
  refused(std::string("\x93NUMPY\x09\0\x01\0\n", 11), {"version 9"});
  refused(std::string("\x93NUMPY\x02\0\xFF\xFF\xFF\xFF", 12), {"header"});
  refused(std::string("\x93NUMPY\x01\0\xFF\xFF{", 11), {"cut off"});
  refused(described("'<f8'", "False", "2, 4") + body.substr(1), {"cut off", "2 rows"});
  refused(described("'<f8'", "False", "2, 4") + body + "x", {"something else"});
  refused(described("'<f8'", "False", "576460752303423489, 4") + body,
          {"cut off"});  // as many bytes, modulo 2^64
  refused(described("'<f8'", "False", "99999999999999999999, 4") + body, {"not understood"});
  refused(described("'<f8'", "False", "2, -4") + body, {"not understood"});
  refused(described("'<f8'", "False", "8,") + body, {"shape (8)"});
  refused(described("'<f8'", "False", "2, 2, 2") + body, {"shape (2, 2, 2)"});
  refused(described("'<f8'", "False", "") + body.substr(0, 8), {"shape ()"});
  refused(described("'<f8'", "False", "8, 1") + body, {"1 column"});
  refused(described("'<f8'", "False", "1, 10") + body + body.substr(0, 16), {"9 coordinates"});
  refused(described("'<f8'", "False", "0, 1000"), {"1000 columns"});
  refused(described("'<i8'", "False", "2, 4") + body, {"<i8", "float64"});
  refused(described("'|O'", "False", "2, 4") + body, {"|O"});
  refused(described("'<c16'", "False", "2, 2") + body, {"<c16"});
  refused(described("'<f8", "False", "2, 4") + body, {"not understood"});
  refused(described("__import__('os')", "False", "2, 4") + body, {"not understood"});
  refused(described("[('x', '<f8'), ('y', '<f8')]", "False", "4,") + body, {"members"});
  refused(described("[('x', '<f8', (2,)), ('r', '<f8')]", "False", "4,") + body, {"not understood"});
  refused(header("{'descr': '<f8', 'fortran_order': False, 'shape': (2, 4), 'more': 1}") + body,
          {"not understood"});
  refused(header("{'descr': '<f8', 'shape': (2, 4)}") + body, {"not understood"});
  const auto with = [&](std::size_t at, double value) {
    std::vector<double> changed = rows;
    changed[at] = value;
    return described("'<f8'", "False", "2, 4") + bytes_of<double>(changed);
  };
  refused(with(7, 0), {"row 2", "radius 0"});
  refused(with(3, -1), {"row 1", "radius -1"});
  refused(with(5, std::nan("")), {"row 2", "nan"});
  refused(with(3, std::numeric_limits<double>::infinity()), {"row 1", "inf"});
  const Folder folder;
  EXPECT_EQ(error_of([&] { read_npy_spheres(folder.path()); }).code(), ErrorCode::bad_packing);
  EXPECT_EQ(error_of([&] { read_npy_spheres(folder / "missing.npy"); }).code(), ErrorCode::bad_packing);
  EXPECT_FALSE(is_npy_file(folder / "missing.npy"));
}

TEST(Npy, IsReadWhereverATextOfSpheresIs) {
  const Folder folder;
  const fs::path file = folder.write("s.txt", described("'<f8'", "False", "2, 4") + bytes_of<double>(rows));
  std::string seen;
  const NamedColumns found = read_spheres(file, [&](std::string_view bytes) { seen += bytes; });
  EXPECT_EQ(found.spheres, two());
  EXPECT_EQ(found.unit, "");
  EXPECT_EQ(seen, text_of(file));
}

TEST(Npy, ABinaryResultHoldsTheSamePacking) {
  const Folder folder;
  const Packing packing = example();
  const WrittenPacking text = write_packing(packing, folder / "text");
  const WrittenPacking array = write_packing(packing, folder / "array", {.as_array = true});
  EXPECT_EQ(array.files.front(), folder / "array/spheres.npy");
  EXPECT_FALSE(fs::exists(folder / "array/spheres.csv"));
  EXPECT_FALSE(fs::exists(folder / "array/spheres.vtp"));
  EXPECT_EQ(array.certificate.statement, text.certificate.statement);
  EXPECT_EQ(spheres_of_result(folder / "array"), folder / "array/spheres.npy");
  EXPECT_EQ(read_packing(folder / "array").spheres, packing.spheres);
  // One takes the place of the other.
  write_packing(packing, folder / "array");
  EXPECT_FALSE(fs::exists(folder / "array/spheres.npy"));
  EXPECT_EQ(read_packing(folder / "array").spheres, packing.spheres);
  write_packing(packing, folder / "text", {.most_as_text = packing.spheres.size() - 1});
  EXPECT_FALSE(fs::exists(folder / "text/spheres.csv"));
  EXPECT_EQ(read_packing(folder / "text").spheres, packing.spheres);
  write_packing(packing, folder / "text", {.most_as_text = packing.spheres.size()});
  EXPECT_TRUE(fs::exists(folder / "text/spheres.csv"));
}

TEST(Npy, RowsAreReadInAnyOrder) {
  const Folder folder;
  NpyRows array(folder.write("c.npy", described("'<f8'", "False", "2, 4") + bytes_of<double>(rows)));
  ASSERT_EQ(array.rows(), 2u);
  ASSERT_EQ(array.columns(), 4u);
  std::vector<double> last(4), all(8);
  array.read(1, last);
  array.read(0, all);
  EXPECT_EQ(last, std::vector<double>(rows.begin() + 4, rows.end()));
  EXPECT_EQ(all, rows);
  EXPECT_EQ(error_of([&] { array.read(1, all); }).code(), ErrorCode::bad_packing) << "beyond the end";
  // What a row cannot be copied out of.
  for (const std::string& text : {described("'<f8'", "True", "2, 4") + bytes_of<double>(columns),
                                  described("'>f8'", "False", "2, 4") + bytes_of<double>(rows, true),
                                  described("'<f4'", "False", "2, 4") + bytes_of<float>(rows)})
    EXPECT_EQ(error_of([&] { NpyRows(folder.write("other.npy", text)); }).code(), ErrorCode::bad_packing);
}

TEST(Npy, AFileOfTheUsersIsNotReplaced) {
  const Folder folder;
  write_packing(example(), folder.path());
  folder.write("spheres.npy", "mine");
  EXPECT_EQ(error_of([&] { check_writable(folder.path(), example().scene); }).code(),
            ErrorCode::cannot_write);
  EXPECT_EQ(text_of(folder / "spheres.npy"), "mine");
}

}  // namespace npy_test
}  // namespace bernal
