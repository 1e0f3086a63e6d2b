#pragma once
#include "bernal/domain/domain.hpp"

namespace bernal {

/// The periods of a domain of two or three dimensions, 0 along axes without one.
Vector<3> periods_of(const Domain&);

}  // namespace bernal
