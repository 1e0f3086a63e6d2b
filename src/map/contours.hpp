#pragma once
#include <vector>

#include "report/plot.hpp"

namespace bernal::drawing {

/// Values over a grid: value(i, j) at (xs[j], ys[i]). Both ascend, at least two each.
struct Field {
  std::vector<double> xs, ys, values;

  double at(std::size_t row, std::size_t column) const { return values[row * xs.size() + column]; }
};

/// The area in bands of colour and contour lines at multiples of `step`, every fifth bold and named, linear
/// between the points of the grid. The axes of the plot may be of any scale.
void add_contours(Plot& plot, const Field& field, double step);

}  // namespace bernal::drawing
