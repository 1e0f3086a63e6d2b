#pragma once
#include <cstddef>
#include <cstdint>
#include <shared_mutex>
#include <unordered_map>
#include <variant>
#include <vector>

#include "bernal/domain/facet.hpp"
#include "core/archive.hpp"
#include "kernels/closest_point.hpp"

namespace bernal {

/// Facets of a container that spheres have come near to, each once and made ready for questions: many spheres
/// are near to the same few, and what one of them asks for is in the cache when the next one does.
class FacetTable {
 public:
  using Number = std::uint32_t;

  /// Of a facet, which is added if it is new. One container may give several of the same id, images of each
  /// other. Not while others ask for something else. Cost: some 50 ns.
  Number number_of(const Facet&);

  /// Asks the memory for what is about to be needed.
  void fetch(Number n) const {
    constexpr std::size_t line = 64;
    const auto* bytes = reinterpret_cast<const char*>(&ready_[n]);
    for (std::size_t at = 0; at < sizeof ready_[n]; at += line) __builtin_prefetch(bytes + at);
  }

  /// p minus the nearest point of the facet; for a facet of an analytic container p is on its inner side.
  Vector<3> offset(Number n, const Vector<3>& p) const {
    if (const auto* triangle = std::get_if<PreparedTriangle>(&ready_[n])) return triangle->offset(p);
    return p - closest_point(std::get<Facet>(ready_[n]), p);
  }

  /// A lower bound of the distance from the facet after a straight move by `move` from p, whose offset is
  /// `from`: concave along the way for the curved walls, whose inside is convex; for a triangle the distance
  /// from the plane through its nearest point, which has all of it behind.
  double distance_after(Number n, const Vector<3>& p, const Vector<3>& from, double distance_before,
                        const Vector<3>& move) const {
    if (const auto* facet = std::get_if<Facet>(&ready_[n])) return distance(*facet, p + move);
    return distance_before + move.dot(from) / distance_before;
  }

  void archive(Archive&);

 private:
  bool find(const Facet&, Number&) const;
  void add(const Facet&);

  mutable std::shared_mutex mutex_;
  std::vector<Facet> facets_;
  std::vector<std::variant<Facet, PreparedTriangle>> ready_;
  std::unordered_multimap<std::uint32_t, Number> numbers_;  // by the facet's id
};

}  // namespace bernal
