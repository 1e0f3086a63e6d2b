#pragma once
#include "cells/cell_file.hpp"
#include "cells/placed_cells.hpp"
#include "formats/text_file.hpp"

namespace bernal {

/// The section **domain of a .tess file: the polyhedron that the cells fill, with its corners, edges and
/// faces and what of the cells lies on them. Where an axis repeats itself it is the box of one period, and
/// only walls have faces of cells.
void write_neper_domain(const CellFile&, const PlacedCells&, TextFile&);

}  // namespace bernal
