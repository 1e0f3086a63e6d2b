#include "bernal/measure/cells.hpp"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "measure/cell_pieces.hpp"
#include "measure/localised.hpp"
#include "measure/shared_corners.hpp"

namespace bernal {
namespace {

constexpr int least_sides = 8, most_sides = 1024;

void require_cells(const Domain& domain, const CellsOptions& options) {
  const int dimension = dimension_of(domain);
  if (dimension != 2 && dimension != 3)
    throw Error(
        ErrorCode::bad_argument,
        fmt::format("cells have corners and faces in two and three dimensions, not in {}", dimension));
  if (options.sides < least_sides || options.sides > most_sides)
    throw Error(ErrorCode::bad_argument, fmt::format("round walls are made of {} to {} flat ones, not of {}",
                                                     least_sides, most_sides, options.sides));
  const auto inset = [](const auto& shape) {
    if constexpr (requires { shape.inset; }) return shape.inset;
    return 0.0;
  };
  if (std::visit(inset, domain) != 0)
    throw Error(ErrorCode::bad_argument, "the domain has an inset; cells are those between its facets");
}

void take_faces(const SharedCorners& shared, Cells& cells) {
  std::vector<std::uint32_t> number(shared.corners(), Cells::none),
      face_of(shared.faces().size(), Cells::none);
  std::vector<std::uint32_t> origin;
  const auto numbered = [&](Cells::Corner corner) {
    std::uint32_t& of = number[corner.corner];
    if (of == Cells::none) {
      of = static_cast<std::uint32_t>(origin.size());
      origin.push_back(corner.corner);
    }
    corner.corner = of;
    return corner;
  };
  cells.first_corner = {0};
  cells.first_side = {0};
  std::uint32_t cell = 0;
  const auto end_cells_before = [&](std::size_t next) {
    for (; cell < next; ++cell) cells.first_side.push_back(static_cast<std::uint32_t>(cells.sides.size()));
  };
  for (std::uint32_t f = 0; f < shared.faces().size(); ++f) {
    const SharedCorners::Face& face = shared.faces()[f];
    if (face.count == 0) continue;
    end_cells_before(face.cell);
    if (face.twin != Cells::none && face.twin < f) {
      cells.sides.push_back({face_of[face.twin], true});
      continue;
    }
    face_of[f] = static_cast<std::uint32_t>(cells.faces.size());
    cells.sides.push_back({face_of[f], false});
    Cells::Face& made = cells.faces.emplace_back(Cells::Face{.cell = face.cell});
    if (face.label < 0) {
      made.wall = static_cast<std::uint32_t>(-1 - face.label);
    } else {
      const CellNeighbour behind = neighbour_of(face.label);
      made.beyond = behind.sphere;
      for (std::size_t k = 0; k < 3; ++k) made.image[k] = static_cast<std::int8_t>(behind.image[k]);
    }
    for (const Cells::Corner& corner : shared.loop(face)) cells.corners_of_faces.push_back(numbered(corner));
    cells.first_corner.push_back(static_cast<std::uint32_t>(cells.corners_of_faces.size()));
  }
  end_cells_before(cells.size());
  for (const std::uint32_t corner : origin) cells.corners.push_back(shared.position(corner));
}

}  // namespace

Cells cells_of(const Spheres<dynamic>& packed, const Domain& domain, const CellsOptions& options) {
  require_upright(domain, "a tessellation into cells");
  require_closed_walls(domain, "a tessellation into cells");
  require_cells(domain, options);
  const Frame frame = frame_of(domain);
  const Domain local_domain = to_local(domain, frame);
  const Boundary<3> boundary = localised(boundary_in_space(domain), frame);
  const FlatWalls walls = flat_walls_of(local_domain, options.sides);
  Cells cells;
  cells.dimension = walls.dimension;
  cells.periods = boundary_in_space(domain).edges;
  cells.walls = walls.walls;
  cells.radii.assign(packed.r.begin(), packed.r.end());
  {
    const std::vector<CellPiece> pieces = cell_pieces(localised(packed, frame), boundary, walls);
    for (const CellPiece& piece : pieces) cells.centers.push_back(frame.to_scene(piece.center));
    const SharedCorners shared(pieces, boundary.edges, walls.dimension);
    cells.merged = frame.scale * shared.merged();
    take_faces(shared, cells);
  }
  for (Vector<3>& corner : cells.corners) corner = frame.to_scene(corner);
  for (Cells::Wall& wall : cells.walls)
    wall.offset = frame.scale * wall.offset + wall.normal.dot(frame.origin);
  cells.deviation = frame.scale * walls.deviation;
  cells.volume = volume_of(domain);
  return cells;
}

}  // namespace bernal
