#pragma once
#include <memory>

#include "bernal/domain/container.hpp"

namespace bernal {

/// The part of a container below a level: what the walls and a plane across `down` enclose. `volume` is its
/// own. The plane is decided in doubles; all questions else are passed on.
std::shared_ptr<const Container> below_level(std::shared_ptr<const Container>, const Vector<3>& down,
                                             double level, double volume);

/// The height against `down` up to which the container holds that volume: of 32,768 evenly distributed points
/// inside, such a share lies below. Error: some thousandths of the height. Precondition: 0 < volume <= that
/// of the container. Cost: a question to the walls a point.
double level_holding(double volume, const Container&, const Vector<3>& down);

}  // namespace bernal
