#include "sizes/density.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/tools/roots.hpp>

#include "sizes/check.hpp"

namespace bernal {
namespace {

using Gauss = boost::math::quadrature::gauss<double, 7>;

/// Largest ratio of a piece's ends: within it r^k of any moment is as good as a polynomial of degree 13.
constexpr double widest = 1.5;
/// Two halves that agree with the whole to this are accurate to some roundoffs, because halving the width
/// divides the error by 2^14.
constexpr double agreement = 1e-12;
/// Negligible share of the whole: rounding.
constexpr double nothing = 1e-16;
constexpr int most_halvings = 16;

struct Piece {
  double a;
  double b;
  double below = 0;      ///< the probability below a
  double density_a = 0;  ///< the probability density at a and b
  double density_b = 0;
};

class Density final : public SizeDistribution {
 public:
  Density(std::string_view name, std::function<double(double)> density, const std::vector<double>& breaks)
      : density_(std::move(density)) {
    const std::vector<double> limits = cut(breaks);
    double about = 0;
    for (std::size_t i = 1; i < limits.size(); ++i) about += integral(0, limits[i - 1], limits[i]);
    for (std::size_t i = 1; i < limits.size(); ++i)
      halve(limits[i - 1], limits[i], integral(0, limits[i - 1], limits[i]), nothing * about, most_halvings);
    if (pieces_.empty())
      throw Error(ErrorCode::bad_argument,
                  fmt::format("the density of this {} distribution is zero everywhere", name));
    set_limits(pieces_.front().a, pieces_.back().b);
    for (std::size_t k = 0; k < above_.size(); ++k) {
      above_[k].assign(pieces_.size() + 1, 0);
      for (std::size_t i = pieces_.size(); i-- > 0;)
        above_[k][i] = above_[k][i + 1] + integral(static_cast<int>(k), pieces_[i].a, pieces_[i].b);
    }
    total_ = above_[0][0];
    if (!std::isfinite(total_))
      throw Error(ErrorCode::bad_argument,
                  fmt::format("the density of this {} distribution is not finite everywhere", name));
    double below = 0;
    for (Piece& piece : pieces_) {
      piece.density_a = density_(piece.a) / total_;
      piece.density_b = density_(piece.b) / total_;
      piece.below = below;
      below += probability(piece.a, piece.b);
    }
  }

  double quantile(double p) const override {
    if (p <= 0) return min();
    if (p >= 1) return max();
    // The last piece that begins below p contains it.
    const auto reaches = [](const Piece& piece, double value) { return piece.below < value; };
    const Piece& piece = *std::prev(std::lower_bound(pieces_.begin(), pieces_.end(), p, reaches));
    const double wanted = p - piece.below;
    const auto excess = [&](double r) {
      return std::pair(probability(piece.a, r) - wanted, density_(r) / total_);
    };
    std::uintmax_t most_steps = 100;
    return boost::math::tools::newton_raphson_iterate(excess, guess(piece, wanted), piece.a, piece.b,
                                                      std::numeric_limits<double>::digits, most_steps);
  }

  double cumulative(double radius) const override {
    if (radius <= min()) return 0;
    if (radius >= max()) return 1;
    const Piece& piece = *std::prev(first_beyond(radius));
    return std::min(1.0, piece.below + probability(piece.a, std::min(radius, piece.b)));
  }

  double moment_above(int k, double radius) const override {
    const auto beyond = first_beyond(radius);
    double sum = whole_from(k, static_cast<std::size_t>(beyond - pieces_.begin()));
    if (beyond != pieces_.begin() && radius < std::prev(beyond)->b)
      sum += integral(k, radius, std::prev(beyond)->b);
    return sum / total_;
  }

 private:
  /// The first piece that begins above a radius.
  std::vector<Piece>::const_iterator first_beyond(double radius) const {
    return std::upper_bound(pieces_.begin(), pieces_.end(), radius,
                            [](double value, const Piece& piece) { return value < piece.a; });
  }

  /// The point at which the probability from the start of the piece would be `wanted` for a linear density.
  static double guess(const Piece& piece, double wanted) {
    const double width = piece.b - piece.a, rise = (piece.density_b - piece.density_a) / width;
    const double root = std::sqrt(std::max(0.0, piece.density_a * piece.density_a + 2 * rise * wanted));
    const double step = 2 * wanted / (piece.density_a + root);
    return piece.a + (step < width ? step : 0.5 * width);
  }

  double integral(int k, double a, double b) const {
    if (k == 0) return Gauss::integrate(density_, a, b);
    return Gauss::integrate([&](double r) { return density_(r) * std::pow(r, k); }, a, b);
  }

  double probability(double a, double b) const { return integral(0, a, b) / total_; }

  /// Over all pieces from the i-th on.
  double whole_from(int k, std::size_t i) const {
    if (k >= 0 && k < static_cast<int>(above_.size())) return above_[static_cast<std::size_t>(k)][i];
    double sum = 0;
    for (; i < pieces_.size(); ++i) sum += integral(k, pieces_[i].a, pieces_[i].b);
    return sum;
  }

  /// The breaks, with more between them.
  static std::vector<double> cut(const std::vector<double>& breaks) {
    std::vector<double> limits = {breaks.front()};
    for (std::size_t i = 1; i < breaks.size(); ++i) {
      const double times = breaks[i] / breaks[i - 1];
      const int n = std::max(1, static_cast<int>(std::ceil(std::log(times) / std::log(widest))));
      for (int k = 1; k < n; ++k)
        limits.push_back(breaks[i - 1] * std::pow(times, static_cast<double>(k) / n));
      limits.push_back(breaks[i]);
    }
    return limits;
  }

  /// Adds the pieces of [a, b], over which the density integrates to `whole`; none if it is zero.
  void halve(double a, double b, double whole, double tolerance, int halvings) {
    const double middle = a + 0.5 * (b - a);
    const double left = integral(0, a, middle), right = integral(0, middle, b);
    if (halvings == 0 || !(std::abs(left + right - whole) > agreement * whole + tolerance)) {
      if (!(left <= 0)) pieces_.push_back({a, middle});
      if (!(right <= 0)) pieces_.push_back({middle, b});
      return;
    }
    halve(a, middle, left, tolerance, halvings - 1);
    halve(middle, b, right, tolerance, halvings - 1);
  }

  std::function<double(double)> density_;
  std::vector<Piece> pieces_;
  double total_ = 1;
  /// above_[k][i]: the integral of r^k over the pieces from the i-th on, for the frequently used moments.
  std::array<std::vector<double>, 7> above_;
};

}  // namespace

std::unique_ptr<SizeDistribution> make_from_density(std::string_view name,
                                                    std::function<double(double)> density,
                                                    const std::vector<double>& breaks) {
  return std::make_unique<Density>(name, std::move(density), breaks);
}

}  // namespace bernal
