#pragma once
#include <array>
#include <cstddef>
#include <limits>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/container.hpp"

namespace bernal {

/// The surface of a bed over the cells of a grid across gravity: see `BedProfile`. Heights are coordinates
/// along -down.
class BedSurface {
 public:
  static constexpr double bare = -std::numeric_limits<double>::infinity();

  /// Cells are about so wide, and tile an axis that repeats itself; wider where they would be more than
  /// four million.
  BedSurface(const Spheres<3>&, const Container&, const Vector<3>& down, double width);

  /// Over the cell of a point; `bare` where no sphere stands over it.
  double height_over(const Vector<3>& p) const;

  /// What a cell has: its height, and how much of it is in the container at that height; of a bare one at
  /// the mean height of the others. Cost: 65,536 questions to the walls, or one a cell.
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
