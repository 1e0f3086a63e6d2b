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
  double weight = 1;  ///< number of pieces that touch at that place
};

/// The pieces near each sphere, in the order of spheres, nearest first, in units of the enclosure.
template <int D>
class NearWalls {
 public:
  /// Adds the pieces nearer than `reach` to the next sphere, at p.
  void add_near(const Enclosure<D>& enclosure, const Vector<D>& p, double reach);
  /// Adds the pieces of `near` that the next sphere, at p, touches. Pieces that touch at the same place are
  /// represented by the first.
  void add_touching(std::span<const NearPiece<D>> near, const Vector<D>& p, double radius, double same_place);

  std::span<const NearPiece<D>> of(std::size_t sphere) const {
    return std::span(walls_).subspan(begin_[sphere], begin_[sphere + 1] - begin_[sphere]);
  }
  /// Erases the k-th of all.
  void erase(std::size_t k);
  void archive(Archive& a) { a(begin_, walls_); }

 private:
  std::vector<std::uint32_t> begin_{0};
  std::vector<NearPiece<D>> walls_;
};

}  // namespace bernal
