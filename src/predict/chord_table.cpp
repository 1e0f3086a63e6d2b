#include "predict/chord_table.hpp"

#include <algorithm>
#include <cmath>

#include "bernal/core/error.hpp"

namespace bernal::predict {
namespace {

/// Of a piece of twice the width, relative to the smaller of the longer and the shorter part.
constexpr double agreement = 1e-10;
/// Relative to the total: roundoff of m2 - L² m0 and of quadratures.
constexpr double rounding = 1e-14;
/// A jump of the density is a kink of T'; the error of its piece is its width squared, and this width is
/// small enough.
constexpr int most_halvings = 45;
/// Limit for distributions with kinks everywhere, which are less precise.
constexpr std::size_t most_pieces = 1 << 17;

/// Value and derivative of Σ terms[k] s^k.
struct Polynomial {
  double value, slope = 0;

  Polynomial(const std::array<double, 6>& c, double s) : value(c[5]) {
    for (int k = 4; k >= 0; --k) {
      slope = slope * s + value;
      value = value * s + c[static_cast<std::size_t>(k)];
    }
  }
};

/// s in [-1, 1] at which the decreasing polynomial is `target`: Newton's method from `s`, with bisection if
/// it leaves the bracket. `slope` receives the last derivative.
double root(const std::array<double, 6>& terms, double target, double s, double& slope) {
  double low = -1, high = 1;
  for (int step = 0; step < 60; ++step) {
    s = s > low && s < high ? s : 0.5 * (low + high);
    const Polynomial p(terms, s);
    slope = p.slope;
    const double excess = p.value - target;
    (excess > 0 ? low : high) = s;
    const double better = s - excess / p.slope;
    // The next step would be below 1e-12.
    if (std::abs(better - s) < 1e-6) return std::clamp(better, -1.0, 1.0);
    s = better;
  }
  return s;
}

}  // namespace

ChordTable::Knot ChordTable::knot(double length) const {
  const double m0 = sizes_->moment_above(0, length), m2 = sizes_->moment_above(2, length);
  const Knot k{length, m2 - length * length * m0, -2 * length * m0};
  if (!std::isfinite(k.tail) || !std::isfinite(k.slope))
    throw Error(ErrorCode::bad_argument, "the sizes spread too widely to predict their packing fraction");
  return k;
}

ChordTable::Piece ChordTable::through(const Knot& a, const Knot& middle, const Knot& b) {
  const double half = 0.5 * (b.length - a.length);
  const double even = 0.5 * (a.tail + b.tail) - middle.tail;
  const double odd = 0.5 * (b.tail - a.tail) - half * middle.slope;
  const double even_slope = 0.5 * half * (b.slope - a.slope);
  const double odd_slope = half * (0.5 * (a.slope + b.slope) - middle.slope);
  return {a.length,
          b.length,
          a.tail,
          b.tail,
          0,
          {middle.tail, half * middle.slope, 2 * even - 0.5 * even_slope, 0.5 * (5 * odd - odd_slope),
           0.5 * even_slope - even, 0.5 * (odd_slope - 3 * odd)}};
}

bool ChordTable::is_right(const Piece& piece, double s, const Knot& truth) const {
  const double error = std::abs(Polynomial(piece.terms, s).value - truth.tail);
  return error <= agreement * std::min(truth.tail, all_ - truth.tail) + rounding * all_;
}

void ChordTable::add(const Knot& a, const Knot& middle, const Knot& b, int halvings) {
  const Piece whole = through(a, middle, b);
  const Knot left = knot(0.5 * (a.length + middle.length));
  const Knot right = knot(0.5 * (middle.length + b.length));
  if ((is_right(whole, -0.5, left) && is_right(whole, 0.5, right)) || halvings >= most_halvings ||
      pieces_.size() >= most_pieces) {
    pieces_.push_back(through(a, left, middle));
    pieces_.push_back(through(middle, right, b));
    return;
  }
  add(a, left, middle, halvings + 1);
  add(middle, right, b, halvings + 1);
}

ChordTable::ChordTable(const SizeDistribution& sizes, int most) : sizes_(&sizes), all_(sizes.moment(2)) {
  if (!std::isnormal(all_))
    throw Error(ErrorCode::bad_argument, "the sizes spread too widely to predict their packing fraction");
  const double shortest = 0.5 / most * all_;
  // A chord is no longer than its sphere, so F(L) <= L² / T(0): no rod is shorter than this.
  double from = std::sqrt(shortest);
  if (sizes.min() > from) {
    from = sizes.min();
    pieces_.push_back({0, from, all_, all_ - from * from, 1, {}});
  }
  const std::vector<double> atoms = sizes.atoms();
  auto atom = std::upper_bound(atoms.begin(), atoms.end(), from);
  // T is smooth between classes; over an octave a power of L is nearly a polynomial.
  for (Knot a = knot(from); a.length < sizes.max() && a.tail > shortest;) {
    double to = std::min(2 * a.length, sizes.max());
    if (atom != atoms.end() && *atom <= to) to = *atom++;
    const Knot b = knot(std::nextafter(to, 0.0));  // excludes a class at `to`
    const double m0 = -0.5 * a.slope / a.length;
    if (m0 == -0.5 * b.slope / b.length)
      pieces_.push_back({a.length, to, a.tail, b.tail, m0, {}});
    else
      add(a, knot(0.5 * (a.length + b.length)), b, 0);
    a = knot(to);
  }
}

ChordTable::ChordTable(const SizeDistribution& sizes, const ChordTable& pieces_of)
    : sizes_(&sizes), all_(sizes.moment(2)) {
  pieces_.reserve(pieces_of.pieces_.size());
  for (const Piece& piece : pieces_of.pieces_) {
    const Knot b = knot(std::nextafter(piece.b, 0.0));  // excludes a class there
    if (piece.m0 > 0) {
      const double tail = piece.a > 0 ? knot(piece.a).tail : all_;
      pieces_.push_back({piece.a, piece.b, tail, b.tail, -0.5 * b.slope / b.length, {}});
    } else {
      pieces_.push_back(through(knot(piece.a), knot(0.5 * (piece.a + piece.b)), b));
    }
  }
}

ChordTable ChordTable::mixture(const ChordTable& a, double number_a, const ChordTable& b, double number_b) {
  const auto both = [&](double of_a, double of_b) { return number_a * of_a + number_b * of_b; };
  ChordTable table;
  table.all_ = both(a.all_, b.all_);
  table.pieces_ = a.pieces_;
  for (std::size_t i = 0; i < table.pieces_.size(); ++i) {
    Piece& piece = table.pieces_[i];
    const Piece& other = b.pieces_[i];
    piece.tail_a = both(piece.tail_a, other.tail_a);
    piece.tail_b = both(piece.tail_b, other.tail_b);
    piece.m0 = both(piece.m0, other.m0);
    for (std::size_t k = 0; k < piece.terms.size(); ++k)
      piece.terms[k] = both(piece.terms[k], other.terms[k]);
  }
  return table;
}

std::vector<double> ChordTable::rod_lengths(int count) const {
  std::vector<double> lengths(static_cast<std::size_t>(count));
  auto piece = pieces_.end() - 1;
  const double step = all_ / count;
  double s = 1, longest = piece->b;
  double slope = -2 * step;
  for (int i = 0; i < count; ++i) {
    const double target = (i + 0.5) * step;
    while (piece->tail_a < target && piece != pieces_.begin()) {
      --piece;
      s = 1;
    }
    double length;
    if (piece->m0 > 0) {
      const double square = piece->b * piece->b - (target - piece->tail_b) / piece->m0;
      length = std::clamp(std::sqrt(std::max(square, 0.0)), piece->a, piece->b);
    } else {
      s = root(piece->terms, target, s + step / slope, slope);
      length = 0.5 * (piece->a + piece->b) + s * (0.5 * (piece->b - piece->a));
    }
    longest = lengths[static_cast<std::size_t>(i)] = std::min(length, longest);
  }
  return lengths;
}

}  // namespace bernal::predict
