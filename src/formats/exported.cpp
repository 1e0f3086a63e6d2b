#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/dimension.hpp"
#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "bernal/scene/sphere_classes.hpp"
#include "bernal/version.hpp"
#include "domain/without_walls.hpp"
#include "formats/format.hpp"
#include "scene/toml_text.hpp"

namespace bernal {
namespace {

/// `mapping.of` for each kind of domain.
struct MappedDomain {
  const Mapping& mapping;

  template <class Point>
  Point point(Point p) const {
    for (int k = 0; k < p.size(); ++k) p[k] = mapping.coordinate(p[k], k);
    return p;
  }
  Domain operator()(Box box) const {
    box.corner = point(box.corner);
    for (double& edge : box.size) edge = mapping.length(edge);
    for (double& length : box.tilt) length = std::copysign(mapping.length(std::abs(length)), length);
    return box;
  }
  Domain operator()(Cylinder cylinder) const {
    cylinder.base = point(cylinder.base);
    cylinder.radius = mapping.length(cylinder.radius);
    cylinder.height = mapping.length(cylinder.height);
    return cylinder;
  }
  Domain operator()(Sphere sphere) const {
    sphere.center = point(sphere.center);
    sphere.radius = mapping.length(sphere.radius);
    return sphere;
  }
  Domain operator()(Mesh mesh) const {
    for (Vector<3>& vertex : mesh.vertices) vertex = point(vertex);
    mesh.exact = nullptr;
    mesh.surface = nullptr;
    return mesh;
  }
  Domain operator()(Revolved revolved) const {
    revolved.base = point(revolved.base);
    for (Vector<2>& p : revolved.profile)
      p = {mapping.length(p[0]), std::copysign(mapping.length(std::abs(p[1])), p[1])};
    return revolved;
  }
  Domain operator()(Polygon polygon) const {
    for (auto& loop : polygon.loops)
      for (Vector<2>& p : loop) p = point(p);
    return polygon;
  }
};

/// Moves centres into the cell of a tilted box, where programs expect them: a result has them in the brick of
/// its edges. Precondition: its origin is at zero.
void wrap_into_cell(Exported& made) {
  with_dimension(made.dimension(), std::integer_sequence<int, 2, 3>{}, [&](auto dimension) {
    constexpr int D = dimension;
    const TiltedBoundary<D> boundary = tilted_boundary_of<D>(made.domain);
    for (std::size_t i = 0; i < made.size(); ++i) {
      const Vector<D> c = made.spheres.center(i), shares = boundary.in_cell_vectors(c);
      Vector<D> moved = c;
      for (int k = 0; k < D; ++k)
        if (const double turns = std::floor(shares[k]); turns != 0) moved -= turns * boundary.cell_vector(k);
      made.wrapped |= moved != c;
      made.spheres.set_center(i, moved);
    }
  });
}

/// Moves centres into the half-open period that programs expect: those that rounding put on its end, and
/// those of other programs' files beyond it.
void wrap_into_periods(Exported& made, bool centred) {
  if (is_tilted(made.domain)) return wrap_into_cell(made);
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

/// Treats contacts as the output requests, on the numbers that the file will hold.
void treat_contacts(Exported& made, const Format& format, const Monitor& monitor) {
  const Output& output = made.output;
  if (format.solids) {
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

/// The type of every sphere, from 1, and their number: classes of radii of equal width if `asked`; else one
/// type a zone; else one type a radius if there are at most ten radii, otherwise one.
std::uint32_t take_types(const Packing& packing, const std::optional<int>& asked,
                         std::vector<std::uint32_t>& types) {
  constexpr std::size_t most_by_radius = 10;
  const std::span<const double> radii = packing.spheres.r;
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
  if (!packing.scene.zones.empty() && packing.classes.size() == radii.size()) {
    for (std::size_t i = 0; i < radii.size(); ++i) types[i] = packing.classes[i] + 1;
    return static_cast<std::uint32_t>(classes_of(packing.scene).size());
  }
  std::set<double> different;
  for (const double r : radii)
    if (different.insert(r); different.size() > most_by_radius) return 1;
  const std::vector<double> sorted(different.begin(), different.end());
  for (std::size_t i = 0; i < radii.size(); ++i)
    types[i] = static_cast<std::uint32_t>(std::ranges::lower_bound(sorted, radii[i]) - sorted.begin()) + 1;
  return static_cast<std::uint32_t>(sorted.size());
}

/// Those of zones, where the output is told no other density than what the scene has for all.
void take_densities(Exported& made) {
  const Scene& scene = made.packing.scene;
  if (scene.zones.empty() || made.output.types || !made.output.material_density ||
      made.density() != usual_density(scene))
    return;
  for (const SphereClass& of : classes_of(scene))
    made.type_densities.push_back(of.material_density.value_or(made.density()));
}

}  // namespace

std::function<double(double)> unit_conversion(Unit from, Unit to) {
  const double factor = conversion_factor(from, to), back = conversion_factor(to, from);
  return [factor, back](double length) { return factor < 1 ? length / back : length * factor; };
}

Vector<3> Mapping::point(Vector<3> p) const { return MappedDomain{*this}.point(p); }
void Mapping::map(Spheres<dynamic>& spheres) const {
  for (std::size_t k = 0; k < spheres.x.size(); ++k)
    for (double& x : spheres.x[k]) x = coordinate(x, static_cast<int>(k));
  for (double& r : spheres.r) r = length(r);
}
Domain Mapping::of(const Domain& domain) const { return std::visit(MappedDomain{*this}, domain); }

Exported exported(const Packing& packing, const Output& output, const Monitor& monitor) {
  const Format& format = format_of(output);
  if (!format.repeated_mesh) require_closed_walls(packing.domain, "the format");
  const auto converted = unit_conversion(packing.scene.unit, *output.unit);
  const auto rounded = [is_single = format.precision == Precision::as_float](double value) {
    return is_single ? static_cast<double>(static_cast<float>(value)) : value;
  };
  Exported made{.packing = packing,
                .output = output,
                .spheres = packing.spheres,
                .domain = Domain(),
                .types = {},
                .monitor = monitor};
  Vector<3> middle = Vector<3>::Zero();
  if (format.centred) {
    const Bounds<3> bounds = bounds_of(packing.domain);
    for (int k = 0; k < 3; ++k) middle[k] = converted(0.5 * (bounds.lower[k] + bounds.upper[k]));
  }
  Mapping mapping{[&](double x, int axis) {
                    const double value = converted(x);
                    return rounded(axis < 3 ? value - middle[axis] : value);
                  },
                  [&](double length) { return rounded(converted(length)); }};
  made.domain = mapping.of(packing.domain);
  // A format of single precision holds diameters, and half of a diameter is exact.
  mapping.length = [&](double radius) { return 0.5 * rounded(converted(2 * radius)); };
  mapping.map(made.spheres);
  for (std::size_t i = 0; i < made.size(); ++i)
    if (const double r = made.spheres.r[i]; !(r > 0 && std::isfinite(r)))
      throw Error(ErrorCode::bad_packing,
                  fmt::format("sphere {} has the radius {} {}, which numbers of the format {} cannot hold", i,
                              packing.spheres.r[i], name_of(packing.scene.unit), output.format));
  if (format.wraps) wrap_into_periods(made, format.centred);
  take_densities(made);
  made.type_count = take_types(packing, output.types, made.types);
  treat_contacts(made, format, monitor);
  return made;
}

std::string Exported::densities_in_words() const {
  return type_densities.empty() ? fmt::format("{}", density())
                                : fmt::format("{}", fmt::join(type_densities, ", "));
}

double Exported::largest_radius() const {
  return spheres.empty() ? 0 : *std::max_element(spheres.r.begin(), spheres.r.end());
}

std::array<bool, 3> Exported::periods() const {
  std::array<bool, 3> all{};
  const std::vector<bool> own = without_walls(domain).periodic;
  std::copy_n(own.begin(), std::min(all.size(), own.size()), all.begin());
  return all;
}

std::string Exported::periods_as(std::string_view yes, std::string_view no, std::string_view between) const {
  const auto periodic = periods();
  const auto word = [&](std::size_t k) { return periodic[k] ? yes : no; };
  return fmt::format("{0}{3}{1}{3}{2}", word(0), word(1), word(2), between);
}

Tilt Exported::tilt() const {
  const auto* box = std::get_if<Box>(&domain);
  return box ? box->tilt : Tilt{};
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

std::string Exported::name_of_type(std::uint32_t type) const {
  return type_count == 1 ? "spheres" : fmt::format("spheres_{}", type);
}

std::string periods_in_python(const Exported& file) {
  return fmt::format("({})", file.periods_as("True", "False", ", "));
}

bool is_plain_word(const std::string& word) {
  return std::ranges::all_of(
      word, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || std::strchr("._-+", c); });
}

std::string as_word(const std::string& word) { return is_plain_word(word) ? word : toml_string(word); }

std::string Exported::title() const {
  return fmt::format("bernal {}: {} spheres in a {}, packing fraction {:.6g}", text_of(this_program()),
                     grouped(size()), name_of(domain),
                     packing.packing_fraction() - contacts.change_of_porosity());
}

std::string row_of(const Vector<3>& v, std::string_view between) {
  return fmt::format("{0}{3}{1}{3}{2}", v[0], v[1], v[2], between);
}

std::string filled(std::string_view text,
                   const std::vector<std::pair<std::string_view, std::string>>& values) {
  std::string made;
  for (std::size_t at; (at = text.find('@')) != text.npos;) {
    const std::size_t end = text.find('@', at + 1);
    const auto value = std::ranges::find(values, text.substr(at + 1, end - at - 1),
                                         &std::pair<std::string_view, std::string>::first);
    const bool is_name = end != text.npos && value != values.end();
    made += text.substr(0, at);
    made += is_name ? value->second : "@";
    text.remove_prefix(is_name ? end + 1 : at + 1);
  }
  return made += text;
}

}  // namespace bernal
