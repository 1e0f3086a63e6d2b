#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <set>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "bernal/version.hpp"
#include "formats/format.hpp"
#include "scene/toml_text.hpp"

namespace bernal {
namespace {

/// Lengths and points of the scene as a file has them. To a larger unit they are divided: by a whole number
/// where both are metric, so that nothing but the result is rounded.
struct Conversion {
  double times = 1, by = 1;
  bool single = false;
  Vector<3> middle = Vector<3>::Zero();

  Conversion(Unit from, Unit to, Precision precision) : single(precision == Precision::as_float) {
    const double factor = conversion_factor(from, to);
    if (factor < 1)
      by = conversion_factor(to, from);
    else
      times = factor;
  }

  double rounded(double value) const {
    return single ? static_cast<double>(static_cast<float>(value)) : value;
  }
  double converted(double length) const { return by == 1 ? length * times : length / by; }

  /// Diameters and edges: what formats of single precision hold, and half of it is exact.
  double length(double of_scene) const { return rounded(converted(of_scene)); }
  double radius(double of_scene) const { return 0.5 * length(2 * of_scene); }
  double coordinate(double of_scene, int axis) const {
    const double value = converted(of_scene);
    return rounded(axis < 3 ? value - middle[axis] : value);
  }
  template <class Point>
  Point point(Point p) const {
    for (int k = 0; k < p.size(); ++k) p[k] = coordinate(p[k], k);
    return p;
  }

  Domain operator()(Box box) const {
    box.corner = point(box.corner);
    for (double& edge : box.size) edge = length(edge);
    return box;
  }
  Domain operator()(Cylinder cylinder) const {
    cylinder.base = point(cylinder.base);
    cylinder.radius = length(cylinder.radius);
    cylinder.height = length(cylinder.height);
    return cylinder;
  }
  Domain operator()(Sphere sphere) const {
    sphere.center = point(sphere.center);
    sphere.radius = length(sphere.radius);
    return sphere;
  }
  Domain operator()(Mesh mesh) const {
    for (Vector<3>& vertex : mesh.vertices) vertex = point(vertex);
    mesh.exact = nullptr;
    return mesh;
  }
  Domain operator()(Polygon polygon) const {
    for (auto& loop : polygon.loops)
      for (Vector<2>& p : loop) p = point(p);
    return polygon;
  }
};

/// Into the half-open period, where programs look for centres: what rounding put on its end, and what a file
/// of another hand has beyond.
void wrap_into_periods(Exported& made, bool centred) {
  const auto* box = std::get_if<Box>(&made.domain);
  const auto periods = made.periods();
  const Bounds<dynamic> bounds = bounds_of<dynamic>(made.domain);
  for (std::size_t k = 0; k < made.spheres.x.size(); ++k) {
    const auto axis = static_cast<int>(k);
    if (!(box ? box->repeats(axis) : periods[k])) continue;
    const double edge = bounds.size()[axis], lower = centred ? -0.5 * edge : bounds.lower[axis],
                 upper = lower + edge;
    for (double& x : made.spheres.x[k]) {
      if (x >= lower && x < upper) continue;
      made.wrapped = true;
      x -= std::floor((x - lower) / edge) * edge;
      if (!(x >= lower && x < upper)) x = lower;
    }
  }
}

/// What the output asks for about contacts, of the numbers that the file will hold.
void treat_contacts(Exported& made, const Format& format, const Monitor& monitor) {
  const Output& output = made.output;
  if (format.table.solids) {
    made.solids = solids_of(
        made.spheres, made.domain,
        {.contact = output.contact, .gap = output.contact_gap, .bridge_radius = output.bridge_radius},
        monitor);
    made.spheres = made.solids.spheres;
    made.domain = made.solids.domain;
    made.contacts = made.solids.contacts;
  } else if (output.contact != ContactTreatment::none) {
    made.contacts = shrink_contacts(made.spheres, made.domain, output.contact, output.contact_gap,
                                    format.precision == Precision::as_float, monitor);
  }
}

}  // namespace

std::uint32_t take_types(std::span<const double> radii, const std::optional<int>& asked,
                         std::vector<std::uint32_t>& types) {
  constexpr std::size_t most_by_radius = 10;
  types.assign(radii.size(), 1);
  if (radii.empty()) return 1;
  if (asked) {
    const auto [low, high] = std::ranges::minmax(radii);
    const double width = (high - low) / *asked;
    for (std::size_t i = 0; i < radii.size() && width > 0; ++i)
      types[i] = std::min(static_cast<std::uint32_t>((radii[i] - low) / width),
                          static_cast<std::uint32_t>(*asked - 1)) +
                 1;
    return static_cast<std::uint32_t>(*asked);
  }
  std::set<double> different;
  for (const double r : radii)
    if (different.insert(r); different.size() > most_by_radius) return 1;
  const std::vector<double> sorted(different.begin(), different.end());
  for (std::size_t i = 0; i < radii.size(); ++i)
    types[i] = static_cast<std::uint32_t>(std::ranges::lower_bound(sorted, radii[i]) - sorted.begin()) + 1;
  return static_cast<std::uint32_t>(sorted.size());
}

Exported exported(const Packing& packing, const Output& output, const Monitor& monitor) {
  const Format& format = format_of(output);
  Conversion convert(packing.scene.unit, *output.unit, format.precision);
  Exported made{.packing = packing,
                .output = output,
                .spheres = packing.spheres,
                .domain = Domain(),
                .types = {},
                .monitor = monitor};
  if (format.centred) {
    const Bounds<3> bounds = bounds_of(packing.domain);
    for (int k = 0; k < 3; ++k)
      convert.middle[k] = convert.converted(0.5 * (bounds.lower[k] + bounds.upper[k]));
    made.middle = convert.middle;
  }
  for (std::size_t k = 0; k < made.spheres.x.size(); ++k)
    for (double& x : made.spheres.x[k]) x = convert.coordinate(x, static_cast<int>(k));
  for (std::size_t i = 0; i < made.size(); ++i) {
    double& r = made.spheres.r[i];
    r = convert.radius(r);
    if (!(r > 0 && std::isfinite(r)))
      throw Error(ErrorCode::bad_packing,
                  fmt::format("sphere {} has the radius {} {}, which numbers of the format {} cannot hold", i,
                              packing.spheres.r[i], name_of(packing.scene.unit), output.format));
  }
  made.domain = std::visit(convert, packing.domain);
  if (format.wraps) wrap_into_periods(made, format.centred);
  made.type_count = take_types(packing.spheres.r, output.types, made.types);
  treat_contacts(made, format, monitor);
  return made;
}

double Exported::largest_radius() const {
  return spheres.empty() ? 0 : *std::max_element(spheres.r.begin(), spheres.r.end());
}

std::array<bool, 3> Exported::periods() const {
  std::array<bool, 3> all{};
  if (const auto* box = std::get_if<Box>(&domain))
    for (int k = 0; k < std::min(3, box->dimension()); ++k)
      all[static_cast<std::size_t>(k)] = box->repeats(k);
  if (const auto* cylinder = std::get_if<Cylinder>(&domain); cylinder && cylinder->periodic)
    all[static_cast<std::size_t>(cylinder->coordinate_axis())] = true;
  return all;
}

std::string Exported::periods_as(std::string_view yes, std::string_view no, std::string_view between) const {
  const auto periodic = periods();
  const auto word = [&](std::size_t k) { return periodic[k] ? yes : no; };
  return fmt::format("{0}{3}{1}{3}{2}", word(0), word(1), word(2), between);
}

Bounds<3> Exported::box() const {
  Bounds<3> bounds = bounds_of(domain);
  const double largest = largest_radius(), diagonal = bounds.size().norm();
  const double margin = largest > 0 ? largest : 1e-3 * diagonal;
  const auto periodic = periods();
  for (int k = 0; k < 3; ++k) {
    if (periodic[static_cast<std::size_t>(k)]) continue;
    bounds.lower[k] -= margin;
    bounds.upper[k] += margin;
  }
  return bounds;
}

std::string Exported::name() const { return plain_text(output.file.string()); }

std::string Exported::name_as_word() const { return as_word(output.file.string()); }

std::string as_word(const std::string& word) {
  const auto is_plain = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || std::strchr("._-+", c);
  };
  return std::ranges::all_of(word, is_plain) ? word : toml_string(word);
}

std::string Exported::title() const {
  return fmt::format("bernal {}: {} spheres in a {}, packing fraction {:.6g}", version(), grouped(size()),
                     name_of(domain), packing.packing_fraction() - contacts.change_of_porosity());
}

std::string row_of(const Vector<3>& v) { return fmt::format("{} {} {}", v[0], v[1], v[2]); }

}  // namespace bernal
