#include "cad/interior.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>

#include "bernal/core/error.hpp"
#include "cad/diagnose_mesh.hpp"
#include "cad/hollows.hpp"
#include "cad/mesh_topology.hpp"
#include "cad/self_intersections.hpp"
#include "cad/surface_pieces.hpp"
#include "cad/triangle_tree.hpp"

namespace bernal::cad {
namespace {

using Planes = std::vector<CutPlane>;

[[noreturn]] void refuse(const std::string& why) { throw Error(ErrorCode::bad_mesh, why); }

std::string text_of(const Vector<3>& p) { return fmt::format("({:g}, {:g}, {:g})", p[0], p[1], p[2]); }

bool is_closed(const Mesh& mesh) { return topology_of(mesh).closed(); }

Mesh cut_by(Mesh mesh, const Planes& planes, double tolerance) {
  for (const CutPlane& plane : planes) mesh = cut(mesh, plane, tolerance);
  return mesh;
}

CutPlane across(int axis, double level, bool upper_stays) {
  CutPlane plane;
  plane.normal = Vector<3>::Unit(axis);
  plane.offset = level;
  plane.text = fmt::format("{} = {:.6g}", "xyz"[axis], level);
  return upper_stays ? plane.turned() : plane;
}

/// The space around a solid, in a box that is larger than it: what planes close off from that box is hollow.
struct Surroundings {
  explicit Surroundings(const Mesh& solid)
      : walls(solid), box(bounds_of_vertices(solid)), tree_of_solid(solid) {
    const Vector<3> margin = Vector<3>::Constant(0.1 * box.diagonal());
    box = {box.lower - margin, box.upper + margin};
    const auto first = static_cast<std::uint32_t>(walls.vertices.size());
    for (unsigned corner = 0; corner < 8; ++corner)
      walls.vertices.emplace_back(corner & 1 ? box.upper[0] : box.lower[0],
                                  corner & 2 ? box.upper[1] : box.lower[1],
                                  corner & 4 ? box.upper[2] : box.lower[2]);
    constexpr std::uint32_t faces[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                                            {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    for (const auto& [a, b, c] : faces) walls.triangles.push_back({first + a, first + b, first + c});
  }

  bool is_on_box(const Vector<3>& p) const {
    return (p.array() == box.lower.array()).any() || (p.array() == box.upper.array()).any();
  }

  /// Whether a piece of what is left of it encloses the solid itself, as where a plane touches a brim and
  /// does
  /// not part what is on both sides of it: asked beside the middle of the piece's largest face.
  bool is_solid(const SurfacePieces& pieces, std::uint32_t piece, const Mesh& mesh) const {
    Vector<3> middle = Vector<3>::Zero(), normal = Vector<3>::Zero();
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      if (pieces.piece_of(t) != piece) continue;
      const auto& [a, b, c] = mesh.triangles[t];
      const Vector<3> two_areas =
          (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]);
      if (two_areas.squaredNorm() <= normal.squaredNorm()) continue;
      normal = two_areas;
      middle = (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3;
    }
    const Vector<3> aside = 1e-6 * box.diagonal() * normal.stableNormalized();
    for (const Vector<3>& p : {Vector<3>(middle + aside), Vector<3>(middle - aside)})
      if (pieces.encloses(piece, p))
        return tree_of_solid.crossing(p, 0, std::numeric_limits<double>::infinity()) == Crossing::odd;
    return true;  // thinner than can be told
  }

  Mesh walls;
  Bounds<3> box;
  TriangleTree tree_of_solid;
};

/// All spaces that the planes close off, those that are no mere crevices, or the largest of these.
enum class Which { all, wide, largest };
/// Of the volume of the box around the solid.
constexpr double crevice = 1e-4;

/// What planes close off around a solid, or of that the space around a point.
std::optional<Mesh> closed_off(const Surroundings& around, const Planes& planes, double tolerance,
                               Which which, const Vector<3>* point) {
  const Mesh mesh = cut_by(around.walls, planes, tolerance);
  if (!is_closed(mesh)) return std::nullopt;
  const SurfacePieces pieces(mesh);
  std::vector<bool> hollow(pieces.count());
  for (std::uint32_t c = 0; c < pieces.count(); ++c) hollow[c] = pieces.depth(c) % 2 == 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const std::uint32_t v : mesh.triangles[t])
      if (around.is_on_box(mesh.vertices[v])) hollow[pieces.piece_of(t)] = false;
  for (std::uint32_t c = 0; c < pieces.count(); ++c)
    if (hollow[c] && around.is_solid(pieces, c, mesh)) hollow[c] = false;
  if (point) {
    const std::uint32_t one = pieces.around(*point);
    if (one == none || !hollow[one]) return std::nullopt;
    hollow.assign(hollow.size(), false);
    hollow[one] = true;
  } else if (which != Which::all) {
    const std::vector<double> volumes = pieces.volumes();
    std::uint32_t largest = none;
    double volume = crevice * around.box.volume();
    for (std::uint32_t c = 0; c < pieces.count(); ++c) {
      if (!hollow[c]) continue;
      const double own = volumes[c];
      hollow[c] = which == Which::wide && own > volume;
      if (which == Which::largest && own > volume) {
        volume = own;
        largest = c;
      }
    }
    if (largest != none) hollow[largest] = true;
  }
  if (std::ranges::find(hollow, true) == hollow.end()) return std::nullopt;
  Mesh walls = pieces.walls_of(hollow);
  if (!planes.empty() && intersects_itself(walls)) return std::nullopt;
  return walls;
}

/// Every choice of the sides that the planes leave open, the one where all smaller values stay first.
std::vector<Planes> choices_of(const Planes& planes) {
  constexpr std::size_t most_open = 6;
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < planes.size(); ++i)
    if (planes[i].side_is_open) open.push_back(i);
  if (open.size() > most_open)
    refuse(fmt::format("more than {} planes with \"=\" in \"cap\"; write < or > for the side that stays",
                       most_open));
  std::vector<Planes> choices;
  for (std::size_t bits = 0; bits < (std::size_t{1} << open.size()); ++bits) {
    choices.push_back(planes);
    for (std::size_t k = 0; k < open.size(); ++k)
      if ((bits >> k & 1) != 0) choices.back()[open[k]] = planes[open[k]].turned();
  }
  return choices;
}

std::string told(const Planes& planes) {
  std::vector<std::string> all;
  for (const CutPlane& plane : planes) {
    std::string text = plane.text;
    for (int k = 0; k < 3; ++k)
      if (std::abs(plane.normal[k]) == plane.normal.norm())
        text = fmt::format("{} = {:.6g} from {}", "xyz"[k], plane.offset / plane.normal[k],
                           plane.normal[k] > 0 ? "above" : "below");
    all.push_back(std::move(text));
  }
  return fmt::format("closed at {}", fmt::join(all, ", "));
}

/// The highest level to which a hollow of a solid can be filled, along z.
std::optional<ChosenInterior> filled_to_the_brim(const Surroundings& around, const Mesh& solid,
                                                 double tolerance, const Vector<3>* point) {
  std::vector<double> heights;
  for (const Vector<3>& v : solid.vertices) heights.push_back(v[2]);
  std::ranges::sort(heights, std::greater<>());
  const auto near = [&](double a, double b) { return a - b <= tolerance; };
  heights.erase(std::unique(heights.begin(), heights.end(), near), heights.end());
  constexpr std::size_t most_levels = 200;
  constexpr double hardly_lower = 1e-3;  // of the way to the next corner
  for (std::size_t i = 0; i + 1 < std::min(heights.size(), most_levels); ++i) {
    // At the corners' own height where the brim is flat, else just below.
    for (const double level : {heights[i], heights[i] - hardly_lower * (heights[i] - heights[i + 1])}) {
      try {
        if (auto mesh = closed_off(around, {across(2, level, false)}, tolerance, Which::wide, point))
          return ChosenInterior{std::move(*mesh),
                                {fmt::format("what is hollow, filled to the highest brim at z = {:.6g}; a "
                                             "hollow that overflows lower is "
                                             "meant by \"solids\" or \"cap\"",
                                             level)}};
      } catch (const Error&) {  // nothing to close at this level
      }
    }
  }
  return std::nullopt;
}

/// The largest hollow that is closed when the solid's surroundings end where it ends itself, on as few sides
/// as will do.
std::optional<ChosenInterior> within_bounds(const Surroundings& around, const Mesh& solid,
                                            const Planes& planes, double tolerance, const Vector<3>* point) {
  const Bounds<3> bounds = bounds_of_vertices(solid);
  Planes sides;
  for (int axis = 0; axis < 3; ++axis) {
    sides.push_back(across(axis, bounds.lower[axis], true));
    sides.push_back(across(axis, bounds.upper[axis], false));
  }
  std::vector<unsigned> subsets(1U << sides.size());
  std::iota(subsets.begin(), subsets.end(), 0U);
  std::ranges::stable_sort(subsets, {}, [](unsigned subset) { return std::popcount(subset); });
  constexpr int most_sides = 4;  // what is left open on more is no hollow
  for (const unsigned subset : subsets) {
    if (std::popcount(subset) > most_sides) break;
    Planes all = planes;
    for (std::size_t k = 0; k < sides.size(); ++k)
      if ((subset >> k & 1) != 0) all.push_back(sides[k]);
    try {
      if (auto mesh = closed_off(around, all, tolerance, Which::largest, point))
        return ChosenInterior{std::move(*mesh), {"the hollow, " + told(all)}};
    } catch (const Error&) {  // one of the sides touches what others have cut
    }
  }
  return std::nullopt;
}

/// The hollows that are open to the outside, each closed across its openings: the one around a point, or all
/// that are no mere dents beside the heaviest one.
std::optional<ChosenInterior> closed_across_openings(const std::vector<Hollow>& hollows,
                                                     const Vector<3>* point) {
  constexpr double as_heavy = 0.2;
  ChosenInterior chosen;
  std::vector<std::string> lids;
  std::size_t taken = 0;
  for (const Hollow& hollow : hollows) {
    const bool is_meant = point ? SurfacePieces(hollow.walls).around(*point) != none
                                : hollow.weight() >= as_heavy * hollows.front().weight();
    if (!is_meant) continue;
    ++taken;
    append(chosen.mesh, hollow.walls);
    for (const Vector<3>& lid : hollow.lids) lids.push_back(text_of(lid));
  }
  if (taken == 0) return std::nullopt;
  constexpr std::size_t most_told = 4;
  const std::size_t openings = lids.size();
  if (openings > most_told) lids.resize(most_told);
  chosen.notes.push_back(fmt::format("{}, closed across {} at {}{}",
                                     taken == 1 ? "the hollow" : counted(taken, "", "hollows"),
                                     openings == 1 ? "its opening" : counted(openings, "", "openings"),
                                     fmt::join(lids, ", "), openings > most_told ? ", ..." : ""));
  if (!point && taken < hollows.size())
    chosen.notes.push_back(
        fmt::format("{} left out, which a point of \"interior\" chooses",
                    counted(hollows.size() - taken, "lesser hollow is", "lesser hollows are")));
  return chosen;
}

/// By all pieces of a surface together, whichever way they are turned.
double enclosed_by(const Mesh& surface) {
  const std::vector<double> volumes = SurfacePieces(surface).volumes();
  return std::accumulate(volumes.begin(), volumes.end(), 0.0);
}

/// Without planes: the voids of a solid or its open hollows, whichever are larger; else what holds water.
std::optional<ChosenInterior> hollow_without_planes(const Surroundings& around, const Mesh& solid,
                                                    const std::vector<Hollow>& hollows, double tolerance,
                                                    const Vector<3>* point) {
  std::optional<Mesh> voids = closed_off(around, {}, tolerance, Which::all, point);
  const double volume = voids ? enclosed_by(*voids) : 0;
  const bool voids_are_larger = hollows.empty() || volume >= hollows.front().volume;
  if (voids && (point || voids_are_larger))
    return ChosenInterior{std::move(*voids), {"the voids of the solid"}};
  if (auto open = closed_across_openings(hollows, point)) {
    if (voids)
      open->notes.emplace_back("the voids of the solid are left out, which a point of \"interior\" chooses");
    return open;
  }
  return filled_to_the_brim(around, solid, tolerance, point);
}

/// A hollow beside which there is much more that is free within the part's bounds may not be the one that is
/// meant: the bore of a pipe that stands higher than the brim of its tank.
void tell_if_little(const Mesh& solid, ChosenInterior& chosen) {
  constexpr double little = 0.1;
  const double free = bounds_of_vertices(solid).volume() - std::abs(volume_of(Domain(solid)));
  const double volume = enclosed_by(chosen.mesh);
  if (volume < little * free)
    chosen.notes.push_back(
        fmt::format("the hollow is {:.2g} % of what is free within the part's bounds: if another one is "
                    "meant, choose it by a point "
                    "of \"interior\", or by \"cap\", a plane",
                    100 * volume / free));
}

ChosenInterior hollow_of(const Mesh& solid, const Planes& planes, double tolerance, const Vector<3>* point) {
  const Surroundings around(solid);
  const std::vector<Planes> choices = choices_of(planes);
  std::optional<Error> failure;
  const auto first_of = [&](const auto& make) -> std::optional<ChosenInterior> {
    for (const Planes& choice : choices) {
      try {
        if (std::optional<ChosenInterior> made = make(choice)) return made;
      } catch (const Error& error) {
        failure = error;
      }
    }
    return std::nullopt;
  };
  const auto by_planes = [&](const Planes& choice) -> std::optional<ChosenInterior> {
    auto mesh = closed_off(around, choice, tolerance, Which::all, point);
    if (!mesh) return std::nullopt;
    return ChosenInterior{std::move(*mesh), {"the hollow, " + told(choice)}};
  };
  if (!planes.empty())
    if (auto made = first_of(by_planes)) return std::move(*made);
  const std::vector<Hollow> hollows = hollows_of(solid, tolerance);
  const auto cut_hollow = [&](const Planes& choice) -> std::optional<ChosenInterior> {
    std::optional<ChosenInterior> open = closed_across_openings(hollows, point);
    if (!open) return std::nullopt;
    open->mesh = cut_by(std::move(open->mesh), choice, tolerance);
    open->notes.push_back(told(choice));
    return open;
  };
  const auto without_planes = [&](const Planes&) {
    return hollow_without_planes(around, solid, hollows, tolerance, point);
  };
  const auto in_bounds = [&](const Planes& choice) {
    return within_bounds(around, solid, choice, tolerance, point);
  };
  if (auto made = planes.empty() ? first_of(without_planes) : first_of(cut_hollow)) {
    if (!point) tell_if_little(solid, *made);
    return std::move(*made);
  }
  if (auto made = first_of(in_bounds)) return std::move(*made);
  if (point)
    refuse(
        fmt::format("the point {} of \"interior\" lies in no space that is closed; close it by \"cap\", a "
                    "plane, or move the point",
                    text_of(*point)));
  if (failure && !planes.empty()) throw *failure;
  refuse(
      "the solid has no void and no hollow that can be told from its wall; close the one that is meant by "
      "\"cap\", a plane");
}

/// What a surface encloses on the planes' sides: the first choice of sides that leaves it closed; else the
/// first that leaves anything.
ChosenInterior enclosed(const Mesh& surface, const Planes& planes, double tolerance) {
  if (planes.empty()) return {surface, {}};
  std::optional<ChosenInterior> open;
  std::optional<Error> failure;
  for (const Planes& choice : choices_of(planes)) {
    try {
      ChosenInterior made{cut_by(surface, choice, tolerance), {told(choice)}};
      if (is_closed(made.mesh)) return made;
      if (!open) open = std::move(made);
    } catch (const Error& error) {
      if (!failure) failure = error;
    }
  }
  if (open) return std::move(*open);
  throw *failure;
}

}  // namespace

ChosenInterior choose_interior(const Mesh& surface, const InteriorRequest& request, double tolerance) {
  const auto* point = std::get_if<Vector<3>>(&request.interior);
  if (!point && std::get<Interior>(request.interior) == Interior::solid)
    return enclosed(surface, request.planes, tolerance);
  const bool sheet = !is_closed(surface);
  if (sheet && request.planes.empty())
    refuse("the surface is open; close it by \"cap\", a plane such as \"z = 1\", where its interior ends");
  if (point) {
    ChosenInterior inside = enclosed(surface, request.planes, tolerance);
    if (is_closed(inside.mesh)) {
      const SurfacePieces pieces(inside.mesh);
      if (const std::uint32_t piece = pieces.around(*point); piece != none && pieces.depth(piece) % 2 == 0) {
        std::vector<bool> outermost(pieces.count(), false);
        outermost[piece] = true;
        inside.notes.push_back(fmt::format("the space around {}", text_of(*point)));
        return {pieces.walls_of(outermost), std::move(inside.notes)};
      }
    }
    if (sheet)
      refuse(fmt::format("the point {} of \"interior\" is not in what \"cap\" closes", text_of(*point)));
  }
  // A sheet without thickness has no hollow beside what it goes round.
  return sheet ? enclosed(surface, request.planes, tolerance)
               : hollow_of(surface, request.planes, tolerance, point);
}

}  // namespace bernal::cad
