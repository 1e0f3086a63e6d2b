#pragma once
#include <cstddef>
#include <vector>

#include "core/archive.hpp"

namespace bernal {

/// How far spheres have moved since their lists were built.
struct FarthestMoves {
  double of_most, of_all;

  /// Spheres that follow each other in the order of sweeps.
  static constexpr std::size_t part = 4096;
  /// From the squares of the farthest moves in parts. Of most: that of a part in which they moved farther
  /// than in nine tenths of the parts, which does not become the larger the more spheres there are.
  static FarthestMoves of_parts(std::vector<float> squares);
};

/// How long neighbour lists with a skin last: until most spheres have moved by what they may be worn, in
/// skins. Above 1, neighbours may be missed until then. Looks at what has moved only as often as the speed of
/// the last sweeps suggests. A pair that is missed for some sweeps overlaps for so much longer, no more.
class ListLife {
 public:
  explicit ListLife(float skin) : skin_(skin), thickest_skin_(skin) {}

  /// Of the lists, in the unit of the radii.
  float skin() const { return skin_; }
  double wear() const { return wear_; }
  void wear(double skins) { wear_ = skins; }
  bool is_over() const { return is_over_; }

  void swept() { ++sweeps_; }
  /// Spheres that were not near each other may be now.
  void end() { is_over_ = true; }
  /// Before the next sweep.
  void look_soon() { patience_ = 0; }
  /// By so much at most, in place; looked at before the next sweep.
  void radii_grew(float most) {
    grown_ += static_cast<double>(most);
    patience_ = 0;
  }

  /// To be called before each sweep. Where lists have to be built anew, or are not there yet, chooses the
  /// skin and calls `build`; `look` returns FarthestMoves. `for_all`: not only most spheres may not have
  /// moved farther.
  template <class Look, class Build>
  void keep(bool for_all, bool are_there, Look&& look, Build&& build) {
    if (!is_over_ && sweeps_ < patience_) return;
    double moved = 0, judged = 0;
    if (are_there) {
      const FarthestMoves moves = look();
      moved = moves.of_most + grown_;
      judged = (for_all ? moves.of_all : moves.of_most) + grown_;
    }
    const double limit = wear_ * static_cast<double>(skin_);
    const double speed = speed_of(moved, limit);
    if (is_over_ || judged > limit) {
      choose_skin();
      build();
      begin();
      moved = 0;
    }
    looked(moved, limit, speed);
  }

  void archive(Archive& a) { a(skin_, is_over_, grown_, moved_, wear_, age_, sweeps_, patience_); }

 private:
  double speed_of(double moved, double limit) const;
  void choose_skin();
  void begin();
  void looked(double moved, double limit, double speed);

  float skin_, thickest_skin_;
  bool is_over_ = true;
  double grown_ = 0;  // at most, by exchanges since they were built
  double moved_ = 0;  // most of them since then, when it was last looked at
  double wear_ = 0.9;
  int age_ = 0;       // in sweeps, when it was last looked at
  int sweeps_ = 0;    // since it was last looked at
  int patience_ = 0;  // sweeps until it is looked at again
};

}  // namespace bernal
