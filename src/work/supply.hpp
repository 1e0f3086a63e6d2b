#pragma once
#include <cstdint>
#include <limits>
#include <vector>

#include "bernal/scene/scene.hpp"
#include "bernal/sizes/radius_sequence.hpp"
#include "bernal/sizes/size_distribution.hpp"
#include "core/archive.hpp"

namespace bernal {

/// The spheres that are still to come: the drawn sequence of radii, less those that have been placed.
///
/// A sphere's tag is its place in the sequence. Stages place the spheres of a short window, in any order, so
/// that a large one that finds no place does not hold up the rest: at most a window's width of them is ever
/// passed over. So the sizes are not biased towards what fits more easily.
class Supply {
 public:
  /// No stage packs denser than this: so many of an open target are never missed.
  static constexpr double densest = 0.95;

  static constexpr double most_spheres = 2147483647.0;
  /// Throws the Error{bad_scene} that more would be.
  [[noreturn]] static void refuse_count(const Target& target);

  /// What the radii are drawn from, and how.
  struct Source {
    const SizeDistribution& radii;
    int dimension = 3;
    std::uint64_t seed = 1;
    Draw draw = Draw::random;
    /// Larger radii are drawn again, and counted.
    double cut = std::numeric_limits<double>::infinity();
    std::vector<double> first = {};  ///< radii of the start, which come before those drawn, whatever the cut
    /// What every sphere has around it: that is in all radii, and no part of the drawn ones. Of a packing
    /// fraction that is asked for the volume without it counts.
    double coat = 0;
  };

  /// Draws as many radii as the target asks for, or as fill `fraction` of the volume where it leaves that
  /// open, by the seed's stream of radii. Throws Error{bad_scene} if those are more than 2^31.
  Supply(const Source& source, double volume, const Target& target, double fraction = densest);

  /// The same of these of the sequence alone, in that order, with nothing taken. Precondition: one or more.
  Supply of(const std::vector<std::uint32_t>& tags) const;

  /// Lengths from now on are in units of `unit`, a power of two.
  void divide_by(double unit);
  /// All sizes are so many times as large from now on.
  void multiply_by(double factor);
  /// By all of these together.
  double scale() const { return scale_; }
  const std::vector<double>& radii() const { return radii_; }
  /// As it was drawn, without its coat: the packer's unit, and no later `multiply_by`.
  double drawn(std::size_t tag) const { return drawn_.empty() ? radii_[tag] : drawn_[tag]; }

  /// Nothing more is to be placed: the target has been reached.
  bool exhausted() const { return window_.empty(); }
  /// Tags that may be placed next, in ascending order.
  const std::vector<std::uint32_t>& window() const { return window_; }
  double radius(std::uint32_t tag) const { return radii_[tag]; }
  /// Takes the k-th of the window.
  void take(std::size_t k);
  /// Takes spheres of any place in the sequence, in ascending order, before any of the window has been taken:
  /// those that have to stand before the others do.
  void take_first(const std::vector<std::uint32_t>& tags);

  /// Of the first `placed.size()` tags those that are set have been placed, and no others. `in_sequence`: by
  /// stages that keep the order of the sequence, so that its tail may be taken out again.
  void set_placed(const std::vector<bool>& placed, bool in_sequence = true);

  /// All tags below this one have been placed.
  std::uint32_t first_missing() const { return window_.empty() ? next_ : window_.front(); }
  /// How many spheres were passed over, i.e. are missing although a later one was placed.
  std::size_t passed_over() const;
  /// Whether only a few spheres stand beyond `first_missing`, so that taking them out again, which makes the
  /// result exactly the drawn sequence less its tail, costs next to nothing.
  bool trimming_is_cheap() const;
  /// How many spheres the target asks for; for an open one an upper bound.
  std::size_t wanted() const { return radii_.size(); }
  /// So many of the sequence, from its start, fill this volume; at most all.
  std::size_t count_filling(double volume) const;
  /// How many draws were above the cut.
  std::size_t cut_off() const { return cut_off_; }
  double cut() const { return cut_; }
  double smallest() const { return smallest_; }
  double largest() const { return largest_; }

  /// What has happened since the radii were drawn, which they are again before this is read.
  void archive(Archive& a) {
    a(window_, taken_first_, in_sequence_, next_, scale_);
    if (scale_ != 1) a(radii_, smallest_, largest_);
  }

 private:
  void open_window();

  int dimension_ = 3;
  std::vector<double> radii_;
  std::vector<double> drawn_;  // where there are coats
  std::vector<std::uint32_t> window_;
  std::vector<std::uint32_t> taken_first_;  // ascending
  bool in_sequence_ = true;                 // but for a window's width, spheres were taken in their order
  std::uint32_t next_ = 0;                  // the first tag that was never in the window
  std::size_t width_ = 1;
  std::size_t cut_off_ = 0;
  double cut_ = 0;
  double smallest_ = 0;
  double largest_ = 0;
  double scale_ = 1;
};

}  // namespace bernal
