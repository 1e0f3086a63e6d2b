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

/// How what is stuck is stirred, and for how long.
struct Stirring {
  double patience;           ///< so often in a row it may leave the spheres no freer than before
  double hopeless_patience;  ///< and this often while there are so many too many that it is of no use
  int failures_a_burst;      ///< of attempts in a row that fail one in so many is followed by a burst
  std::function<void()> milestone;
  std::function<bool()> is_over;                                 ///< asked between two attempts
  double most_sweeps = std::numeric_limits<double>::infinity();  ///< and within each
  std::function<bool()> is_free = [] { return true; };  ///< for certain, as far as the engine can tell
  Checkpoints* checkpoints = nullptr;
};

/// What is taken out where not all spheres find room, in mean squeezes times spheres; and the factor from one
/// time to the next.
inline constexpr double taken_out = 0.7, taken_out_faster = 1.25;

/// Spheres that overlap in a domain of fixed size, and what can be done about that. The ground they stand on,
/// a container or a box, knows the engine that pushes them apart, and the holes between them.
///
/// They are relaxed with radii that are larger than asked for by the share `margin`; they count as free of
/// overlap when the largest overlap ratio has fallen below nearly all of it, so that the radii that were
/// asked for touch nothing.
template <class Ground>
class Crowd {
 public:
  static constexpr int D = Ground::dimension;
  /// Precondition: there are spheres, with centres where the ground wants them.
  Crowd(Ground ground, Spheres<D> spheres);

  /// Where they were at the end of the last `settle`, with the radii as given.
  const Spheres<D>& spheres() const { return spheres_; }
  std::size_t size() const { return spheres_.size(); }

  /// Sweeps until the spheres are free of overlap, `converged`, or hardly get any freer, `full`, or there
  /// have been more than `most_sweeps` in all, `hit_limit`. `milestone` is called now and then.
  StageEnd settle(const Monitor& monitor, const std::function<void()>& milestone = {},
                  double most_sweeps = std::numeric_limits<double>::infinity());

  /// Settles and stirs again and again, until the spheres are free of overlap, it does not help any more, or
  /// it is over.
  StageEnd relax(const Stirring& how, const Monitor& monitor, Random& random);

  /// Exchanges sizes once, by steps of that length, and sweeps. Returns `energy_of` the spheres.
  double exchange(SizeExchange& sizes, double step);

  /// Sweeps with larger radii for a while and then goes back, which shakes what is stuck out of its place.
  void burst();

  /// Puts the share of the spheres that are squeezed most, and all that are squeezed severely, into the
  /// largest holes, the largest first.
  void relocate(double share, Random& random);

  /// Takes away the last `count` spheres, at least one and never all, and puts as many that are squeezed most
  /// into holes: so the places that become empty are those where there is least room.
  void drop_last(double count, Random& random);

  /// Takes away the last `count` spheres, at least one and never all, and empties as many places, those that
  /// are squeezed most: the others are dealt out to the places that are left in the order of the radii, so
  /// that hardly any becomes another by more than a trifle.
  void drop_last_dealing(double count);

  /// Adds spheres in the largest holes, if there are holes for all.
  bool add(std::span<const double> radii, Random& random);

  /// Puts everything back to where `spheres` are: fewer, perhaps.
  void restore(Spheres<D> spheres);

  /// Of the spheres as they are relaxed, which are a little larger than asked for.
  double largest_overlap() const { return largest_overlap_; }
  bool is_free() const;
  /// How far that is from 1 to where the spheres are free.
  double done() const { return std::log(largest_overlap_) / std::log(ground_.margin()); }
  /// Mean over the spheres of the root of the sum of their squared overlap ratios.
  double mean_squeeze() const { return mean_squeeze_; }

  double sweeps() const { return sweeps_; }
  Effect lists_built() const { return ground_.lists_built(); }

  /// All of its state, on the same ground; spheres are those that it had last.
  void archive(Archive& a) {
    a(spheres_, squeeze_, largest_overlap_, mean_squeeze_, severe_, sweeps_);
    if (a.reads()) ground_.place(spheres_);
    a(ground_);
  }

 private:
  /// How far `settle` has come.
  struct Settling {
    using ArchivedAsBytes = void;
    int slow = 0;    // looks in a row that found them hardly freer
    int sweeps = 0;  // since the last look
    double least_squeeze = 1e300;
  };
  StageEnd settle(Settling& so_far, const std::function<bool()>& stop, const std::function<void()>& milestone,
                  double most_sweeps);
  void measure();
  std::vector<std::uint32_t> most_squeezed(std::size_t count) const;

  const Made made_{"relaxation"};
  Ground ground_;
  Spheres<D> spheres_;
  std::vector<float> squeeze_;  // of each sphere the sum of its squared overlap ratios, when last measured
  double largest_overlap_ = 1, mean_squeeze_ = 1;
  std::size_t severe_ = 0;  // so many overlap so much that they will not find a place by themselves
  double sweeps_ = 0;
};

using CrowdInContainer = Crowd<ContainerGround>;
template <int D>
using CrowdInBox = Crowd<BoxGround<D>>;

}  // namespace bernal
