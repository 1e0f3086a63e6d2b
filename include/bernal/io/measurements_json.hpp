#pragma once
#include <string>

#include "bernal/measure/measure.hpp"
#include "bernal/run/packing.hpp"

namespace bernal {

/// Measurements as one JSON object: what `bernal measure --json` prints. Lengths are in the scene's unit,
/// radii are radii. What there is not is null: `g_r` where there are walls, `chambers` and `walls` where
/// there are none, p-values that would mean nothing.
std::string measurements_as_json(const Packing&, const Measurements&);

}  // namespace bernal
