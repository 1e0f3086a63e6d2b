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

/// The facets of a container that spheres have come near to, each stored once and prepared for distances.
/// Many spheres are near the same few facets, which then stay in the cache.
class FacetTable {
 public:
  using Number = std::uint32_t;

  /// The number of a facet, which is added if it is new. A container may give several facets with the same
  /// id, images of each other. Threads may call it at the same time, but no other member meanwhile. Cost:
  /// some 50 ns.
  Number number_of(const Facet&);

  /// Prefetches a facet.
  void fetch(Number n) const {
    constexpr std::size_t line = 64;
    const auto* bytes = reinterpret_cast<const char*>(&ready_[n]);
    for (std::size_t at = 0; at < sizeof ready_[n]; at += line) __builtin_prefetch(bytes + at);
  }

  /// p minus the nearest point of the facet. Precondition: p is on the inner side of a facet of an analytic
  /// container.
  Vector<3> offset(Number n, const Vector<3>& p) const {
    if (const auto* triangle = std::get_if<PreparedTriangle>(&ready_[n])) return triangle->offset(p);
    return p - closest_point(std::get<Facet>(ready_[n]), p);
  }

  /// A lower bound of the distance from the facet after a straight move by `move` from p, whose offset is
  /// `from`, and at any point of the way. For curved walls, whose inside is convex, the distance is concave
  /// along the way. From a frustum it falls by no more than the way is long. For a triangle the bound is the
  /// distance from the plane through its nearest point, which has all of the triangle behind it.
  double distance_after(Number n, const Vector<3>& p, const Vector<3>& from, double distance_before,
                        const Vector<3>& move) const {
    if (const auto* facet = std::get_if<Facet>(&ready_[n]))
      return facet->kind == Facet::Kind::frustum ? distance_before - move.norm() : distance(*facet, p + move);
    return distance_before + move.dot(from) / distance_before;
  }

  void archive(Archive&);

 private:
  bool find(const Facet&, Number&) const;
  void add(const Facet&);

  mutable std::shared_mutex mutex_;
  std::vector<Facet> facets_;
  std::vector<std::variant<Facet, PreparedTriangle>> ready_;
  std::unordered_multimap<std::uint32_t, Number> numbers_;  // by id
};

}  // namespace bernal
