#include <CGAL/IO/OFF.h>
#include <CGAL/IO/OFF/File_header_OFF.h>
#include <CGAL/IO/PLY.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include <fmt/format.h>

#include "cad/read/caged_reader.hpp"
#include "cad/read/file_facts.hpp"
#include "cad/read/known_formats.hpp"
#include "cad/read/polygon_soup.hpp"

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

/// CGAL casts whatever is in a face of an OFF text to indices, so that 1e300 may become the first vertex, and
/// allocates as many corners as the face claims. So the faces are checked first. Empty if they are good, or
/// if CGAL will report the error itself.
std::string wrong_face_of_off(const std::string& text) {
  std::istringstream in(text);
  CGAL::File_header_OFF header;
  in >> header;
  if (!in || header.binary()) return {};
  const std::size_t vertices = header.size_of_vertices(), lines = vertices + header.size_of_facets();
  std::string line;
  for (std::size_t k = 0; k < lines && std::getline(in, line);) {  // a vertex or face, or only a comment
    const char *at = line.data(), *const end = at + std::min(line.find('#'), line.size());
    const auto skip_blanks = [&] {
      at = std::find_if(at, end, [](char c) { return c != ' ' && c != '\t' && c != '\r'; });
    };
    const auto next_below = [&](std::size_t bound) {
      skip_blanks();
      double number = -1;
      at = std::from_chars(at, end, number).ptr;
      return number >= 0 && number < static_cast<double>(bound) && number == std::floor(number)
                 ? static_cast<std::size_t>(number)
                 : bound;
    };
    skip_blanks();
    if (at == end || k++ < vertices) continue;
    const std::size_t most = line.size(), corners = next_below(most);  // each takes a character and more
    if (corners == most) return "malformed or truncated";
    for (std::size_t i = 0; i < corners; ++i) {
      skip_blanks();
      if (at == end) return "malformed or truncated";
      if (next_below(vertices) == vertices) return "a face names a vertex that does not exist";
    }
  }
  return {};
}

/// CGAL reads the coordinates of a PLY file only as float or double and the corners of its faces only as int
/// or uint, and loops as often as the header says. Returns the error for other types and impossible counts,
/// else empty.
std::string wrong_header_of_ply(const std::string& text) {
  const auto is_one_of = [](const std::string& type, std::initializer_list<std::string_view> known) {
    return std::ranges::find(known, type) != known.end();
  };
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("end_header")) return {};
    std::istringstream words(line);
    std::string word, type, count, name;
    if (!(words >> word >> type)) continue;
    if (word == "element" && words >> count &&
        (count.size() > 15 || std::strtoull(count.c_str(), nullptr, 10) > text.size()))
      return fmt::format("its header promises {} of \"{}\", more than it can hold", count.substr(0, 20),
                         type.substr(0, 20));
    if (word != "property") continue;
    const bool list = type == "list";
    if (list) words >> count >> type;
    words >> name;
    if (list && name.starts_with("vertex_ind") && !is_one_of(type, {"int", "uint", "int32", "uint32"}))
      return fmt::format("its faces give their vertices as {}; write these as int", type);
    if (is_one_of(name, {"x", "y", "z"}) && !is_one_of(type, {"float", "double", "float32", "float64"}))
      return fmt::format("its coordinates are {}; write them as double", type);
  }
  return "its header has no end";
}

}  // namespace

ReadAttempt read_with_cgal(const std::filesystem::path& file) {
  const bool off = extension_of(file) == ".off";
  const std::string text = text_without_mark(file);
  if (std::string wrong = off ? wrong_face_of_off(text) : wrong_header_of_ply(text); !wrong.empty())
    return {.failure = std::move(wrong)};
  ReadAttempt result = read_in_cage("CGAL", cage_limits(text.size()), [&] {
    return attempt([&](Points& points, Polygons& polygons) {
      std::istringstream in(text);
      return off ? CGAL::IO::read_OFF(in, points, polygons) : CGAL::IO::read_PLY(in, points, polygons);
    });
  });
  result.reader = "CGAL, double precision";
  return result;
}

}  // namespace bernal::cad
