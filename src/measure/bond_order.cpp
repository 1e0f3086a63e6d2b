#include "bernal/measure/bond_order.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/parallel.hpp"
#include "measure/harmonics.hpp"
#include "measure/touching.hpp"

namespace bernal {
namespace {

/// Harmonics in single precision, to save memory: sums over about ten bonds are accurate to 1e-6.
using Order = Eigen::Matrix<float, 13, 1>;

/// Bonds in groups of parts, for sums over the bonds of each sphere that are computed in threads but in a
/// fixed order. A group owns the spheres from which its bonds were found, and adds to these alone; bonds that
/// end in spheres of other groups are added by those groups afterwards.
class GroupedBonds {
 public:
  GroupedBonds(std::size_t spheres, std::vector<std::vector<NearDirection>> parts)
      : parts_(std::move(parts)),
        groups_(std::clamp<std::size_t>(parts_.size() / parts_a_group, 1, most_groups)),
        group_of_(spheres, 0),
        strays_(groups_ * groups_) {
    parallel_for(groups_, [&](std::size_t g) {
      for_each_in(g,
                  [&](const NearDirection& bond) { group_of_[bond.first] = static_cast<std::uint8_t>(g); });
    });
    parallel_for(groups_, [&](std::size_t g) {
      for_each_in(g, [&](const NearDirection& bond) {
        const std::size_t other = group_of_[bond.second];
        if (other != g) strays_[other * groups_ + g].push_back(&bond);
      });
    });
  }

  /// Calls add(sphere, of(bond)) for both ends of each bond.
  template <class Of, class Add>
  void add_to_both(const Of& of, const Add& add) const {
    parallel_for(groups_, [&](std::size_t g) {
      for_each_in(g, [&](const NearDirection& bond) {
        const auto value = of(bond);
        add(bond.first, value);
        if (group_of_[bond.second] == g) add(bond.second, value);
      });
    });
    parallel_for(groups_, [&](std::size_t g) {
      for (std::size_t from = 0; from < groups_; ++from)
        for (const NearDirection* bond : strays_[g * groups_ + from]) add(bond->second, of(*bond));
    });
  }

 private:
  static constexpr std::size_t parts_a_group = 4, most_groups = 32;

  template <class Visit>
  void for_each_in(std::size_t group, const Visit& visit) const {
    for (std::size_t p = parts_.size() * group / groups_; p < parts_.size() * (group + 1) / groups_; ++p)
      for (const NearDirection& bond : parts_[p]) visit(bond);
  }

  std::vector<std::vector<NearDirection>> parts_;
  std::size_t groups_;
  std::vector<std::uint8_t> group_of_;                     // of spheres
  std::vector<std::vector<const NearDirection*>> strays_;  // by target and source group
};

/// For every sphere the sum over its bonds, zero without bonds, and their number.
struct Sums {
  std::vector<Order> orders;
  std::vector<std::uint32_t> bonds;

  Sums(std::size_t spheres, const GroupedBonds& all) : orders(spheres, Order::Zero()), bonds(spheres, 0) {
    all.add_to_both(
        [](const NearDirection& bond) -> Order {
          if (bond.direction.isZero(0)) return Order::Zero();  // coincident centres have no direction
          return harmonics6(bond.direction.cast<double>()).cast<float>();
        },
        [&](std::uint32_t i, const Order& h) {
          orders[i] += h;
          bonds[i] += !h.isZero(0);
        });
  }
};

/// Mean of q6 over the first `asked` spheres, and its standard error.
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

std::vector<Bonds> solid_bonds(const GroupedBonds& all, std::vector<Order> orders) {
  for (Order& q : orders) q.normalize();
  std::vector<Bonds> found(orders.size());
  all.add_to_both(
      [&](const NearDirection& bond) {
        return orders[bond.first].dot(orders[bond.second]) > BondOrder::solid_bond;
      },
      [&](std::uint32_t i, bool is_solid) { found[i].add(is_solid); });
  return found;
}

}  // namespace

std::optional<BondOrder> bond_order(const Spheres<dynamic>& spheres, const Domain& domain,
                                    std::span<const Region> regions) {
  if (spheres.dimension() != 3) return {};
  BondsInside near = near_directions_inside(
      spheres, domain, BondOrder::widest_gap,
      spheres.size() > BondOrder::most_spheres ? BondOrder::looked_at : spheres.size());
  const std::size_t known = near.ids.empty() ? spheres.size() : near.ids.size();
  const GroupedBonds grouped(known, std::move(near.bonds));
  Sums sums(known, grouped);
  BondOrder order;
  write_mean_q6(sums, near.asked, order);
  const std::vector<Bonds> bonds = solid_bonds(grouped, std::move(sums.orders));
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
