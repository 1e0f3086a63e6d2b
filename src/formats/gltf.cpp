#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "formats/layered.hpp"
#include "formats/surface_file.hpp"
#include "report/legend.hpp"
#include "surfaces/icosphere.hpp"
#include "viewer/palette.hpp"

namespace bernal {
namespace {

/// Bound on a renderer's error in scale · corner + translation, relative to the shift: two roundings of
/// numbers no larger than the largest coordinate, one of decimals, and one spare.
constexpr double renderer_shifts = 4.01;

/// The primitives of the explicit mesh: the container and the spheres of each colour, in its order.
struct Primitive {
  int colour_class = -1;  ///< -1: the container
  std::uint64_t first = 0, indices = 0;
};

/// The contents of the file: one icosphere for all whole spheres, and triangles for the rest.
struct Written {
  std::vector<std::uint32_t> instances, triangles;  ///< spheres; the latter by colour class
  std::vector<float> scales;                        ///< of instances
  std::vector<FloatPoint> corners;                  ///< of the icosphere
  const Icosphere* icosphere = nullptr;
  std::vector<Primitive> primitives;
  std::uint64_t vertices = 0, indices = 0;
  FloatPoint lower{}, upper{};
};

FloatPoint center_of(const Exported& file, std::uint32_t i) {
  return {static_cast<float>(file.coordinate(0, i)), static_cast<float>(file.coordinate(1, i)),
          static_cast<float>(file.coordinate(2, i))};
}

/// The largest scale at which any renderer's icosphere stays within the allowed triangles; 0 if there is
/// none. Proven: the ball around the rounded centre, with the renderer's error, lies within the ball of the
/// certificate.
float scale_of(const Surfaces& surfaces, std::uint32_t sphere, const FloatPoint& center) {
  constexpr double longest_corner = 1 + 0x1p-22;  // of unit vectors rounded to single precision
  const Piece& piece = surfaces.spheres().first_piece(sphere);
  const double within = piece.radius - surfaces.spheres().inset() - renderer_shifts * surfaces.shift();
  const double room = within - 1.001 * surfaces.shift();
  const float scale = std::nextafter(static_cast<float>(room / longest_corner), 0.0F);
  const double left = (within - scale * longest_corner) * (1 - 1e-9);
  return scale > 0 && lies_within(center, piece.center, left) ? scale : 0;
}

/// How the balls of a file look, and what they are called.
struct Look {
  std::vector<std::uint32_t> material;  ///< of each ball, its place in `materials`
  std::vector<std::string> materials;   ///< as JSON
  std::vector<std::string> names;       ///< of each ball
  std::string title;
};

Written plan(const Exported& file, const Surfaces& surfaces, const Look& look) {
  Written made;
  const bool may_instance =
      file.output.surface == SurfaceChoice::spheres || file.output.surface == SurfaceChoice::all;
  for (std::uint32_t i = 0; surfaces.has_spheres() && i < file.size(); ++i) {
    const bool whole = may_instance && surfaces.spheres().is_whole(i);
    const float scale = whole ? scale_of(surfaces, i, center_of(file, i)) : 0;
    if (scale > 0) {
      made.instances.push_back(i);
      made.scales.push_back(scale);
    } else {
      made.triangles.push_back(i);
    }
  }
  const auto colour_of = [&](std::uint32_t i) { return static_cast<int>(look.material[i]); };
  std::ranges::stable_sort(made.triangles, {}, colour_of);
  if (!made.instances.empty()) {
    made.icosphere = &icosphere(surfaces.spheres().frequency());
    for (const Vector<3>& v : made.icosphere->vertices)
      made.corners.push_back({static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])});
  }
  surfaces.visit(made.triangles, [&](const SurfacePart& part) {
    const int colour_class = part.sphere ? colour_of(*part.sphere) : -1;
    if (made.primitives.empty() || made.primitives.back().colour_class != colour_class)
      made.primitives.push_back({colour_class, made.indices, 0});
    made.primitives.back().indices += 3 * part.triangles.size();
    made.indices += 3 * part.triangles.size();
    for (const FloatPoint& p : part.vertices) {
      if (made.vertices++ == 0) made.lower = made.upper = p;
      for (std::size_t k = 0; k < 3; ++k) {
        made.lower[k] = std::min(made.lower[k], p[k]);
        made.upper[k] = std::max(made.upper[k], p[k]);
      }
    }
  });
  std::erase_if(made.primitives, [](const Primitive& primitive) { return primitive.indices == 0; });
  return made;
}

/// The elements of a JSON list.
struct List {
  std::string text;
  std::size_t size = 0;
  std::size_t add(const std::string& element) {
    if (size > 0) text += ",\n";
    text += element;
    return size++;
  }
};

std::string material_of(const Colour& colour, double opacity, const std::string& name = {}) {
  const auto linear = [](double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); };
  return fmt::format(
      "{{{}\"pbrMetallicRoughness\":{{\"baseColorFactor\":[{:.4g},{:.4g},{:.4g},{}],\"metallicFactor\":0,"
      "\"roughnessFactor\":0.6}}{}}}",
      name.empty() ? "" : fmt::format("\"name\":\"{}\",", name), linear(colour.red), linear(colour.green),
      linear(colour.blue), opacity, opacity < 1 ? ",\"alphaMode\":\"BLEND\",\"doubleSided\":true" : "");
}

/// Spheres in the colours of their sizes.
Look look_of_sizes(const Exported& file) {
  const SizeScale sizes(file.spheres.r);
  Look look;
  for (std::size_t i = 0; i < file.size(); ++i) {
    look.material.push_back(static_cast<std::uint32_t>(sizes.colour_class(file.spheres.r[i])));
    look.names.push_back(fmt::format("sphere_{}", i));
  }
  for (int c = 0; c < colour_classes; ++c)
    look.materials.push_back(material_of(size_colour((c + 0.5) / colour_classes), 1));
  return look;
}

/// A ball for each layer, in the colour of what it is made of, through which one sees what lies within. Those
/// of the surfaces come first.
Look look_of_layers(const Exported& file, Exported& balls) {
  constexpr double veil = 0.3;
  const LayeredSpheres layers = layered(file);
  std::vector<bool> is_core(layers.kinds.size(), false);
  balls.spheres = Spheres<dynamic>(file.dimension());
  Look look;
  const auto add = [&](std::size_t i, std::size_t k) {
    for (std::size_t axis = 0; axis < file.spheres.x.size(); ++axis)
      balls.spheres.x[axis].push_back(file.spheres.x[axis][i]);
    balls.spheres.r.push_back(layers.outer[k]);
    look.material.push_back(layers.kind[k]);
    look.names.push_back(fmt::format("{}_{}", layers.kinds[layers.kind[k]].name, i));
  };
  for (std::size_t i = 0; i < file.size(); ++i) {
    is_core[layers.kind[layers.first[i]]] = true;
    add(i, layers.first[i + 1] - 1);
  }
  for (std::size_t i = 0; i < file.size(); ++i)
    for (std::size_t k = layers.first[i]; k + 1 < layers.first[i + 1]; ++k) add(i, k);
  for (std::size_t k = 0; k < layers.kinds.size(); ++k)
    look.materials.push_back(
        material_of(kind_colour(layers.kinds[k].material), is_core[k] ? 1 : veil, layers.kinds[k].name));
  return look;
}

constexpr int array_buffer = 34962, element_buffer = 34963, as_float = 5126, as_uint32 = 5125;

/// Source: Khronos Group, glTF 2.0 Specification (2021).
std::string json_of(const Exported& file, const Surfaces& surfaces, const Look& look, const Written& written,
                    std::uint64_t& bytes) {
  List views, accessors, meshes, materials, nodes;
  bytes = 0;
  const auto view = [&](std::uint64_t length, int target) {
    views.add(fmt::format("{{\"buffer\":0,\"byteOffset\":{},\"byteLength\":{},\"target\":{}}}", bytes, length,
                          target));
    bytes += length;
    return views.size - 1;
  };
  const auto positions = [&](std::uint64_t count, const FloatPoint& low, const FloatPoint& high) {
    const std::size_t at = view(12 * count, array_buffer);
    return accessors.add(fmt::format(
        "{{\"bufferView\":{},\"componentType\":{},\"count\":{},\"type\":\"VEC3\",\"min\":[{},{},{}],"
        "\"max\":[{},{},{}]}}",
        at, as_float, count, low[0], low[1], low[2], high[0], high[1], high[2]));
  };
  const auto indices = [&](std::size_t at, std::uint64_t first, std::uint64_t count) {
    return accessors.add(fmt::format(
        "{{\"bufferView\":{},\"byteOffset\":{},\"componentType\":{},\"count\":{},\"type\":\"SCALAR\"}}", at,
        4 * first, as_uint32, count));
  };
  const auto primitive = [](std::size_t position, std::size_t index, std::size_t material) {
    return fmt::format("{{\"attributes\":{{\"POSITION\":{}}},\"indices\":{},\"material\":{}}}", position,
                       index, material);
  };
  for (const std::string& material : look.materials) materials.add(material);
  // Glass if spheres are inside, else an opaque surface.
  const bool glass = file.output.surface == SurfaceChoice::all;
  materials.add(material_of({0.62, 0.70, 0.80}, glass ? 0.2 : 1.0));

  std::string children;
  const auto add_node = [&](const std::string& node) {
    if (!children.empty()) children += ',';
    fmt::format_to(std::back_inserter(children), "{}", nodes.add(node));
  };
  // In glTF y points up, in bernal z: (x, y, z) becomes (x, z, -y), column by column.
  nodes.add("");
  if (written.icosphere) {
    FloatPoint low = written.corners[0], high = low;
    for (const FloatPoint& p : written.corners)
      for (std::size_t k = 0; k < 3; ++k) low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
    const std::size_t position = positions(written.corners.size(), low, high);
    const std::uint64_t count = 3 * written.icosphere->triangles.size();
    const std::size_t index = indices(view(4 * count, element_buffer), 0, count);
    std::vector<std::optional<std::size_t>> mesh_of(look.materials.size());
    for (std::size_t n = 0; n < written.instances.size(); ++n) {
      const std::uint32_t i = written.instances[n];
      const std::uint32_t c = look.material[i];
      if (!mesh_of[c])
        mesh_of[c] = meshes.add(fmt::format("{{\"primitives\":[{}]}}", primitive(position, index, c)));
      const FloatPoint p = center_of(file, i);
      add_node(fmt::format("{{\"name\":\"{}\",\"mesh\":{},\"translation\":[{},{},{}],\"scale\":[{},{},{}]}}",
                           look.names[i], *mesh_of[c], p[0], p[1], p[2], written.scales[n], written.scales[n],
                           written.scales[n]));
    }
  }
  if (written.indices > 0) {
    const std::size_t position = positions(written.vertices, written.lower, written.upper);
    const std::size_t at = view(4 * written.indices, element_buffer);
    std::string primitives;
    for (const Primitive& part : written.primitives) {
      if (!primitives.empty()) primitives += ',';
      primitives += primitive(
          position, indices(at, part.first, part.indices),
          part.colour_class < 0 ? look.materials.size() : static_cast<std::size_t>(part.colour_class));
    }
    const std::size_t mesh = meshes.add(fmt::format("{{\"primitives\":[{}]}}", primitives));
    add_node(fmt::format("{{\"name\":\"{}\",\"mesh\":{}}}",
                         surfaces.container().triangles.empty() ? "cut_spheres" : "container", mesh));
  }
  const std::string root =
      fmt::format("{{\"name\":\"bernal\",\"matrix\":[1,0,0,0,0,0,-1,0,0,1,0,0,0,0,0,1]{}}}",
                  children.empty() ? "" : fmt::format(",\"children\":[{}]", children));
  std::string json = fmt::format(
      "{{\"asset\":{{\"version\":\"2.0\",\"generator\":\"{}; lengths in m\"}},\n\"scene\":0,"
      "\"scenes\":[{{\"nodes\":[0]}}],\n\"nodes\":[{}{}]",
      look.title, root, nodes.text);
  if (meshes.size > 0)
    json += fmt::format(
        ",\n\"meshes\":[{}],\n\"materials\":[{}],\n\"accessors\":[{}],\n\"bufferViews\":[{}],\n"
        "\"buffers\":[{{\"byteLength\":{}}}]",
        meshes.text, materials.text, accessors.text, views.text, bytes);
  json += "}\n";
  json.resize((json.size() + 3) / 4 * 4, ' ');
  return json;
}

std::string write_gltf_file(const Exported& given, StagedFolder& staged) {
  const bool by_layers = shows_layers(given) && given.output.surface == SurfaceChoice::spheres;
  Exported file = given;
  Look look = by_layers ? look_of_layers(given, file) : look_of_sizes(given);
  look.title = given.title();
  const Surfaces surfaces(file.spheres, file.domain, file.output.deflection, file.output.surface,
                          file.monitor, {given.size(), false});
  const Written written = plan(file, surfaces, look);
  std::uint64_t bytes = 0;
  const std::string json = json_of(file, surfaces, look, written, bytes);
  const std::uint64_t length = 12 + 8 + json.size() + (bytes > 0 ? 8 + bytes : 0);
  if (length > 0xffff'ffffU)
    throw Error(ErrorCode::bad_argument, "a .glb file ends at 4 GiB; allow a larger deflection",
                file.output.locations.whole);
  OutputFile out(staged.add(file.output.file.string()));
  constexpr std::uint32_t magic = 0x46546C67, version = 2, json_chunk = 0x4E4F534A, binary_chunk = 0x004E4942;
  for (const std::uint32_t word : {magic, version, static_cast<std::uint32_t>(length),
                                   static_cast<std::uint32_t>(json.size()), json_chunk})
    append_bytes(out, word);
  out.append(json);
  if (bytes > 0) {
    append_bytes(out, static_cast<std::uint32_t>(bytes));
    append_bytes(out, binary_chunk);
    if (written.icosphere) {
      append_bytes(out, std::span<const FloatPoint>(written.corners));
      append_bytes(out, std::span<const Triangle>(written.icosphere->triangles));
    }
    if (written.indices > 0) {
      surfaces.visit(written.triangles, [&](const SurfacePart& part) { append_bytes(out, part.vertices); });
      surfaces.visit(written.triangles, [&](const SurfacePart& part) { append_bytes(out, part.triangles); });
    }
  }
  out.close();
  return surfaces.note() + (by_layers ? "; a mesh a layer" : "") + "; y points up";
}

}  // namespace

Format gltf_format() {
  Format made = surface_format(
      "gltf",
      "scene for viewers and Blender, binary, coloured by size, or by layer; an icosphere that nodes "
      "scale and move",
      "spheres.glb", write_gltf_file, {"layers"});
  std::erase(made.keys, "unit");
  made.unit = Unit::m;
  return made;
}

}  // namespace bernal
