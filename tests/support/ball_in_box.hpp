// Volumes in a single cell, by the grid that images are made with.
#pragma once
#include "voxels/ball_in_cells.hpp"

namespace bernal::testing {

/// Volume of the ball around `center` in the box.
inline double ball_in_box(const Vector<3>& center, double radius, const Bounds<3>& box) {
  BallInCells cells;
  for (int k = 0; k < 3; ++k)
    cells.planes[static_cast<std::size_t>(k)] = {(box.lower[k] - center[k]) / radius,
                                                 (box.upper[k] - center[k]) / radius};
  double volume = 0;
  cells.add(radius * radius * radius, box.volume(), &volume, 0, 0);
  return volume;
}

/// Area of the disc in the rectangle.
inline double disc_in_rectangle(const Vector<2>& center, double radius, const Bounds<2>& rectangle) {
  BallInCells cells;
  for (int k = 0; k < 2; ++k)
    cells.planes[static_cast<std::size_t>(k)] = {(rectangle.lower[k] - center[k]) / radius,
                                                 (rectangle.upper[k] - center[k]) / radius};
  double area = 0;
  cells.add_disc(radius * radius, rectangle.volume(), &area, 0);
  return area;
}

}  // namespace bernal::testing
