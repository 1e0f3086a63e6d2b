#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "bernal/measure/cells.hpp"
#include "measure/cell_pieces.hpp"

namespace bernal {

/// The corners and faces that cells have in common which were cut out one by one, each with rounding of its
/// own. `Cells` are made of it.
///
/// A corner of one cell is a corner of the cell behind each of its faces: such pairs are one, and so are the
/// ends of edges that are shorter than what is told apart. Where more than four cells meet in a point, or
/// more than three in a line, rounding lets some cells have faces there that others have not; these have lost
/// all their area now, and are left out. What then is a corner with only two edges is none. Where the two
/// cells of a face still differ, the corners that only one of them has are united with the nearest, and all
/// of that is done again: every time there are fewer corners, so it ends.
class SharedCorners {
 public:
  /// A face of a piece, counted over all pieces.
  struct Face {
    std::uint32_t cell = 0;
    ConvexCell::Label label = 0;
    std::uint32_t twin = Cells::none;  ///< the same face as the cell behind it has it
    std::uint32_t first = 0, count = 0;
  };

  /// The pieces outlive this.
  SharedCorners(const std::vector<CellPiece>& pieces, const Vector<3>& periods, int dimension);

  /// Faces that are left have corners.
  const std::vector<Face>& faces() const { return faces_; }
  std::span<const Cells::Corner> loop(const Face& face) const {
    return std::span(loops_).subspan(face.first, face.count);
  }
  std::size_t corners() const { return origin_.size(); }
  Vector<3> position(std::uint32_t corner) const { return place_of(origin_[corner]); }
  double merged() const { return merged_; }

 private:
  /// A corner of a piece is another one, moved.
  struct Same {
    std::uint32_t one, other;
    Cells::Image image;
    double distance;
  };

  void find_twins();
  template <class See>
  std::vector<Same> from_ranges(const See& see) const;
  /// Short edges, and what both cells of a face see.
  std::vector<Same> pairs() const;
  void add_short_edges(std::uint32_t face, std::vector<Same>& found) const;
  void add_seen_by_both(std::uint32_t face, std::vector<Same>& found) const;
  std::span<const std::uint32_t> loop_of_piece(std::uint32_t face) const;
  void unite(const Same&);
  Cells::Corner root(std::uint32_t corner);
  void number_corners();
  void make_loops();
  bool drop_corners_of_two_edges();
  std::vector<Same> differences() const;
  void compare(const Face&, std::vector<Same>& out) const;

  std::uint32_t piece_of(std::uint32_t corner) const;
  Vector<3> place_of(std::uint32_t corner) const;
  Vector<3> place_of(const Cells::Corner&) const;
  double told_apart(std::uint32_t cell, std::uint32_t other) const;
  std::size_t least_corners() const { return static_cast<std::size_t>(dimension_); }

  const std::vector<CellPiece>& pieces_;
  Vector<3> periods_;
  int dimension_;
  std::vector<std::uint32_t> first_corner_, first_face_;  ///< of every piece, and the end
  std::vector<Face> faces_;
  std::vector<Cells::Corner> parent_;  ///< of every corner of a piece: which it is, and how moved
  std::vector<Cells::Corner> number_;  ///< of every corner of a piece
  std::vector<std::uint32_t> origin_;  ///< of every number, the corner of a piece whose place it has
  std::vector<Cells::Corner> loops_;
  double merged_ = 0;
};

}  // namespace bernal
