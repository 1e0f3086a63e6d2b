#pragma once
#include <cstdint>
#include <memory>
#include <variant>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "core/archive.hpp"
#include "work/effect_log.hpp"
#include "work/spheres_in_bed.hpp"
#include "work/supply.hpp"
#include "work/task.hpp"

namespace bernal {

/// The spheres of a run while stages give all of them their places at once, in a box that may be scaled:
/// periodic, or between walls along axes.
struct SpheresInBox {
  const Task& task;
  std::shared_ptr<Supply> supply = {};
  /// Radii as drawn, which no stage changes. Centres in [0, edge) once `placed`.
  Spheres<dynamic> spheres = Spheres<dynamic>();
  /// Of each its number in the drawn sequence, ascending.
  std::vector<std::uint32_t> tags = {};
  /// Of the box; before the spheres are placed only its proportions mean something.
  Vector<dynamic> edges = {};
  bool placed = false;
  /// Of the first stage: so many of the first spheres come from a start, with places in a box of these
  /// edges, and some of them may overlap. Once all have places they are `placed`, too.
  std::size_t begun = 0;
  bool may_overlap = false;
  /// Volume of the box that the spheres needed, before it grew to the one that was asked for.
  double needed_volume = 0;

  int dimension() const { return spheres.dimension(); }
  /// The least distance between a sphere and an image of it in the box with these edges, walls aside.
  double shortest_period(const Vector<dynamic>& of_edges) const {
    return bernal::shortest_period(periodic_box(of_edges, {}, task.tilt(of_edges)));
  }
  double volume_of_spheres() const { return volume_of(spheres); }
  /// Of all spheres, whether they have places or not.
  double packing_fraction() const { return volume_of_spheres() / edges.prod(); }
  /// Of those that have places.
  double filled() const { return placed ? packing_fraction() : 0; }

  /// The first `count` of the sequence, without places.
  void begin_with(std::size_t count);
  /// Only the spheres with these numbers are left.
  void leave(const std::vector<std::uint32_t>& numbers);

  /// After the first stage.
  void forget_start() { begun = 0, may_overlap = false; }

  /// What stages leave to each other, besides the spheres.
  void archive_facts(Archive& a) { a(edges, tags, placed, begun, may_overlap, needed_volume); }
};

/// The spheres of a run stand in a bed or in a box; a stage works on one of the two.
using SpheresOfRun = std::variant<SpheresInBed, SpheresInBox>;

/// Those of a box that have places, in a bed of the domain as it is asked for; without those that do not fit.
void stand_in_bed(SpheresOfRun& spheres, EffectLog& effects);
/// In a box, those of a bed; or, where many are missing, all that are wanted, without places.
void stand_in_box(SpheresOfRun& spheres);

inline const std::shared_ptr<Supply>& supply_of(const SpheresOfRun& spheres) {
  return std::visit(
      [](const auto& there) -> const auto& { return there.supply; }, spheres);
}
/// Null where they stand in a box.
inline const Bed* bed_of(const SpheresOfRun& spheres) {
  const auto* in_bed = std::get_if<SpheresInBed>(&spheres);
  return in_bed ? &in_bed->bed() : nullptr;
}

}  // namespace bernal
