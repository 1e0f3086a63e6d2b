#include "bernal/measure/contacts.hpp"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "core/parallel.hpp"
#include "measure/coated.hpp"
#include "measure/touching.hpp"

namespace bernal {
namespace {

/// Ranks are stored in a byte.
constexpr std::size_t most_gaps = 256;

/// Neighbours of each sphere, in one flat list, with the rank of each pair; pairs of spheres and their own
/// images are kept apart.
class Neighbours {
 public:
  struct Near {
    std::span<const std::uint32_t> ids;
    std::span<const std::uint8_t> ranks;

    /// Calls visit(id) for neighbours of at most this rank.
    template <class Visit>
    void up_to(std::uint32_t rank, const Visit& visit) const {
      for (std::size_t k = 0; k < ids.size(); ++k)
        if (ranks[k] <= rank) visit(ids[k]);
    }
  };

  /// The parts are freed as they are read.
  Neighbours(std::size_t spheres, std::vector<std::vector<RankedPair>> parts) : start_(spheres + 1, 0) {
    for (const auto& part : parts)
      for (const RankedPair& pair : part) {
        if (pair.first == pair.second) {
          own_.push_back(pair);
          continue;
        }
        ++start_[pair.first];
        ++start_[pair.second];
      }
    for (std::size_t k = 1; k < start_.size(); ++k) start_[k] += start_[k - 1];
    ids_.resize(start_.back());
    ranks_.resize(start_.back());
    for (auto& part : parts) {
      for (const RankedPair& pair : part) {
        if (pair.first == pair.second) continue;
        add(pair.first, pair.second, pair.rank);
        add(pair.second, pair.first, pair.rank);
      }
      part = {};
    }
  }

  Near of(std::size_t i) const {
    return {std::span(ids_).subspan(start_[i], start_[i + 1] - start_[i]),
            std::span(ranks_).subspan(start_[i], start_[i + 1] - start_[i])};
  }
  const std::vector<RankedPair>& own_images() const { return own_; }

 private:
  void add(std::uint32_t of, std::uint32_t id, std::uint32_t rank) {
    ids_[--start_[of]] = id;
    ranks_[start_[of]] = static_cast<std::uint8_t>(rank);
  }

  std::vector<std::size_t> start_;
  std::vector<std::uint32_t> ids_;
  std::vector<std::uint8_t> ranks_;
  std::vector<RankedPair> own_;
};

/// Marks the spheres that are not rattlers, by the pairs up to that rank. `held` is the number of walls that
/// each touches; on return the number of its initial contacts.
std::vector<bool> backbone_of(int dimension, std::vector<std::uint32_t>& held, const Neighbours& neighbours,
                              std::uint32_t rank) {
  const auto needed = static_cast<std::uint32_t>(dimension + 1);
  std::vector<std::uint32_t> loose;
  for (std::uint32_t i = 0; i < held.size(); ++i) {
    neighbours.of(i).up_to(rank, [&](std::uint32_t) { ++held[i]; });
    if (held[i] < needed) loose.push_back(i);
  }
  std::vector<bool> backbone(held.size(), true);
  for (std::size_t k = 0; k < loose.size(); ++k) {
    backbone[loose[k]] = false;
    neighbours.of(loose[k]).up_to(rank, [&](std::uint32_t j) {
      if (held[j]-- == needed) loose.push_back(j);
    });
  }
  return backbone;
}

Contacts count(std::size_t spheres, const Domain& domain, const Neighbours& neighbours, std::uint32_t rank,
               const std::vector<NearWall>& walls, double contact_gap) {
  const int dimension = dimension_of(domain);
  const auto n = static_cast<double>(spheres);
  Contacts contacts;
  contacts.contact_gap = contact_gap;
  std::vector<std::uint32_t> held(spheres, 0);
  for (const NearWall& wall : walls) {
    if (!(wall.gap < contact_gap)) continue;
    ++held[wall.sphere];
    ++contacts.walls;
  }
  const std::vector<bool> backbone = backbone_of(dimension, held, neighbours, rank);

  std::uint64_t ends = 0, backbone_ends = 0;  // ends of pairs, two for each
  for (std::uint32_t i = 0; i < spheres; ++i)
    neighbours.of(i).up_to(rank, [&](std::uint32_t j) {
      ++ends;
      backbone_ends += backbone[i] && backbone[j];
    });
  contacts.pairs = ends / 2;
  contacts.backbone_pairs = backbone_ends / 2;
  for (const RankedPair& pair : neighbours.own_images()) {
    if (pair.rank > rank) continue;
    ++contacts.pairs;
    contacts.backbone_pairs += backbone[pair.first];
  }
  contacts.coordination = n > 0 ? 2.0 * static_cast<double>(contacts.pairs) / n : 0;
  contacts.backbone = static_cast<std::uint64_t>(std::ranges::count(backbone, true));
  contacts.rattlers = spheres - contacts.backbone;
  for (const NearWall& wall : walls)
    contacts.backbone_walls += wall.gap < contact_gap && backbone[wall.sphere];
  if (contacts.backbone == 0) return contacts;
  contacts.backbone_coordination =
      2.0 * static_cast<double>(contacts.backbone_pairs) / static_cast<double>(contacts.backbone);
  contacts.isostatic = static_cast<std::uint64_t>(dimension) * contacts.backbone + 1 -
                       static_cast<std::uint64_t>(symmetries_of(domain));
  return contacts;
}

/// Each gap ratio once.
std::vector<double> ascending_gaps(std::span<const double> contact_gaps) {
  for (const double gap : contact_gaps) require_gap_ratio(gap);
  std::vector<double> ascending(contact_gaps.begin(), contact_gaps.end());
  std::ranges::sort(ascending);
  const auto repeated = std::ranges::unique(ascending);
  ascending.erase(repeated.begin(), repeated.end());
  if (ascending.size() > most_gaps)
    throw Error(ErrorCode::bad_argument, fmt::format("contacts of more than {} gaps at once", most_gaps));
  return ascending;
}

std::uint32_t rank_of(double gap, const std::vector<double>& ascending) {
  return static_cast<std::uint32_t>(std::ranges::lower_bound(ascending, gap) - ascending.begin());
}

}  // namespace

Contacts measure_contacts(const Spheres<dynamic>& spheres, const Domain& domain, double contact_gap) {
  return measure_contacts(spheres, domain, {&contact_gap, 1}).front();
}

std::vector<Contacts> measure_contacts_across(double gap, double wall_gap, const Spheres<dynamic>& spheres,
                                              const Domain& domain, std::span<const double> contact_gaps,
                                              const std::shared_ptr<const Container>& made) {
  const Coated coated(spheres, domain, {.gap = gap, .wall_gap = wall_gap, .container = made});
  return measure_contacts(*coated.spheres, *coated.domain, contact_gaps, coated.container);
}

std::vector<Contacts> measure_contacts(const Spheres<dynamic>& spheres, const Domain& domain,
                                       std::span<const double> contact_gaps,
                                       const std::shared_ptr<const Container>& made) {
  if (contact_gaps.empty()) return {};
  const std::vector<double> ascending = ascending_gaps(contact_gaps);
  const Neighbours neighbours(spheres.size(), ranked_pairs(spheres, domain, ascending));
  const std::vector<NearWall> walls = near_walls(spheres, domain, ascending.back(), made);
  std::vector<Contacts> all(contact_gaps.size());
  parallel_for(all.size(), [&](std::size_t k) {
    const double gap = contact_gaps[k];
    all[k] = count(spheres.size(), domain, neighbours, rank_of(gap, ascending), walls, gap);
  });
  return all;
}

ContactsOfSome contacts_of_some(const std::vector<bool>& counted, double gap, const Spheres<dynamic>& spheres,
                                const Domain& domain, std::span<const double> contact_gaps) {
  ContactsOfSome found;
  if (contact_gaps.empty()) return found;
  const std::vector<double> ascending = ascending_gaps(contact_gaps);
  std::vector<std::uint64_t> ends(ascending.size(), 0);  // of pairs, by rank
  const Coated coated(spheres, domain, {.gap = gap});
  for (const auto& part : ranked_pairs(*coated.spheres, *coated.domain, ascending))
    for (const RankedPair& pair : part)
      for (const std::uint32_t end : {pair.first, pair.second}) ends[pair.rank] += counted[end];
  std::partial_sum(ends.begin(), ends.end(), ends.begin());
  found.spheres = static_cast<std::uint64_t>(std::ranges::count(counted, true));
  const double n = std::max(1.0, static_cast<double>(found.spheres));
  for (const double at : contact_gaps)
    found.by_gap.push_back({at, static_cast<double>(ends[rank_of(at, ascending)]) / n});
  return found;
}

}  // namespace bernal
