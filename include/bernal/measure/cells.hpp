#pragma once
#include <array>
#include <compare>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/container.hpp"
#include "bernal/domain/domain.hpp"

namespace bernal {

/// The cells of the power diagram, see `LocalPacking`, as polyhedra that share their corners and faces, in
/// two dimensions as polygons that share their corners and sides (which are the faces below). Together they
/// are the domain, or one period of it: what is cut off at one end of the period stands behind the other.
///
/// Lengths are in the spheres' unit. Cells and spheres have the same numbers; a cell may be empty.
struct Cells {
  static constexpr std::uint32_t none = 0xFFFFFFFF;
  /// So many periods along each axis.
  using Image = std::array<std::int8_t, 3>;
  /// A corner, moved.
  struct Corner {
    std::uint32_t corner = 0;
    Image image = {};
    bool operator==(const Corner&) const = default;
  };
  /// A plane piece between two cells, or between a cell and a wall.
  struct Face {
    std::uint32_t cell = 0;       ///< seen from which the corners run anticlockwise from outside
    std::uint32_t beyond = none;  ///< whose cell, moved by `image`, is on the other side; none at a wall
    Image image = {};
    std::uint32_t wall = none;  ///< a place in `walls`
  };
  /// A face of a cell: from the side that its corners say, or from the other one, where the face and all its
  /// corners have to be moved back by its image.
  struct Side {
    std::uint32_t face = 0;
    bool beyond = false;
  };
  /// A flat wall: the domain is where p·normal <= offset.
  struct Wall {
    Vector<3> normal = Vector<3>::Zero();
    double offset = 0;
    std::string name = {};  ///< "x0", "z1" of boxes and lids, else "f1", "f2", …
  };

  int dimension = 3;
  Vector<3> periods = Vector<3>::Zero();  ///< 0 along axes that do not repeat themselves
  std::vector<Vector<3>> centers;         ///< in one period
  std::vector<double> radii;              ///< whose squares are the weights
  std::vector<Vector<3>> corners;         ///< each once a period; z = 0 in two dimensions
  std::vector<Face> faces;
  std::vector<std::uint32_t> first_corner;  ///< of every face, and the end
  std::vector<Corner> corners_of_faces;
  std::vector<std::uint32_t> first_side;  ///< of every cell, and the end
  std::vector<Side> sides;                ///< in two dimensions anticlockwise
  std::vector<Wall> walls;

  double volume = 0;     ///< of the domain, or of one period
  double deviation = 0;  ///< how far the flat walls are at most from round ones that they stand for
  /// The largest distance of two corners that were taken for one, see `cells_of`.
  double merged = 0;

  std::size_t size() const { return centers.size(); }
  std::span<const Corner> corners_of(std::uint32_t face) const {
    return std::span(corners_of_faces)
        .subspan(first_corner[face], first_corner[face + 1] - first_corner[face]);
  }
  std::span<const Side> sides_of(std::uint32_t cell) const {
    return std::span(sides).subspan(first_side[cell], first_side[cell + 1] - first_side[cell]);
  }
  bool is_empty(std::uint32_t cell) const { return first_side[cell] == first_side[cell + 1]; }
  /// By how much a side's corners are moved to lie around its cell.
  Image image_of(const Side& side) const {
    const Image& image = faces[side.face].image;
    return side.beyond ? Image{static_cast<std::int8_t>(-image[0]), static_cast<std::int8_t>(-image[1]),
                               static_cast<std::int8_t>(-image[2])}
                       : Image{};
  }
  Vector<3> place(const Corner& corner, const Image& image = {}) const {
    Vector<3> p = corners[corner.corner];
    for (int k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      p[k] += (corner.image[axis] + image[axis]) * periods[k];
    }
    return p;
  }
  /// Whose cell is behind a side, `none` for a wall.
  std::uint32_t neighbour(const Side& side) const {
    return side.beyond ? faces[side.face].cell : faces[side.face].beyond;
  }
};

struct CellsOptions {
  /// Round walls are made of so many flat ones around their axis, of the same volume.
  int sides = 64;
};

/// The cells that `local_packing` measures. Faces are flat to rounding; a corner is where three or more of
/// them meet. Corners of a cell that are nearer to each other than 1e-9 of its reach, the distance of its
/// farthest corner, are one, so that the corners in which more than four cells meet, as in lattices, stay
/// together; whatever two cells do not see alike after that is drawn together until they do, and `merged`
/// says how far. So every edge of a cell is in two of its faces, every face between two cells is one, and
/// corners - edges + faces = 2 holds for every cell.
///
/// Round walls are made flat, with `sides` around, so that the volume of the whole is that of the round
/// domain, and what a single cell is off at the wall is of second order; `deviation` says how far the walls
/// are. `made`: as `MeasureOptions::container`.
///
/// The result is the same for any number of threads. Cost: about 50 µs a sphere in one thread, half of it in
/// threads; for walls 1 ns for each flat wall and sphere; memory about 4 kB a sphere. Throws
/// Error{bad_argument} for a container that is not convex, with an inset, or of other than two or three
/// dimensions, Cancelled if an interrupt requests it.
Cells cells_of(const Spheres<dynamic>&, const Domain&, const CellsOptions& = {});

/// The shape of one cell.
struct CellShape {
  double volume = 0;   ///< area in two dimensions
  double surface = 0;  ///< length of the outline in two dimensions
  Vector<3> centroid = Vector<3>::Zero();
  std::uint32_t faces = 0;       ///< of cells and walls
  std::uint32_t neighbours = 0;  ///< faces that are not of walls
  std::uint32_t edges = 0, corners = 0;
  /// The surface of the ball of the same volume over that of the cell; in two dimensions likewise with
  /// lengths.
  double sphericity = 0;
  /// The root of the largest over the smallest principal moment of the volume about the centroid: 1 for a
  /// ball, a cube and a regular polyhedron.
  double aspect = 0;

  /// 2 for a polyhedron, 0 for a polygon.
  int euler(int dimension) const {
    const auto sum = static_cast<int>(corners) - static_cast<int>(edges);
    return dimension == 3 ? sum + static_cast<int>(faces) : sum;
  }
};
/// Volumes are those of pyramids from a point inside over triangles, which both cells of a face divide alike.
/// Zero for an empty cell. Cost: some µs.
CellShape shape_of(const Cells&, std::uint32_t cell);
/// All of them, in threads.
std::vector<CellShape> shapes_of(const Cells&);

/// A line between two corners, each once a period.
struct CellEdge {
  std::uint32_t from = 0;  ///< a corner as it stands
  std::uint32_t to = 0;    ///< a corner, moved by `image`
  Cells::Image image = {};
  auto operator<=>(const CellEdge&) const = default;
};
/// The edge between two corners of a face: the one from the smaller number, or where both have the same, the
/// one whose image is positive.
CellEdge cell_edge(Cells::Corner a, Cells::Corner b);
/// All of them, sorted; in two dimensions the sides. Cost: O(n log n).
std::vector<CellEdge> edges_of(const Cells&);

/// What is said of all cells together; means are over those that are not empty.
struct CellStatistics {
  std::uint64_t cells = 0, empty = 0;
  std::uint64_t corners = 0, edges = 0, faces = 0;  ///< of the whole, each once a period
  /// corners - edges + faces - cells of the whole (in two dimensions corners - edges + cells): 0 where all
  /// axes repeat themselves, 1 between walls all around.
  std::int64_t euler = 0;
  std::uint64_t not_euler = 0;  ///< cells for which corners - edges + faces is not 2 (0 in two dimensions)
  double volume = 0;            ///< the sum
  double volume_error = 0;      ///< |sum - volume of the domain| / volume of the domain
  struct Moments {
    double mean = 0, deviation = 0, skewness = 0, kurtosis = 0;  ///< the last is 3 for a normal distribution
    double least = 0, most = 0;
  };
  Moments volumes, diameters;  ///< diameters are those of balls of the same volume
  Moments faces_a_cell, edges_a_face, sphericity, aspect;
  std::vector<std::uint64_t> with_faces;  ///< how many cells have so many faces
};
CellStatistics statistics_of(const Cells&, const std::vector<CellShape>&);

}  // namespace bernal
