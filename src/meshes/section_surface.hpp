#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "meshes/conforming_surface.hpp"

namespace bernal {

constexpr std::uint32_t not_of_whole = 0xFFFFFFFF;

/// A part of a surface, with vertices of its own.
struct PartOfSurface {
  ConformingSurface surface;             ///< without statement, sizes and periods
  std::vector<std::uint32_t> vertex;     ///< of the whole, by those of the part, or `not_of_whole`
  std::vector<std::uint32_t> triangles;  ///< of the whole; the part may have others after these
};

/// Numbers vertices of a part as its triangles need them.
class PartBuilder {
 public:
  /// Vertices of the whole, in which triangles are given, and more that are numbered after them and are not
  /// of the whole.
  explicit PartBuilder(const std::vector<Vector<3>>& vertices, std::span<const Vector<3>> more = {})
      : vertices_(vertices), more_(more) {}
  void add(const FaceCorners& triangle, std::uint32_t patch);
  /// In the part; nothing where that does not have all of them.
  std::vector<std::uint32_t> numbers_of(std::vector<std::uint32_t> vertices) const;
  /// Triangles from a closed chain of edges, in numbers of the part, to a point that stands over its middle,
  /// by half of its diagonal along `out`: many edges that lie nearly in one plane make poor triangles there.
  void add_cone(const std::vector<std::uint32_t>& chain, const Vector<3>& out, std::uint32_t patch);
  const PartOfSurface& part() const { return part_; }
  PartOfSurface& part() { return part_; }

 private:
  /// Of a vertex of the whole, in the part.
  std::uint32_t number_of(std::uint32_t vertex);

  const std::vector<Vector<3>>& vertices_;
  std::span<const Vector<3>> more_;
  std::vector<std::uint32_t> number_;
  PartOfSurface part_;
};

/// Picks parts of a surface. It holds what it needs of spheres, necks and walls; the surface outlives it.
class SurfaceParts {
 public:
  SurfaceParts(const ConformingSurface&, int axis);

  /// The spheres that reach into an interval along the axis or come near it, whole, with the necks between
  /// them, and the walls beside these. Lids close the holes of walls, the walls beyond all of these, and
  /// spheres where necks to those left out are missing.
  PartOfSurface near(double low, double high) const;
  /// The largest extent of a sphere along the axis.
  double largest_extent() const { return largest_extent_; }

 private:
  struct Range {
    double low = 0, high = 0;
    bool meets(const Range& other) const { return low <= other.high && other.low <= high; }
    void take(const Range& other);
  };
  Range range_of(const FaceCorners& triangle) const;
  bool is_wall(std::uint32_t patch) const;
  bool is_neck(std::uint32_t patch) const;
  void find_pieces();
  std::vector<std::uint8_t> chosen_pieces(const Range& near) const;

  const ConformingSurface& surface_;
  int axis_;
  std::vector<std::uint32_t> piece_;                        ///< of each patch that is no neck and no wall
  std::vector<std::uint32_t> piece_of_vertex_;              ///< `not_of_whole` on walls and inside of necks
  std::vector<std::vector<std::uint32_t>> pieces_of_neck_;  ///< by patch
  double largest_extent_ = 0, longest_edge_ = 0;
};

}  // namespace bernal
