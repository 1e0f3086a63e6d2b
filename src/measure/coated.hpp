#pragma once
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/measure/contact_list.hpp"

namespace bernal {

/// Larger gap ratios are between spheres with others between them.
inline constexpr double widest_ratio = 1;

inline void require_gap_ratio(double ratio) {
  if (!(std::abs(ratio) <= widest_ratio))
    throw Error(ErrorCode::bad_argument,
                fmt::format("spheres touch below a gap ratio of 0 to {:g}, not {}", widest_ratio, ratio));
}

/// Spheres and walls so that what keeps its gap, and the margin of the domain, touches; copies only where
/// there are any.
class Coated {
 public:
  Coated(const Spheres<dynamic>& bare, const Domain& shape, const ContactOptions& options)
      : spheres(&bare), domain(&shape), container(options.container) {
    const double from_wall = options.wall_gap + margin_of(shape);
    if (options.gap == 0 && from_wall == 0) return;
    with_coats_ = bare;
    for (double& r : with_coats_.r) r += 0.5 * options.gap;
    walls_moved_ = with_walls_moved(shape, from_wall - 0.5 * options.gap);
    spheres = &with_coats_;
    domain = &walls_moved_;
    container = nullptr;
  }
  Coated(const Coated&) = delete;
  Coated& operator=(const Coated&) = delete;

  const Spheres<dynamic>* spheres;
  const Domain* domain;
  std::shared_ptr<const Container> container;

 private:
  Spheres<dynamic> with_coats_{0};
  Domain walls_moved_;
};

}  // namespace bernal
