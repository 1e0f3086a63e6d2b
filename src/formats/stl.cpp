#include <Eigen/Geometry>

#include <fmt/format.h>

#include "formats/layered.hpp"
#include "formats/surface_file.hpp"

namespace bernal {
namespace {

struct StlTriangle {
  std::array<float, 3> normal;
  std::array<FloatPoint, 3> corners;
};

std::array<float, 3> normal_of(const FloatPoint& a, const FloatPoint& b, const FloatPoint& c) {
  const auto vector = [](const FloatPoint& p) { return Vector<3>(p[0], p[1], p[2]); };
  Vector<3> normal = (vector(b) - vector(a)).cross(vector(c) - vector(a));
  const double length = normal.norm();
  if (length > 0) normal /= length;
  return {static_cast<float>(normal[0]), static_cast<float>(normal[1]), static_cast<float>(normal[2])};
}

std::string write_stl_file(const Exported& file, StagedFolder& staged) {
  const std::string& layer = file.output.layer;
  const BallsOfLayer of_layer =
      layer.empty() ? BallsOfLayer{file.spheres, file.size()} : balls_of_layer(file, layer);
  const Surfaces surfaces(of_layer.balls, file.domain, file.output.deflection, file.output.surface,
                          file.monitor, {of_layer.outer, true});
  OutputFile out(staged.add(file.output.file.string()));
  write_stl(out, file, surfaces);
  out.close();
  return layer.empty() ? surfaces.note() : fmt::format("the layer {}: {}", layer, surfaces.note());
}

}  // namespace

Surfaces surfaces_of(const Exported& file) {
  return {file.spheres, file.domain, file.output.deflection, file.output.surface, file.monitor};
}

Format surface_format(std::string_view name, std::string_view help, std::string_view file,
                      std::string (*write)(const Exported&, StagedFolder&),
                      const std::vector<std::string_view>& keys) {
  std::vector<std::string_view> all = {"unit", "surface", "deflection", "contact", "contact_gap"};
  all.insert(all.end(), keys.begin(), keys.end());
  return {.name = name,
          .writes = help,
          .keys = std::move(all),
          .file = file,
          .sizes = "triangles",
          .write_with_note = write};
}

void write_stl(OutputFile& out, const Exported& file, const Surfaces& surfaces) {
  // Readers treat a file that begins with "solid" as text.
  std::string header = fmt::format("lengths in {}; {}", name_of(file.unit()), file.title());
  header.resize(80, ' ');
  out.append(header);
  append_bytes(out, static_cast<std::uint32_t>(surfaces.triangles()));
  std::vector<FloatPoint> shared;  // of the container, which comes first
  std::string bytes;
  surfaces.visit([&](const SurfacePart& part) {
    if (!part.sphere) shared.assign(part.vertices.begin(), part.vertices.end());
    const auto corner = [&](std::uint32_t v) {
      return v >= part.first_vertex ? part.vertices[v - part.first_vertex] : shared[v];
    };
    bytes.clear();
    for (const auto& [a, b, c] : part.triangles) {
      StlTriangle triangle{{}, {corner(a), corner(b), corner(c)}};
      triangle.normal = normal_of(triangle.corners[0], triangle.corners[1], triangle.corners[2]);
      bytes.append(reinterpret_cast<const char*>(&triangle), sizeof triangle);
      bytes.append(2, '\0');
    }
    out.append(bytes);
  });
}

Format stl_format() {
  return surface_format("stl", "triangles for meshers and printers, binary, one solid", "spheres.stl",
                        write_stl_file, {"layer"});
}

}  // namespace bernal
