#pragma once
#include <limits>

namespace bernal::verify {

/// Whether a ball lies inside, and its least gap from a near wall over its radius; infinite if none is near.
struct Stand {
  bool inside = true;
  double gap = std::numeric_limits<double>::infinity();
};

}  // namespace bernal::verify
