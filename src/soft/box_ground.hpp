#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "bernal/core/random.hpp"
#include "bernal/core/spheres.hpp"
#include "soft/soft_engine.hpp"

namespace bernal {

/// What a `Crowd` stands on in a box of 1 to 8 dimensions that repeats itself along all axes or along those
/// without walls. What matters is how distances compare with radii: where spheres are to be larger, the box
/// is smaller.
template <int D>
class BoxGround {
 public:
  static constexpr int dimension = D;
  /// Of the radii, in a burst. Where there are more dimensions to give way in, more helps faster: N = 2,000,
  /// in five dimensions at 0.302 and six at 0.197, 0.4 s and 0.85 s instead of 0.85 s and 1.3 s.
  static constexpr double burst_swelling = D <= 4 ? 1.02 : 1.04;
  static constexpr std::size_t always_stay = 1;

  /// Every edge is at least the largest diameter less what overlap is allowed: the spheres are relaxed with
  /// the share 1 - `allowed` of their radii. Axes with `walls` keep whole spheres between them; none: empty.
  BoxGround(const Vector<D>& edges, double allowed, std::vector<bool> walls = {});

  /// Puts the spheres, with centres in [0, edge), into the engine.
  void place(const Spheres<D>& spheres);
  void read_places(Spheres<D>& spheres) const;

  void sweep(float omega) { engine_->sweep(omega * D / 3); }
  double sweep_and_measure(float omega) { return engine_->sweep_and_measure(omega * D / 3); }
  void wear_lists(double wear) { engine_->wear_lists(wear); }
  std::vector<float> squeeze() const { return engine_->squeeze(); }
  void swell(double factor);
  /// Share of the radii; it takes D times as much off the packing fraction.
  double margin() const { return margin_; }

  /// Puts the spheres `ids` into the largest holes, the largest first.
  void move_to_holes(Spheres<D>& spheres, std::vector<std::uint32_t> ids, Random& random);

  std::uint64_t list_builds() const { return list_builds_ + engine_->builds(); }

 private:
  Vector<D> edges_;
  double allowed_;
  std::vector<bool> walls_;
  double margin_ = 0;
  std::optional<SoftEngine<D>> engine_;
  std::uint64_t list_builds_ = 0;
};

}  // namespace bernal
