#pragma once
#include <minizip/zip.h>

#include <cstdint>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "support/folder.hpp"
#include "support/meshes.hpp"

// Meshes in the formats that name a unit or an axis, as other programs write them.
namespace bernal::test {

namespace detail {
template <class Number, class Rows>
std::string numbers(const Rows& rows) {
  std::string text;
  for (const auto& row : rows)
    for (int k = 0; k < 3; ++k) text += fmt::format("{} ", Number(row[static_cast<std::size_t>(k)]));
  return text;
}
}  // namespace detail

inline std::string as_text_ply(const Mesh& mesh) {
  std::string text = fmt::format(
      "ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\nproperty double z\n"
      "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
      mesh.vertices.size(), mesh.triangles.size());
  for (const Vector<3>& v : mesh.vertices) text += fmt::format("{} {} {}\n", v[0], v[1], v[2]);
  for (const auto& [i, j, k] : mesh.triangles) text += fmt::format("3 {} {} {}\n", i, j, k);
  return text;
}

/// Collada with a unit of so many metres; `up`: "X_UP", "Y_UP", "Z_UP". Coordinates stand in the file as
/// given.
inline std::string as_collada(const Mesh& mesh, double metres, std::string_view up) {
  return fmt::format(
      R"(<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="unit" meter="{}"/><up_axis>{}</up_axis></asset>
<library_geometries><geometry id="g" name="part"><mesh><source id="p"><float_array id="pa" count="{}">{}</float_array>
<technique_common><accessor source="#pa" count="{}" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="{}"><input semantic="VERTEX" source="#v" offset="0"/><p>{}</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n" name="part"><instance_geometry url="#g"/></node>
</visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene>
</COLLADA>)",
      metres, up, 3 * mesh.vertices.size(), detail::numbers<double>(mesh.vertices), mesh.vertices.size(),
      mesh.triangles.size(), detail::numbers<std::uint32_t>(mesh.triangles));
}

/// glTF, whose unit is the metre, with its numbers in part.bin.
inline std::string as_gltf(const Mesh& mesh) {
  const std::size_t points = 12 * mesh.vertices.size(), faces = 12 * mesh.triangles.size();
  Vector<3> lower = mesh.vertices[0], upper = lower;
  for (const Vector<3>& v : mesh.vertices) lower = lower.cwiseMin(v), upper = upper.cwiseMax(v);
  return fmt::format(
      R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],)"
      R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],)"
      R"("buffers":[{{"uri":"part.bin","byteLength":{0}}}],)"
      R"("bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":{1}}},{{"buffer":0,"byteOffset":{1},"byteLength":{2}}}],)"
      R"("accessors":[{{"bufferView":0,"componentType":5126,"count":{3},"type":"VEC3","min":[{4},{5},{6}],"max":[{7},{8},{9}]}},)"
      R"({{"bufferView":1,"componentType":5125,"count":{10},"type":"SCALAR"}}]}})",
      points + faces, points, faces, mesh.vertices.size(), float(lower[0]), float(lower[1]), float(lower[2]),
      float(upper[0]), float(upper[1]), float(upper[2]), 3 * mesh.triangles.size());
}
inline std::string as_gltf_numbers(const Mesh& mesh) {
  std::string bytes;
  const auto append = [&](const auto& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
  };
  for (const Vector<3>& v : mesh.vertices)
    for (int k = 0; k < 3; ++k) append(static_cast<float>(v[k]));
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t i : t) append(i);
  return bytes;
}

/// The bytes of an archive of these entries, each a name and what it holds.
inline std::string archived(const std::vector<std::pair<std::string, std::string>>& entries) {
  const testing::Folder folder;
  const zipFile zip = zipOpen64((folder / "archive.zip").c_str(), 0);
  for (const auto& [name, content] : entries) {
    zipOpenNewFileInZip64(zip, name.c_str(), nullptr, nullptr, 0, nullptr, 0, nullptr, 8, 6, 0);
    zipWriteInFileInZip(zip, content.data(), static_cast<unsigned>(content.size()));
    zipCloseFileInZip(zip);
  }
  zipClose(zip, nullptr);
  return testing::text_of(folder / "archive.zip");
}

/// A 3MF of these entries, whose relationships name `root`.
inline std::string packaged_3mf(std::vector<std::pair<std::string, std::string>> entries,
                                std::string_view root = "/3D/3dmodel.model") {
  const std::pair<std::string, std::string> package[] = {
      {"[Content_Types].xml",
       R"(<?xml version="1.0"?><Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">)"
       R"(<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>)"},
      {"_rels/.rels",
       fmt::format(
           R"(<?xml version="1.0"?><Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">)"
           R"(<Relationship Target="/Metadata/thumbnail.png" Id="t" )"
           R"(Type="http://schemas.openxmlformats.org/package/2006/relationships/metadata/thumbnail"/>)"
           R"(<Relationship Target="{}" Id="r" )"
           R"(Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>)",
           root)}};
  entries.insert(entries.begin(), std::begin(package), std::end(package));
  return archived(entries);
}

/// The bytes of a 3MF archive around its model, in XML.
inline std::string archived_3mf(std::string_view model) {
  return packaged_3mf({{"3D/3dmodel.model", std::string(model)}});
}

/// 3MF; `unit`: "millimeter", "inch", …
/// `support`, if it has faces, is an object that holds the part while it is printed.
inline std::string model_3mf(const Mesh& mesh, std::string_view unit, const Mesh& support = {}) {
  std::string xml =
      fmt::format(R"(<?xml version="1.0" encoding="UTF-8"?><model unit="{}" xml:lang="en-US" )"
                  R"(xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources>)",
                  unit);
  const auto add = [&](int id, std::string_view type, const Mesh& object) {
    xml += fmt::format(R"(<object id="{}" type="{}"><mesh><vertices>)", id, type);
    for (const Vector<3>& v : object.vertices)
      xml += fmt::format(R"(<vertex x="{}" y="{}" z="{}"/>)", v[0], v[1], v[2]);
    xml += "</vertices><triangles>";
    for (const auto& [i, j, k] : object.triangles)
      xml += fmt::format(R"(<triangle v1="{}" v2="{}" v3="{}"/>)", i, j, k);
    xml += "</triangles></mesh></object>";
  };
  const bool supported = !support.triangles.empty();
  add(1, "model", mesh);
  if (supported) add(2, "support", support);
  xml += fmt::format(R"(</resources><build><item objectid="1"/>{}</build></model>)",
                     supported ? R"(<item objectid="2"/>)" : "");
  return xml;
}
inline std::string as_3mf(const Mesh& mesh, std::string_view unit, const Mesh& support = {}) {
  return archived_3mf(model_3mf(mesh, unit, support));
}

/// AMF in millimetres, of a material that it does not define.
inline std::string as_amf(const Mesh& mesh) {
  std::string xml = R"(<?xml version="1.0"?><amf unit="millimeter"><object id="0"><mesh><vertices>)";
  for (const Vector<3>& v : mesh.vertices)
    xml += fmt::format("<vertex><coordinates><x>{}</x><y>{}</y><z>{}</z></coordinates></vertex>", v[0], v[1],
                       v[2]);
  xml += R"(</vertices><volume materialid="3">)";
  for (const auto& [i, j, k] : mesh.triangles)
    xml += fmt::format("<triangle><v1>{}</v1><v2>{}</v2><v3>{}</v3></triangle>", i, j, k);
  return xml + "</volume></mesh></object></amf>";
}

}  // namespace bernal::test
