#include "soft/facet_table.hpp"

#include <mutex>

namespace bernal {

bool FacetTable::find(const Facet& facet, Number& number) const {
  const auto [first, last] = numbers_.equal_range(facet.id);
  for (auto it = first; it != last; ++it) {
    const Facet& other = facets_[it->second];
    if (other.kind != facet.kind || other.radius != facet.radius || other.a != facet.a ||
        other.b != facet.b || other.c != facet.c)
      continue;
    number = it->second;
    return true;
  }
  return false;
}

/// Distances are those from the facets, of a frustum as of a triangle.
static Facet without_inset(Facet facet) {
  if (facet.kind == Facet::Kind::frustum) facet.radius = 0;
  return facet;
}

void FacetTable::add(const Facet& facet) {
  numbers_.emplace(facet.id, static_cast<Number>(facets_.size()));
  facets_.push_back(facet);
  if (facet.kind == Facet::Kind::triangle)
    ready_.emplace_back(PreparedTriangle(facet.a, facet.b, facet.c));
  else
    ready_.emplace_back(without_inset(facet));
}

FacetTable::Number FacetTable::number_of(const Facet& facet) {
  Number number = 0;
  {
    const std::shared_lock reading(mutex_);
    if (find(facet, number)) return number;
  }
  const std::unique_lock writing(mutex_);
  if (find(facet, number)) return number;
  add(facet);
  return static_cast<Number>(facets_.size() - 1);
}

void FacetTable::archive(Archive& a) {
  std::vector<Facet> facets = facets_;
  a(facets);
  if (!a.reads()) return;
  facets_.clear();
  ready_.clear();
  numbers_.clear();
  for (const Facet& facet : facets) add(facet);
}

}  // namespace bernal
