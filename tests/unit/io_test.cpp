#include <gtest/gtest.h>
#include <sys/resource.h>

#include <bit>
#include <cmath>
#include <csignal>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/io/certificate_json.hpp"
#include "bernal/io/read_packing.hpp"
#include "bernal/io/write_packing.hpp"
#include "io/output_file.hpp"
#include "io/report.hpp"
#include "io/write_csv.hpp"
#include "io/write_vtp.hpp"
#include "support/folder.hpp"
#include "support/packings.hpp"

namespace bernal {
namespace {

namespace fs = std::filesystem;
using testing::Folder;
using testing::packing_of;
using testing::scattered;
using testing::text_of;

const BoxShape box{Vector<3>::Zero(), Vector<3>::Constant(10)};

Packing example(std::uint64_t seed = 1, std::size_t n = 300) {
  return packing_of(scattered(n, 0.1, 0.8, bounds_of(box), seed), box);
}

/// The error that `call` throws, or a failed test.
template <class Call>
Error error_of(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << "no error";
  return {ErrorCode::bad_argument, "none"};
}

template <class Write>
fs::path written(const Folder& folder, const std::string& name, const Write& write) {
  OutputFile file(folder / name);
  write(file);
  file.close();
  return folder / name;
}

std::set<std::string> names_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename());
  return names;
}

const std::set<std::string> all_files = {"packing.svg", "report.html", "report.json",
                                         "scene.toml",  "spheres.csv", "spheres.vtp"};

std::vector<std::string> texts_of(const fs::path& folder) {
  std::vector<std::string> texts;
  for (const std::string& name : all_files) texts.push_back(text_of(folder / name));
  return texts;
}

// ---- spheres.csv

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
  const SpheresFile back =
      read_csv(written(folder, "s.csv", [&](OutputFile& file) { write_csv(file, spheres, "um"); }));
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
  EXPECT_EQ(text_of(written(folder, "s.csv", [&](OutputFile& file) { write_csv(file, spheres, "mm"); })),
            "# unit: mm\nx,y,z,r\n0.1,-2,1e-07,0.5\n");
}

/// Some spheres of any dimension.
Spheres<dynamic> example_in(int dimension, std::size_t n = 50) {
  Random random(1, stream(Stream::test));
  Spheres<dynamic> spheres(dimension);
  for (std::size_t i = 0; i < n; ++i) {
    Vector<dynamic> c(dimension);
    for (double& x : c) x = random.uniform(-1, 1);
    spheres.push_back(c, random.uniform(0.1, 1));
  }
  return spheres;
}

TEST(Csv, ComesBackInEveryDimension) {
  const Folder folder;
  for (int dimension = 1; dimension <= max_dimension; ++dimension) {
    const Spheres<dynamic> spheres = example_in(dimension);
    const auto file = written(folder, std::to_string(dimension) + ".csv",
                              [&](OutputFile& out) { write_csv(out, spheres, "mm"); });
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
      {head + "1;2;3;4\n", 3, "1 fields, expected 4"},
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
      {head + std::string(1000, '7') + "\n", 3, "1 fields, expected 4"},
      {head + "1,2,3,4\n" + std::string(1'000'000, '7') + "\n", 4, "1 fields, expected 4"},
      {head + "1,2,3,4\r5\n", 3, "r = \"4\\x0d5\" is not a number"},
  };
  const Folder folder;
  for (const Corrupt& corrupt : cases) {
    const fs::path file = folder.write("bad.csv", corrupt.text);
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

// ---- spheres.vtp

/// The value of `name="…"` in the first tag after `from` that mentions it.
std::string attribute(const std::string& xml, std::size_t from, const std::string& name) {
  const std::size_t start = xml.find(" " + name + "=\"", from) + name.size() + 3;
  return xml.substr(start, xml.find('"', start) - start);
}

/// The appended block of the data array called `name`, checked against what its tag says.
template <class T>
std::vector<T> appended(const std::string& vtp, const std::string& name, const std::string& type) {
  const std::size_t tag = vtp.rfind("<DataArray", vtp.find("Name=\"" + name + "\""));
  EXPECT_EQ(attribute(vtp, tag, "type"), type);
  EXPECT_EQ(attribute(vtp, tag, "format"), "appended");
  const std::size_t data = vtp.find('_', vtp.find("<AppendedData encoding=\"raw\">")) + 1;
  const std::size_t block = data + std::stoul(attribute(vtp, tag, "offset"));
  std::uint64_t bytes = 0;
  std::memcpy(&bytes, vtp.data() + block, sizeof bytes);
  std::vector<T> values(bytes / sizeof(T));
  EXPECT_LE(block + sizeof bytes + bytes, vtp.size());
  if (!values.empty()) std::memcpy(values.data(), vtp.data() + block + sizeof bytes, bytes);
  return values;
}

TEST(Vtp, ReadsBack) {
  for (const std::size_t n : {std::size_t{0}, std::size_t{1}, std::size_t{217}}) {
    const Spheres<3> spheres = scattered(n, 0.1, 0.8, bounds_of(box), 5);
    ASSERT_EQ(spheres.size(), n);
    const Folder folder;
    const std::string vtp =
        text_of(written(folder, "s.vtp", [&](OutputFile& file) { write_vtp(file, spheres); }));
    EXPECT_EQ(attribute(vtp, vtp.find("<VTKFile"), "header_type"), "UInt64");
    EXPECT_EQ(attribute(vtp, vtp.find("<VTKFile"), "byte_order"), "LittleEndian");
    EXPECT_EQ(attribute(vtp, vtp.find("<Piece"), "NumberOfPoints"), std::to_string(n));
    EXPECT_EQ(attribute(vtp, vtp.find("<Piece"), "NumberOfVerts"), std::to_string(n));
    EXPECT_EQ(attribute(vtp, vtp.find("Name=\"Points\""), "NumberOfComponents"), "3");

    EXPECT_EQ(appended<double>(vtp, "radius", "Float64"), spheres.r);
    const auto points = appended<double>(vtp, "Points", "Float64");
    const auto ids = appended<std::int64_t>(vtp, "id", "Int64");
    const auto connectivity = appended<std::int64_t>(vtp, "connectivity", "Int64");
    const auto offsets = appended<std::int64_t>(vtp, "offsets", "Int64");
    ASSERT_EQ(points.size(), 3 * n);
    ASSERT_EQ(ids.size(), n);
    ASSERT_EQ(connectivity.size(), n);
    ASSERT_EQ(offsets.size(), n);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(points[3 * i + k], spheres.x[k][i]);
      EXPECT_EQ(ids[i], static_cast<std::int64_t>(i));
      EXPECT_EQ(connectivity[i], static_cast<std::int64_t>(i));
      EXPECT_EQ(offsets[i], static_cast<std::int64_t>(i + 1));
    }
    // Nothing lies between the last block and the closing tag.
    EXPECT_TRUE(vtp.ends_with("\n  </AppendedData>\n</VTKFile>\n"));
  }
}

TEST(Vtp, HasTheCoordinatesBeyondTheThirdAsPointData) {
  const Folder folder;
  for (int dimension = 1; dimension <= max_dimension; ++dimension) {
    const Spheres<dynamic> spheres = example_in(dimension);
    const std::string vtp = text_of(written(folder, std::to_string(dimension) + ".vtp",
                                            [&](OutputFile& file) { write_vtp(file, spheres); }));
    EXPECT_EQ(appended<double>(vtp, "radius", "Float64"), spheres.r);
    const auto points = appended<double>(vtp, "Points", "Float64");
    ASSERT_EQ(points.size(), 3 * spheres.size());
    for (std::size_t i = 0; i < spheres.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_EQ(points[3 * i + k], k < spheres.x.size() ? spheres.x[k][i] : 0.0);
    for (std::size_t k = 3; k < max_dimension; ++k) {
      const std::string name = fmt::format("x{}", k);
      EXPECT_EQ(vtp.find("Name=\"" + name + "\"") != std::string::npos, k < spheres.x.size());
      if (k < spheres.x.size()) {
        EXPECT_EQ(appended<double>(vtp, name, "Float64"), spheres.x[k]);
      }
    }
    EXPECT_EQ(appended<std::int64_t>(vtp, "offsets", "Int64").size(), spheres.size());
    EXPECT_TRUE(vtp.ends_with("\n  </AppendedData>\n</VTKFile>\n"));
  }
}

// ---- report.json and report.html

TEST(CertificateJson, HasNullWhereThereIsNothing) {
  const auto json = nlohmann::json::parse(certificate_as_json(Certificate{}));
  EXPECT_EQ(json.at("certified"), false);
  EXPECT_TRUE(json.at("worst_pair").is_null());
  EXPECT_TRUE(json.at("worst_wall").is_null());
  EXPECT_TRUE(json.at("min_wall_gap").is_null());

  Certificate own;
  own.worst_pair = {4, 4};
  own.max_overlap = 0.5;
  own.worst_wall = 0;
  own.min_wall_gap = -0.25;
  const auto full = nlohmann::json::parse(certificate_as_json(own));
  EXPECT_EQ(full.at("worst_pair"), (std::vector<int>{4, 4}));
  EXPECT_EQ(full.at("max_overlap"), 0.5);
  EXPECT_EQ(full.at("worst_wall"), 0);
  EXPECT_EQ(full.at("min_wall_gap"), -0.25);
}

TEST(ReportJson, HasEveryKeyOfTheFormatWithTheRightType) {
  const Folder folder;
  Packing packing = example();
  packing.seed = 18446744073709551615u >> 1;
  packing.effects = {{"insertion", 12, 0.25}};
  packing.history = {{"insert", 300, 0.1, 5, 0.2}};
  write_packing(packing, folder.path());
  const auto json = nlohmann::json::parse(text_of(folder / "report.json"));
  for (const char* key : {"phi", "coordination", "max_overlap", "min_wall_gap", "seconds", "contact_gap"}) {
    EXPECT_TRUE(json.at(key).is_number()) << key;
  }
  for (const char* key :
       {"seed", "threads", "n", "dimension", "contacts", "wall_contacts", "rattlers", "peak_memory_bytes"}) {
    EXPECT_TRUE(json.at(key).is_number_unsigned()) << key;
  }
  for (const char* key : {"version", "outcome", "reason", "unit", "hash"}) {
    EXPECT_TRUE(json.at(key).is_string()) << key;
  }
  for (const char* key : {"pairs_tested", "walls_tested", "centers_tested", "decided_double", "decided_exact",
                          "overlapping_pairs", "protruding_spheres", "worst_wall"}) {
    EXPECT_TRUE(json.at("certificate").at(key).is_number_unsigned()) << key;
  }
  EXPECT_TRUE(json.at("certificate").at("statement").is_string());
  EXPECT_TRUE(json.at("certificate").contains("worst_pair"));
  EXPECT_EQ(json.at("certified"), true);
  EXPECT_EQ(json.at("seed"), packing.seed);
  EXPECT_EQ(json.at("n"), packing.spheres.size());
  EXPECT_EQ(json.at("dimension"), 3);
  EXPECT_EQ(json.at("unit"), "mm");
  EXPECT_EQ(json.at("phi"), packing.packing_fraction());
  EXPECT_EQ(json.at("hash"), hash_of(packing.spheres));
  EXPECT_EQ(json.at("container").at("kind"), "box");
  EXPECT_EQ(json.at("container").at("volume"), 1000);
  EXPECT_EQ(json.at("container").at("bounds").at("upper"), (std::vector<double>{10, 10, 10}));
  EXPECT_EQ(json.at("effects").at(0),
            (nlohmann::json{{"name", "insertion"}, {"calls", 12}, {"seconds", 0.25}}));
  EXPECT_EQ(json.at("history").at(0).at("stage"), "insert");
  EXPECT_GT(json.at("peak_memory_bytes"), 1'000'000);
}

TEST(ReportJson, WritesWhatIsNotFiniteAsNullAndNoPairAsNull) {
  const Packing packing = example(1, 1);
  Certificate certificate;
  certificate.min_wall_gap = std::numeric_limits<double>::infinity();
  certificate.max_overlap = std::numeric_limits<double>::quiet_NaN();
  const Measurements measured;
  const auto json = nlohmann::json::parse(json_of(Report{packing, certificate, measured, nullptr, "0"}));
  EXPECT_TRUE(json.at("min_wall_gap").is_null());
  EXPECT_TRUE(json.at("max_overlap").is_null());
  EXPECT_TRUE(json.at("certificate").at("worst_pair").is_null());
  EXPECT_EQ(json.at("certified"), false);
}

TEST(ReportHtml, IsOnePageThatAsksForNothingElse) {
  Packing packing = example();
  packing.reason = "<script>alert(1)</script>";
  packing.effects = {{"a < b", 1, 1}};
  packing.history = {{"insert", 1, 0.1, 5, 0.1}, {"compress", 1, 0.2, 4, 0.2}, {"compress", 1, 0.2, 4, 0.2}};
  const Folder folder;
  write_packing(packing, folder.path());
  const std::string html = text_of(folder / "report.html");
  for (const char* outside : {"<script", "<link", "<img", "<iframe", "src=", "href=", "@import", "https:"}) {
    EXPECT_EQ(html.find(outside), std::string::npos) << outside;
  }
  EXPECT_NE(html.find("a &lt; b"), std::string::npos);
  EXPECT_NE(html.find(text_of(folder / "packing.svg")), std::string::npos);
  EXPECT_EQ(html.find("nan"), std::string::npos);
}

TEST(ReportHtml, ManagesWithoutSpheresWithOneAndWithClasses) {
  Spheres<3> one, two;
  one.push_back({5, 5, 5}, 1);
  two.push_back({2, 2, 2}, 1);
  two.push_back({7, 7, 7}, 2);
  for (const Spheres<3>& spheres : {Spheres<3>{}, one, two}) {
    const Folder folder;
    write_packing(packing_of(spheres, box), folder.path());
    const std::string html = text_of(folder / "report.html");
    EXPECT_NE(html.find("</html>"), std::string::npos);
    EXPECT_EQ(html.find("nan"), std::string::npos);
    EXPECT_EQ(html.find("inf"), std::string::npos);
  }
}

TEST(ReportHtml, DrawsWhatHardlyVaries) {
  // A history that stands still up to rounding and radii that differ in their last bit: axes of no length.
  Packing packing = example();
  for (double& r : packing.spheres.r) r = 0.05;
  for (std::size_t i = 1; i < 30; ++i) packing.spheres.r[i] = std::nextafter(packing.spheres.r[i - 1], 1);
  packing.history = {{"insert", 1, 0.3, 1e9, 0},
                     {"insert", 1, std::nextafter(0.3, 1), 1e9, 0},
                     {"refill", 1, 0.3, std::nextafter(1e9, 0), 0}};
  const Folder folder;
  write_packing(packing, folder.path());
  const std::string html = text_of(folder / "report.html");
  EXPECT_EQ(html.find("nan"), std::string::npos);
  EXPECT_LT(html.size(), 1'000'000u);
}

// ---- All files together

TEST(WritePacking, WritesTheSixFilesIntoAFolderThatItMakes) {
  const Folder folder;
  const fs::path target = folder / "some/where";
  const Packing packing = example();
  const WrittenPacking result = write_packing(packing, target);
  EXPECT_EQ(names_in(target), all_files);
  ASSERT_EQ(result.files.size(), all_files.size());
  EXPECT_EQ(result.files.front(), target / "spheres.csv");
  for (const fs::path& file : result.files) EXPECT_TRUE(fs::is_regular_file(file)) << file;
  EXPECT_TRUE(result.certificate.certified);
  EXPECT_EQ(read_csv(target / "spheres.csv").spheres, packing.spheres);
}

TEST(WritePacking, ReplacesAnEarlierResultAndNothingElse) {
  const Folder folder;
  folder.write("mine.txt", "keep");
  write_packing(example(1), folder.path());
  const Packing second = example(2);
  write_packing(second, folder.path());
  EXPECT_EQ(read_csv(folder / "spheres.csv").spheres, second.spheres);
  EXPECT_EQ(text_of(folder / "mine.txt"), "keep");
  std::set<std::string> expected = all_files;
  expected.insert("mine.txt");
  EXPECT_EQ(names_in(folder.path()), expected);
}

TEST(WritePacking, TheSeedThatWasUsedIsInTheScene) {
  const Folder folder;
  Packing packing = example();
  packing.seed = 77;
  write_packing(packing, folder.path());
  EXPECT_EQ(read_scene(folder / "scene.toml").seed, 77u);
}

TEST(WritePacking, CertifiesWhatIsWrittenAndHidesNothing) {
  Packing packing = example();
  const Vector<3> c = packing.spheres.center(0);
  packing.spheres.push_back(c + Vector<3>(1e-9, 0, 0), packing.spheres.r[0]);
  const Folder folder;
  const WrittenPacking result = write_packing(packing, folder.path());
  EXPECT_FALSE(result.certificate.certified);
  EXPECT_GE(result.certificate.overlapping_pairs, 1u);
  EXPECT_EQ(nlohmann::json::parse(text_of(folder / "report.json")).at("certified"), false);
  EXPECT_NE(text_of(folder / "report.html").find(">no</b>"), std::string::npos);
}

/// While it lives no file may grow beyond `bytes`: what a full disk does to a program, but for the errno.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int);
};

TEST(WritePacking, AFullDiskLeavesEarlierOutputUntouched) {
  const Folder folder;
  write_packing(example(1), folder.path());
  const std::vector<std::string> before = texts_of(folder.path());
  // Whichever file is the one that no longer fits: report.json is the smallest, report.html the largest.
  std::set<std::string> refused;
  for (const rlim_t bytes : {0, 100, 4000, 20'000, 30'000, 45'000, 60'000}) {
    std::string message;
    {
      const FileSizeLimit limit(bytes);
      try {
        write_packing(example(2), folder.path());
      } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::cannot_write);
        message = error.what();
        refused.insert(fs::path(error.location().file).filename());
      }
    }
    if (message.empty()) continue;
    EXPECT_NE(message.find("File too large"), std::string::npos) << message;
    EXPECT_EQ(names_in(folder.path()), all_files) << bytes;
    EXPECT_EQ(texts_of(folder.path()), before) << bytes;
  }
  EXPECT_TRUE(refused.contains("spheres.csv"));
  EXPECT_TRUE(refused.contains("report.html"));
}

TEST(WritePacking, AFailureLeavesNoNewFolderBehind) {
  const Folder folder;
  {
    const FileSizeLimit limit(100);
    error_of([&] { write_packing(example(), folder / "new/deep"); });
  }
  EXPECT_TRUE(names_in(folder.path()).empty());
}

TEST(WritePacking, ARenameThatFailsTakesBackTheOthers) {
  // A folder stands where the last file is to go: everything before it has been renamed by then.
  const Folder folder;
  write_packing(example(1), folder.path());
  fs::remove(folder / "packing.svg");
  fs::remove(folder / "spheres.vtp");
  fs::create_directory(folder / "packing.svg");
  const std::string csv = text_of(folder / "spheres.csv"), json = text_of(folder / "report.json");
  const Error error = error_of([&] { write_packing(example(2), folder.path()); });
  EXPECT_EQ(error.code(), ErrorCode::cannot_write);
  EXPECT_EQ(error.location().file, (folder / "packing.svg").string());
  EXPECT_EQ(text_of(folder / "spheres.csv"), csv);
  EXPECT_EQ(text_of(folder / "report.json"), json);
  EXPECT_EQ(names_in(folder.path()), (std::set<std::string>{"packing.svg", "report.html", "report.json",
                                                            "scene.toml", "spheres.csv"}));
}

TEST(CheckWritable, LeavesNothingBehind) {
  const Folder folder;
  check_writable(folder.path());
  check_writable(folder / "new/deep");
  check_writable(folder / "new/deep/");
  EXPECT_TRUE(names_in(folder.path()).empty());
}

TEST(CheckWritable, SaysWhatIsInTheWay) {
  const Folder folder;
  const fs::path file = folder.write("file", "");
  for (const fs::path& target : {file, file / "below"}) {
    const Error error = error_of([&] { check_writable(target); });
    EXPECT_EQ(error.code(), ErrorCode::cannot_write);
    EXPECT_TRUE(std::string(error.what()).starts_with(folder.path().string())) << error.what();
  }
  EXPECT_EQ(error_of([&] { check_writable("/proc/bernal"); }).code(), ErrorCode::cannot_write);
  EXPECT_EQ(names_in(folder.path()), std::set<std::string>{"file"});
}

}  // namespace
}  // namespace bernal
