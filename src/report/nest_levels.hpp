#pragma once
#include "bernal/scene/packing.hpp"
#include "report/measured_json.hpp"

namespace bernal {

/// The levels of a packing, see `levels_of`: the key `levels` of report.json and nest.json.
Json levels_json(const Packing&);

}  // namespace bernal
