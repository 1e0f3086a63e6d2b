#pragma once
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "bernal/cad/read_mesh.hpp"
#include "bernal/core/error.hpp"
#include "cad/read/polygon_soup.hpp"
#include "support/cad_formats.hpp"
#include "support/folder.hpp"
#include "support/meshes.hpp"

// 3MF and AMF made of meshes, and what is read of them.
namespace bernal::test::printed {

using Entries = std::vector<std::pair<std::string, std::string>>;

inline constexpr const char* core = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02";
inline constexpr const char* production = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06";
inline constexpr const char* root = "3D/3dmodel.model";
inline constexpr const char* item_1 = R"(<item objectid="1"/>)";

inline std::string mesh_3mf(const Mesh& mesh, std::string_view p = "", std::string_view behind = "") {
  std::string xml = fmt::format("<{0}mesh><{0}vertices>", p);
  for (const Vector<3>& v : mesh.vertices)
    xml += fmt::format("<{}vertex x=\"{}\" y=\"{}\" z=\"{}\"/>\n", p, v[0], v[1], v[2]);
  xml += fmt::format("</{0}vertices><{0}triangles>", p);
  for (const auto& [i, j, k] : mesh.triangles)
    xml += fmt::format("<{}triangle v1=\"{}\" v2=\"{}\" v3=\"{}\" pid=\"9\"/>\n", p, i, j, k);
  return xml + fmt::format("</{0}triangles>{1}</{0}mesh>", p, behind);
}

inline std::string mesh_amf(const Mesh& mesh, std::string_view volume = "<volume>") {
  std::string xml = "<mesh><vertices>";
  for (const Vector<3>& v : mesh.vertices)
    xml += fmt::format("<vertex><coordinates><x>{}</x><y>{}</y><z>{}</z></coordinates></vertex>\n", v[0],
                       v[1], v[2]);
  xml += fmt::format("</vertices>{}", volume);
  for (const auto& [i, j, k] : mesh.triangles)
    xml += fmt::format("<triangle><v1>{}</v1><v2>{}</v2><v3>{}</v3></triangle>\n", i, j, k);
  return xml + "</volume></mesh>";
}

inline std::string object(int id, std::string_view inside, std::string_view attributes = R"(type="model")") {
  return fmt::format(R"(<object id="{}" {}>{}</object>)", id, attributes, inside);
}

inline std::string model(std::string_view resources, std::string_view build,
                         std::string_view attributes = R"(unit="millimeter")") {
  return fmt::format(
      R"(<?xml version="1.0" encoding="UTF-8"?><model {} xmlns="{}" xmlns:p="{}" xml:lang="en-US">)"
      R"(<metadata name="Title">a &amp; b</metadata><resources>{}</resources><build>{}</build></model>)",
      attributes, core, production, resources, build);
}

/// Puts the sizes and places of an archive's directory into fields of 64 bits, as some libraries always do.
inline std::string in_fields_of_64_bits(const std::string& archive) {
  const auto number = [&](std::size_t at, int bytes) {
    std::uint64_t value = 0;
    for (int k = bytes; k-- > 0;)
      value = value << 8U | static_cast<unsigned char>(archive[at + std::size_t(k)]);
    return value;
  };
  const auto bytes_of = [](std::uint64_t value, int bytes) {
    std::string text;
    for (int k = 0; k < bytes; ++k, value >>= 8U) text += static_cast<char>(value);
    return text;
  };
  const std::size_t end = archive.rfind("PK\x05\x06");
  const std::size_t begin = number(end + 16, 4);
  std::string directory;
  for (std::size_t at = begin; at < end;) {
    const std::size_t name = number(at + 28, 2), extra = number(at + 30, 2);
    const std::string long_numbers = bytes_of(1, 2) + bytes_of(24, 2) + bytes_of(number(at + 24, 4), 8) +
                                     bytes_of(number(at + 20, 4), 8) + bytes_of(number(at + 42, 4), 8);
    std::string entry = archive.substr(at, 46 + name) + long_numbers;
    entry.replace(20, 8, std::string(8, '\xff'));
    entry.replace(42, 4, std::string(4, '\xff'));
    entry.replace(30, 2, bytes_of(long_numbers.size(), 2));
    directory += entry;
    at += 46 + name + extra;
  }
  std::string last = archive.substr(end);
  last.replace(12, 4, bytes_of(directory.size(), 4));
  return archive.substr(0, begin) + directory + last;
}

class PrintedFormats : public ::testing::Test {
 protected:
  static cad::ReadAttempt attempt(const std::filesystem::path& file) {
    return file.extension() == ".3mf" ? cad::read_3mf(file) : cad::read_amf(file);
  }

  /// What stands in the file, in its unit: a volume, so many parts, a box from the lower corner to the upper.
  void expect(std::string_view name, const std::string& bytes, double volume, std::size_t parts,
              const Vector<3>& lower, const Vector<3>& upper) {
    const auto file = folder.write(fmt::format("{}", name), bytes);
    const cad::ReadAttempt read = attempt(file);
    ASSERT_TRUE(read.ok()) << name << ": " << read.failure;
    EXPECT_EQ(std::max<std::size_t>(read.soup.solids.size(), 1), parts) << name;
    double six_fold = 0;
    Bounds<3> box{Vector<3>::Constant(1e300), Vector<3>::Constant(-1e300)};
    for (const auto& t : read.soup.polygons) {
      const Vector<3>&a = read.soup.points[t[0]], &b = read.soup.points[t[1]], &c = read.soup.points[t[2]];
      six_fold += a.dot(b.cross(c));
      for (const Vector<3>& p : {a, b, c})
        box.lower = box.lower.cwiseMin(p), box.upper = box.upper.cwiseMax(p);
    }
    EXPECT_NEAR(six_fold / 6, volume, 1e-9 * volume) << name;
    EXPECT_LT((box.lower - lower).norm() + (box.upper - upper).norm(), 1e-9) << name;
  }
  void expect_cube(std::string_view name, const std::string& bytes) {
    expect(name, bytes, 1000, 1, {0, 0, 0}, {10, 10, 10});
  }
  void expect_model(std::string_view name, const std::string& xml, double volume, std::size_t parts,
                    const Vector<3>& lower, const Vector<3>& upper) {
    expect(name, archived_3mf(xml), volume, parts, lower, upper);
  }

  std::string refusal(std::string_view name, const std::string& bytes) {
    const cad::ReadAttempt read = attempt(folder.write(fmt::format("{}", name), bytes));
    EXPECT_EQ(read.failure.find('\n'), std::string::npos);
    return read.failure;
  }
  std::string refusal_of_model(const std::string& xml) { return refusal("bad.3mf", archived_3mf(xml)); }

  const Mesh cube = box_mesh({0, 0, 0}, {10, 10, 10}), small = box_mesh({0, 0, 0}, {2, 2, 2});
  testing::Folder folder;
};

}  // namespace bernal::test::printed
