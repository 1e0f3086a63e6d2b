#include "cad/repair/interior.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <ranges>

#include "bernal/core/error.hpp"
#include "cad/diagnose/counted.hpp"
#include "cad/repair/hollows.hpp"
#include "cad/repair/plane_hollows.hpp"
#include "cad/repair/surface_pieces.hpp"
#include "cad/repair/surroundings.hpp"
#include "geometry/changes.hpp"
#include "geometry/measures.hpp"
#include "geometry/topology.hpp"

namespace bernal::cad {
namespace {

using Planes = std::vector<CutPlane>;

[[noreturn]] void refuse(const std::string& why) { throw Error(ErrorCode::bad_mesh, why); }

std::string text_of(const Vector<3>& p) { return fmt::format("({:g}, {:g}, {:g})", p[0], p[1], p[2]); }

bool is_closed(const Mesh& mesh) { return topology_of(mesh).closed(); }

/// `idle`: a caution for each plane that a closed surface lies on one side of, as a whole.
Mesh cut_by(Mesh mesh, const Planes& planes, double tolerance, std::vector<std::string>* idle = nullptr) {
  for (const CutPlane& plane : planes) {
    Mesh rest = cut(mesh, plane, tolerance);
    if (idle && rest.triangles == mesh.triangles)
      idle->push_back(fmt::format(
          "the plane \"{}\" cuts nothing off: the surface is closed, and all of it lies on one side",
          plane.text));
    mesh = std::move(rest);
  }
  return mesh;
}

CutPlane across(int axis, double level, bool upper_stays) {
  CutPlane plane;
  plane.normal = Vector<3>::Unit(axis);
  plane.offset = level;
  plane.text = fmt::format("{} = {:.6g}", "xyz"[axis], level);
  return upper_stays ? plane.turned() : plane;
}

/// Every choice of the planes' open sides, the one with all smaller values first.
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

std::string planes_text(const Planes& planes) {
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

/// The largest hollow that is closed when the surroundings end at the solid's own bounds, on as few sides as
/// possible.
std::optional<ChosenInterior> within_bounds(const Surroundings& around, const Mesh& solid,
                                            const Planes& planes, double tolerance, const Vector<3>* point) {
  const Bounds<3> bounds = bounds_of(solid);
  Planes sides;
  for (int axis = 0; axis < 3; ++axis) {
    sides.push_back(across(axis, bounds.lower[axis], true));
    sides.push_back(across(axis, bounds.upper[axis], false));
  }
  std::vector<unsigned> subsets(1U << sides.size());
  std::iota(subsets.begin(), subsets.end(), 0U);
  std::ranges::stable_sort(subsets, {}, [](unsigned subset) { return std::popcount(subset); });
  constexpr int most_sides = 4;  // a hollow is open on fewer sides
  for (const unsigned subset : subsets) {
    if (std::popcount(subset) > most_sides) break;
    Planes all = planes;
    for (std::size_t k = 0; k < sides.size(); ++k)
      if ((subset >> k & 1) != 0) all.push_back(sides[k]);
    try {
      auto spaces = around.closed_off(all, tolerance, point ? 0 : around.crevice(), point);
      if (!spaces.empty())
        return ChosenInterior{std::move(spaces.front().walls), {"the hollow, " + planes_text(all)}};
    } catch (const Error&) {  // one of the sides touches an earlier cut
    }
  }
  return std::nullopt;
}

/// A candidate for the chosen hollow.
struct Candidate {
  Mesh walls;
  double volume, openness;
  std::string words;  ///< how it is closed
  Vector<3> inside;   ///< a point inside
  bool is_void = false, is_flat = true;

  /// The volume that can be filled: less if its opening is as wide as a dish's.
  double size() const { return volume * std::clamp(1 / openness - 1, 0.01, 1.0); }
  double weight() const { return volume * (1 / openness - 1); }
};

std::string words_of_lids(std::vector<Vector<3>> lids) {
  constexpr std::size_t most_listed = 4;
  const std::size_t openings = lids.size();
  std::vector<std::string> places;
  for (const Vector<3>& lid : lids | std::views::take(most_listed)) places.push_back(text_of(lid));
  return fmt::format("closed across {} at {}{}",
                     openings == 1 ? "its opening" : counted(openings, "", "openings"),
                     fmt::join(places, ", "), openings > most_listed ? ", ..." : "");
}

Mesh without_voids(const Mesh& solid) {
  const SurfacePieces pieces(solid);
  Mesh outside{solid.vertices, {}};
  for (std::size_t t = 0; t < solid.triangles.size(); ++t)
    if (pieces.depth(pieces.piece_of(t)) == 0) outside.triangles.push_back(solid.triangles[t]);
  drop_unused_vertices(outside);
  return outside;
}

/// The open hollows of a solid, each once: closed across its openings, or by one plane. A planar lid is
/// reliable; another may have been drawn up by what is on the brim, or across a step in it; then the hollow
/// that one plane closes is taken, unless it is much smaller.
std::vector<Candidate> open_hollows(const Mesh& solid, double tolerance) {
  std::vector<Candidate> below_planes, all;
  for (PlaneHollow& hollow : hollows_below_planes(without_voids(solid), tolerance))
    below_planes.push_back({std::move(hollow.space.walls), hollow.space.volume, hollow.openness,
                            planes_text({hollow.brim}), hollow.inside});
  std::vector<bool> is_taken(below_planes.size(), false), is_chosen(below_planes.size(), false);
  std::vector<Hollow> hollows = hollows_of(solid, tolerance);
  if (hollows.empty() && below_planes.empty())
    if (std::optional<Hollow> ring = hollow_of_shell(solid, tolerance)) hollows.push_back(std::move(*ring));
  for (Hollow& hollow : hollows) {
    const TriangleTree tree(hollow.walls);
    const std::optional<Vector<3>> inside = point_within(hollow.walls, tree);
    if (!inside) continue;
    Candidate own{std::move(hollow.walls), hollow.volume, hollow.openness, words_of_lids(hollow.lids),
                  *inside};
    own.is_flat = hollow.is_flat;
    std::optional<std::size_t> same;  // the largest of those that overlap it
    for (std::size_t k = 0; k < below_planes.size(); ++k) {
      const bool overlap = tree.crossing(below_planes[k].inside, 0, endless) == Crossing::odd ||
                           TriangleTree(below_planes[k].walls).crossing(*inside, 0, endless) == Crossing::odd;
      if (overlap && !same) same = k;
      if (overlap) is_taken[k] = true;
    }
    constexpr double as_much = 0.5, hardly = 0.01;
    if (same && is_chosen[*same]) continue;
    if (same) {
      Candidate& other = below_planes[*same];
      const bool is_larger = other.volume > (1 + hardly) * own.volume;
      const bool is_rather = other.volume >= as_much * own.volume || other.weight() >= own.weight();
      is_chosen[*same] = is_larger || (!own.is_flat && is_rather);
      if (is_chosen[*same]) own = other;
    }
    all.push_back(std::move(own));
  }
  for (std::size_t k = 0; k < below_planes.size(); ++k)
    if (!is_taken[k]) all.push_back(std::move(below_planes[k]));
  std::ranges::stable_sort(all, std::greater<>(), &Candidate::size);
  return all;
}

/// An error in one line that lists the candidates and how to choose each.
[[noreturn]] void refuse_choice(const std::vector<Candidate>& all) {
  constexpr std::size_t most = 4;
  std::vector<std::string> words;
  for (const Candidate& one : all | std::views::take(most))
    words.push_back(fmt::format("one of volume {:.4g}, {}: interior = [{:.4g}, {:.4g}, {:.4g}]", one.volume,
                                one.words, one.inside[0], one.inside[1], one.inside[2]));
  refuse(fmt::format("the part has {} hollows, and none is clearly the largest; choose by a point: {}{}",
                     all.size(), fmt::join(words, "; "), all.size() > most ? "; ..." : ""));
}

std::string caution_of_lids(const Candidate& one) {
  return fmt::format(
      "the hollow is {}, and not all its lids are planar: something on a brim, or a step in it, may have "
      "drawn them up; if so, close it by \"cap\", a plane",
      one.words);
}

std::string left_out(std::size_t hollows) {
  return fmt::format("{} left out; a point in \"interior\" chooses one",
                     counted(hollows, "lesser hollow is", "lesser hollows are"));
}

/// Without planes: the largest among the voids of a solid and its fillable open hollows, with any of equal
/// size. A void beside a hollow that is not much smaller cannot be filled: it is a void in a wall. Throws if
/// another candidate is nearly as large.
std::optional<ChosenInterior> hollow_without_planes(const Surroundings& around, const Mesh& solid,
                                                    double tolerance, const Vector<3>* point) {
  constexpr double alike = 0.95, clearly = 0.5, dent = 0.02;
  const std::vector<Space> voids = around.closed_off({}, tolerance, 0, point);
  if (point && !voids.empty()) return ChosenInterior{walls_of(voids), {"the voids of the solid"}};
  std::vector<Candidate> open = open_hollows(solid, tolerance);
  if (point) {
    for (Candidate& one : open)
      if (SurfacePieces(one.walls).around(*point) != no_index)
        return ChosenInterior{std::move(one.walls),
                              {"the hollow, " + one.words},
                              one.is_flat ? std::vector<std::string>() : std::vector{caution_of_lids(one)}};
    return std::nullopt;
  }
  double in_voids = 0;
  for (const Space& space : voids) in_voids += space.volume;
  if (in_voids > 0 && (open.empty() || open.front().size() < dent * in_voids)) {
    ChosenInterior chosen{walls_of(voids), {"the voids of the solid"}};
    if (!open.empty()) chosen.notes.push_back(left_out(open.size()));
    return chosen;
  }
  if (open.empty()) return std::nullopt;
  const double largest = open.front().size();
  const auto first_lesser =
      std::ranges::find_if(open, [&](const Candidate& one) { return one.size() < alike * largest; });
  const bool is_clear = first_lesser == open.end() || first_lesser->size() < clearly * largest;
  if (!is_clear || clearly * in_voids > largest) {
    for (const Space& space : voids) {
      const TriangleTree tree(space.walls);
      if (const auto inside = point_within(space.walls, tree))
        open.push_back({space.walls, space.volume, 0, "closed all around", *inside});
    }
    std::ranges::stable_sort(open, std::greater<>(), &Candidate::volume);
    refuse_choice(open);
  }
  ChosenInterior chosen;
  std::vector<std::string> words;
  for (auto one = open.begin(); one != first_lesser; ++one) {
    append(chosen.mesh, one->walls);
    words.push_back(one->words);
    if (!one->is_flat) chosen.cautions.push_back(caution_of_lids(*one));
  }
  constexpr std::size_t most_listed = 4;
  const std::size_t taken = words.size();
  if (taken > most_listed) words.resize(most_listed);
  chosen.notes.push_back(fmt::format("{}, {}{}", taken == 1 ? "the hollow" : counted(taken, "", "hollows"),
                                     fmt::join(words, "; "), taken > most_listed ? "; ..." : ""));
  if (taken < open.size()) chosen.notes.push_back(left_out(open.size() - taken));
  if (in_voids > 0)
    chosen.notes.emplace_back("the voids of the solid are left out; a point in \"interior\" chooses one");
  return chosen;
}

/// A hollow much smaller than the free space within the part's bounds is probably a bolt hole.
void caution_if_small(const Mesh& solid, ChosenInterior& chosen) {
  constexpr double little = 0.01;
  const double free = bounds_of(solid).volume() - std::abs(signed_volume(solid));
  const std::vector<double> volumes = SurfacePieces(chosen.mesh).volumes();
  const double volume = std::accumulate(volumes.begin(), volumes.end(), 0.0);
  if (volume < little * free)
    chosen.cautions.push_back(fmt::format(
        "the hollow is {:.2g} % of the free volume within the part's bounds: if another one is meant, "
        "choose it by a point in \"interior\", or by \"cap\", a plane",
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
    const std::vector<Space> spaces = around.closed_off(choice, tolerance, 0, point);
    if (spaces.empty()) return std::nullopt;
    return ChosenInterior{walls_of(spaces), {"the hollow, " + planes_text(choice)}};
  };
  if (!planes.empty())
    if (auto made = first_of(by_planes)) return std::move(*made);
  const auto in_bounds = [&](const Planes& choice) {
    return within_bounds(around, solid, choice, tolerance, point);
  };
  if (std::optional<ChosenInterior> made = hollow_without_planes(around, solid, tolerance, point)) {
    const auto cut_hollow = [&](const Planes& choice) -> std::optional<ChosenInterior> {
      ChosenInterior rest{cut_by(made->mesh, choice, tolerance), made->notes, {}};
      rest.notes.push_back(planes_text(choice));
      return rest;
    };
    if (planes.empty() && !point) caution_if_small(solid, *made);
    if (planes.empty()) return std::move(*made);
    if (auto rest = first_of(cut_hollow)) return std::move(*rest);
  }
  if (auto made = first_of(in_bounds)) return std::move(*made);
  if (point)
    refuse(
        fmt::format("the point {} of \"interior\" lies in no space that is closed; close it by \"cap\", a "
                    "plane, or move the point",
                    text_of(*point)));
  if (failure && !planes.empty()) throw *failure;
  refuse(
      "the solid has no void and no hollow that can be recognised; close the one that is meant by \"cap\", a "
      "plane");
}

/// What a surface encloses on the planes' sides: the first choice of sides that leaves it closed; else the
/// first that leaves anything.
ChosenInterior enclosed(const Mesh& surface, const Planes& planes, double tolerance) {
  if (planes.empty()) return {surface, {}};
  std::optional<ChosenInterior> open;
  std::optional<Error> failure;
  for (const Planes& choice : choices_of(planes)) {
    try {
      std::vector<std::string> idle;
      Mesh rest = cut_by(surface, choice, tolerance, &idle);
      ChosenInterior made{std::move(rest), {planes_text(choice)}, std::move(idle)};
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
      if (const std::uint32_t piece = pieces.around(*point);
          piece != no_index && pieces.depth(piece) % 2 == 0) {
        std::vector<bool> outermost(pieces.count(), false);
        outermost[piece] = true;
        inside.notes.push_back(fmt::format("the space around {}", text_of(*point)));
        return {pieces.walls_of(outermost), std::move(inside.notes)};
      }
    }
    if (sheet)
      refuse(fmt::format("the point {} of \"interior\" is not in what \"cap\" closes", text_of(*point)));
  }
  // A sheet without thickness has no hollow distinct from what it encloses.
  return sheet ? enclosed(surface, request.planes, tolerance)
               : hollow_of(surface, request.planes, tolerance, point);
}

}  // namespace bernal::cad
