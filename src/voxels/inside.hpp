#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "bernal/voxels/voxels.hpp"

namespace bernal {

/// The voxels of a row with centres in a domain: first <= i <= last.
struct InsideRun {
  std::int64_t row, first, last;
};

/// Finds the voxels of a grid with centres in a domain, to rounding, from the crossings of lines along x with
/// its walls.
///
/// A line through the centres of a row crosses the facets of a mesh an even number of times, even through
/// edges and vertices: on which side it passes an edge is decided by the same doubles for both facets, and a
/// point on the edge counts for one side. Const, and safe for several threads.
class InsideOfDomain {
 public:
  /// Both must outlive this.
  InsideOfDomain(const Domain& domain, const VoxelGrid& grid);

  /// Replaces `out` by the runs of a layer, rows ascending. Cost: some ns a row, and for a mesh 1 ns a
  /// triangle.
  void layer(std::int64_t k, std::vector<InsideRun>& out) const;

 private:
  using Interval = std::array<double, 2>;  // closed
  struct Crossing {
    std::int64_t row;
    double x;
    bool operator<(const Crossing& other) const { return row != other.row ? row < other.row : x < other.x; }
  };
  void add(std::int64_t row, const Interval& x, std::vector<InsideRun>& out) const;
  Interval interval(const Box&, double y, double z) const;
  Interval interval(const Cylinder&, double y, double z) const;
  Interval interval(const Sphere&, double y, double z) const;
  void cross(const Mesh&, double z, std::vector<Crossing>& out) const;
  void cross(const Polygon&, double z, std::vector<Crossing>& out) const;
  /// The parts of a line along x.
  std::vector<Interval> parts(const Revolved&, double y, double z) const;
  /// The first row with its centre at y or above.
  std::int64_t row_from(double y) const;

  const Domain& domain_;
  const VoxelGrid& grid_;
  std::vector<std::array<double, 2>> heights_;  // of the lowest and highest corner of each triangle
};

}  // namespace bernal
