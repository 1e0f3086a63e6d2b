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

}  // namespace bernal
