#pragma once
#include <string>
#include <vector>

#include "bernal/measure/measure.hpp"
#include "bernal/scene/packing.hpp"

namespace bernal {

/// A chart of values from 0 to `highest`, columns of blocks; higher values are cut. A row is 1 / rows_a_unit
/// high.
void print_chart(const std::vector<double>& values, int highest, int rows_a_unit, const std::string& reach);

// What `bernal measure` says of cells, waves and pores.
void print_local(const Packing&, const LocalPacking&);
void print_structure(const StructureFactor&);
void print_pores(const Packing&, const PoreSizes&, const std::string& where);

}  // namespace bernal
