#include "meshes/tetgen.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <string>

#include "bernal/core/error.hpp"
#include "core/disjoint_sets.hpp"
#include "files/input_file.hpp"
#include "files/next_line.hpp"
#include "files/output_file.hpp"
#include "geometry/edges.hpp"
#include "meshes/mesh_quality.hpp"

namespace bernal {
namespace {

/// Numbers as text, which are kept until there are many of them.
class NumberFile {
 public:
  explicit NumberFile(const std::filesystem::path& path) : file_(path) {}
  template <class T>
  void add(T value, char after) {
    std::array<char, 32> digits;
    text_.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr);
    text_ += after;
    if (text_.size() < most) return;
    file_.append(text_);
    text_.clear();
  }
  void close() {
    file_.append(text_);
    file_.close();
  }

 private:
  static constexpr std::size_t most = 1 << 16;
  OutputFile file_;
  std::string text_;
};

[[noreturn]] void refuse(const std::string& why, const std::filesystem::path& file) {
  throw Error(ErrorCode::bad_mesh, why, {file.string()});
}

/// The rows of a file of TetGen's: numbers between blanks, comments after #.
class Rows {
 public:
  explicit Rows(const std::filesystem::path& path) : path_(path), in_(path) {}
  /// The next row with numbers in it, as a place to take them from.
  void next() {
    do {
      if (next_line(in_, line_) != NextLine::read) refuse("TetGen's file ends too early", path_);
      at_ = line_.data();
      skip_blanks();
    } while (at_ == line_.data() + line_.size() || *at_ == '#');
  }
  template <class T>
  T number() {
    skip_blanks();
    T value{};
    const auto [after, wrong] = std::from_chars(at_, line_.data() + line_.size(), value);
    if (wrong != std::errc{}) refuse("TetGen's file has something else than a number", path_);
    at_ = after;
    return value;
  }

 private:
  void skip_blanks() {
    while (at_ != line_.data() + line_.size() && (*at_ == ' ' || *at_ == '\t' || *at_ == '\r')) ++at_;
  }
  std::filesystem::path path_;
  InputFile in_;
  std::string line_;
  const char* at_ = nullptr;
};

void read_vertices(const ConformingSurface& surface, const std::filesystem::path& file, VolumeMesh& mesh) {
  constexpr double digits = 1e-12;  // it writes sixteen
  Rows rows(file);
  rows.next();
  const auto count = rows.number<std::size_t>();
  if (count < surface.vertices.size()) refuse("TetGen lost vertices of the surface", file);
  mesh.vertices.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    rows.next();
    rows.number<std::size_t>();
    Vector<3> place;
    for (int k = 0; k < 3; ++k) place[k] = rows.number<double>();
    if (i < surface.vertices.size()) {
      const Vector<3>& wanted = surface.vertices[i];
      if ((place - wanted).cwiseAbs().maxCoeff() > digits * wanted.cwiseAbs().maxCoeff())
        refuse("TetGen moved a vertex of the surface", file);
      place = wanted;
    }
    mesh.vertices.push_back(place);
  }
}

void read_tetrahedra(const std::filesystem::path& file, VolumeMesh& mesh) {
  Rows rows(file);
  rows.next();
  const auto count = rows.number<std::size_t>();
  rows.number<int>();
  const bool has_parts = rows.number<int>() > 0;
  mesh.tetrahedra.reserve(count);
  mesh.region.reserve(count);
  double turned = 0;  // all are turned alike, by exact arithmetic; doubles do not tell that of flat ones
  for (std::size_t t = 0; t < count; ++t) {
    rows.next();
    rows.number<std::size_t>();
    TetrahedronCorners c{};
    for (std::uint32_t& corner : c) {
      corner = rows.number<std::uint32_t>();
      if (corner >= mesh.vertices.size()) refuse("TetGen names a vertex that it did not write", file);
    }
    turned += sicn(mesh.vertices[c[0]], mesh.vertices[c[1]], mesh.vertices[c[2]], mesh.vertices[c[3]]);
    const double part = has_parts ? rows.number<double>() : 0;
    if (!(part >= 0 && part <= static_cast<double>(count))) refuse("TetGen's parts have no numbers", file);
    mesh.tetrahedra.push_back(c);
    mesh.region.push_back(static_cast<std::uint32_t>(part));
  }
  if (turned < 0)
    for (TetrahedronCorners& c : mesh.tetrahedra) std::swap(c[2], c[3]);
}

/// Whether a triangle is of a wall that stands around something in the domain, as obstacles do: what hangs
/// together of it encloses a negative volume, the feet of bridges left out.
std::vector<std::uint8_t> walls_around_something(const ConformingSurface& surface) {
  const auto is_wall = [&](std::size_t t) {
    return surface.patches[surface.patch[t]].kind == SurfacePatch::Kind::wall;
  };
  DisjointSets walls(surface.vertices.size());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    if (is_wall(t))
      for (const std::size_t k : {1, 2}) walls.unite(surface.triangles[t][0], surface.triangles[t][k]);
  struct Wall {
    Bounds<3> bounds = Bounds<3>::of_nothing();
    double six_volumes = 0;
  };
  std::map<std::uint32_t, Wall> of;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    if (is_wall(t))
      for (const std::uint32_t c : surface.triangles[t]) of[walls.find(c)].bounds.add(surface.vertices[c]);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    if (!is_wall(t)) continue;
    const FaceCorners& c = surface.triangles[t];
    Wall& wall = of.at(walls.find(c[0]));
    const Vector<3> middle = wall.bounds.center(), a = surface.vertices[c[0]] - middle;
    wall.six_volumes += a.dot((surface.vertices[c[1]] - middle).cross(surface.vertices[c[2]] - middle));
  }
  std::vector<std::uint8_t> around(surface.triangles.size(), 0);
  for (std::size_t t = 0; t < around.size(); ++t)
    around[t] = is_wall(t) && of.at(walls.find(surface.triangles[t][0])).six_volumes < 0;
  return around;
}

}  // namespace

void write_for_tetgen(const ConformingSurface& surface, const std::vector<Vector<3>>& holes,
                      const std::filesystem::path& folder) {
  const auto add_place = [](NumberFile& file, const Vector<3>& p, char after) {
    file.add(p[0], ' ');
    file.add(p[1], ' ');
    file.add(p[2], after);
  };
  NumberFile nodes(folder / "packing.node");
  nodes.add(surface.vertices.size(), ' ');
  for (const int count : {3, 0}) nodes.add(count, ' ');
  nodes.add(0, '\n');
  for (std::size_t i = 0; i < surface.vertices.size(); ++i) {
    nodes.add(i, ' ');
    add_place(nodes, surface.vertices[i], '\n');
  }
  nodes.close();
  NumberFile faces(folder / "packing.smesh");
  for (const int count : {0, 3, 0}) faces.add(count, ' ');
  faces.add(0, '\n');
  faces.add(surface.triangles.size(), ' ');
  faces.add(0, '\n');
  for (const FaceCorners& triangle : surface.triangles) {
    faces.add(3, ' ');
    for (std::size_t k = 0; k < 3; ++k) faces.add(triangle[k], k == 2 ? '\n' : ' ');
  }
  faces.add(holes.size(), '\n');
  for (std::size_t i = 0; i < holes.size(); ++i) {
    faces.add(i, ' ');
    add_place(faces, holes[i], '\n');
  }
  faces.add(0, '\n');
  faces.close();
}

std::vector<Vector<3>> points_of_holes(const ConformingSurface& surface) {
  constexpr double into = 0.02;  // of an edge
  const std::vector<std::uint8_t> around_something = walls_around_something(surface);
  const auto is_hole = [&](std::size_t t) {
    const SurfacePatch& patch = surface.patches[surface.patch[t]];
    if (patch.kind == SurfacePatch::Kind::wall) return around_something[t] != 0;
    return patch.kind != SurfacePatch::Kind::period_end &&
           std::ranges::find(patch.regions, SurfacePatch::nothing) != patch.regions.end();
  };
  DisjointSets parts(surface.vertices.size());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    if (is_hole(t))
      for (const std::size_t k : {1, 2}) parts.unite(surface.triangles[t][0], surface.triangles[t][k]);
  std::vector<std::uint8_t> has_open_edge(surface.triangles.size(), 0);
  for (const EdgeUse& use : open_edges(surface.triangles)) has_open_edge[use.triangle] = 1;
  struct Largest {
    bool is_open = false;
    double area = 0;
    Vector<3> point = Vector<3>::Zero();
  };
  std::map<std::uint32_t, Largest> of_part;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    if (!is_hole(t)) continue;
    const FaceCorners& c = surface.triangles[t];
    const Vector<3>&a = surface.vertices[c[0]], &b = surface.vertices[c[1]], &d = surface.vertices[c[2]];
    const Vector<3> normal = (b - a).cross(d - a);
    const double area = normal.norm();
    Largest& largest = of_part[parts.find(c[0])];
    largest.is_open |= has_open_edge[t] != 0;
    if (area <= largest.area) continue;
    const bool is_behind = surface.patches[surface.patch[t]].regions[0] == SurfacePatch::nothing;
    const double far = into * std::sqrt(area);
    largest.area = area;
    largest.point = (a + b + d) / 3 + (is_behind ? -far : far) * (normal / area);
  }
  std::vector<Vector<3>> points;
  for (const auto& [part, largest] : of_part)
    if (!largest.is_open) points.push_back(largest.point);
  return points;
}

VolumeMesh read_from_tetgen(const ConformingSurface& surface, const std::filesystem::path& folder) {
  VolumeMesh mesh;
  mesh.triangles = surface.triangles;
  mesh.patch = surface.patch;
  mesh.patches = surface.patches;
  mesh.regions = surface.regions;
  mesh.periodic = surface.periodic;
  read_vertices(surface, folder / "packing.1.node", mesh);
  read_tetrahedra(folder / "packing.1.ele", mesh);
  if (mesh.tetrahedra.empty()) refuse("TetGen made no tetrahedra", folder / "packing.1.ele");
  return mesh;
}

}  // namespace bernal
