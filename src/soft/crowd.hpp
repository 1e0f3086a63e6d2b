#pragma once
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "bernal/core/monitor.hpp"
#include "bernal/core/random.hpp"
#include "bernal/core/spheres.hpp"
#include "core/archive.hpp"
#include "soft/ground.hpp"
#include "soft/size_exchange.hpp"
#include "work/reporter.hpp"

namespace bernal {

/// How spheres that are stuck are stirred, and for how long.
struct Stirring {
  double patience;           ///< this many attempts in a row may fail to reduce the overlaps
  double hopeless_patience;  ///< the same while there are far too many spheres
  int failures_a_burst;      ///< after every so many failures in a row a burst follows
  std::function<void()> milestone;
  std::function<bool()> is_over;                                 ///< called between two attempts
  double most_sweeps = std::numeric_limits<double>::infinity();  ///< the limit within an attempt
  /// Called when the engine finds the spheres free of overlap: whether they are in double precision, too.
  std::function<bool()> is_free = [] { return true; };
  Checkpoints* checkpoints = nullptr;
};

/// The number of spheres to take out if not all find room, over the mean squeeze times the number of spheres;
/// and the factor by which it increases from one time to the next.
inline constexpr double taken_out = 0.7, taken_out_faster = 1.25;

/// Overlapping spheres in a domain of fixed size, and the means to free them of overlap. Their `Ground`, a
/// container or a box, has the engine that pushes them apart, and finds holes between them.
///
/// They are relaxed with radii that are larger by the share `margin` than those asked for. They count as free
/// of overlap when the largest overlap ratio is a little below the margin: then the spheres that were asked
/// for do not touch. Below jamming overlaps decay by a third in some fifty sweeps, so a wide margin saves
/// sweeps as long as there is room for it; `relax` narrows the margin of spheres that are stuck.
template <class Ground>
class Crowd {
 public:
  static constexpr int D = Ground::dimension;
  /// Preconditions: there are spheres; centres are as `Ground::place` needs them.
  Crowd(Ground ground, Spheres<D> spheres);

  /// The spheres at the end of the last `settle`, with the radii that were asked for.
  const Spheres<D>& spheres() const { return spheres_; }
  std::size_t size() const { return spheres_.size(); }

  /// Sweeps until the spheres are free of overlap (`converged`), overlaps hardly decrease any more (`full`),
  /// or the sweeps of this crowd are more than `most_sweeps` (`hit_limit`). Calls `milestone` now and then.
  StageEnd settle(const Monitor& monitor, const std::function<void()>& milestone = {},
                  double most_sweeps = std::numeric_limits<double>::infinity());

  /// Settles and stirs by turns, until the spheres are free of overlap, stirring no longer helps, or
  /// `is_over` says so.
  StageEnd relax(const Stirring& how, const Monitor& monitor, Random& random);

  /// Exchanges sizes once, when the share `done` of all exchanges is over, and sweeps. Returns `energy_of`
  /// the spheres.
  double exchange(SizeExchange& sizes, double done);

  /// Sweeps with larger radii for a while and then goes back to the former: this shakes stuck spheres loose.
  void burst();

  /// Puts the most squeezed spheres, this share of all and every severely squeezed one, into the largest
  /// holes, the largest spheres first.
  void relocate(double share, Random& random);

  /// Takes away the last `count` spheres, at least one and never all, and puts as many of the most squeezed
  /// into holes: so the places with least room become empty.
  void drop_last(double count, Random& random);

  /// Takes away the last `count` spheres, at least one and never all, and empties as many of the most
  /// squeezed places. The other spheres are assigned to the remaining places in the order of the radii, so
  /// that the radius at a place hardly changes.
  void drop_last_dealing(double count);

  /// Adds spheres in the largest holes. Returns false, and adds none, if there are not enough holes.
  bool add(std::span<const double> radii, Random& random);

  /// Takes these spheres, perhaps fewer, in place of the present ones.
  void restore(Spheres<D> spheres);

  /// Of the radii that are relaxed, which are a little larger than those asked for.
  double largest_overlap() const { return largest_overlap_; }
  bool is_free() const;
  /// How far the largest overlap has come from 1, where this is 0, to the margin, where this is 1.
  double done() const { return std::log(largest_overlap_) / std::log(ground_.margin()); }
  /// Mean over the spheres of the root of the sum of their squared overlap ratios.
  double mean_squeeze() const { return mean_squeeze_; }

  double sweeps() const { return sweeps_; }
  Effect lists_built() const { return ground_.lists_built(); }

  /// Writes or reads the state, on the same ground.
  void archive(Archive& a) {
    a(spheres_, squeeze_, largest_overlap_, mean_squeeze_, severe_, sweeps_);
    if (a.reads()) ground_.place(spheres_);
    a(ground_);
  }

 private:
  /// How far `settle` has come.
  struct Settling {
    using ArchivedAsBytes = void;
    int slow = 0;    // looks in a row at which overlaps had hardly decreased
    int sweeps = 0;  // since the last look
    double least_squeeze = 1e300;
  };
  StageEnd settle(Settling& so_far, const std::function<bool()>& stop, const std::function<void()>& milestone,
                  double most_sweeps);
  /// As `pace_for` says of other dimensions than three.
  float over_relaxation(const Pace& pace) const {
    return ground_.policy().omega_at(pace) * static_cast<float>(ground_.axes()) / 3;
  }
  void measure();
  std::vector<std::uint32_t> most_squeezed(std::size_t count) const;

  const Made made_{"relaxation"};
  Ground ground_;
  Spheres<D> spheres_;
  std::vector<float> squeeze_;  // the sum of squared overlap ratios of each sphere, when last measured
  double largest_overlap_ = 1, mean_squeeze_ = 1;
  std::size_t severe_ = 0;  // the number of spheres that overlap too much to find a place by sweeps
  double sweeps_ = 0;
};

using CrowdInContainer = Crowd<ContainerGround>;
template <int D>
using CrowdInBox = Crowd<BoxGround<D>>;

}  // namespace bernal
