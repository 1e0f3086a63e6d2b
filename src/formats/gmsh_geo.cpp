#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include <fmt/format.h>

#include "formats/gmsh_model.hpp"
#include "scene/toml_text.hpp"

namespace bernal {
namespace {

std::string braced(const Vector<3>& v) { return fmt::format("{}, {}, {}", v[0], v[1], v[2]); }

/// What makes volume 1.
struct GeoDomain {
  const GmshModel& model;

  std::string operator()(const Box& box) const {
    return fmt::format("Box(1) = {{{}, {}}};\n", braced(box.corner), braced(box.size));
  }
  std::string operator()(const Cylinder& cylinder) const {
    return fmt::format("Cylinder(1) = {{{}, {}, {}}};\n", braced(cylinder.base),
                       braced(cylinder.height * cylinder.axis.normalized()), cylinder.radius);
  }
  std::string operator()(const Sphere& sphere) const {
    return fmt::format("Sphere(1) = {{{}, {}}};\n", braced(sphere.center), sphere.radius);
  }
  std::string operator()(const Mesh& mesh) const {
    std::string text;
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
      text += fmt::format("Point({}) = {{{}}};\n", v + 1, braced(mesh.vertices[v]));
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> lines;
    int wires = 0;
    std::string surfaces;  // after all loops: they take numbers of loops that are free so far
    const auto line = [&](std::uint32_t a, std::uint32_t b) {
      if (const auto known = lines.find({b, a}); known != lines.end()) return -known->second;
      const auto [entry, is_new] = lines.try_emplace({a, b}, static_cast<int>(lines.size()) + 1);
      if (is_new) text += fmt::format("Line({}) = {{{}, {}}};\n", entry->second, a + 1, b + 1);
      return entry->second;
    };
    for (std::size_t f = 0; f < model.faces.size(); ++f) {
      std::string of_face;
      for (const auto& loop : model.faces[f].loops) {
        std::string around;
        for (std::size_t k = 0; k < loop.size(); ++k)
          around += fmt::format("{}{}", k == 0 ? "" : ", ", line(loop[k], loop[(k + 1) % loop.size()]));
        text += fmt::format("Curve Loop({}) = {{{}}};\n", ++wires, around);
        of_face += fmt::format("{}{}", of_face.empty() ? "" : ", ", wires);
      }
      surfaces += fmt::format("Plane Surface({}) = {{{}}};\n", f + 1, of_face);
    }
    return text + surfaces +
           fmt::format("Surface Loop(1) = {{1:{}}};\nVolume(1) = {{1}};\n", model.faces.size());
  }
  std::string operator()(const Polygon&) const { return {}; }
};

std::string list_of(const std::vector<std::size_t>& volumes) {
  std::string text;
  for (std::size_t k = 0; k < volumes.size(); ++k)
    text += fmt::format("{}{}", k == 0 ? "" : k % 20 == 0 ? ",\n  " : ", ", volumes[k]);
  return text;
}

std::string solids_of_geo(const GmshModel& model) {
  std::string text;
  const auto& pieces = model.solids.pieces;
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    text += fmt::format("Sphere({}) = {{{}, {}}};\n", p + 2, braced(pieces[p].center), pieces[p].radius);
    if (const Turn& turn = model.turns[p]; turn.angle != 0)
      text +=
          fmt::format("Rotate {{{{{:.6g}, {:.6g}, {:.6g}}}, {{{}}}, {:.6g}}} {{ Volume{{{}}}; }}\n",
                      turn.axis[0], turn.axis[1], turn.axis[2], braced(pieces[p].center), turn.angle, p + 2);
  }
  std::size_t tool = model.first_bridge() + model.solids.bridges.size();
  for (std::size_t p = 0; p < model.caps.size(); ++p) {
    const std::size_t first = tool;
    for (const CapTool& cap : model.caps[p])
      text += fmt::format("Cylinder({}) = {{{}, {}, {}}};\n", tool++, braced(cap.base), braced(cap.axis),
                          cap.radius);
    if (tool > first)
      text += fmt::format("BooleanDifference{{ Volume{{{}}}; Delete; }}{{ Volume{{{}:{}}}; Delete; }}\n",
                          p + 2, first, tool - 1);
  }
  const auto& bridges = model.solids.bridges;
  for (std::size_t b = 0; b < bridges.size(); ++b) {
    const Vector<3> along = (bridges[b].rims[1] - bridges[b].rims[0]).normalized() * bridges[b].radius;
    const Vector<3> from = bridges[b].rims[0] - along, to = bridges[b].rims[1] + along;
    text += fmt::format("Cylinder({}) = {{{}, {}, {}}};\n", model.first_bridge() + b, braced(from),
                        braced(to - from), bridges[b].radius);
  }
  if (!bridges.empty())
    text += fmt::format("BooleanDifference{{ Volume{{{}:{}}}; Delete; }}{{ Volume{{2:{}}}; }}\n",
                        model.first_bridge(), model.first_bridge() + bridges.size() - 1,
                        model.first_bridge() - 1);
  std::vector<std::size_t> cut;
  for (const std::size_t p : model.cut_pieces) cut.push_back(p + 2);
  for (const std::size_t b : model.cut_bridges) cut.push_back(model.first_bridge() + b);
  if (!cut.empty())
    text +=
        fmt::format("BooleanIntersection{{ Volume{{\n  {}}}; Delete; }}{{ Volume{{1}}; }}\n", list_of(cut));
  const std::size_t last = model.first_bridge() + bridges.size() - 1;
  if (last < 2) return text + "v() = {1};\nmatrix() = {1};\n";
  const std::string trouble = model.trouble();
  // Deleted objects come back under their own numbers, as long as one of each does.
  return text + fmt::format(
                    "v() = BooleanFragments{{ Volume{{1}}; Delete; }}{{ Volume{{2:{0}}}; Delete; }};\n"
                    "matrix() = v();\nmatrix() -= {{2:{0}}};\n"
                    "If (#v() - #matrix() != {1})\n  Error(\"%g solids where {1} were made{2}\", #v() - "
                    "#matrix());\n  Exit;\nEndIf\n",
                    last, last - 1, trouble.empty() ? trouble : ": " + trouble);
}

std::string groups_of(const GmshModel& model) {
  std::string text = "Physical Volume(\"matrix\") = {matrix()};\n";
  std::vector<std::vector<std::size_t>> types(model.file.type_count);
  for (std::size_t p = 0; p < model.solids.pieces.size(); ++p) types[model.type_of(p) - 1].push_back(p + 2);
  for (std::uint32_t type = 1; type <= model.file.type_count; ++type)
    if (!types[type - 1].empty())
      text += fmt::format("Physical Volume({}) = {{\n  {}}};\n", toml_string(model.name_of_type(type)),
                          list_of(types[type - 1]));
  if (!model.solids.bridges.empty())
    text += fmt::format("Physical Volume(\"bridges\") = {{{}:{}}};\n", model.first_bridge(),
                        model.first_bridge() + model.solids.bridges.size() - 1);
  text +=
      "outer() = Abs(CombinedBoundary{ Volume{v()}; });\n"
      "inner() = Abs(Boundary{ Volume{v()}; });\n"
      "inner() -= {outer()};\nwalls() = {outer()};\n"
      "Physical Surface(\"interface\") = {inner()};\n";
  const bool is_box = std::holds_alternative<Box>(model.file.domain);
  const double close = 1e-6 * model.bounds.size().maxCoeff();
  for (int axis = 0; axis < 3; ++axis) {
    const bool repeats = model.periods[static_cast<std::size_t>(axis)];
    if (!is_box && !repeats) continue;
    const char letter = "xyz"[axis];
    for (const bool upper : {false, true}) {
      Bounds<3> slab{model.bounds.lower - Vector<3>::Constant(close),
                     model.bounds.upper + Vector<3>::Constant(close)};
      (upper ? slab.lower : slab.upper)[axis] =
          (upper ? model.bounds.upper[axis] - close : model.bounds.lower[axis] + close);
      const std::string name = fmt::format("{}_{}", letter, upper ? "upper" : "lower");
      text += fmt::format(
          "{0}() = Surface In BoundingBox {{{1}, {2}}};\nwalls() -= {{{0}()}};\n"
          "Physical Surface(\"{0}\") = {{{0}()}};\n",
          name, braced(slab.lower), braced(slab.upper));
    }
    if (!repeats) continue;
    Vector<3> shift = Vector<3>::Zero();
    shift[axis] = model.bounds.size()[axis];
    text += fmt::format(
        R"(For i In {{0:#{0}_lower()-1}}
  a() = BoundingBox Surface {{ {0}_lower(i) }};
  near() = Surface In BoundingBox {{ a(0) + {1} - {4}, a(1) + {2} - {4}, a(2) + {3} - {4}, a(3) + {1} + {4}, a(4) + {2} + {4}, a(5) + {3} + {4} }};
  For j In {{0:#near()-1}}
    b() = BoundingBox Surface {{ near(j) }};
    If (Fabs(b(0) - a(0) - {1}) < {4} && Fabs(b(1) - a(1) - {2}) < {4} && Fabs(b(2) - a(2) - {3}) < {4} && Fabs(b(3) - a(3) - {1}) < {4} && Fabs(b(4) - a(4) - {2}) < {4} && Fabs(b(5) - a(5) - {3}) < {4})
      Periodic Surface {{ near(j) }} = {{ {0}_lower(i) }} Translate {{ {1}, {2}, {3} }};
    EndIf
  EndFor
EndFor
)",
        letter, shift[0], shift[1], shift[2], close);
  }
  return text + "If (#walls() > 0)\n  Physical Surface(\"walls\") = {walls()};\nEndIf\n";
}

/// Six pyramids about a narrow place, with the smallest size at their common tip.
std::string pyramids(const NarrowPlace& place) {
  const Vector<3> u = place.normal.unitOrthogonal(), v = place.normal.cross(u);
  const std::array<Vector<3>, 3> axes = {u * place.reach, v * place.reach, place.normal * place.reach / 2};
  std::string text;
  for (std::size_t a = 0; a < 3; ++a)
    for (const double side : {1., -1.}) {
      text += "SY(";
      constexpr std::array<std::array<int, 2>, 4> corners = {{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
      for (const auto& [x, y] : corners) {
        const Vector<3> p =
            place.point + side * axes[a] + x * axes[(a + 1) % 3] + y * side * axes[(a + 2) % 3];
        text += fmt::format("{:.8g},{:.8g},{:.8g},", p[0], p[1], p[2]);
      }
      text += fmt::format("{0:.8g},{1:.8g},{2:.8g}){{{3:.5g},{3:.5g},{3:.5g},{3:.5g},{4:.5g}}};\n",
                          place.point[0], place.point[1], place.point[2], place.size_beside, place.size);
    }
  return text;
}

std::string sizes_of(const GmshModel& model) {
  std::string text = fmt::format(
      "// Sizes: by curvature on spheres, in narrow gaps by what pyramids about them say.\n"
      "Mesh.MeshSizeMax = {};\nMesh.MeshSizeFromCurvature = {};\nMesh.MeshSizeFromPoints = 0;\n"
      "Mesh.LcIntegrationPrecision = 1e-4;\n",
      model.largest_size, std::lround(2 * std::numbers::pi / model.file.output.mesh_size));
  std::array<std::string, NarrowPlace::most_layers> layers;
  for (const NarrowPlace& place : model.places)
    layers[static_cast<std::size_t>(place.layer)] += pyramids(place);
  int views = 0;
  std::string fields;
  for (const std::string& layer : layers) {
    if (layer.empty()) continue;
    text += fmt::format(
        "View \"narrow {0}\" {{\n{1}}};\nView[{0}].Visible = 0;\nField[{2}] = PostView;\n"
        "Field[{2}].ViewIndex = {0};\n",
        views, layer, views + 1);
    ++views;
    fields += fmt::format("{}{}", fields.empty() ? "" : ", ", views);
  }
  if (views > 0)
    text += fmt::format("Field[{0}] = Min;\nField[{0}].FieldsList = {{{1}}};\nBackground Field = {0};\n",
                        views + 1, fields);
  return text;
}

}  // namespace

std::string gmsh_geo(const GmshModel& model) {
  const Exported& file = model.file;
  return fmt::format(
      "// {0}; for Gmsh 4.8 and later, lengths in {1}.\n"
      "//   gmsh {2} -                         makes the mesh and writes it\n"
      "//   gmsh {2} -setnumber mesh 0        shows the solids\n"
      "SetFactory(\"OpenCASCADE\");\nDefineConstant[ mesh = 1 ];\n{3}{4}{5}{6}"
      "Mesh.Algorithm3D = 10; // HXT\nMesh.OptimizeThreshold = 0.4;\nMesh.ElementOrder = {7};\n"
      "Mesh.ScalingFactor = {9}; // of what is written\n"
      "If (mesh)\n  Mesh 3;\n  Save {8};\nEndIf\n",
      file.title(), model.unit_in_words(), file.name_as_word(), std::visit(GeoDomain{model}, file.domain),
      solids_of_geo(model), groups_of(model), sizes_of(model), file.output.mesh_order,
      toml_string(file_beside(file.output.file, ".msh")), model.length());
}

}  // namespace bernal
