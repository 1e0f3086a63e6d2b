#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "core/archive.hpp"
#include "jam/enclosure.hpp"

namespace bernal {

/// A piece of wall near a sphere.
template <int D>
struct NearPiece {
  using ArchivedAsBytes = void;
  WallPiece<D> piece;
  double distance;    ///< of the centre, when it was found
  double weight = 1;  ///< how many pieces touch in that place
};

/// Those of all spheres, sphere after sphere, nearest first, in units of the enclosure.
template <int D>
class NearWalls {
 public:
  /// Those of the next sphere, at p, that are nearer than `reach`.
  void add_near(const Enclosure<D>& enclosure, const Vector<D>& p, double reach);
  /// Those of the next sphere, at p, that it touches, out of `near`. Of pieces that touch in one place the
  /// first stands for all.
  void add_touching(std::span<const NearPiece<D>> near, const Vector<D>& p, double radius, double same_place);

  std::span<const NearPiece<D>> of(std::size_t sphere) const {
    return std::span(walls_).subspan(begin_[sphere], begin_[sphere + 1] - begin_[sphere]);
  }
  /// The k-th of all.
  void erase(std::size_t k);
  void archive(Archive& a) { a(begin_, walls_); }

 private:
  std::vector<std::uint32_t> begin_{0};
  std::vector<NearPiece<D>> walls_;
};

}  // namespace bernal
