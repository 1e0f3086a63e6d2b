#pragma once
#include <array>
#include <vector>

#include "bernal/predict/predict.hpp"

namespace bernal::predict {

/// The distribution of chord lengths of a size distribution, prepared for inversion: what is longer than L
/// (Farr 2013, eqs. 18, 25), in units of the distribution's radii squared,
///   T(L) = m2(L) - L² m0(L),   T'(L) = -2 L m0(L),   mk(L) = ∫_L^∞ r^k dC(r),   1 - F(L) = T(L) / T(0).
///
/// Between size classes m0 is constant and L(T) is a square root. Elsewhere T is a quintic through T and T'
/// at both ends and the middle of a piece; pieces are halved until those of twice the width are accurate to
/// 1e-10 of the smaller of T and T(0) - T, so that the pieces themselves, with an error of order six, are to
/// 2e-12; 1e-10 where the density jumps.
///
/// Cost to make: 400 to 1,200 values of m0 and m2 for a lognormal distribution, 3 a size class. Throws
/// Error{bad_argument} if moments exceed the range of double precision.
class ChordTable {
 public:
  /// For up to `most` rods.
  ChordTable(const SizeDistribution& sizes, int most);

  /// The table of a distribution on the pieces of another that contains its sizes, such as a mixture and its
  /// parts. The precision is relative to the other.
  ChordTable(const SizeDistribution& sizes, const ChordTable& pieces_of);

  /// T is linear in the numbers of spheres: the table of `a` and `b` mixed in these numbers, at least 0 and
  /// not both 0. Precondition: both have the same pieces. Cost: 10 ns a piece.
  static ChordTable mixture(const ChordTable& a, double number_a, const ChordTable& b, double number_b);

  /// The lengths of `count` <= `most` rods in descending order: F^-1((count - i + 1/2) / count),
  /// i = 1 … count (eq. 24). About 20 ns each.
  std::vector<double> rod_lengths(int count) const;

 private:
  ChordTable() = default;

  struct Knot {
    double length, tail, slope;
  };
  /// T((a + b) / 2 + s (b - a) / 2) = Σ terms[k] s^k for s in [-1, 1]; or L² decreases with T at 1 / m0.
  struct Piece {
    double a, b;
    double tail_a, tail_b;
    double m0;  ///< if it is constant, else 0
    std::array<double, 6> terms;
  };

  Knot knot(double length) const;
  bool is_right(const Piece& piece, double s, const Knot& truth) const;
  void add(const Knot& a, const Knot& middle, const Knot& b, int halvings);
  static Piece through(const Knot& a, const Knot& middle, const Knot& b);

  const SizeDistribution* sizes_ = nullptr;
  double all_ = 0;
  std::vector<Piece> pieces_;  ///< ascending
};

/// Throws Error{bad_argument} for fewer than 2 rods.
void require_enough(int rods);

/// The prediction for a table made for at least `rods`; `mean_chord` is 2 <r³> / 3 <r²>.
Prediction predict_from_chords(const ChordTable&, double mean_chord, int rods,
                               double gap_factor = rod_gap_factor);

}  // namespace bernal::predict
