#include "bernal/measure/bond_order.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "measure/harmonics.hpp"
#include "measure/touching.hpp"

namespace bernal {
namespace {

/// Harmonics in single precision, of sums over some ten bonds good to 1e-6: half of the memory.
using Order = Eigen::Matrix<float, 13, 1>;
using BondParts = std::vector<std::vector<NearDirection>>;

/// Of every sphere the sum over its bonds, zero without bonds, and how many these are.
struct Sums {
  std::vector<Order> orders;
  std::vector<std::uint32_t> bonds;

  Sums(std::size_t spheres, const BondParts& parts) : orders(spheres, Order::Zero()), bonds(spheres, 0) {
    for (const auto& part : parts)
      for (const NearDirection& bond : part) {
        if (bond.direction.isZero(0)) continue;  // centres that coincide show no direction
        const Order h = harmonics6(bond.direction.cast<double>()).cast<float>();
        for (const std::uint32_t i : {bond.first, bond.second}) {
          orders[i] += h;
          ++bonds[i];
        }
      }
  }
};

/// Mean of q6 of the first so many, and its standard error.
void write_mean_q6(const Sums& sums, std::size_t asked, BondOrder& out) {
  double n = 0, sum = 0, squares = 0;
  for (std::size_t i = 0; i < asked; ++i) {
    if (sums.bonds[i] == 0) continue;
    const double q6 = std::min(1.0, sums.orders[i].cast<double>().norm() / sums.bonds[i]);
    ++n;
    sum += q6;
    squares += q6 * q6;
  }
  if (n == 0) return;
  out.mean_q6 = sum / n;
  out.q6_error = n > 1 ? std::sqrt(std::max(0.0, squares / n - out.mean_q6 * out.mean_q6) / (n - 1)) : 0;
}

struct Bonds {
  std::uint32_t all = 0, solid = 0;

  void add(bool is_solid) {
    ++all;
    solid += is_solid;
  }
  bool crystalline() const {
    return solid >= BondOrder::fewest_solid && solid >= BondOrder::solid_share * all;
  }
};

std::vector<Bonds> solid_bonds(const BondParts& parts, std::vector<Order> orders) {
  for (Order& q : orders) q.normalize();
  std::vector<Bonds> found(orders.size());
  for (const auto& part : parts)
    for (const NearDirection& bond : part) {
      const bool solid = orders[bond.first].dot(orders[bond.second]) > BondOrder::solid_bond;
      found[bond.first].add(solid);
      found[bond.second].add(solid);
    }
  return found;
}

}  // namespace

std::optional<BondOrder> bond_order(const Spheres<dynamic>& spheres, const Domain& domain,
                                    std::span<const Region> regions) {
  if (spheres.dimension() != 3) return {};
  const BondsInside near = near_directions_inside(
      spheres, domain, BondOrder::widest_gap,
      spheres.size() > BondOrder::most_spheres ? BondOrder::looked_at : spheres.size());
  Sums sums(near.ids.empty() ? spheres.size() : near.ids.size(), near.bonds);
  BondOrder order;
  write_mean_q6(sums, near.asked, order);
  const std::vector<Bonds> bonds = solid_bonds(near.bonds, std::move(sums.orders));
  if (!regions.empty()) order.near_wall = order.core = BondOrder::Count{};
  for (std::size_t i = 0; i < near.asked; ++i) {
    const auto count = [&](BondOrder::Count& where) {
      ++where.spheres;
      where.crystalline += bonds[i].crystalline();
    };
    count(order.all);
    if (regions.empty()) continue;
    const Region region = regions[near.ids.empty() ? i : near.ids[i]];
    if (region == Region::near_wall) count(*order.near_wall);
    if (region == Region::core) count(*order.core);
  }
  return order;
}

}  // namespace bernal
