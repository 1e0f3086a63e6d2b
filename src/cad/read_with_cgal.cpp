#include <CGAL/IO/OBJ.h>
#include <CGAL/IO/OFF.h>
#include <CGAL/IO/PLY.h>
#include <CGAL/IO/STL.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "cad/polygon_soup.hpp"

namespace bernal::cad {
namespace {

using SoupPoint = CGAL::Simple_cartesian<double>::Point_3;
using Points = std::vector<SoupPoint>;
using Polygons = std::vector<std::vector<std::size_t>>;

template <typename Read>
ReadAttempt attempt(const Read& read) {
  Points points;
  Polygons polygons;
  ReadAttempt result;
  try {
    if (!read(points, polygons)) result.failure = "malformed or truncated";
  } catch (const std::exception& error) {
    result.failure = error.what();
  }
  if (!result.ok()) return result;

  for (const SoupPoint& p : points) {
    result.soup.points.emplace_back(p.x(), p.y(), p.z());
    if (!result.soup.points.back().allFinite()) result.failure = "a coordinate is not finite";
  }
  for (const auto& polygon : polygons) {
    if (polygon.size() < 3) continue;
    if (*std::max_element(polygon.begin(), polygon.end()) >= points.size())
      result.failure = "a face names a vertex that does not exist";
    result.soup.polygons.emplace_back(polygon.begin(), polygon.end());
  }
  return result;
}

}  // namespace

std::string extension_of(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

bool cgal_reads(const std::filesystem::path& file) {
  const std::string extension = extension_of(file);
  return extension == ".off" || extension == ".obj" || extension == ".ply";
}

ReadAttempt read_with_cgal(const std::filesystem::path& file) {
  const std::string extension = extension_of(file);
  return attempt([&](Points& points, Polygons& polygons) {
    std::ifstream in(file, std::ios::binary);
    if (extension == ".off") return CGAL::IO::read_OFF(in, points, polygons);
    if (extension == ".obj") return CGAL::IO::read_OBJ(in, points, polygons);
    return CGAL::IO::read_PLY(in, points, polygons);
  });
}

ReadAttempt read_stl_with_cgal(const std::string& content) {
  return attempt([&](Points& points, Polygons& polygons) {
    std::istringstream in(content);
    return CGAL::IO::read_STL(in, points, polygons);
  });
}

}  // namespace bernal::cad
