#pragma once
#include <cstdint>
#include <utility>
#include <vector>

namespace bernal {

/// Redistributes the sizes of spheres that push each other, a little at a time: a sphere that is squeezed
/// more than others of its size becomes smaller, one that is squeezed less becomes larger. The set of sizes
/// stays the same, by construction.
///
/// P_i, the sum of the forces on sphere i, is the derivative of the energy of the overlaps by its radius, and
/// p_i = P_i / r_i^(D - 1) a pressure. Sphere i wishes for ln r_i - step (p_i / <p> - 1) as the logarithm of
/// its radius. The given sizes, ascending, are assigned in the order of the wishes.
///
/// Sources: Berthier, Coslovich, Ninarello & Ozawa, Phys. Rev. Lett. 116, 238002 (2016): exchange of sizes
/// makes denser disordered packings. Brito, Lerner & Wyart, Phys. Rev. X 8, 031050 (2018), and Kapteijns, Ji,
/// Brito, Wyart & Lerner, Phys. Rev. E 99, 012106 (2019): radii as degrees of freedom that lower the energy.
class SizeExchange {
 public:
  /// The largest step, in ln r, from one size to the next that an exchange can cross.
  static constexpr double longest_way = 0.03;

  SizeExchange(const std::vector<double>& radii, int dimension);

  /// Standard deviation of ln r among sizes that exchanges can reach from each other; 0 if none can.
  double spread() const { return spread_; }
  bool is_of_use() const { return spread_ > 0; }

  /// Takes P_i of each sphere and returns the permutation `to`: sphere to[i] takes the place of sphere i. It
  /// is valid until the next call. Precondition: is_of_use(). Cost: O(N), some 20 ns a sphere.
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

/// The factor by which exchange increases the packing fraction, for sizes with this `spread`. Fitted to boxes
/// of 3,000 and 10,000 lognormal spheres with sigma from 0.01 to 0.7, to within 0.01, and to containers of
/// 250 to 9,000 spheres with sigma 0.2 and 0.3, to within 0.02. Walls add to the gain.
double gain_by_exchange(double spread, bool has_walls);

/// The number of exchanges that anneal a packing, and of sweeps before each. Three times as many exchanges
/// add 0.001 to 0.002 to the packing fraction.
inline constexpr int exchanges = 6000, sweeps_an_exchange = 5, exchanges_a_milestone = 50;
/// The step of an exchange when the share `done` of them is over. Long steps at first agitate the spheres,
/// which finds denser packings; short ones later settle them.
double exchange_step(double done);
/// While sizes are exchanged, `energy_of` the spheres is kept at about `crowding`: below it the packing
/// fraction is multiplied by `compression`.
inline constexpr double crowding = 2e-5, compression = 1.0015;
/// The mean over the spheres of half the sum of their squared overlap ratios. Precondition: there are
/// spheres.
double energy_of(const std::vector<float>& squeeze);

}  // namespace bernal
