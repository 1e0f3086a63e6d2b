#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "bernal/core/monitor.hpp"
#include "bernal/core/random.hpp"
#include "bernal/core/spheres.hpp"
#include "soft/neighbor_relaxation.hpp"
#include "soft/soft_packing.hpp"

namespace bernal {

/// Spheres that overlap in a periodic box of 1 to 8 dimensions, and what can be done about that. What `Crowd`
/// is in a container.
///
/// They are relaxed with radii that are larger by the share `margin`; they count as free of overlap when the
/// largest overlap ratio has fallen below nearly all of it, so that the radii that were asked for touch
/// nothing.
template <int D>
class PeriodicCrowd {
 public:
  enum class Rest {
    free,   ///< of overlap
    stuck,  ///< what overlaps has nowhere to go
    over,   ///< the limit on sweeps came first
    cancelled,
  };

  /// Centres are in [0, edge), and every edge is at least the largest diameter less what overlap is allowed:
  /// the spheres are relaxed with the share 1 - `allowed` of their radii. Axes with `walls` keep whole
  /// spheres between them; none: empty.
  PeriodicCrowd(Spheres<D> spheres, const Vector<D>& edges, double allowed, std::vector<bool> walls = {});

  /// Where they were at the end of the last `settle`, with the radii as given.
  const Spheres<D>& spheres() const { return spheres_; }
  std::size_t size() const { return spheres_.size(); }

  /// Sweeps until the spheres are free of overlap or hardly get any freer, or there have been more than
  /// `most_sweeps` in all.
  Rest settle(const Monitor& monitor, double most_sweeps);

  /// Sweeps in a smaller box for a while and then goes back, which shakes what is stuck out of its place.
  void burst();

  /// Puts the share of the spheres that are squeezed most, and all that are squeezed severely, into the
  /// largest holes, the largest first.
  void relocate(double share, Random& random);

  /// Takes away the last `count` spheres, and puts as many that are squeezed most into holes: so the places
  /// that become empty are those where there is least room.
  void drop_last(std::size_t count, Random& random);

  /// Of the spheres as they are relaxed, which are a little larger than asked for.
  double largest_overlap() const { return largest_overlap_; }
  /// What these overlap.
  double margin() const { return margin_; }
  /// Mean over the spheres of the root of the sum of their squared overlap ratios.
  double strain() const { return strain_; }
  /// How many spheres overlap so much that they will not find a place by themselves.
  std::size_t severely_squeezed() const { return severe_; }

  double sweeps() const { return sweeps_; }
  std::uint64_t list_builds() const;

 private:
  void prepare();
  void sweep(int times, float omega);
  void measure();
  void read_places();
  void move_to_holes(std::size_t count, Random& random);
  template <class Act>
  auto with_engine(Act&& act) const;

  Spheres<D> spheres_;
  const Vector<D> edges_;
  const double allowed_;
  const std::vector<bool> walls_;
  double margin_;
  std::unique_ptr<SoftPacking> wide_;           // where it can be used; it knows no walls of a periodic box
  std::unique_ptr<NeighborRelaxation<D>> any_;  // elsewhere
  std::vector<float> stress_;
  double largest_overlap_ = 1, strain_ = 1;
  std::size_t severe_ = 0;
  double sweeps_ = 0;
  std::uint64_t list_builds_ = 0;
};

}  // namespace bernal
