#include <fmt/format.h>

#include "cells/vtk_appended.hpp"
#include "files/output_file.hpp"
#include "mesh_files/mesh_file.hpp"
#include "meshes/boundary_layer.hpp"
#include "meshes/mesh_quality.hpp"

namespace bernal {
namespace {

std::string write_mesh_as_vtu(const MeshToWrite& file, StagedFolder& staged) {
  constexpr std::uint8_t tetrahedron_type = 10, wedge_type = 13, pyramid_type = 14, quadratic_type = 24;
  const VolumeMesh& mesh = file.mesh;
  const std::size_t prisms = mesh.stacks.prisms.size(), cells = mesh.tetrahedra.size() + prisms;
  std::vector<double> points;
  for (std::size_t i = 0; i < mesh.node_count(); ++i)
    for (int k = 0; k < 3; ++k) points.push_back(mesh.node(i)[k]);
  std::vector<std::int64_t> nodes, ends;
  std::vector<std::int32_t> region, sphere, layer;
  std::vector<float> quality;
  std::vector<std::uint8_t> types(mesh.tetrahedra.size(),
                                  mesh.is_curved() ? quadratic_type : tetrahedron_type);
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const TetrahedronCorners& c = mesh.tetrahedra[t];
    nodes.insert(nodes.end(), c.begin(), c.end());
    if (mesh.is_curved())
      nodes.insert(nodes.end(), mesh.middles_of_tetrahedron[t].begin(), mesh.middles_of_tetrahedron[t].end());
    ends.push_back(static_cast<std::int64_t>(nodes.size()));
    region.push_back(static_cast<std::int32_t>(file.groups.volume_of(mesh, t)));
    const auto& of = mesh.regions[mesh.region[t]].sphere;
    sphere.push_back(of ? static_cast<std::int32_t>(*of) : -1);
    quality.push_back(static_cast<float>(
        sicn(mesh.vertices[c[0]], mesh.vertices[c[1]], mesh.vertices[c[2]], mesh.vertices[c[3]])));
  }
  for (std::size_t p = 0; p < prisms; ++p) {
    std::vector<std::uint32_t> c = distinct_corners(mesh.stacks.prisms[p]);
    types.push_back(c.size() == 6 ? wedge_type : c.size() == 5 ? pyramid_type : tetrahedron_type);
    if (c.size() == 6)  // whose first triangle turns away from the second, here
      for (const std::size_t k : {1, 4}) std::swap(c[k], c[k + 1]);
    nodes.insert(nodes.end(), c.begin(), c.end());
    ends.push_back(static_cast<std::int64_t>(nodes.size()));
    region.push_back(static_cast<std::int32_t>(file.groups.volume_of_region[0]));
    sphere.push_back(-1);
    quality.push_back(static_cast<float>(scaled_jacobian(mesh, mesh.stacks.prisms[p])));
  }
  for (std::size_t p = 0; p < cells && prisms > 0; ++p)
    layer.push_back(p < mesh.tetrahedra.size()
                        ? 0
                        : static_cast<std::int32_t>((p - mesh.tetrahedra.size()) % mesh.stacks.layers + 1));
  VtkAppended data;
  std::string text = vtu_head(file.title, file.unit, mesh.node_count(), cells);
  text += data.tag("Float64", "Points", points, 3) + "      </Points>\n      <Cells>\n";
  text += data.tag("Int64", "connectivity", nodes);
  text += data.tag("Int64", "offsets", ends);
  text += data.tag("UInt8", "types", types);
  text += "      </Cells>\n      <CellData Scalars=\"sicn\">\n";
  text += data.tag("Int32", "region", region);
  text += data.tag("Int32", "sphere", sphere);
  text += data.tag("Float32", "sicn", quality);
  if (prisms > 0) text += data.tag("Int32", "layer", layer);
  text += "      </CellData>\n    </Piece>\n  </UnstructuredGrid>\n";
  OutputFile out(staged.add(file.name.string()));
  out.append(text);
  data.append_to(out);
  out.close();
  std::string meaning;
  for (std::size_t v = 0; v < file.groups.volumes.size(); ++v)
    meaning += fmt::format("{}{} {}", v == 0 ? "" : ", ", v, file.groups.volumes[v]);
  return fmt::format("{} with region ({}), sphere (-1: none) and sicn{}",
                     prisms > 0 ? "tetrahedra and prisms" : "tetrahedra", meaning,
                     prisms > 0 ? ", of prisms their scaled Jacobian, and layer (0: none)" : "");
}

}  // namespace

MeshWriter vtu_of_mesh() {
  return {.format = {"vtu", "ParaView, VTK, meshio: tetrahedra, each with region, sphere and SICN", ".vtu", 2,
                     true},
          .write = write_mesh_as_vtu};
}

}  // namespace bernal
