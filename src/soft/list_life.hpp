#pragma once
#include <cstddef>
#include <vector>

#include "core/archive.hpp"

namespace bernal {

/// How far spheres have moved since their lists were built: the farthest of all, and the farthest of most.
struct FarthestMoves {
  double of_most, of_all;

  /// The number of spheres, in the order of sweeps, that make one part.
  static constexpr std::size_t part = 4096;
  /// From the squares of the farthest move in each part. `of_most` is the ninth decile of the parts, which
  /// does not grow with the number of spheres.
  static FarthestMoves of_parts(std::vector<float> squares);
};

/// How long neighbour lists with a skin last: until most spheres have moved by `wear` skins. With a wear
/// above 1 neighbours may be missed before that; such a pair only overlaps for some sweeps more. It looks at
/// the moves as often as the speed of the last sweeps suggests.
class ListLife {
 public:
  explicit ListLife(float skin) : skin_(skin), thickest_skin_(skin) {}

  /// In the unit of the radii.
  float skin() const { return skin_; }
  void wear(double skins) { wear_ = skins; }
  bool is_over() const { return is_over_; }

  void swept() { ++sweeps_; }
  /// The lists are no longer valid: spheres that were not near each other may be now.
  void end() { is_over_ = true; }
  /// Looks at the moves before the next sweep.
  void look_soon() { patience_ = 0; }
  /// Radii grew by at most this length, in place. Looks at the moves before the next sweep.
  void radii_grew(float most) {
    grown_ += static_cast<double>(most);
    patience_ = 0;
  }

  /// Call it before each sweep. If the lists are worn out, or not there yet, it chooses the skin and calls
  /// `build`. `look` returns FarthestMoves. With `for_all` the lists last until any sphere has moved that
  /// far.
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
  double grown_ = 0;  // by what radii grew, at most, since the lists were built
  double moved_ = 0;  // `of_most` at the last look
  double wear_ = 0.9;
  int age_ = 0;       // of the lists, in sweeps, at the last look
  int sweeps_ = 0;    // since the last look
  int patience_ = 0;  // sweeps from one look to the next
};

}  // namespace bernal
