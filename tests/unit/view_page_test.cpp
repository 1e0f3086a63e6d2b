#include "bernal/viewer/view_page.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "bernal/result/write_packing.hpp"
#include "geometry/edges.hpp"
#include "geometry/simplified.hpp"
#include "support/packings.hpp"
#include "support/refusals.hpp"
#include "support/written_files.hpp"
#include "viewer/base64.hpp"
#include "viewer/viewer_data.hpp"
#include "viewer/viewer_files.hpp"

namespace bernal {
namespace view_page_test {

using testing::example;
using testing::Folder;
using testing::packing_of;
using testing::scattered;
using testing::text_of;

/// Base64 by the letter: another way than `base64_of`.
template <class T>
std::vector<T> decoded(const std::string& text) {
  std::vector<unsigned char> bytes;
  std::uint32_t bits = 0;
  int held = 0;
  for (const char c : text) {
    if (c == '=') break;
    const int digit = c == '+'   ? 62
                      : c == '/' ? 63
                      : c <= '9' ? c - '0' + 52
                      : c <= 'Z' ? c - 'A'
                                 : c - 'a' + 26;
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    if ((held += 6) >= 8) bytes.push_back(static_cast<unsigned char>(bits >> (held -= 8)));
  }
  std::vector<T> numbers;
  for (std::size_t k = 0; k + sizeof(T) <= bytes.size(); k += sizeof(T)) {
    std::array<unsigned char, sizeof(T)> one;
    std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(k), sizeof(T), one.begin());
    numbers.push_back(std::bit_cast<T>(one));
  }
  EXPECT_EQ(numbers.size() * sizeof(T), bytes.size());
  return numbers;
}

/// Of a page.
nlohmann::json data_in(const std::string& page) {
  const std::string open = "<script type=\"application/json\" class=\"bernal-data\">";
  const std::size_t from = page.find(open) + open.size();
  return nlohmann::json::parse(page.substr(from, page.find("</script", from) - from));
}

std::size_t count_of(const std::string& part, const std::string& text) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++n;
  return n;
}

std::vector<float> column(const nlohmann::json& data, const std::string& key) {
  for (const auto& c : data.at("columns")) {
    if (c.at("key") != key) continue;
    const std::string values = c.at("values");
    if (c.at("kind") != "count" && c.at("kind") != "category") return decoded<float>(values);
    const auto counts = decoded<std::uint16_t>(values);
    return {counts.begin(), counts.end()};
  }
  return {};
}

/// Centres and radii as they are in the page, in the scene's lengths, are those of the packing to the single
/// precision of the domain's size.
void expect_same_spheres(const Packing& packing, const nlohmann::json& data) {
  const int dimension = packing.spheres.dimension();
  const auto centers = decoded<float>(data.at("spheres").at("centers"));
  ASSERT_EQ(centers.size(), packing.spheres.size() * static_cast<std::size_t>(dimension));
  const double scale = data.at("scale"), precision = scale * std::numeric_limits<float>::epsilon();
  const auto& radii = data.at("spheres").at("radii");
  const auto each = radii.is_string() ? decoded<float>(radii) : std::vector<float>();
  for (std::size_t i = 0; i < packing.spheres.size(); ++i) {
    for (int k = 0; k < dimension; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      const double origin = data.at("origin").at(axis);
      const double x = centers[i * static_cast<std::size_t>(dimension) + axis] * scale;
      EXPECT_NEAR(x, packing.spheres.x[axis][i] - origin, precision);
    }
    const double r = radii.is_string() ? each.at(i) : radii.get<double>();
    EXPECT_NEAR(r * scale, packing.spheres.r[i], precision * packing.spheres.r[i] / scale);
  }
}

TEST(Base64, IsThatOfTheStandard) {
  for (const auto& [text, expected] :
       std::vector<std::pair<std::string, std::string>>{{"", ""},
                                                        {"f", "Zg=="},
                                                        {"fo", "Zm8="},
                                                        {"foo", "Zm9v"},
                                                        {"foob", "Zm9vYg=="},
                                                        {"fooba", "Zm9vYmE="},
                                                        {"foobar", "Zm9vYmFy"}})  // RFC 4648, section 10
    EXPECT_EQ(base64_of<char>(text), expected);
}

TEST(ViewPage, HasTheSpheresToSinglePrecision) {
  const Packing packing = example(1, 400);
  const auto data = data_in(view_page(packing));
  EXPECT_EQ(data.at("count"), packing.spheres.size());
  EXPECT_EQ(data.at("shown"), packing.spheres.size());
  EXPECT_EQ(data.at("unit"), "mm");
  expect_same_spheres(packing, data);
}

TEST(ViewPage, KeepsItsDigitsFarFromTheOriginAndInAnyUnit) {
  for (const double size : {1e-9, 1.0, 1e9}) {
    for (const double away : {0.0, 1e6}) {
      Packing packing = example(1, 100);
      const Vector<3> shift = Vector<3>(1, -2, 3) * away * size;
      packing.domain = Box{shift, Vector<3>::Constant(10 * size)};
      for (std::size_t i = 0; i < packing.spheres.size(); ++i) {
        packing.spheres.set_center(i, packing.spheres.center(i) * size + shift);
        packing.spheres.r[i] *= size;
      }
      expect_same_spheres(packing, data_in(view_page(packing)));
    }
  }
}

TEST(ViewPage, WritesEqualRadiiOnceAndManyOfAnySize) {
  Packing packing = example(1, 50);
  for (double& r : packing.spheres.r) r = 0.01;
  EXPECT_TRUE(data_in(view_page(packing)).at("spheres").at("radii").is_number());
  packing.spheres.r[7] = 0.00001;
  const auto data = data_in(view_page(packing));
  EXPECT_TRUE(data.at("spheres").at("radii").is_string());
  expect_same_spheres(packing, data);
}

TEST(ViewPage, ManagesWithoutSpheresAndWithOne) {
  Spheres<3> one;
  one.push_back({5, 5, 5}, 1);
  for (const Spheres<3>& spheres : {Spheres<3>{}, one}) {
    const auto data =
        data_in(view_page(packing_of(spheres, Box{Vector<3>::Zero(), Vector<3>::Constant(10)})));
    EXPECT_EQ(data.at("count"), spheres.size());
    EXPECT_EQ(data.at("columns").size(), spheres.empty() ? 0 : 3);
    if (spheres.empty()) continue;
    EXPECT_FALSE(std::isfinite(column(data, "gap").at(0))) << "there is nothing else";
    EXPECT_EQ(column(data, "wall").at(0), 4);
    EXPECT_EQ(column(data, "contacts").at(0), 0);
  }
}

TEST(ViewPage, SaysOfImagesWhatTouches) {
  // A sphere that fills its period touches itself at both ends of every axis; one in a narrower box still
  // does.
  Spheres<3> spheres;
  spheres.push_back({0.25, 0.25, 0.25}, 0.5);
  Packing packing = packing_of(spheres, periodic_box(Vector<3>(1, 1, 1)));
  auto data = data_in(view_page(packing));
  EXPECT_EQ(column(data, "contacts").at(0), 6);
  EXPECT_EQ(column(data, "gap").at(0), 0);
  EXPECT_TRUE(column(data, "wall").empty());
  EXPECT_EQ(data.at("domain").at("walls"), false);
  packing.domain = periodic_box(Vector<3>(2, 2, 1), {true, true, false});
  data = data_in(view_page(packing));
  EXPECT_EQ(column(data, "contacts").at(0), 2);
  EXPECT_EQ(column(data, "wall").at(0), -0.25f);
}

TEST(ViewPage, ShowsDiscsInTheirPlane) {
  Packing packing = example(1);
  packing.domain = periodic_box(Vector<2>(4, 2));
  packing.spheres = Spheres<dynamic>(2);
  packing.spheres.push_back(Vector<2>(1, 1), 0.5);
  packing.spheres.push_back(Vector<2>(2.25, 1), 0.5);
  const auto data = data_in(view_page(packing));
  EXPECT_EQ(data.at("dimension"), 2);
  expect_same_spheres(packing, data);
  EXPECT_EQ(column(data, "gap"), (std::vector<float>{0.25f, 0.25f}));
}

TEST(ViewPage, IsNotThereInOtherDimensions) {
  for (const int dimension : {1, 5}) {
    Packing packing = example(1);
    packing.spheres = Spheres<dynamic>(dimension);
    packing.domain = periodic_box(Vector<dynamic>::Ones(dimension));
    EXPECT_THROW(view_page(packing), Error);
    EXPECT_EQ(view_data(packing, nullptr), "null");
  }
}

TEST(ViewPage, RefusesNumbersThatAreNone) {
  for (const double wrong :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Packing packing = example(1, 5);
    packing.spheres.x[1][3] = wrong;
    EXPECT_THROW(view_page(packing), Error);
    packing = example(1, 5);
    packing.spheres.r[3] = wrong;
    EXPECT_THROW(view_page(packing), Error);
  }
  Packing far = example(1, 5);
  far.spheres.x[0][2] = 1e300;
  for (const float x : decoded<float>(data_in(view_page(far)).at("spheres").at("centers")))
    EXPECT_TRUE(std::isfinite(x));
}

TEST(ViewPage, HasOfVeryManySpheresThoseThatHideTheOthers) {
  const Packing packing = example(1, 600);
  const auto data = data_in(view_page(packing, nullptr, {.most_spheres = 200}));
  EXPECT_EQ(data.at("count"), packing.spheres.size());
  EXPECT_EQ(data.at("shown"), 200);
  const auto indices = decoded<std::uint32_t>(data.at("spheres").at("indices"));
  ASSERT_EQ(indices.size(), 200u);
  std::vector<bool> shown(packing.spheres.size());
  for (const std::uint32_t i : indices) shown.at(i) = true;
  const double deepest = data.at("spheres").at("depth");
  for (std::size_t i = 0; i < packing.spheres.size(); ++i) {
    const Vector<3> c = packing.spheres.center(i);
    const double depth =
        std::min(c.minCoeff(), (Vector<3>::Constant(10) - c).minCoeff()) - packing.spheres.r[i];
    EXPECT_EQ(shown[i], depth < deepest) << i;
  }
  // What is said of one of them counts all of them, the hidden ones too.
  const auto all = data_in(view_page(packing));
  for (const char* key : {"contacts", "gap", "wall"}) {
    const std::vector<float> some = column(data, key), each = column(all, key);
    for (std::size_t k = 0; k < indices.size(); ++k) EXPECT_EQ(some.at(k), each.at(indices[k])) << key;
  }
}

TEST(ViewPage, LetsNothingOutOfItsScripts) {
  Packing packing = example(1, 20);
  const std::string hostile = "</script><script>alert(1)</script>\xe2\x80\xa8\"'`${1}\xff.stl";
  packing.scene.file = hostile;
  packing.scene.container = MeshFile{hostile};
  packing.reason = packing.program.version = hostile;
  const std::string page = view_page(packing);
  EXPECT_TRUE(is_utf8(page));
  EXPECT_EQ(count_of("<script", page), 3u);
  EXPECT_EQ(count_of("</script", page), 3u);
  for (const char* outside : {"<link", "<img", "<iframe", "src=", "href=", "@import", "https:", "http:/"})
    EXPECT_EQ(page.find(outside), page.npos) << outside;
  EXPECT_NE(page.find("default-src 'none'"), page.npos);
}

TEST(ViewPage, IsLightOrDarkAsAsked) {
  const Packing packing = example(1, 5);
  using Theme = ViewOptions::Theme;
  EXPECT_NE(view_page(packing, nullptr, {.theme = Theme::dark}).find("class=\"bernal-page bernal-dark\""),
            std::string::npos);
  EXPECT_NE(view_page(packing, nullptr, {.theme = Theme::light}).find("class=\"bernal-page bernal-light\""),
            std::string::npos);
  EXPECT_NE(view_page(packing).find("class=\"bernal-page\""), std::string::npos);
}

TEST(ViewPage, TakesSomeBytesASphere) {
  const std::size_t few = view_page(example(1, 1)).size();
  const Packing packing = example(1, 600);
  const double each =
      static_cast<double>(view_page(packing).size() - few) / static_cast<double>(packing.spheres.size());
  EXPECT_LT(each, 40);
  EXPECT_LT(few, 80'000u);
}

TEST(ViewPage, ProgramIsWhole) {
  // Every file of the folder is in it, and nothing of what joins modules is left.
  for (const char* part : {"function decode", "class Camera", "class Renderer", "class Panel",
                           "\"sphere.frag\": `#version", "function pick", "start();"})
    EXPECT_NE(viewer_script.find(part), viewer_script.npos) << part;
  for (const char* joint : {"import {", "\nexport "})
    EXPECT_EQ(viewer_script.find(joint), viewer_script.npos);
}

TEST(Report, HasTheViewUnlessItIsLeftOut) {
  const Packing packing = example(1, 30);
  const Folder with, without;
  write_packing(packing, with.path());
  write_packing(packing, without.path(), {.view = false});
  const std::string page = text_of(with / "report.html"), plain = text_of(without / "report.html");
  expect_same_spheres(packing, data_in(page));
  for (const char* part : {"<script", "bernal-view", "bernal-data"})
    EXPECT_EQ(plain.find(part), plain.npos) << part;
  EXPECT_GT(page.size(), plain.size() + viewer_script.size());
  for (const char* file : {"packing.svg", "section.svg"})
    for (const std::string& html : {page, plain})
      EXPECT_NE(html.find(text_of(with / file)), html.npos) << "the still pictures stay";
}

Mesh ball(std::uint32_t rows) {
  Mesh mesh;
  const std::uint32_t around = 2 * rows;
  for (std::uint32_t i = 0; i <= rows; ++i)
    for (std::uint32_t k = 0; k < around; ++k) {
      const double t = std::numbers::pi * i / rows, p = std::numbers::pi * k / rows;
      mesh.vertices.push_back({std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t)});
    }
  const auto corner = [&](std::uint32_t i, std::uint32_t k) {  // the poles have one each
    return i * around + (i == 0 || i == rows ? 0 : k % around);
  };
  for (std::uint32_t i = 0; i < rows; ++i)
    for (std::uint32_t k = 0; k < around; ++k) {
      const std::uint32_t a = corner(i, k), b = corner(i, k + 1), c = corner(i + 1, k),
                          d = corner(i + 1, k + 1);
      if (a != b) mesh.triangles.push_back({a, c, b});
      if (c != d) mesh.triangles.push_back({b, c, d});
    }
  return mesh;
}

TEST(Simplified, IsSmallerAndLooksTheSame) {
  const Mesh mesh = ball(200), coarse = simplified(mesh, 5000);
  ASSERT_GT(mesh.triangles.size(), 100'000u);
  EXPECT_LE(coarse.triangles.size(), 5000u);
  EXPECT_GT(coarse.triangles.size(), 1000u);
  for (const Vector<3>& v : coarse.vertices) EXPECT_NEAR(v.norm(), 1, 0.01);
  EXPECT_NEAR(area_of(coarse), area_of(mesh), 0.03 * area_of(mesh));
  EXPECT_EQ(simplified(mesh, mesh.triangles.size()).triangles, mesh.triangles);
}

TEST(SharpEdges, AreThoseThatBend) {
  Mesh box;
  for (int corner = 0; corner < 8; ++corner)
    box.vertices.push_back(Vector<3>(corner & 1, corner >> 1 & 1, corner >> 2));
  box.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                   {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  const auto edges = sharp_edges(box, 100);
  EXPECT_EQ(edges.size(), 12u) << "no diagonal of a face";
  for (const auto& [a, b] : edges) EXPECT_NEAR((box.vertices[b] - box.vertices[a]).norm(), 1, 1e-15);
  EXPECT_EQ(sharp_edges(box, 5).size(), 5u);
  EXPECT_EQ(sharp_edges(ball(60), 100).size(), 0u);
}

}  // namespace view_page_test
}  // namespace bernal
