#pragma once
#include <cstdint>
#include <vector>

#include "bernal/core/vector.hpp"
#include "soft/fixed_point.hpp"

namespace bernal {

/// Cells over those axes of a periodic box that are worth cutting, for points in fixed point: with k of them
/// a sphere looks at 3^k cells, and at the share Π (3 / cells) of all spheres. In many dimensions, or where
/// spheres are few, that is none of them.
template <int D>
class FixedPointGrid {
 public:
  using Id = std::uint32_t;
  struct Row {  // of cells: the points [first, last) in the order of the cells
    Id first, last;
  };

  /// Cuts the box into cells that are nowhere less than `reach` across and counts the first `count` points
  /// into them. Returns where each of these goes when they are sorted by cell. Precondition: `reach` is
  /// positive. Cost: O(count).
  std::vector<Id> sort(const Vector<D>& edges, double reach, const std::vector<FixedPlace<D>>& places,
                       std::size_t count);

  /// Sets `rows` to the rows of the cells around a point: all points within `reach` of it are there.
  void rows_near(const FixedPlace<D>& place, std::vector<Row>& rows) const;

 private:
  struct Axis {
    int axis, cells;
  };

  void choose_axes(const Vector<D>& edges, double reach, double count);

  std::vector<Axis> axes_;      // those that are cut, the last the fastest
  std::vector<Id> cell_start_;  // of each cell in the order; one more than cells
};

}  // namespace bernal
