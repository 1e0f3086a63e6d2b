#pragma once
#include "bernal/geometry/true_surface.hpp"
#include "core/archive.hpp"

namespace bernal {

void archive(Archive&, TrueSurface::Bezier&);
void archive(Archive&, TrueSurface::Patch&);
void archive(Archive&, TrueSurface::Face&);
void archive(Archive&, TrueSurface&);

}  // namespace bernal
