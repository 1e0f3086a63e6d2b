#include "viewer/viewer_data.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/scene/sphere_classes.hpp"
#include "bernal/scene/sphere_layers.hpp"
#include "core/parallel.hpp"
#include "domain/revolved_surface.hpp"
#include "geometry/edges.hpp"
#include "geometry/openings.hpp"
#include "geometry/simplified.hpp"
#include "measure/neighbourhoods.hpp"
#include "viewer/base64.hpp"
#include "viewer/palette.hpp"
#include "viewer/view.hpp"
#include "viewer/viewer_columns.hpp"

namespace bernal {
namespace {

constexpr std::size_t most_sharp_edges = 8000;
constexpr double farthest_placed =
    1e9;  // in sizes of the domain; far beyond what is visible, and in range of float

std::string json_number(double value) { return std::isfinite(value) ? fmt::format("{}", value) : "null"; }

std::string json_list(std::span<const double> values) {
  std::string text = "[";
  for (const double value : values) {
    if (text.size() > 1) text += ',';
    text += json_number(value);
  }
  return text + "]";
}
std::string json_list(const Vector<3>& v) { return json_list(std::span(v.data(), 3)); }

/// A JSON string in ASCII that cannot end a script: everything else is escaped.
std::string json_text(std::string_view text) {
  std::string out = "\"";
  for (const char c : text)
    out += c >= ' ' && c < '\x7f' && c != '"' && c != '\\' && c != '<' && c != '&'
               ? std::string(1, c)
               : fmt::format("\\u{:04x}", static_cast<unsigned char>(c));
  return out + "\"";
}

float placed(double local) {
  return static_cast<float>(std::clamp(local, -farthest_placed, farthest_placed));
}

/// A point of the domain's two or three dimensions in the frame.
Vector<3> in_frame(const Vector<dynamic>& p, const Frame& frame) {
  Vector<3> in_space = Vector<3>::Zero();
  in_space.head(p.size()) = p;
  return frame.to_local(in_space);
}

/// Of a tilted box, in which the view draws no images, none.
Vector<3> periods_of_view(const Domain& domain) {
  return is_tilted(domain) ? Vector<3>::Zero() : boundary_in_space(domain).edges;
}

/// Depth of a sphere behind the walls, or the ends of the periods, which hide it.
std::vector<double> depths_of(const Packing& packing, std::span<const std::uint32_t> of) {
  const int dimension = packing.spheres.dimension();
  const Bounds<dynamic> bounds = bounds_of<dynamic>(packing.domain);
  const Vector<3> periods = is_tilted(packing.domain) ? Vector<3>(bounds_of(packing.domain).size())
                                                      : boundary_in_space(packing.domain).edges;
  std::vector<double> depths(of.size(), bounds.size().maxCoeff());
  if (has_walls(packing.domain)) depths = wall_gaps(packing.spheres, packing.domain, of, packing.container);
  parallel_ranges(of.size(), 1 << 14, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      const Vector<dynamic> c = packing.spheres.center(of[k]);
      for (int axis = 0; axis < dimension; ++axis)
        if (periods[axis] > 0)
          depths[k] = std::min({depths[k], c[axis] - bounds.lower[axis] - packing.spheres.r[of[k]],
                                bounds.upper[axis] - c[axis] - packing.spheres.r[of[k]]});
    }
  });
  return depths;
}

/// The visible part of very many spheres, and its depth.
struct Shell {
  std::vector<std::uint32_t> spheres;  ///< in their order
  double depth = 0;                    ///< 0: all are shown
};

Shell shell_of(const Packing& packing, std::size_t most) {
  const std::size_t n = packing.spheres.size();
  Shell shell{std::vector<std::uint32_t>(n)};
  std::iota(shell.spheres.begin(), shell.spheres.end(), 0u);
  if (n <= most) return shell;
  const std::vector<double> depths = depths_of(packing, shell.spheres);
  std::vector<double> sorted = depths;
  const auto last = sorted.begin() + static_cast<std::ptrdiff_t>(most);
  std::ranges::nth_element(sorted, last);
  shell.depth = *last;
  // Of those at exactly this depth, the first.
  std::size_t left = most - static_cast<std::size_t>(std::count_if(
                                sorted.begin(), last, [&](double depth) { return depth < shell.depth; }));
  std::erase_if(shell.spheres, [&](std::uint32_t i) {
    if (depths[i] < shell.depth) return false;
    if (depths[i] > shell.depth || left == 0) return true;
    --left;
    return false;
  });
  return shell;
}

std::string spheres_json(const Packing& packing, const Shell& shell, const Frame& frame) {
  const Spheres<dynamic>& spheres = packing.spheres;
  std::vector<float> centers, radii;
  for (const std::uint32_t i : shell.spheres) {
    const Vector<3> c = in_frame(spheres.center(i), frame);
    for (int k = 0; k < spheres.dimension(); ++k) centers.push_back(placed(c[k]));
    radii.push_back(placed(spheres.r[i] / frame.scale));
  }
  const bool equal = !radii.empty() && std::ranges::count(radii, radii.front()) == std::ssize(radii);
  std::string text = fmt::format("{{\"centers\":\"{}\",\"radii\":", base64_of<float>(centers));
  text += equal ? json_number(double{radii.front()}) : fmt::format("\"{}\"", base64_of<float>(radii));
  if (shell.spheres.size() < spheres.size())
    text += fmt::format(",\"indices\":\"{}\",\"depth\":{}", base64_of<std::uint32_t>(shell.spheres),
                        json_number(shell.depth));
  return text + "}";
}

/// The layers of the spheres that are shown: of each how many, then where they end, from the centre out, and
/// what they are made of, by its place among the names; none where the scene names none.
std::string layers_json(const Packing& packing, const Shell& shell, const Frame& frame) {
  const SphereLayers layers = layers_of(packing);
  if (layers.empty()) return {};
  const std::vector<std::string> materials = materials_of(packing.scene);
  std::vector<std::uint16_t> counts, kinds;
  std::vector<float> radii;
  for (const std::uint32_t i : shell.spheres) {
    const std::vector<Layer>& of = layers.of_class[packing.classes.empty() ? 0 : packing.classes[i]];
    counts.push_back(static_cast<std::uint16_t>(of.size()));
    for (std::size_t k = 0; k < of.size(); ++k) {
      radii.push_back(placed(layers.of(i)[k] / frame.scale));
      const auto found = std::ranges::find(materials, material_of(of[k]));
      kinds.push_back(static_cast<std::uint16_t>(found - materials.begin()));
    }
  }
  std::string names, colours;
  for (std::size_t k = 0; k < materials.size(); ++k) {
    names += (k == 0 ? "" : ",") + json_text(materials[k]);
    colours += fmt::format("{}\"{}\"", k == 0 ? "" : ",", kind_colour(k).text());
  }
  return fmt::format(
      ",\n\"layers\":{{\"names\":[{}],\"colours\":[{}],\"counts\":\"{}\",\"radii\":\"{}\",\"kinds\":\"{}\"}}",
      names, colours, base64_of<std::uint16_t>(counts), base64_of<float>(radii),
      base64_of<std::uint16_t>(kinds));
}

std::string columns_json(const std::vector<ViewColumn>& columns) {
  using Kind = ViewColumn::Kind;
  std::string text = "[";
  for (const ViewColumn& column : columns) {
    const bool small = column.kind == Kind::count || column.kind == Kind::category;
    const std::string_view kind = column.kind == Kind::length  ? "length"
                                  : column.kind == Kind::count ? "count"
                                  : small                      ? "category"
                                                               : "number";
    std::vector<std::uint16_t> counts;
    if (small)
      for (const float value : column.values)
        counts.push_back(static_cast<std::uint16_t>(std::clamp(value, 0.0f, 65535.0f)));
    text += fmt::format("{}{{\"key\":{},\"title\":{},\"kind\":\"{}\",\"values\":\"{}\"}}",
                        text.size() > 1 ? "," : "", json_text(column.key), json_text(column.title), kind,
                        small ? base64_of<std::uint16_t>(counts) : base64_of<float>(column.values));
  }
  return text + "]";
}

std::vector<float> placed_all(std::span<const Vector<3>> points, const Frame& frame) {
  std::vector<float> values;
  for (const Vector<3>& p : points)
    for (const double x : frame.to_local(p)) values.push_back(placed(x));
  return values;
}

struct WallsJson {
  const Frame& frame;
  std::size_t most_triangles;

  std::string operator()(const Box&) const { return {}; }  // its bounds suffice
  std::string operator()(const Cylinder& c) const {
    return fmt::format(",\"base\":{},\"axis\":{},\"radius\":{},\"height\":{}",
                       json_list(frame.to_local(c.base)), json_list(c.axis.stableNormalized()),
                       json_number(c.radius / frame.scale), json_number(c.height / frame.scale));
  }
  std::string operator()(const Sphere& s) const {
    return fmt::format(",\"center\":{},\"radius\":{}", json_list(frame.to_local(s.center)),
                       json_number(s.radius / frame.scale));
  }
  static Mesh without_openings(Mesh mesh) {
    mesh.triangles = triangles_of_walls(mesh);
    return mesh;
  }
  std::string operator()(const Mesh& mesh) const {
    const Mesh shown = mesh.repeats() ? simplified(without_openings(mesh), most_triangles)
                                      : simplified(mesh, most_triangles);
    std::vector<std::uint32_t> corners;
    for (const auto& triangle : shown.triangles)
      corners.insert(corners.end(), triangle.begin(), triangle.end());
    std::vector<Vector<3>> ends;
    for (const auto& [a, b] : sharp_edges(mesh, most_sharp_edges))
      ends.insert(ends.end(), {mesh.vertices[a], mesh.vertices[b]});
    return fmt::format(",\"triangle_count\":{},\"vertices\":\"{}\",\"triangles\":\"{}\",\"edges\":\"{}\"",
                       mesh.triangles.size(), base64_of<float>(placed_all(shown.vertices, frame)),
                       base64_of<std::uint32_t>(corners), base64_of<float>(placed_all(ends, frame)));
  }
  std::string operator()(const Revolved& revolved) const {
    constexpr int sides = 180;
    return (*this)(surface_of(revolved, sides));
  }
  std::string operator()(const Polygon& polygon) const {
    std::vector<Vector<3>> ends;
    for (const auto& loop : polygon.loops)
      for (std::size_t k = 0; k < loop.size(); ++k)
        for (const Vector<2>& p : {loop[k], loop[(k + 1) % loop.size()]}) ends.push_back({p[0], p[1], 0});
    return fmt::format(",\"edges\":\"{}\"", base64_of<float>(placed_all(ends, frame)));
  }
};

std::string domain_json(const Domain& domain, const Frame& frame, const ViewOptions& options) {
  const Bounds<dynamic> bounds = bounds_of<dynamic>(domain);
  const std::string_view kind = std::holds_alternative<Box>(domain)        ? "box"
                                : std::holds_alternative<Revolved>(domain) ? "mesh"  // as it is drawn
                                                                           : kind_of(domain);
  return fmt::format("{{\"kind\":{},\"name\":{},\"walls\":{},\"lower\":{},\"upper\":{},\"periods\":{}{}}}",
                     json_text(kind), json_text(name_of(domain)), has_walls(domain),
                     json_list(in_frame(bounds.lower, frame)), json_list(in_frame(bounds.upper, frame)),
                     json_list(periods_of_view(domain) / frame.scale),
                     std::visit(WallsJson{frame, options.most_triangles}, domain));
}

std::string palette_json() {
  constexpr int steps = 33;
  std::string text = "[";
  for (int k = 0; k < steps; ++k)
    text += fmt::format("{}\"{}\"", k ? "," : "", size_colour(k / (steps - 1.0)).text());
  return text + "]";
}

void require_finite(const Spheres<dynamic>& spheres) {
  for (std::size_t i = 0; i < spheres.size(); ++i)
    if (!spheres.center(i).allFinite() || !(std::isfinite(spheres.r[i]) && spheres.r[i] > 0))
      throw Error(ErrorCode::bad_argument,
                  fmt::format("sphere {} cannot be shown: its centre has to be finite, its radius finite and "
                              "positive",
                              i));
}

}  // namespace

std::string view_data(const Packing& packing, const Measurements* measured, const ViewOptions& options) {
  const int dimension = packing.spheres.dimension();
  if (!has_view(dimension)) return "null";
  require_finite(packing.spheres);
  const Frame frame = frame_of(packing.domain);
  const Shell shell = shell_of(packing, options.most_spheres);
  return fmt::format(
      "{{\"dimension\":{},\"unit\":{},\"count\":{},\"shown\":{},\"origin\":{},\"scale\":{},\"eye\":{},"
      "\"palette\":{},\"domain\":{},\n\"spheres\":{},\n\"columns\":{}{}}}",
      dimension, json_text(name_of(packing.scene.unit)), packing.spheres.size(), shell.spheres.size(),
      json_list(frame.origin), json_number(frame.scale), json_list(View::towards_eye()), palette_json(),
      domain_json(packing.domain, frame, options), spheres_json(packing, shell, frame),
      columns_json(view_columns(packing, measured, shell.spheres)), layers_json(packing, shell, frame));
}

}  // namespace bernal
