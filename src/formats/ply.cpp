#include <fmt/format.h>

#include "formats/surface_file.hpp"

namespace bernal {
namespace {

/// Source: Greg Turk, The PLY polygon file format (1994).
std::string write_ply_file(const Exported& file, StagedFolder& staged) {
  const Surfaces surfaces = surfaces_of(file);
  OutputFile out(staged.add(file.output.file.string()));
  out.append(fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment {}\ncomment lengths in {}; sphere is the index "
      "in the packing from 0, -1 the container\nelement vertex {}\nproperty float x\nproperty float "
      "y\nproperty float z\nelement face {}\nproperty list uchar int vertex_indices\nproperty int "
      "sphere\nend_header\n",
      file.title(), name_of(file.unit()), surfaces.vertices(), surfaces.triangles()));
  surfaces.visit([&](const SurfacePart& part) { append_bytes(out, part.vertices); });
  std::string bytes;
  surfaces.visit([&](const SurfacePart& part) {
    const std::int32_t sphere = part.sphere ? static_cast<std::int32_t>(*part.sphere) : -1;
    bytes.clear();
    for (const Triangle& triangle : part.triangles) {
      bytes += '\3';
      bytes.append(reinterpret_cast<const char*>(&triangle), sizeof triangle);
      bytes.append(reinterpret_cast<const char*>(&sphere), sizeof sphere);
    }
    out.append(bytes);
  });
  out.close();
  return surfaces.note();
}

}  // namespace

Format ply_format() {
  return surface_format("ply", "triangles with the number of the sphere of each, binary", "spheres.ply",
                        write_ply_file);
}

}  // namespace bernal
