#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "bernal/core/monitor.hpp"
#include "bernal/domain/domain.hpp"
#include "bernal/settle/insert.hpp"

namespace bernal {

/// An orthogonal cell of a crystal whose nearest sites are one apart; sites in edges of the cell.
struct CrystalCell {
  Vector<3> edges;
  std::vector<Vector<3>> sites;
  double density;  ///< packing fraction of touching spheres
};

CrystalCell cell_of(Layout layout, int dimension);

/// Where a crystal is laid, in the packer's coordinates.
struct CrystalGround {
  Boundary<3> boundary;
  Bounds<3> bounds;
  Frame frame;
  int dimension = 3;
  bool is_box = true;  ///< its walls, where it has some, are flat and across the axes

  double period(int axis) const { return frame.scale * boundary.edges[axis]; }  ///< in the scene's unit
};

/// Both in the scene's unit: the spacing from `least` on with which cells divide all periods; nothing where
/// that is none up to a share `stretch` wider. A period may be a rounding too short.
std::optional<double> spacing_dividing(const CrystalGround& ground, const CrystalCell& cell, double least,
                                       double stretch);
/// A period may be so much off a number of cells, for the digits that people write.
inline constexpr double roundings_of_periods = 1e-9;

/// Throws Error{bad_scene} with the nearest periods that a crystal of this spacing divides.
[[noreturn]] void refuse_periods(Layout layout, const CrystalGround& ground, const CrystalCell& cell,
                                 double spacing);

/// The planes of sites across an axis: of those at each fraction of a cell the coordinate in every cell, the
/// packer's and what becomes of that in the scene, to the bit. Sites have their coordinates from here, so
/// that the distances between all of them follow from a few.
class Planes {
 public:
  /// `count` cells of that edge, the first of them at `from`, in the scene's unit; all of them make up
  /// `period`, unless it is 0.
  Planes(const std::vector<double>& fractions, double from, double edge, int count, double period,
         double origin, double scale);

  std::size_t cells() const { return at_.front().size(); }
  /// The packer's.
  double at(std::size_t fraction, std::size_t cell) const { return local_[fraction][cell]; }
  /// The least distance along the axis of a plane at one fraction from one at another, so many cells on.
  /// Infinite if there are none. Differences of doubles are exact here, or nearly.
  long double least_gap(std::size_t fraction, std::size_t other, int cells_on) const;

 private:
  std::vector<std::vector<double>> local_, at_;  // at_ in the scene
  double period_;
};

/// A crystal that is laid somewhere.
struct Crystal {
  const CrystalCell& cell;
  std::array<std::vector<double>, 3> fractions;  ///< of the sites' planes, along each axis
  std::vector<Planes> planes;                    ///< across each axis

  /// Whether no two sites, in whatever images, are nearer than `distance`: certainly, if it says so.
  bool keeps(double distance) const;

  /// Calls visit(place) for every site, in the packer's coordinates. Throws Cancelled.
  template <class Visit>
  void for_each_site(const Monitor& monitor, const Visit& visit) const {
    for (std::size_t k = 0; k < planes[2].cells(); ++k)
      for (std::size_t j = 0; j < planes[1].cells(); ++j) {
        if (monitor.stop()) throw Cancelled();
        for (std::size_t i = 0; i < planes[0].cells(); ++i)
          for (const Vector<3>& site : cell.sites)
            visit(Vector<3>(planes[0].at(fraction_of(site, 0), i), planes[1].at(fraction_of(site, 1), j),
                            planes[2].at(fraction_of(site, 2), k)));
      }
  }

 private:
  friend class Ways;
  std::size_t fraction_of(const Vector<3>& site, int axis) const;
};

/// Ways to lay a crystal of this cell and spacing, for spheres of radius r; lengths are the scene's.
class Ways {
 public:
  Ways(const CrystalGround& ground, const CrystalCell& cell, double spacing, double r);

  std::size_t count() const { return shifts_[0].size() * shifts_[1].size() * shifts_[2].size(); }
  /// All axes go on at once, so that the middle of all three is tried early.
  Crystal crystal(std::size_t way) const;

 private:
  const CrystalCell& cell_;
  const CrystalGround& ground_;
  Bounds<3> room_;
  Vector<3> edges_;
  std::array<std::vector<double>, 3> fractions_, shifts_;
};

}  // namespace bernal
