#include "mesh_files/named_walls.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/core/quantity.hpp"
#include "bernal/core/text.hpp"
#include "cad/repair/plane_cut.hpp"

namespace bernal {
namespace {

constexpr double share_of_diagonal = 1e-6;

struct NamedPlane {
  std::string name;
  cad::CutPlane plane;
};

[[noreturn]] void refuse_patches(const std::string& why) { throw Error(ErrorCode::bad_argument, why); }

std::string in_lower_case(std::string_view name) {
  std::string made(name);
  for (char& c : made)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return made;
}

/// Programs such as Abaqus tell names apart without regard to case, and nodes from elements not at all.
void require_name(std::string_view given) {
  constexpr std::size_t longest = 60;
  static constexpr std::array<std::string_view, 16> taken = {
      "all",   "fluid", "spheres", "bridges", "necks",   "caps",    "side",    "walls",
      "floor", "lid",   "x_lower", "x_upper", "y_lower", "y_upper", "z_lower", "z_upper"};
  const std::string name = in_lower_case(given);
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || c == '_'; };
  const auto is_of_word = [&](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '-'; };
  if (name.empty() || name.size() > longest || !is_letter(name.front()) ||
      !std::ranges::all_of(name, is_of_word))
    refuse_patches(
        fmt::format("a name of ‹patches› is a word that begins with a letter, of at most {} letters, "
                    "digits, _ and -, not \"{}\"",
                    longest, plain_text(given)));
  const auto begins = [&](const char* with) { return name.starts_with(with); };
  if (std::ranges::find(taken, name) != taken.end() ||
      std::ranges::any_of(std::array{"surface_of_", "layer_", "spheres_", "face_"}, begins))
    refuse_patches(
        fmt::format("other parts of meshes are called \"{}\"; give the patch another name", given));
}

std::vector<NamedPlane> planes_in(std::string_view text, Unit unit) {
  std::vector<NamedPlane> planes;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t comma = std::min(text.find(',', from), text.size());
    const std::string_view one = text.substr(from, comma - from);
    from = comma + 1;
    const std::size_t colon = one.find(':');
    if (colon == std::string_view::npos || one.find_first_of("<>") != std::string_view::npos)
      refuse_patches(
          fmt::format("‹patches› takes names and planes such as \"inlet: z = 0, outlet: z = 40\", not \"{}\"",
                      plain_text(text)));
    const std::string_view name = trimmed(one.substr(0, colon));
    require_name(name);
    for (const NamedPlane& other : planes)
      if (other.name != name && in_lower_case(other.name) == in_lower_case(name))
        refuse_patches(
            fmt::format("the names {} and {} of ‹patches› differ in case alone", other.name, name));
    const std::string plane(trimmed(one.substr(colon + 1)));
    planes.push_back({std::string(name), cad::plane_in(without_unit(plane, unit))});
    planes.back().plane.text = plane;
  }
  return planes;
}

/// Of the corners of a patch the least and the largest height above a plane.
struct Heights {
  double least = std::numeric_limits<double>::infinity();
  double largest = -std::numeric_limits<double>::infinity();
};

std::vector<Heights> heights_above(const ConformingSurface& surface, const cad::CutPlane& plane) {
  std::vector<Heights> of(surface.patches.size());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    if (surface.patches[surface.patch[t]].kind != SurfacePatch::Kind::wall) continue;
    Heights& heights = of[surface.patch[t]];
    for (const std::uint32_t corner : surface.triangles[t]) {
      const double height = plane.height(surface.vertices[corner]);
      heights.least = std::min(heights.least, height);
      heights.largest = std::max(heights.largest, height);
    }
  }
  return of;
}

double diagonal_of(const ConformingSurface& surface) {
  Bounds<3> bounds = Bounds<3>::of_nothing();
  for (const Vector<3>& p : surface.vertices) bounds.add(p);
  return bounds.diagonal();
}

}  // namespace

void name_walls(ConformingSurface& surface, std::string_view text, Unit unit) {
  const double tolerance = share_of_diagonal * diagonal_of(surface);
  for (const NamedPlane& named : planes_in(text, unit)) {
    double nearest = std::numeric_limits<double>::infinity();  // of parallel walls that are not in the plane
    bool is_found = false;
    const std::vector<Heights> heights = heights_above(surface, named.plane);
    for (std::size_t p = 0; p < heights.size(); ++p) {
      const auto& [least, largest] = heights[p];
      if (!(largest - least <= 2 * tolerance)) continue;
      if (std::abs(least) <= tolerance && std::abs(largest) <= tolerance) {
        std::string& name = surface.patches[p].name;
        if (!name.empty() && name != named.name)
          refuse_patches(fmt::format("the patches {} and {} name the same wall", name, named.name));
        name = named.name;
        is_found = true;
      } else if (std::abs(least) < std::abs(nearest)) {
        nearest = least;
      }
    }
    if (is_found) continue;
    refuse_patches(fmt::format(
        "no flat wall lies in the plane \"{}\" of the patch {}; {}", plain_text(named.plane.text), named.name,
        std::isfinite(nearest)
            ? fmt::format("the nearest parallel one is {:.6g} off it, {} its normal", std::abs(nearest),
                          nearest > 0 ? "along" : "against")
            : std::string("no flat wall is parallel to it, and ends of periods have names of their own")));
  }
}

}  // namespace bernal
