#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bernal/core/error.hpp"
#include "report/write_image.hpp"
#include "support/polygons.hpp"
#include "support/written_files.hpp"

namespace bernal {
namespace image_files_test {

using testing::Folder;
using testing::text_of;
using testing::written;

/// The number that stands there.
template <class T>
T at(const std::string& bytes, std::size_t place) {
  T value{};
  EXPECT_LE(place + sizeof value, bytes.size());
  if (place + sizeof value <= bytes.size()) std::memcpy(&value, bytes.data() + place, sizeof value);
  return value;
}

template <class Write>
std::string text_that(const Write& write) {
  const Folder folder;
  return text_of(written(folder, "image", write));
}

/// What the image is made of, and its voxels as they are to stand in every file.
struct Example {
  Spheres<dynamic> spheres;
  Domain domain;
  VoxelGrid grid;

  explicit Example(int dimension = 3) : spheres(dimension) {
    if (dimension == 3) {
      domain = Cylinder{{1, 2, -3}, {0, 0, 1}, 1, 2};
      spheres.push_back(Vector<3>(1.2, 2.1, -2), 0.5);
      spheres.push_back(Vector<3>(0.7, 1.8, -1.4), 0.3);
    } else {
      domain = test::triangle();
      spheres.push_back(Vector<2>(4, 3), 1.5);
    }
    grid = voxel_grid(domain, dimension == 3 ? 0.25 : 0.5);
  }
  VoxelImage image(VoxelValues values) const { return {spheres, domain, grid, values, "mm", "made by hand"}; }
  std::string voxels(VoxelValues values) const {
    std::string bytes;
    voxelise(spheres, domain, grid, values, [&](std::string_view layers) { bytes += layers; });
    return bytes;
  }
};

constexpr VoxelValues every_kind[] = {VoxelValues::binary, VoxelValues::labels, VoxelValues::fraction};

TEST(ImageFiles, NrrdReadsBack) {
  for (const int dimension : {2, 3}) {
    const Example example(dimension);
    for (const VoxelValues values : every_kind) {
      const std::string file = text_that([&](OutputFile& out) { write_nrrd(out, example.image(values)); });
      const std::size_t end = file.find("\n\n");
      ASSERT_NE(end, std::string::npos);
      EXPECT_TRUE(file.substr(end + 2) == example.voxels(values));

      std::istringstream lines(file.substr(0, end));
      std::string line;
      std::getline(lines, line);
      EXPECT_EQ(line, "NRRD0004");
      std::map<std::string, std::string> fields;
      while (std::getline(lines, line)) {
        if (line.front() == '#') continue;
        const std::size_t colon = line.find(':');
        ASSERT_NE(colon, std::string::npos) << line;
        fields[line.substr(0, colon)] = line.substr(colon + 2);  // ": " or ":="
      }
      const char* types[] = {"uint8", "uint32", "float"};
      EXPECT_EQ(fields.at("type"), types[static_cast<int>(values)]);
      EXPECT_EQ(fields.count("endian"), values == VoxelValues::binary ? 0u : 1u);
      EXPECT_EQ(fields.at("encoding"), "raw");
      if (dimension == 3) {
        EXPECT_EQ(fields.at("sizes"), "8 8 8");
        EXPECT_EQ(fields.at("space directions"), "(0.25,0,0) (0,0.25,0) (0,0,0.25)");
        EXPECT_EQ(fields.at("space origin"), "(0.125,1.125,-2.875)");  // a voxel's centre
        EXPECT_EQ(fields.at("space units"), "\"mm\" \"mm\" \"mm\"");
        EXPECT_EQ(fields.at("centers"), "cell cell cell");
      } else {
        EXPECT_EQ(fields.at("sizes"), "20 18");
        EXPECT_EQ(fields.at("space directions"), "(0.5,0) (0,0.5)");
        EXPECT_EQ(fields.at("space origin"), "(0.25,0.25)");
        EXPECT_EQ(fields.at("space dimension"), "2");
      }
    }
  }
}

TEST(ImageFiles, VtiReadsBack) {
  for (const int dimension : {2, 3}) {
    const Example example(dimension);
    for (const VoxelValues values : every_kind) {
      const std::string file = text_that([&](OutputFile& out) { write_vti(out, example.image(values)); });
      const auto attribute = [&](const std::string& tag, const std::string& name) {
        const std::size_t from = file.find(" " + name + "=\"", file.find("<" + tag)) + name.size() + 3;
        return file.substr(from, file.find('"', from) - from);
      };
      EXPECT_EQ(attribute("VTKFile", "type"), "ImageData");
      EXPECT_EQ(attribute("VTKFile", "header_type"), "UInt64");
      EXPECT_EQ(attribute("ImageData", "WholeExtent"), dimension == 3 ? "0 8 0 8 0 8" : "0 20 0 18 0 0");
      EXPECT_EQ(attribute("Piece", "Extent"), attribute("ImageData", "WholeExtent"));
      EXPECT_EQ(attribute("ImageData", "Origin"), dimension == 3 ? "0 1 -3" : "0 0 0");
      EXPECT_EQ(attribute("ImageData", "Spacing"), dimension == 3 ? "0.25 0.25 0.25" : "0.5 0.5 0.5");
      const char* types[] = {"UInt8", "UInt32", "Float32"};
      EXPECT_EQ(attribute("DataArray", "type"), types[static_cast<int>(values)]);
      EXPECT_EQ(attribute("CellData", "Scalars"), attribute("DataArray", "Name"));
      EXPECT_EQ(attribute("DataArray", "offset"), "0");
      const std::size_t data = file.find('_', file.find("<AppendedData encoding=\"raw\">")) + 1;
      const auto bytes = at<std::uint64_t>(file, data);
      EXPECT_TRUE(file.substr(data + 8, bytes) == example.voxels(values));
      EXPECT_EQ(file.substr(data + 8 + bytes), "\n  </AppendedData>\n</VTKFile>\n");
    }
  }
}

struct Page {
  std::map<int, std::uint64_t> tags;  // the value, or where it stands
  std::map<int, std::uint64_t> counts;
};

/// The directories of a TIFF or BigTIFF of intel's byte order, as the specification says to walk them.
std::vector<Page> pages_of(const std::string& file) {
  EXPECT_EQ(file.substr(0, 2), "II");
  const int version = at<std::uint16_t>(file, 2);
  const bool big = version == 43;
  EXPECT_TRUE(big || version == 42);
  const auto offset = [&](std::size_t place) -> std::uint64_t {
    return big ? at<std::uint64_t>(file, place) : at<std::uint32_t>(file, place);
  };
  if (big) {
    EXPECT_EQ(at<std::uint16_t>(file, 4), 8);
    EXPECT_EQ(at<std::uint16_t>(file, 6), 0);
  }
  std::vector<Page> pages;
  for (std::uint64_t next = offset(big ? 8 : 4); next != 0 && next < file.size();) {
    EXPECT_EQ(next % 2, 0u);
    const std::uint64_t count = big ? at<std::uint64_t>(file, next) : at<std::uint16_t>(file, next);
    std::size_t entry = next + (big ? 8 : 2);
    Page page;
    int last = 0;
    for (std::uint64_t k = 0; k < count; ++k, entry += big ? 20 : 12) {
      const int tag = at<std::uint16_t>(file, entry), type = at<std::uint16_t>(file, entry + 2);
      EXPECT_GT(tag, last) << "tags ascend";
      last = tag;
      page.counts[tag] = offset(entry + 4);
      const std::size_t value = entry + (big ? 12 : 8);
      page.tags[tag] = type == 3   ? at<std::uint16_t>(file, value)
                       : type == 4 ? at<std::uint32_t>(file, value)
                                   : offset(value);
    }
    pages.push_back(page);
    next = offset(entry);
  }
  return pages;
}

TEST(ImageFiles, TiffReadsBack) {
  for (const int dimension : {2, 3}) {
    const Example example(dimension);
    for (const VoxelValues values : every_kind) {
      const std::string file = text_that([&](OutputFile& out) { write_tiff(out, example.image(values)); });
      EXPECT_EQ(at<std::uint16_t>(file, 2), 42);
      const std::vector<Page> pages = pages_of(file);
      ASSERT_EQ(pages.size(), dimension == 3 ? 8u : 1u);
      std::string voxels;
      for (const Page& page : pages) {
        EXPECT_EQ(page.tags.at(256), dimension == 3 ? 8u : 20u);
        EXPECT_EQ(page.tags.at(257), dimension == 3 ? 8u : 18u);
        EXPECT_EQ(page.tags.at(278), page.tags.at(257));  // one strip
        EXPECT_EQ(page.tags.at(258), values == VoxelValues::binary ? 8u : 32u);
        EXPECT_EQ(page.tags.at(259), 1u);
        EXPECT_EQ(page.tags.at(262), 1u);
        EXPECT_EQ(page.tags.at(277), 1u);
        EXPECT_EQ(page.tags.at(296), 1u);
        EXPECT_EQ(page.tags.at(339), values == VoxelValues::fraction ? 3u : 1u);
        for (const int tag : {282, 283})
          EXPECT_DOUBLE_EQ(static_cast<double>(at<std::uint32_t>(file, page.tags.at(tag))) /
                               at<std::uint32_t>(file, page.tags.at(tag) + 4),
                           dimension == 3 ? 4 : 2);  // pixels a mm
        voxels += file.substr(page.tags.at(273), page.tags.at(279));
      }
      EXPECT_TRUE(voxels == example.voxels(values));
      const std::string text = file.substr(pages[0].tags.at(270), pages[0].counts.at(270));
      EXPECT_EQ(text.back(), '\0');
      EXPECT_TRUE(text.starts_with(dimension == 3
                                       ? "ImageJ=1.53t\nimages=8\nslices=8\nunit=mm\nspacing=0.25\n"
                                       : "ImageJ=1.53t\nimages=1\nslices=1\nunit=mm\nspacing=0.5\n"))
          << text;
    }
  }
}

TEST(ImageFiles, TiffOfFourGigabytesIsABigTiff) {
  const Box cube = periodic_box(Vector<3>(1, 1, 1));
  const Spheres<dynamic> none(3);
  const Domain domain = cube;
  for (const auto& [n, big] : {std::pair{1023, false}, {1024, true}, {2048, true}}) {
    const VoxelImage image{none, domain, voxel_grid_of(domain, n), VoxelValues::labels, "mm", "empty"};
    const std::string file = text_that([&](OutputFile& out) { write_tiff_directories(out, image); });
    EXPECT_EQ(at<std::uint16_t>(file, 2), big ? 43 : 42) << n;
    const std::vector<Page> pages = pages_of(file);
    ASSERT_EQ(pages.size(), static_cast<std::size_t>(n));
    const auto page_bytes = static_cast<std::uint64_t>(4 * n) * static_cast<std::uint64_t>(n);
    for (std::size_t k = 0; k < pages.size(); ++k) {
      ASSERT_EQ(pages[k].tags.at(273), file.size() + k * page_bytes);
      ASSERT_EQ(pages[k].tags.at(279), page_bytes);
    }
    if (!big) continue;
    const std::uint64_t pixels = pages[0].tags.at(282);  // a quotient that stands in the entry itself
    EXPECT_EQ(pixels & 0xFFFFFFFF, static_cast<unsigned>(n) * (pixels >> 32));
  }
}

TEST(ImageFiles, RawHasItsHeader) {
  const Example example;
  for (const VoxelValues values : every_kind) {
    const std::string file = text_that([&](OutputFile& out) { write_raw(out, example.image(values)); });
    EXPECT_TRUE(file == example.voxels(values));
    const auto json = nlohmann::json::parse(raw_header(example.image(values)));
    const char* types[] = {"|u1", "<u4", "<f4"};
    EXPECT_EQ(json.at("dtype"), types[static_cast<int>(values)]);
    EXPECT_EQ(json.at("unit"), "mm");
    EXPECT_EQ(json.at("spacing"), (std::vector{0.25, 0.25, 0.25}));
    EXPECT_EQ(json.at("corner"), (std::vector{0.0, 1.0, -3.0}));
    EXPECT_EQ(json.at("origin"), (std::vector{0.125, 1.125, -2.875}));
  }
  const Example flat(2);
  const auto json = nlohmann::json::parse(raw_header(flat.image(VoxelValues::binary)));
  EXPECT_EQ(json.at("sizes"), (std::vector{20, 18}));
  EXPECT_EQ(json.at("shape"), (std::vector{18, 20}));  // NumPy's axes begin with the slowest
}

// XResolution is a quotient of 32 bits.
TEST(ImageFiles, ATiffHoldsTheEdgeOfAVoxelOrSaysSo) {
  Example of;
  for (const double edge :
       {0.25, 5e-5, 1 / 3.0, 0.0327309403, 7.77e-8, 32730.9403, 1e9, 3.4e-10, 2.9e9, 4e9}) {
    of.grid.spacing = Vector<3>(edge, 0.7 * edge, edge);
    const std::string tiff =
        text_that([&](OutputFile& file) { write_tiff_directories(file, of.image(VoxelValues::binary)); });
    const auto directory = at<std::uint32_t>(tiff, 4);
    ASSERT_EQ(at<std::uint16_t>(tiff, directory), 15) << edge;
    for (std::size_t k = 0; k < 2; ++k) {
      const std::size_t tag = directory + 2 + 12 * (11 + k);
      ASSERT_EQ(at<std::uint16_t>(tiff, tag), 282 + k);
      const auto place = at<std::uint32_t>(tiff, tag + 8);
      const double numerator = at<std::uint32_t>(tiff, place),
                   denominator = at<std::uint32_t>(tiff, place + 4);
      EXPECT_NEAR(denominator / numerator, of.grid.spacing[static_cast<int>(k)],
                  1e-9 * of.grid.spacing[static_cast<int>(k)]);
    }
    EXPECT_TRUE(has_scale_in_tiff(of.grid));
    EXPECT_NE(tiff.find("unit=mm\nspacing="), std::string::npos);
  }
  for (const double edge : {5e-11, 1e-300, 1e10, 1e300}) {
    of.grid.spacing = Vector<3>(edge, 2 * edge, edge);
    const std::string tiff =
        text_that([&](OutputFile& file) { write_tiff_directories(file, of.image(VoxelValues::binary)); });
    EXPECT_FALSE(has_scale_in_tiff(of.grid));
    EXPECT_EQ(at<std::uint16_t>(tiff, at<std::uint32_t>(tiff, 4)), 13);
    EXPECT_EQ(tiff.find("spacing="), std::string::npos);
    EXPECT_NE(tiff.find(fmt::format("voxels of {} x {} x {} mm", edge, 2 * edge, edge)), std::string::npos);
  }
}

}  // namespace image_files_test
}  // namespace bernal
