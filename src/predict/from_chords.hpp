#pragma once
#include "bernal/predict/predict.hpp"
#include "predict/chord_table.hpp"

namespace bernal::predict {

/// Throws Error{bad_argument} for fewer than 2 rods.
void require_enough(int rods);

/// The prediction for a table that was made for at least `rods`; `mean_chord` is 2 <r³> / 3 <r²>.
Prediction predict_from_chords(const ChordTable&, double mean_chord, int rods);

}  // namespace bernal::predict
