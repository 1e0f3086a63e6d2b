#include "plan/places_of_zones.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/cad/read_mesh.hpp"
#include "bernal/plan/plan.hpp"
#include "cad/diagnose/diagnose_mesh.hpp"
#include "cad/repair/obstacles.hpp"
#include "cad/repair/plane_cut.hpp"
#include "cad/repair/surface_pieces.hpp"
#include "domain/flattened.hpp"
#include "geometry/measures.hpp"
#include "plan/part_below.hpp"
#include "scene/zones.hpp"

namespace bernal {
namespace {

using cad::CutPlane;

constexpr double endless = std::numeric_limits<double>::infinity();
/// Less than this share of the container is no overlap of two zones but rounding.
constexpr double negligible_overlap = 1e-9;

[[noreturn]] void refuse(const Zone& zone, std::string_view key, const std::string& why) {
  throw Error(ErrorCode::bad_scene, why, zone.locations.of(key));
}

std::vector<CutPlane> planes_of(const Zone& zone) {
  std::vector<CutPlane> planes;
  for (const std::string& text : zone.place) {
    try {
      planes.push_back(cad::plane_in(text));
    } catch (const Error& error) {
      refuse(zone, "place", error.what());
    }
    if (planes.back().side_is_open)
      refuse(zone, "place",
             fmt::format("\"{}\" does not say on which side the zone lies: write < or >", text));
  }
  return planes;
}

/// Points between two planes across a direction.
struct Interval {
  double lower = -endless, upper = endless;

  bool overlaps(const Interval& other) const {
    return std::max(lower, other.lower) < std::min(upper, other.upper);
  }
};

/// A zone as an interval along a unit vector; nothing where one of its planes lies otherwise, to rounding.
std::optional<Interval> interval_of(const std::vector<CutPlane>& planes, const Vector<3>& along) {
  constexpr double rounding = 1e-12;
  Interval interval;
  for (const CutPlane& plane : planes) {
    const double length = plane.normal.norm();
    if (plane.normal.cross(along).norm() > rounding * length) return {};
    const double at = plane.offset / length;
    if (plane.normal.dot(along) > 0)
      interval.upper = std::min(interval.upper, at);
    else
      interval.lower = std::max(interval.lower, -at);
  }
  return interval;
}

/// What lies between intervals, in their order, from `first.lower` to `first.upper`.
std::vector<Interval> gaps_between(std::vector<Interval> intervals, Interval all) {
  std::ranges::sort(intervals, {}, &Interval::lower);
  std::vector<Interval> gaps;
  for (const Interval& interval : intervals) {
    if (interval.lower > all.lower) gaps.push_back({all.lower, interval.lower});
    all.lower = std::max(all.lower, interval.upper);
  }
  if (all.lower < all.upper) gaps.push_back(all);
  return gaps;
}

void refuse_overlap(const Scene& scene, std::size_t k, std::size_t other) {
  refuse(scene.zones[k], "place",
         fmt::format(
             "the places of {} and {} overlap: give one of them another plane, as in place = [\"z > 10\", "
             "\"z < 20\"]",
             name_of_zone(scene, other), name_of_zone(scene, k)));
}

std::optional<Domain> cut_by(const Domain& domain, const std::vector<CutPlane>& planes) {
  std::optional<Domain> part = domain;
  for (const CutPlane& plane : planes)
    if (part) part = part_below(*part, plane.normal, plane.offset);
  return part;
}

/// Chambers by their size, the largest first; walls and what stands in them.
class ChambersOfMesh {
 public:
  explicit ChambersOfMesh(const Domain& domain) : mesh_(std::get_if<Mesh>(&domain)) {}

  Domain domain_of(const Zone& zone) {
    if (!mesh_) refuse(zone, "chamber", "a \"chamber\" is one of a mesh: give a \"place\"");
    find();
    const auto k = static_cast<std::size_t>(*zone.chamber) - 1;
    if (k >= outermost_.size())
      refuse(zone, "chamber",
             fmt::format("the container has {} closed space{}; bernal inspect counts them", outermost_.size(),
                         outermost_.size() == 1 ? "" : "s"));
    if (!taken_.insert(k).second) refuse(zone, "chamber", "two zones are the same chamber");
    return walls_of(k);
  }
  std::vector<Domain> others() {
    find();
    std::vector<Domain> all;
    for (std::size_t k = 0; k < outermost_.size(); ++k)
      if (!taken_.contains(k)) all.push_back(walls_of(k));
    return all;
  }

 private:
  void find() {
    if (pieces_) return;
    pieces_.emplace(*mesh_);
    const std::vector<double> volumes = pieces_->volumes();
    for (std::uint32_t piece = 0; piece < pieces_->count(); ++piece)
      if (pieces_->depth(piece) % 2 == 0) outermost_.push_back(piece);
    std::ranges::stable_sort(outermost_, std::ranges::greater{},
                             [&](std::uint32_t piece) { return std::abs(volumes[piece]); });
  }
  Domain walls_of(std::size_t k) const {
    std::vector<bool> chosen(pieces_->count(), false);
    chosen[outermost_[k]] = true;
    return pieces_->walls_of(chosen);
  }

  const Mesh* mesh_;
  std::optional<cad::SurfacePieces> pieces_;
  std::vector<std::uint32_t> outermost_;
  std::set<std::size_t> taken_;
};

Domain domain_of_solid(const Scene& scene, const Zone& zone) {
  Scene of = scene_of_zone(scene, zone);
  auto& mesh = std::get<MeshFile>(of.container);
  mesh.solids = zone.solids;
  mesh.sha256.clear();
  try {
    return domain_of(of);
  } catch (const Error& error) {
    refuse(zone, "solid", error.message());
  }
}

/// Zones within surfaces, each taken out of what the others leave of the container.
class SurfacesInContainer {
 public:
  SurfacesInContainer(Scene& scene, const Domain& whole) : scene_(scene), whole_(whole) {}

  Domain domain_of(Zone& zone) {
    Domain domain = read(zone);
    if (rest_.triangles.empty()) {
      if (is_periodic(whole_)) refuse(zone, "mesh", "a \"mesh\" lies in a container without periods");
      rest_ = flattened(whole_, RoundAs::within).mesh;
    }
    const Mesh& surface = std::get<Mesh>(domain);
    const double before = signed_volume(rest_), own = signed_volume(surface);
    const std::string name = zone.mesh->file.filename().string();
    try {
      cad::take_out(rest_, surface, name);
    } catch (const OptionError& error) {
      refuse(zone, "mesh", error.what());
    }
    const double outside = own - (before - signed_volume(rest_));
    if (outside > negligible_overlap * before)
      refuse(
          zone, "mesh",
          fmt::format("{:.3g} % of what is in {} lies outside of the container or in another zone: move or "
                      "cut it in CAD; round walls are flat pieces on their inner side here",
                      100 * outside / own, name));
    return domain;
  }
  Domain rest() {
    cad::Triangles rest{.mesh = std::move(rest_)};
    if (const MeshReport report = cad::diagnose_mesh(rest); !report.usable())
      throw Error(ErrorCode::bad_scene,
                  fmt::format("the surfaces of zones leave walls that spheres cannot be packed between: {}; "
                              "move them a little",
                              fmt::join(report.problems, ", ")),
                  scene_.zones.front().locations.of("mesh"));
    return std::move(rest.mesh);
  }

 private:
  Domain read(Zone& zone) {
    Scene of = scene_of_zone(scene_, zone);
    MeshFile file = *zone.mesh;
    if (const auto* mesh = std::get_if<MeshFile>(&scene_.container)) file.unit = mesh->unit;
    of.container = std::move(file);
    of.container.locations.keys["sha256"] = zone.locations.of("mesh_sha256");
    std::string notes, caution;
    Domain domain = bernal::domain_of(of, notes, caution);
    zone.mesh->sha256 = std::get<MeshFile>(of.container).sha256;
    return domain;
  }

  Scene& scene_;
  const Domain& whole_;
  Mesh rest_;
};

Domain domain_of_place(const Scene& scene, std::size_t k, const Domain& whole) {
  const Zone& zone = scene.zones[k];
  std::optional<Domain> part;
  try {
    part = cut_by(whole, planes_of(zone));
  } catch (const Error& error) {
    if (!error.location().file.empty()) throw;
    refuse(zone, "place", error.message());
  }
  if (!part)
    refuse(zone, "place",
           fmt::format("nothing of the container is in the place of {}", name_of_zone(scene, k)));
  return std::move(*part);
}

/// Throws where one zone, cut by the planes of another, leaves something.
void require_apart(const Scene& scene, const std::vector<PlaceOfZone>& places, double volume) {
  for (std::size_t k = 0; k < places.size(); ++k)
    for (std::size_t other = 0; other < k; ++other) {
      const Zone &a = scene.zones[other], &b = scene.zones[k];
      if (a.place.empty() || b.place.empty()) continue;
      const std::optional<Domain> common = cut_by(places[other].domain, planes_of(b));
      if (common && volume_of(*common) > negligible_overlap * volume) refuse_overlap(scene, k, other);
    }
}

/// Of zones between parallel planes what they leave.
std::vector<Domain> between_zones(const Scene& scene, const Domain& whole) {
  Vector<3> along = Vector<3>::Zero();
  std::vector<Interval> intervals;
  for (const Zone& zone : scene.zones) {
    const std::vector<CutPlane> planes = planes_of(zone);
    if (along.isZero(0)) along = planes.front().normal.normalized();
    const std::optional<Interval> interval = interval_of(planes, along);
    if (!interval)
      refuse(zone, "place",
             "what lies in no zone is not known where their planes are not parallel: leave \"diameter\" and "
             "\"radius\" out of [spheres], or give that a [[zone]]");
    intervals.push_back(*interval);
  }
  std::vector<Domain> pieces;
  for (const Interval& gap : gaps_between(intervals, {})) {
    std::vector<CutPlane> planes;
    if (std::isfinite(gap.upper)) planes.push_back({.normal = along, .offset = gap.upper});
    if (std::isfinite(gap.lower)) planes.push_back({.normal = -along, .offset = -gap.lower});
    if (std::optional<Domain> piece = cut_by(whole, planes)) pieces.push_back(std::move(*piece));
  }
  return pieces;
}

void require_one_kind(const Scene& scene) {
  const auto kind_of = [](const Zone& zone) {
    return zone.mesh ? 3 : !zone.solids.empty() ? 2 : zone.chamber ? 1 : 0;
  };
  for (const Zone& zone : scene.zones)
    if (kind_of(zone) != kind_of(scene.zones.front()))
      refuse(zone, "",
             "zones are all places, all solids, all chambers or all surfaces (\"mesh\") in a container");
}

void require_one_piece(const Scene& scene, std::size_t pieces) {
  if (pieces == 0)
    throw Error(ErrorCode::bad_scene,
                "the zones are all of the container, and nothing is left for the sizes in [spheres]: leave "
                "these out, or make room for them",
                scene.locations.whole);
  const bool is_open = scene.target.is_open() || scene.target.has_packing_fraction();
  if (pieces > 1 && !is_open)
    throw Error(ErrorCode::bad_scene,
                fmt::format("an amount in [spheres] is of what lies in no zone, and that has {} pieces: give "
                            "each a [[zone]]",
                            pieces),
                scene.target.where);
}

}  // namespace

bool has_own_domains(const Scene& scene) {
  return std::ranges::any_of(
      scene.zones, [](const Zone& zone) { return !zone.solids.empty() || zone.chamber || zone.mesh; });
}

std::vector<PlaceOfZone> places_of_zones(Scene& scene, const Domain& whole) {
  require_one_kind(scene);
  const auto rest = static_cast<std::uint32_t>(scene.zones.size());
  std::vector<PlaceOfZone> places;
  ChambersOfMesh chambers(whole);
  SurfacesInContainer surfaces(scene, whole);
  for (std::uint32_t k = 0; k < rest; ++k) {
    Zone& zone = scene.zones[k];
    places.push_back({!zone.solids.empty() ? domain_of_solid(scene, zone)
                      : zone.chamber       ? chambers.domain_of(zone)
                      : zone.mesh          ? surfaces.domain_of(zone)
                                           : domain_of_place(scene, k, whole),
                      k});
  }
  require_apart(scene, places, volume_of(whole));
  if (!scene.draws()) return places;
  std::vector<Domain> others;
  if (scene.zones.front().mesh)
    others.push_back(surfaces.rest());
  else
    others = scene.zones.front().chamber ? chambers.others() : between_zones(scene, whole);
  require_one_piece(scene, others.size());
  for (Domain& piece : others) places.push_back({std::move(piece), rest});
  return places;
}

std::vector<LayerOfZone> layers_of_zones(const Scene& scene, double lowest, double highest) {
  const auto rest = static_cast<std::uint32_t>(scene.zones.size());
  const Vector<3> up = -down_in(scene);
  std::vector<LayerOfZone> layers;
  std::vector<std::pair<Interval, std::uint32_t>> intervals;
  for (std::uint32_t k = 0; k < rest; ++k) {
    const Zone& zone = scene.zones[k];
    if (zone.place.empty()) {
      layers.push_back({k, {}});
      continue;
    }
    const std::optional<Interval> interval = interval_of(planes_of(zone), up);
    if (!interval)
      refuse(zone, "place", "layers of a bed lie one upon the other: give planes across gravity");
    if (interval->upper <= lowest || interval->lower >= highest)
      refuse(zone, "place",
             fmt::format("nothing of the container is in the place of {}", name_of_zone(scene, k)));
    intervals.emplace_back(*interval, k);
  }
  if (!layers.empty() && !intervals.empty())
    refuse(scene.zones[layers.front().sphere_class], "",
           "either all layers of a bed have a \"place\", or none has, and they lie in their order");
  if (intervals.empty()) {
    if (scene.draws()) layers.push_back({rest, {}});
    return layers;
  }
  std::vector<Interval> taken;
  for (const auto& [interval, k] : intervals) taken.push_back(interval);
  const std::vector<Interval> gaps = gaps_between(taken, {lowest, highest});
  if (scene.draws()) {
    require_one_piece(scene, gaps.size());
    for (const Interval& gap : gaps) intervals.emplace_back(gap, rest);
  }
  std::ranges::stable_sort(intervals, {}, [](const auto& interval) { return interval.first.lower; });
  double ground = lowest;
  for (std::size_t n = 0; n < intervals.size(); ++n) {
    const auto& [interval, k] = intervals[n];
    if (n > 0 && interval.overlaps(intervals[n - 1].first)) refuse_overlap(scene, k, intervals[n - 1].second);
    if (interval.lower > ground)
      refuse(
          scene.zones[k], "place",
          fmt::format("nothing lies under {}: give \"diameter\" or \"radius\" in [spheres], or another zone "
                      "below it",
                      name_of_zone(scene, k)));
    ground = std::max(ground, interval.upper);
    const bool has_end = interval.upper < highest;
    layers.push_back({k, has_end ? std::optional(interval.upper - lowest) : std::nullopt});
  }
  return layers;
}

}  // namespace bernal
