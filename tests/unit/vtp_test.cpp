#include "result/write_vtp.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "support/written_files.hpp"

namespace bernal {
namespace vtp_test {

using testing::example_box;
using testing::example_in;
using testing::Folder;
using testing::scattered;
using testing::text_of;
using testing::written;

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
    const Spheres<3> spheres = scattered(n, 0.1, 0.8, bounds_of(example_box), 5);
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

TEST(Vtp, HasTheCoordinationOfEverySphere) {
  const Folder folder;
  const Spheres<3> spheres = scattered(20, 0.1, 0.8, bounds_of(example_box), 5);
  std::vector<std::uint32_t> contacts;
  for (std::uint32_t i = 0; i < spheres.size(); ++i) contacts.push_back(i % 5);
  const std::string vtp =
      text_of(written(folder, "s.vtp", [&](OutputFile& file) { write_vtp(file, spheres, "mm", contacts); }));
  EXPECT_EQ(appended<std::int64_t>(vtp, "coordination", "Int64"),
            std::vector<std::int64_t>(contacts.begin(), contacts.end()));
  EXPECT_EQ(appended<double>(vtp, "radius", "Float64"), spheres.r);
  EXPECT_EQ(appended<std::int64_t>(vtp, "offsets", "Int64").back(), 20);
}

TEST(Vtp, OfContactsIsALineBetweenTheCentres) {
  const Folder folder;
  Spheres<3> spheres;
  spheres.push_back({1, 2, 2}, 1);
  spheres.push_back({2.5, 2, 2}, 0.5);
  const ContactList contacts = contact_list(spheres, Box{Vector<3>::Zero(), Vector<3>(6, 6, 6)});
  ASSERT_EQ(contacts.size(), 2u);  // with the wall x = 0, and with each other
  const std::string vtp = text_of(
      written(folder, "c.vtp", [&](OutputFile& file) { write_contacts_vtp(file, contacts, spheres, "mm"); }));
  EXPECT_EQ(appended<double>(vtp, "Points", "Float64"),
            (std::vector<double>{1, 2, 2, 0, 2, 2, 1, 2, 2, 2.5, 2, 2}));
  EXPECT_EQ(appended<std::int64_t>(vtp, "j", "Int64"), (std::vector<std::int64_t>{-1, 1}));
  EXPECT_EQ(appended<double>(vtp, "normal", "Float64"), (std::vector<double>{-1, 0, 0, 1, 0, 0}));
  EXPECT_EQ(appended<std::int64_t>(vtp, "offsets", "Int64"), (std::vector<std::int64_t>{2, 4}));
  EXPECT_TRUE(vtp.ends_with("\n  </AppendedData>\n</VTKFile>\n"));
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

}  // namespace vtp_test
}  // namespace bernal
