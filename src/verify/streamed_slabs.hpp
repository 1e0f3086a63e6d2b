#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "bernal/verify/certificate.hpp"
#include "verify/ball.hpp"
#include "verify/slabs.hpp"
#include "verify/space.hpp"

namespace bernal::verify {

/// Calls visit(first, values) for all rows, in pieces of `piece` rows.
template <class Visit>
void for_each_piece(const SphereRows& rows, std::uint64_t piece, const Visit& visit) {
  const auto width = static_cast<std::size_t>(rows.dimension) + 1;
  std::vector<double> values;
  for (std::uint64_t first = 0; first < rows.count; first += piece) {
    values.resize(width * static_cast<std::size_t>(std::min(piece, rows.count - first)));
    rows.read(first, values);
    visit(first, std::span<const double>(values));
  }
}

/// Like `Slabs`, for spheres that are read again for every slab. Only the bounds of each piece of some
/// thousand rows are stored, 48 bytes a piece in three dimensions, and only the pieces that reach into a slab
/// are read for it. So rows sorted along one coordinate are read a few times in all, and rows in any other
/// order once a slab; the slabs are along the axis on which pieces are shortest. The answer does not depend
/// on the order.
template <int D>
class StreamedSlabs {
 public:
  /// `at_once` > 0; centres are finite.
  template <class Space>
  StreamedSlabs(const SphereRows& rows, const Space& space, std::size_t at_once)
      : rows_(rows), piece_(std::clamp<std::uint64_t>(at_once / pieces_a_slab, 1, most_a_piece)) {
    find_pieces(space);
    cut(space, at_once);
  }

  std::size_t size() const { return counts_.size(); }
  Box<D> extent(std::size_t slab) const { return extents_[slab]; }

  template <class Space>
  std::vector<Ball<D>> balls(std::size_t slab, const Space& space) const {
    std::vector<Ball<D>> balls;
    balls.reserve(counts_[slab]);
    std::vector<double> values;
    for (std::size_t p = 0; p < pieces_.size(); ++p) {
      const Range& range = pieces_[p][axis_];
      if (slab_of_bin_[bin_of(range.upper)] < slab || slab_of_bin_[bin_of(range.lower)] > slab) continue;
      const std::uint64_t first = p * piece_;
      values.resize((D + 1) * static_cast<std::size_t>(std::min(piece_, rows_.count - first)));
      rows_.read(first, values);
      for (std::size_t n = 0; n < values.size() / (D + 1); ++n) {
        const double* const row = &values[n * (D + 1)];
        if (slab_of_bin_[bin_of(space.representative(axis_, row[axis_]))] != slab) continue;
        Ball<D>& ball = balls.emplace_back();
        for (int k = 0; k < D; ++k) ball.c[k] = space.representative(k, row[k]);
        ball.r = row[D];
        ball.index = first + n;
      }
    }
    return balls;
  }

 private:
  static constexpr std::uint64_t pieces_a_slab = 8, most_a_piece = 4096;
  static constexpr std::size_t bins_a_slab = 64;

  template <class Space>
  void find_pieces(const Space& space) {
    std::array<double, D> lengths{};
    for_each_piece(rows_, piece_, [&](std::uint64_t, std::span<const double> values) {
      std::array<Range, D>& piece = pieces_.emplace_back();
      for (std::size_t at = 0; at < values.size(); at += D + 1)
        for (int k = 0; k < D; ++k) {
          const double x = space.representative(k, values[at + static_cast<std::size_t>(k)]);
          piece[k].include(x, x);
        }
      for (int k = 0; k < D; ++k) {
        lengths[k] += piece[k].upper - piece[k].lower;
        all_[k].include(piece[k].lower, piece[k].upper);
      }
    });
    const auto share = [&](int k) {  // share of an axis that a piece covers
      const double extent = all_[k].upper - all_[k].lower;
      return extent > 0 ? lengths[k] / extent : Box<D>::infinity;
    };
    for (int k = 1; k < D; ++k)
      if (share(k) < share(axis_)) axis_ = k;
  }

  /// As in `Slabs::cut`: bins of equal width, and slabs of consecutive bins.
  template <class Space>
  void cut(const Space& space, std::size_t at_once) {
    bins_ = bins_a_slab * static_cast<std::size_t>((rows_.count + at_once - 1) / at_once);
    bins_ = std::max<std::size_t>(bins_, 1);
    std::vector<std::size_t> in_bin(bins_, 0);
    std::vector<Range> along(bins_);
    for_each_piece(rows_, piece_, [&](std::uint64_t, std::span<const double> values) {
      for (std::size_t at = 0; at < values.size(); at += D + 1) {
        const double x = space.representative(axis_, values[at + static_cast<std::size_t>(axis_)]);
        const double r = values[at + D];
        ++in_bin[bin_of(x)];
        along[bin_of(x)].include(rounded_down(x - r), rounded_up(x + r));
      }
    });
    Box<D> everywhere;
    std::swap(everywhere.lower, everywhere.upper);
    slab_of_bin_.resize(bins_);
    Range range;
    const auto end_slab = [&] {
      extents_.back().lower[axis_] = range.lower;
      extents_.back().upper[axis_] = range.upper;
      range = {};
    };
    for (std::size_t b = 0; b < bins_; ++b) {
      if (counts_.empty() || (counts_.back() > 0 && counts_.back() + in_bin[b] > at_once)) {
        if (!counts_.empty()) end_slab();
        counts_.push_back(0);
        extents_.push_back(everywhere);
      }
      counts_.back() += in_bin[b];
      range.include(along[b].lower, along[b].upper);
      slab_of_bin_[b] = counts_.size() - 1;
    }
    end_slab();
  }

  std::size_t bin_of(double x) const {
    const double extent = all_[axis_].upper - all_[axis_].lower;
    const double share = extent > 0 ? (x - all_[axis_].lower) / extent : 0;
    return std::min(bins_ - 1, static_cast<std::size_t>(share * static_cast<double>(bins_)));
  }

  const SphereRows& rows_;
  const std::uint64_t piece_;
  std::vector<std::array<Range, D>> pieces_;  // of centres, on every axis
  std::array<Range, D> all_;
  int axis_ = 0;
  std::size_t bins_ = 1;
  std::vector<std::size_t> slab_of_bin_;
  std::vector<std::size_t> counts_;  // of each slab
  std::vector<Box<D>> extents_;
};

}  // namespace bernal::verify
