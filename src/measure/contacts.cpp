#include "bernal/measure/contacts.hpp"

#include <algorithm>

#include "measure/touching.hpp"

namespace bernal {
namespace {

/// Who touches whom, both ways, in one flat list.
class Neighbours {
 public:
  Neighbours(std::size_t spheres, const std::vector<NearPair>& pairs) : start_(spheres + 1, 0) {
    const auto holds = [](const NearPair& pair) { return pair.first != pair.second; };
    for (const NearPair& pair : pairs) {
      if (!holds(pair)) continue;
      ++start_[pair.first];
      ++start_[pair.second];
    }
    for (std::size_t k = 1; k < start_.size(); ++k) start_[k] += start_[k - 1];
    list_.resize(start_.back());
    for (const NearPair& pair : pairs) {
      if (!holds(pair)) continue;
      list_[--start_[pair.first]] = pair.second;
      list_[--start_[pair.second]] = pair.first;
    }
  }
  std::span<const std::uint32_t> of(std::size_t i) const {
    return {list_.data() + start_[i], list_.data() + start_[i + 1]};
  }

 private:
  std::vector<std::size_t> start_;
  std::vector<std::uint32_t> list_;
};

/// Which spheres are no rattlers. `held` starts as the number of walls that each touches.
std::vector<bool> backbone_of(int dimension, std::vector<int> held, const std::vector<NearPair>& pairs) {
  const int needed = dimension + 1;
  const Neighbours neighbours(held.size(), pairs);
  std::vector<std::uint32_t> loose;
  for (std::uint32_t i = 0; i < held.size(); ++i) {
    held[i] += static_cast<int>(neighbours.of(i).size());
    if (held[i] < needed) loose.push_back(i);
  }
  std::vector<bool> backbone(held.size(), true);
  for (std::size_t k = 0; k < loose.size(); ++k) {
    backbone[loose[k]] = false;
    for (const std::uint32_t j : neighbours.of(loose[k]))
      if (held[j]-- == needed) loose.push_back(j);
  }
  return backbone;
}

Contacts count(std::size_t spheres, const Domain& domain, const std::vector<NearPair>& pairs,
               const std::vector<NearWall>& walls, double contact_gap) {
  const int dimension = dimension_of(domain);
  const auto n = static_cast<double>(spheres);
  std::vector<int> held(spheres, 0);
  for (const NearWall& wall : walls) ++held[wall.sphere];
  const std::vector<bool> backbone = backbone_of(dimension, held, pairs);

  Contacts contacts;
  contacts.contact_gap = contact_gap;
  contacts.pairs = pairs.size();
  contacts.walls = walls.size();
  contacts.coordination = n > 0 ? 2.0 * static_cast<double>(pairs.size()) / n : 0;
  contacts.backbone = static_cast<std::uint64_t>(std::ranges::count(backbone, true));
  contacts.rattlers = spheres - contacts.backbone;
  for (const NearPair& pair : pairs) contacts.backbone_pairs += backbone[pair.first] && backbone[pair.second];
  for (const NearWall& wall : walls) contacts.backbone_walls += backbone[wall.sphere];
  if (contacts.backbone == 0) return contacts;
  contacts.backbone_coordination =
      2.0 * static_cast<double>(contacts.backbone_pairs) / static_cast<double>(contacts.backbone);
  contacts.isostatic = static_cast<std::uint64_t>(dimension) * contacts.backbone + 1 -
                       static_cast<std::uint64_t>(symmetries_of(domain));
  return contacts;
}

}  // namespace

Contacts measure_contacts(const Spheres<dynamic>& spheres, const Domain& domain, double contact_gap) {
  return measure_contacts(spheres, domain, {&contact_gap, 1}).front();
}

std::vector<Contacts> measure_contacts_across(double gap, double wall_gap, const Spheres<dynamic>& spheres,
                                              const Domain& domain, std::span<const double> contact_gaps,
                                              const std::shared_ptr<const Container>& made) {
  if (gap == 0 && wall_gap == 0) return measure_contacts(spheres, domain, contact_gaps, made);
  Spheres<dynamic> with_coats = spheres;
  for (double& r : with_coats.r) r += 0.5 * gap;
  return measure_contacts(with_coats, with_walls_moved(domain, wall_gap - 0.5 * gap), contact_gaps);
}

std::vector<Contacts> measure_contacts(const Spheres<dynamic>& spheres, const Domain& domain,
                                       std::span<const double> contact_gaps,
                                       const std::shared_ptr<const Container>& made) {
  if (contact_gaps.empty()) return {};
  const double widest = std::ranges::max(contact_gaps);
  const std::vector<NearPair> pairs = near_pairs(spheres, domain, widest);
  const std::vector<NearWall> walls = near_walls(spheres, domain, widest, made);
  std::vector<Contacts> all;
  for (const double gap : contact_gaps) {
    const auto touches = [gap](const auto& near) { return near.gap < gap; };
    std::vector<NearPair> touching_pairs;
    std::vector<NearWall> touching_walls;
    std::ranges::copy_if(pairs, std::back_inserter(touching_pairs), touches);
    std::ranges::copy_if(walls, std::back_inserter(touching_walls), touches);
    all.push_back(count(spheres.size(), domain, touching_pairs, touching_walls, gap));
  }
  return all;
}

}  // namespace bernal
