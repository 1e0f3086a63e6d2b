#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "bernal/core/vector.hpp"

namespace bernal {

/// Volumes of the unit ball's parts in the cells of a rectilinear grid, in closed form.
///
/// Let T(a, b, c) be the volume of the ball with x > a, y > b, z > c. The volume in a cell is the alternating
/// sum of T over its eight corners. If a corner lies in the ball, the divergence theorem for the volume and
/// the Gauss-Bonnet theorem for the area of the spherical patch give
///
///   T = V/8 - (C(a) + C(b) + C(c))/4 + (D(a,b) + D(b,c) + D(c,a))/2 - abc,
///
/// with the ball's volume V, that of a cap C(a) = π/3 (1 - a)² (2 + a), and that cut off by two planes,
///
///   D(a,b) = 2/3 [ atan2(s, ab) + ab s - g(a) atan2(s, b) - g(b) atan2(s, a) ],
///   s² = 1 - a² - b²,  g(a) = a (3 - a²) / 2;
///
/// otherwise T is zero, D, or a sum by inclusion and exclusion. A cell with all corners inside has the volume
/// abc, its own. As D depends on two planes, a grid of n planes an axis takes 9 n² arcs and n³ sums.
///
/// The error of T is a few roundoffs of the ball's volume; relative to a cell of edge h it is 1/h³ larger.
/// Cf. Strobl, Formella & Pöschel, J. Comput. Phys. 311 (2016) 158, who add up cell by cell.
class BallInCells {
 public:
  /// Coordinates of the planes along each axis, ascending, at least two an axis; in radii from the centre.
  std::array<std::vector<double>, 3> planes;

  /// Adds `scale` times the volume in each cell, and exactly `whole` if the cell lies in the ball, to to[i +
  /// j * stride_y + k * stride_z]. Both may be negative, of a ball that is taken out.
  void add(double scale, double whole, double* to, std::ptrdiff_t stride_y, std::ptrdiff_t stride_z);
  /// The same for the areas of the unit disc in the cells of the first two axes.
  void add_disc(double scale, double whole, double* to, std::ptrdiff_t stride_y);

 private:
  void make_tables();
  void make_layer(std::size_t k, std::vector<double>& layer) const;

  std::array<std::vector<double>, 3> caps_;    // C of each plane, by axis
  std::array<std::vector<double>, 3> wedges_;  // D of the other two axes, the lower axis fastest
  std::vector<double> below_, above_;          // T on two layers of corners
};

}  // namespace bernal
