#pragma once
#include <cstdint>
#include <utility>
#include <vector>

#include "work/stage_entry.hpp"

namespace bernal {

/// Redistributes the sizes of spheres that push each other, a little at a time: a sphere that is squeezed
/// more than others of its size becomes smaller, one that is squeezed less becomes larger. The set of sizes
/// stays the same, by construction.
///
/// P_i, the sum of the forces on sphere i, is the derivative of the energy of the overlaps by its radius, and
/// p_i = P_i / r_i^(D - 1) a pressure. Sphere i wishes for ln r_i - step (p_i / <p> - 1) as the logarithm of
/// its radius. The given sizes, ascending, are assigned in the order of the wishes.
///
/// A step crosses some per cent, and the sizes of classes may lie farther apart. So classes are widened until
/// they touch, exchange, and are narrowed again slowly, while exchange goes on. Where the gap g in ln r
/// between two classes is at most `farthest`, a part of each next to the gap takes sizes on a straight line
/// in ln r over the rank. What is gained falls with the gap, and to hardly anything at a ratio of 1.25: the
/// last part of the way is one that no exchange can cross.
///
/// Sources: Berthier, Coslovich, Ninarello & Ozawa, Phys. Rev. Lett. 116, 238002 (2016): exchange of sizes
/// makes denser disordered packings. Brito, Lerner & Wyart, Phys. Rev. X 8, 031050 (2018), and Kapteijns, Ji,
/// Brito, Wyart & Lerner, Phys. Rev. E 99, 012106 (2019): radii as degrees of freedom that lower the energy.
class SizeExchange {
 public:
  /// The largest step, in ln r, from one size to the next that an exchange can cross; and the largest between
  /// classes that are widened until it can.
  static constexpr double longest_way = 0.03, farthest = 0.225;

  SizeExchange(const std::vector<double>& radii, int dimension);

  bool is_of_use() const { return spread_ > 0; }
  /// The factor by which exchange increases the packing fraction. Fitted to boxes of 3,000 and 10,000
  /// lognormal spheres with sigma from 0.01 to 0.7, to within 0.01, and to classes from 5 to 20 % apart, to
  /// within 0.01. Walls add to the gain. Beds of few spheres gain less, by as much as some spheres fill, and
  /// classes gain little in a bed: there spheres come and go one at a time, where a box shrinks and grows.
  /// Beds of 130 to 9,000 spheres in balls, cylinders and boxes, lognormal with sigma from 0.01 to 0.3,
  /// classes and mixtures, are met to within 0.03.
  double gain(const WallsAround& around) const;

  /// Makes `radii` those of classes that are widened by this share of the way: 0 are the given ones. Returns
  /// whether engines are to `resize` their spheres: at the first call, and where the share is another one;
  /// never where there are no classes. Cost: O(N).
  bool widen(double share);
  bool is_widened() const { return share_ > 0; }
  /// By sphere, in single precision.
  const std::vector<float>& radii() const { return radii_; }

  /// Takes P_i of each sphere and returns the permutation `to`: sphere to[i] takes the place of sphere i. It
  /// is valid until the next call. Precondition: is_of_use(). Cost: O(N), some 20 ns a sphere.
  const std::vector<std::uint32_t>& deal(const std::vector<float>& forces, double step);

 private:
  using Wish = std::pair<float, std::uint32_t>;
  /// Ranks [first, last) on both sides of a gap.
  struct Bridge {
    std::size_t first, last;
  };
  double log_at(std::size_t rank) const { return static_cast<double>(given_logs_[ascending_[rank]]); }
  void find_classes();
  void set(std::uint32_t sphere, float log_radius);
  void sort_wishes();

  int dimension_;
  std::vector<float> given_, given_logs_, radii_, log_radii_, inverse_areas_;  // by sphere
  std::vector<std::uint32_t> ascending_;                                       // spheres by radius
  double spread_ = 0;       // standard deviation of ln r among sizes that exchanges can reach from each other
  double ease_ = 1;         // share of the gain that gaps leave
  double ease_in_bed_ = 1;  // the same in a bed
  std::vector<Bridge> bridges_;
  double share_ = -1;  // of the widening; negative: `radii` have not been asked for
  std::vector<float> pressures_;
  std::vector<Wish> wishes_, sorted_;
  std::vector<std::uint32_t> to_;
};

/// The number of exchanges that anneal a packing, and of sweeps before each. Three times as many exchanges
/// add 0.001 to 0.002 to the packing fraction.
inline constexpr int exchanges = 6000, sweeps_an_exchange = 5, exchanges_a_milestone = 50;
/// The step of an exchange when the share `done` of them is over. Long steps at first agitate the spheres,
/// which finds denser packings; short ones later settle them.
double exchange_step(double done);
/// How wide classes are then: as wide as they become, over most of the way narrower and narrower, and at last
/// as they are given.
double widening(double done);
/// Above so many times `crowding` spheres whose classes are widened get the room back.
inline constexpr double too_crowded = 4;
/// While sizes are exchanged, `energy_of` the spheres is kept at about `crowding`: below it the packing
/// fraction is multiplied by `compression`.
inline constexpr double crowding = 2e-5, compression = 1.0015;
/// The mean over the spheres of half the sum of their squared overlap ratios. Precondition: there are
/// spheres.
double energy_of(const std::vector<float>& squeeze);

}  // namespace bernal
