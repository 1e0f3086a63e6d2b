#pragma once
#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "bernal/core/dimension.hpp"
#include "bernal/core/spheres.hpp"
#include "core/archive.hpp"
#include "work/bed.hpp"
#include "work/supply.hpp"
#include "work/task.hpp"

namespace bernal {

template <int D>
double volume_of(const Spheres<D>& spheres) {
  double sum = 0;
  for (const double r : spheres.r) sum += ball_volume(static_cast<int>(spheres.x.size()), r);
  return sum;
}

/// Of the spheres of a bed, which are discs in the plane z = 0 where D is 2, the coordinates that there are.
template <int D>
Spheres<D> along_axes(const Spheres<3>& in_bed) {
  Spheres<D> spheres;
  std::copy_n(in_bed.x.begin(), D, spheres.x.begin());
  spheres.r = in_bed.r;
  return spheres;
}

/// The first of the drawn sequence, in its order, of which some have places.
struct FirstDrawn {
  Spheres<3> spheres;
  std::vector<bool> placed;
  void extend(std::size_t count, const Supply& supply);
};

/// The spheres of a run while they come one after the other into a domain of fixed size with walls.
/// Precondition: the task has a container.
struct SpheresInBed {
  const Task& task;
  std::shared_ptr<Supply> supply;
  /// Of the first stage: so many of the first of the sequence come from a start.
  std::size_t begun = 0;
  /// The start as it is, where not all of it fits.
  Spheres<3> crowded_start = {};

  /// An empty bed.
  SpheresInBed(const Task&, std::shared_ptr<Supply>, EffectLog&);

  Bed& bed() { return *bed_; }
  const Bed& bed() const { return *bed_; }
  void replace_bed(std::unique_ptr<Bed> bed) { bed_ = std::move(bed); }

  /// How many of the sequence fill this share of the container.
  std::size_t count_filling(double packing_fraction) const {
    return supply->count_filling(packing_fraction * task.container->volume());
  }
  /// How many spheres a stage that places what is expected is to place.
  std::size_t target_count() const;
  /// At least `count` of the sequence, and up to the last that stands in the bed; those have places.
  FirstDrawn drawn(std::size_t count) const;
  /// Of spheres of a bed; of discs their area.
  double volume_of(const Spheres<3>& spheres) const;
  /// Of so many of the sequence, or all that stand in the bed if these are more.
  double volume_of_drawn(std::size_t count) const { return volume_of(drawn(count).spheres); }
  /// The roomiest place of the container, as far as it is known. Looked for once.
  const Room& roomiest() const;
  /// Whether the walls leave a sphere of this radius less room than the skin, so that it only fits touching.
  bool is_snug(double r) const { return r + bed().skin() > roomiest().radius; }
  /// Whether a sphere may appear at a place: clear of others by the skin; and of walls, or touching them
  /// exactly if they leave it no other choice.
  bool fits_in_bed(const Vector<3>& place, double r) const;

  /// The first of the sequence in place of all that is in the bed, but for those that do not fit where they
  /// are. Returns whether all do.
  bool put_in_bed(const Spheres<3>& first);
  /// Those that have places, in place of all that is in the bed. Precondition: they fit.
  void put_back(const FirstDrawn&);

  /// After the first stage.
  void forget_start() { begun = 0, crowded_start = {}; }

  /// What stages leave to each other, besides the spheres.
  void archive_facts(Archive& a) { a(begun, crowded_start); }
  /// The spheres that stand in the bed, and those that are still to come.
  void archive_bed(Archive& a, EffectLog& effects);

 private:
  std::unique_ptr<Bed> bed_;
  mutable std::optional<Room> roomiest_ = {};
};

/// The spheres of a bed as they stand before a stage, so that a stage which is cut short takes nothing away
/// from what the ones before it left. Cost: a copy of the spheres.
class BedKeepsake {
 public:
  explicit BedKeepsake(const SpheresInBed& in_bed)
      : packing_fraction_(in_bed.bed().packing_fraction()), spheres_(in_bed.drawn(0)) {}
  BedKeepsake() = default;  ///< to be read from an archive

  double packing_fraction() const { return packing_fraction_; }
  const FirstDrawn& spheres() const { return spheres_; }
  /// Puts everything back if less of the container is filled now.
  void give_back_if_denser(SpheresInBed& in_bed) const {
    if (in_bed.bed().packing_fraction() < packing_fraction_) in_bed.put_back(spheres_);
  }

  void archive(Archive& a) { a(packing_fraction_, spheres_.spheres, spheres_.placed); }

 private:
  double packing_fraction_ = 0;
  FirstDrawn spheres_;
};

}  // namespace bernal
