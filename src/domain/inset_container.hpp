#pragma once
#include <memory>

#include "bernal/domain/container.hpp"

namespace bernal {

/// The container of facets whose wall stands `inset` inside of them, made of the one whose wall they are: a
/// ball of radius r clears the one wall where that of radius r + inset clears the other, the sum rounded up,
/// so that what is decided without rounding stays so. `volume`: what is left inside.
std::unique_ptr<Container> make_inset_container(std::shared_ptr<const Container> facets, double inset,
                                                double volume);

}  // namespace bernal
