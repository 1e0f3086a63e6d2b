#pragma once
#include <algorithm>
#include <cstddef>
#include <vector>

#include "bernal/domain/facet.hpp"

namespace bernal {

/// Appends the facets nearer than `reach` to `c`, nearest first; equal distances in the order given.
template <class Facets>
void append_nearest_first(const Facets& facets, const Vector<3>& c, double reach,
                          std::vector<NearFacet>& out) {
  const auto first = static_cast<std::ptrdiff_t>(out.size());
  for (const Facet& f : facets) {
    const double d = distance(f, c);
    if (d < reach) out.push_back({d, f});
  }
  std::sort(out.begin() + first, out.end(), [](const NearFacet& x, const NearFacet& y) {
    return x.distance != y.distance ? x.distance < y.distance : x.facet.id < y.facet.id;
  });
}

/// Puts a facet among those from `first` on, nearest first; equal distances in the order given.
inline void insert_nearest_first(const NearFacet& near, std::ptrdiff_t first, std::vector<NearFacet>& out) {
  out.insert(std::upper_bound(out.begin() + first, out.end(), near,
                              [](const NearFacet& x, const NearFacet& y) { return x.distance < y.distance; }),
             near);
}

}  // namespace bernal
