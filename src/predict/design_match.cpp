#include <boost/math/tools/minima.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "bernal/core/error.hpp"
#include "bernal/predict/design.hpp"

namespace bernal {
namespace {

constexpr int steps = 32;
/// Accuracy of the packing fraction: a bracket that does not close to this is a jump, not a root.
constexpr double precision = 1e-7;

struct Point {
  double parameter, phi;
};

class Matching {
 public:
  Matching(const FamilyOf& family, double target, int rods) : family_(family), target_(target), rods_(rods) {}

  Match run(double from, double to) {
    std::vector<Point> points;
    for (int k = 0; k <= steps; ++k) {
      points.push_back(at(k == steps ? to : from + k * ((to - from) / steps)));
      if (k > 0 && close(points[points.size() - 2], points.back())) return match_;
    }
    // A maximum or minimum between two steps may reach beyond them.
    for (const double sign : {1.0, -1.0}) {
      std::size_t best = 0;
      for (std::size_t k = 1; k < points.size(); ++k)
        if (sign * points[k].phi > sign * points[best].phi) best = k;
      const Point left = points[best == 0 ? 0 : best - 1];
      const Point right = points[std::min(best + 1, points.size() - 1)];
      const Point peak = extreme(left.parameter, right.parameter, sign);
      if (close(left, peak) || close(peak, right)) return match_;
    }
    return match_;
  }

 private:
  Point at(double parameter) {
    const double phi = predict_packing_fraction(*family_(parameter), rods_).phi;
    if (phi < match_.least) {
      match_.least = phi;
      match_.at_least = parameter;
    }
    if (phi > match_.most) {
      match_.most = phi;
      match_.at_most = parameter;
    }
    return {parameter, phi};
  }

  /// Whether the target lies between the two points and was found there.
  bool close(const Point& a, const Point& b) {
    if ((a.phi - target_) * (b.phi - target_) > 0) return false;
    Point best = std::abs(a.phi - target_) <= std::abs(b.phi - target_) ? a : b;
    const auto excess = [&](double parameter) {
      const Point p = at(parameter);
      if (std::abs(p.phi - target_) < std::abs(best.phi - target_)) best = p;
      return p.phi - target_;
    };
    if (best.phi != target_) {
      std::uintmax_t most = 60;
      const bool ascending = a.parameter < b.parameter;
      const Point& low = ascending ? a : b;
      const Point& high = ascending ? b : a;
      boost::math::tools::toms748_solve(excess, low.parameter, high.parameter, low.phi - target_,
                                        high.phi - target_, boost::math::tools::eps_tolerance<double>(44),
                                        most);
    }
    if (std::abs(best.phi - target_) > precision) return false;
    match_.found = true;
    match_.parameter = best.parameter;
    match_.prediction = predict_packing_fraction(*family_(best.parameter), rods_);
    return true;
  }

  /// The largest packing fraction between two parameters, or with sign -1 the smallest.
  Point extreme(double a, double b, double sign) {
    std::uintmax_t most = 40;
    const auto [parameter, value] = boost::math::tools::brent_find_minima(
        [&](double p) { return -sign * at(p).phi; }, std::min(a, b), std::max(a, b), 24, most);
    return {parameter, -sign * value};
  }

  const FamilyOf& family_;
  double target_;
  int rods_;
  Match match_;
};

}  // namespace

Match match_packing_fraction(const FamilyOf& family, double from, double to, double target, int rods) {
  if (!(target > 0 && target < 1))
    throw Error(ErrorCode::bad_argument,
                "a packing fraction lies between 0 and 1, not at " + std::to_string(target));
  if (!std::isfinite(from) || !std::isfinite(to) || from == to)
    throw Error(ErrorCode::bad_argument, "the parameter must range between two finite values");
  return Matching(family, target, rods).run(from, to);
}

}  // namespace bernal
