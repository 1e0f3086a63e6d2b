#include "bernal/measure/contact_list.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "bernal/core/dimension.hpp"
#include "measure/coated.hpp"
#include "measure/touching.hpp"

namespace bernal {
namespace {

ContactList with_columns(int dimension) {
  ContactList list;
  list.normal.resize(static_cast<std::size_t>(dimension));
  list.place.resize(static_cast<std::size_t>(dimension));
  return list;
}

template <class Normal>
void append(ContactList& list, const Spheres<dynamic>& spheres, std::size_t i, std::int64_t j, double gap,
            const Normal& normal) {
  const double away = spheres.r[i] + 0.5 * gap;
  list.i.push_back(static_cast<std::int64_t>(i));
  list.j.push_back(j);
  list.gap.push_back(gap);
  for (std::size_t k = 0; k < list.normal.size(); ++k) {
    const double n = normal[static_cast<int>(k)];
    list.normal[k].push_back(n);
    list.place[k].push_back(spheres.x[k][i] + away * n);
  }
}

template <class T>
void reorder(std::vector<T>& column, const std::vector<std::uint64_t>& order) {
  std::vector<T> ordered;
  ordered.reserve(order.size());
  for (const std::uint64_t k : order) ordered.push_back(column[k]);
  column = std::move(ordered);
}

void sort(ContactList& list) {
  std::vector<std::uint64_t> order(list.size());
  std::iota(order.begin(), order.end(), std::uint64_t{0});
  std::ranges::stable_sort(order, {}, [&](std::uint64_t k) { return std::pair{list.i[k], list.j[k]}; });
  reorder(list.i, order);
  reorder(list.j, order);
  reorder(list.gap, order);
  for (auto* columns : {&list.normal, &list.place})
    for (std::vector<double>& column : *columns) reorder(column, order);
}

}  // namespace

ContactList contact_list(const Spheres<dynamic>& spheres, const Domain& domain,
                         const ContactOptions& options) {
  require_gap_ratio(options.contact_gap);
  const Coated coated(spheres, domain, options);
  ContactList list = with_columns(spheres.dimension());
  with_dimension(spheres.dimension(), EveryDimension{}, [&](auto of_space) {
    constexpr int D = of_space;
    for (const BondIn<D>& bond : bonds_in<D>(*coated.spheres, *coated.domain, options.contact_gap)) {
      const auto [i, j] = std::minmax(bond.first, bond.second);
      const Vector<D> n = bond.displacement.stableNormalized() * (bond.first == i ? 1.0 : -1.0);
      append(list, spheres, i, j, bond.gap * (coated.spheres->r[i] + coated.spheres->r[j]) + options.gap, n);
    }
  });
  for (const WallBond& bond :
       wall_bonds(*coated.spheres, *coated.domain, options.contact_gap, coated.container))
    append(list, spheres, bond.sphere, ContactList::wall,
           bond.gap * coated.spheres->r[bond.sphere] + options.wall_gap, bond.outward);
  sort(list);
  return list;
}

std::vector<std::uint64_t> ContactSums::spheres_by_contacts() const {
  std::vector<std::uint64_t> spheres;
  for (const std::uint32_t contacts : coordination) {
    if (contacts >= spheres.size()) spheres.resize(contacts + 1, 0);
    ++spheres[contacts];
  }
  return spheres;
}

ContactSums contact_sums(const Spheres<dynamic>& spheres, const Domain& domain,
                         const ContactOptions& options) {
  require_gap_ratio(options.contact_gap);
  const Coated coated(spheres, domain, options);
  BondSums sums = bond_sums(*coated.spheres, *coated.domain, options.contact_gap);
  ContactSums found;
  found.coordination = std::move(sums.ends);
  if (sums.pairs == 0) return found;
  sums.products /= static_cast<double>(sums.pairs);
  for (const auto& row : sums.products.rowwise()) found.fabric.emplace_back(row.begin(), row.end());
  return found;
}

}  // namespace bernal
