#pragma once
#include <string>
#include <string_view>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/domain.hpp"

namespace bernal {

/// Discs in a box of two dimensions: what is in it, images that reach into it included, and faintly what
/// sticks out of it. Of very many discs a part of the box is shown, which the key says. Precondition: two
/// dimensions, centres in one period. Cost: O(N).
std::string disc_svg(const Spheres<dynamic>& spheres, const Box& box, std::string_view unit);

}  // namespace bernal
