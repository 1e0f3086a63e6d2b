#pragma once
#include <cstdint>
#include <utility>
#include <vector>

namespace bernal {

/// Spheres that push each other deal the sizes that they have anew among themselves, a little at a time, so
/// that what is squeezed more than others of its size becomes smaller and what is squeezed less becomes
/// larger. The sizes as a whole stay what they are, by construction.
///
/// P_i, the sum of the forces on sphere i, is the derivative of the energy of the overlaps by its radius, and
/// P_i / r_i^(D - 1) a pressure p_i. Each wishes for the radius ln r_i - step (p_i / <p> - 1), and the given
/// sizes, ascending, are dealt out in the order of the wishes.
///
/// Sources: Berthier, Coslovich, Ninarello & Ozawa, Phys. Rev. Lett. 116, 238002 (2016), that exchange of
/// sizes makes denser disordered packings; Brito, Lerner & Wyart, Phys. Rev. X 8, 031050 (2018), and
/// Kapteijns, Ji, Brito, Wyart & Lerner, Phys. Rev. E 99, 012106 (2019), radii as degrees of freedom whose
/// energy falls.
class SizeExchange {
 public:
  /// How far, in logarithms of the radius, a size may be from the next one to be reached at all.
  static constexpr double longest_way = 0.03;

  SizeExchange(const std::vector<double>& radii, int dimension);

  /// Standard deviation of ln r among sizes that can be reached from each other, in steps of up to
  /// `longest_way`; 0 where nothing can be exchanged.
  double spread() const { return spread_; }
  bool is_of_use() const { return spread_ > 0; }

  /// From P_i of each sphere the permutation `to`: sphere to[i] takes the place of sphere i. Valid until the
  /// next call. Cost: O(N), some 20 ns a sphere. Precondition: is_of_use().
  const std::vector<std::uint32_t>& deal(const std::vector<float>& forces, double step);

 private:
  using Wish = std::pair<float, std::uint32_t>;
  void sort_wishes();

  std::vector<float> log_radii_, inverse_areas_;  // by sphere
  std::vector<std::uint32_t> ascending_;          // spheres by radius
  double spread_ = 0;
  std::vector<float> pressures_;
  std::vector<Wish> wishes_, sorted_;
  std::vector<std::uint32_t> to_;
};

/// What exchange makes of the packing fraction that such sizes reach without, as a factor. Fitted to boxes of
/// 3,000 and 10,000 lognormal spheres, sigma from 0.01 to 0.7, which met it within 0.01, and to containers
/// of 250 to 9,000 with sigma 0.2 and 0.3, within 0.02: at walls, too, more is gained.
double gain_by_exchange(double spread, bool has_walls);

/// So many exchanges, each after so many sweeps, anneal a packing: packing fractions grow by 0.001 to 0.002
/// with three times as many.
inline constexpr int exchanges = 6000, sweeps_an_exchange = 5, exchanges_a_milestone = 50;
/// Of an exchange, when the share `done` of them is over: steps that are long at first agitate, which finds
/// denser packings, and short ones settle.
double exchange_step(double done);
/// While sizes are exchanged, spheres are kept so crowded that the mean over them of half the sum of their
/// squared overlap ratios is about this. Below, the packing fraction is raised by `compression`.
inline constexpr double crowding = 2e-5, compression = 1.0015;
/// That mean. Precondition: there are spheres.
double energy_of(const std::vector<float>& squeeze);

}  // namespace bernal
