#pragma once
#include <functional>
#include <memory>
#include <span>

#include "bernal/core/monitor.hpp"
#include "bernal/core/random.hpp"
#include "bernal/core/spheres.hpp"
#include "bernal/domain/container.hpp"
#include "soft/soft_packing.hpp"
#include "work/places.hpp"

namespace bernal {

/// Spheres that overlap in a container, and what can be done about that.
///
/// They are relaxed with radii that are larger by the share `margin`; they count as free of overlap when the
/// largest overlap ratio has fallen below nearly all of it, so that the radii that were asked for touch
/// nothing.
class Crowd {
 public:
  enum class Rest {
    free,   ///< of overlap
    stuck,  ///< what overlaps has nowhere to go
    cancelled,
  };

  /// Centres are inside the container. Throws Error{bad_scene} where single precision cannot tell the spheres
  /// apart: a container 100,000 times as large as they are.
  Crowd(const Container& container, const Places& places, Spheres<3> spheres);

  const Spheres<3>& spheres() const { return spheres_; }
  std::size_t size() const { return spheres_.size(); }

  /// Sweeps until the spheres are free of overlap or hardly get any freer.
  Rest settle(const Monitor& monitor, const std::function<void()>& milestone);

  /// Sweeps with larger radii for a while and then goes back, which shakes what is stuck out of its place.
  void burst();

  /// Puts the share of the spheres that are squeezed most, and all that are squeezed severely, into the
  /// largest holes where they clear the wall, the largest first.
  void relocate(double share, Random& random);

  /// Takes away the last `count` spheres, and puts as many that are squeezed most into holes: so the places
  /// that become empty are those where there is least room.
  void drop_last(std::size_t count, Random& random);

  /// Adds spheres in the largest holes. Returns how many, which is none if there were not holes for all.
  std::size_t add(std::span<const double> radii, Random& random);

  /// Puts everything back to where `spheres` are: fewer, perhaps.
  void restore(Spheres<3> spheres);

  double largest_overlap() const { return largest_overlap_; }
  /// Mean over the spheres of the root of the sum of their squared overlap ratios.
  double strain() const { return strain_; }
  /// How many spheres overlap so much that they will not find a place by themselves.
  std::size_t severely_squeezed() const { return severe_; }

  std::uint64_t sweeps() const { return sweeps_; }
  std::uint64_t list_builds() const { return list_builds_ + packing_->builds(); }
  std::uint64_t wall_queries() const { return wall_queries_ + packing_->wall_queries(); }

 private:
  void measure();
  void prepare();
  std::size_t probes() const;
  void move_to_holes(std::vector<std::uint32_t> ids, Random& random);

  const Container& container_;
  const Places& places_;
  Spheres<3> spheres_;
  std::unique_ptr<SoftPacking> packing_;
  double margin_ = 1e-4;  // share of the radius; it takes three times as much off the packing fraction
  double largest_overlap_ = 1;
  double strain_ = 1;
  std::size_t severe_ = 0;
  std::uint64_t sweeps_ = 0, list_builds_ = 0, wall_queries_ = 0;
};

}  // namespace bernal
