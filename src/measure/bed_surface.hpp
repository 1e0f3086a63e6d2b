#pragma once
#include <array>
#include <cstddef>
#include <limits>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/container.hpp"

namespace bernal {

/// The surface of a bed as heights over a grid of cells normal to gravity, see `BedProfile`. Heights are
/// coordinates along -down.
class BedSurface {
 public:
  static constexpr double bare = -std::numeric_limits<double>::infinity();

  /// Cells have about this width, and tile periodic axes; they are wider if there would be more than four
  /// million.
  BedSurface(const Spheres<3>&, const Container&, const Vector<3>& down, double width);

  /// The height of the cell of a point; `bare` if no sphere is over it.
  double height_over(const Vector<3>& p) const;

  /// A cell's height, and the share of the cell inside the container at that height (for a bare cell, at the
  /// mean height of the others). Cost: 65,536 wall queries, or one a cell if there are more.
  struct Cell {
    double height, share;
  };
  std::vector<Cell> cells(const Container&, double floor) const;

 private:
  struct Axis {
    Vector<3> along;
    double from, width;
    std::size_t cells;
    bool repeats;

    std::size_t cell_of(double x) const;
  };
  void raise(const Vector<3>& center, double r);

  Vector<3> up_;
  std::array<Axis, 2> axes_;
  std::vector<double> heights_;
};

}  // namespace bernal
