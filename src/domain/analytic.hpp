#pragma once
#include <memory>

#include "bernal/domain/container.hpp"

namespace bernal {

// One factory for each analytic container; the classes are in their own files. Each decides `contains` as
// follows: plain by the clearance in double; filtered by the clearance and a bound on its error, exactly
// where that cannot tell; exact always exactly (exact_analytic.hpp).
std::unique_ptr<Container> make_box(const Box&, WallArithmetic, double resolution);
std::unique_ptr<Container> make_cylinder(const Cylinder&, WallArithmetic, double resolution);
std::unique_ptr<Container> make_sphere(const Sphere&, WallArithmetic, double resolution);
std::unique_ptr<Container> make_polygon(const Polygon&, WallArithmetic, double resolution);
std::unique_ptr<Container> make_revolved(const Revolved&, WallArithmetic, double resolution);

/// Decides `clearance >= r` as the arithmetic promises; `error` bounds the rounding error of clearance - r
/// and `exactly` is asked where the double cannot or must not decide.
template <class Exactly>
bool decide_contains(WallArithmetic arithmetic, double clearance, double r, double error, Exactly exactly) {
  const double gap = clearance - r;
  if (arithmetic == WallArithmetic::plain) return gap >= 0;
  if (arithmetic == WallArithmetic::filtered) {
    if (gap > error) return true;
    if (gap < -error) return false;
  }
  return exactly();
}

}  // namespace bernal
