#pragma once
#include "bernal/domain/domain.hpp"

namespace bernal {

/// A box with the domain's periods, whose walls are as far outside the bounds as these are wide: what is
/// certified in it are pairs alone.
Box without_walls(const Domain&);

}  // namespace bernal
