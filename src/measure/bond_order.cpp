#include "bernal/measure/bond_order.hpp"

#include "measure/harmonics.hpp"
#include "measure/touching.hpp"

namespace bernal {
namespace {

/// q of every sphere: the sum over its bonds at unit length, zero without bonds.
std::vector<Harmonics6> orders_of(std::size_t spheres, const std::vector<NearBond>& bonds) {
  std::vector<Harmonics6> orders(spheres, Harmonics6::Zero());
  for (const NearBond& bond : bonds) {
    if (bond.displacement.isZero(0)) continue;  // centres that coincide show no direction
    const Harmonics6 h = harmonics6(bond.displacement.normalized());
    orders[bond.first] += h;
    orders[bond.second] += h;
  }
  for (Harmonics6& q : orders) q.normalize();
  return orders;
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

std::vector<Bonds> solid_bonds(const Spheres<dynamic>& spheres, const Domain& domain) {
  const std::vector<NearBond> bonds = near_bonds(spheres, domain, BondOrder::widest_gap);
  const std::vector<Harmonics6> orders = orders_of(spheres.size(), bonds);
  std::vector<Bonds> found(spheres.size());
  for (const NearBond& bond : bonds) {
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
  const std::vector<Bonds> bonds = solid_bonds(spheres, domain);
  BondOrder order;
  if (!regions.empty()) order.near_wall = order.core = BondOrder::Count{};
  for (std::size_t i = 0; i < bonds.size(); ++i) {
    const auto count = [&](BondOrder::Count& where) {
      ++where.spheres;
      where.crystalline += bonds[i].crystalline();
    };
    count(order.all);
    if (regions.empty()) continue;
    if (regions[i] == Region::near_wall) count(*order.near_wall);
    if (regions[i] == Region::core) count(*order.core);
  }
  return order;
}

}  // namespace bernal
