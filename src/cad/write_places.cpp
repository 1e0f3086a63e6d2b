#include <fmt/format.h>

#include <fstream>
#include <iterator>

#include "bernal/cad/read_mesh.hpp"
#include "cad/diagnose/defects.hpp"

namespace bernal {

void write_places(const ImportedMesh& imported, const std::filesystem::path& file) {
  const Mesh& mesh = imported.mesh;
  std::vector<std::string_view> color(mesh.triangles.size(), "190 190 190");
  const cad::DefectiveFaces faces = cad::defective_faces(mesh);
  for (const std::uint32_t t : faces.at_open_edges) color[t] = "240 150 20";
  for (const std::uint32_t t : faces.at_branching_edges) color[t] = "40 90 230";
  for (const std::uint32_t t : faces.crossing) color[t] = "220 30 30";

  std::string text = fmt::format(
      "ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\nproperty double z\n"
      "element face {}\nproperty list uchar int vertex_indices\nproperty uchar red\nproperty uchar green\n"
      "property uchar blue\nend_header\n",
      mesh.vertices.size(), mesh.triangles.size());
  const auto out = std::back_inserter(text);
  for (const Vector<3>& v : mesh.vertices) fmt::format_to(out, "{} {} {}\n", v[0], v[1], v[2]);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    fmt::format_to(out, "3 {} {} {} {}\n", a, b, c, color[t]);
  }
  std::ofstream written(file, std::ios::binary);
  written << text;
  written.close();
  if (!written) throw Error(ErrorCode::cannot_write, "cannot be written", {file.string()});
}

}  // namespace bernal
