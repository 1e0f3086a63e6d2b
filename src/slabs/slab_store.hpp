#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "bernal/core/spheres.hpp"

namespace bernal {

/// A sphere of a periodic box: its centre as shares of the edges, from 0 to 1, so that it stays the same
/// while the box grows.
struct SlabSphere {
  std::array<double, 3> at;
  double r;
};

/// The spheres of a periodic box in slabs of one thickness across an axis, each in a file of its own: so many
/// of them that memory holds one slab, not all. A sphere stays in the slab that it was put into, wherever it
/// moves. Files are read and written front to back, and go with this object. Throws Error{cannot_write}.
class SlabStore {
 public:
  /// In a folder of its own, which is made.
  SlabStore(std::filesystem::path folder, int slabs, int axis);
  ~SlabStore() { end(); }
  SlabStore(const SlabStore&) = delete;
  SlabStore& operator=(const SlabStore&) = delete;

  int size() const { return static_cast<int>(slabs_.size()); }
  int axis() const { return axis_; }
  std::uint64_t spheres(int slab) const { return at(slab).count; }

  /// All slabs are empty again.
  void clear();
  /// Puts one where it lies. To be followed by `close`.
  void add(const SlabSphere& sphere);
  void close();

  using Visit = std::function<void(const SlabSphere&)>;
  void for_each(int slab, const Visit& visit) const;
  /// In their order others for the spheres of a slab: change(k, sphere) for the k-th.
  void rewrite(int slab, const std::function<void(std::uint64_t k, SlabSphere&)>& change);
  /// Gives the room on the disk back: of a slab; of all, with the folder.
  void forget(int slab);
  void end();

  /// Along the axis, from the middle of a slab on, the short way round the period.
  double offset(int slab, const SlabSphere& sphere) const;
  /// Where its spheres begin and end, as offsets.
  struct Extent {
    double lower = 0.5, upper = -0.5;
    void include(double at);
  };
  const Extent& extent(int slab) const { return at(slab).extent; }

 private:
  struct Slab {
    std::uint64_t count = 0;
    Extent extent = {};
    std::vector<SlabSphere> waiting = {};  // to be written
  };

  const Slab& at(int slab) const { return slabs_[static_cast<std::size_t>(slab)]; }
  Slab& at(int slab) { return slabs_[static_cast<std::size_t>(slab)]; }
  std::filesystem::path file(int slab) const;
  void append(int slab);

  std::filesystem::path folder_;
  int axis_;
  std::vector<Slab> slabs_;
};

/// The spheres of a slab, first, and those of others that may come near them, in a box of their own that
/// repeats itself, and in which those of the slab meet whom they meet in the whole box.
struct SlabSurroundings {
  Spheres<3> spheres = {};
  std::size_t own = 0;
  Vector<3> edges;
  double origin = 0;  ///< along the axis, as a share of the whole box's edge
};

/// Those within `width` of the slab's extent, in a box of these edges. Between the two ends of their own box
/// there is room of `gap` more. Memory: 32 bytes for each of them.
SlabSurroundings surroundings(const SlabStore& store, int slab, const Vector<3>& edges, double width,
                              double gap = 0);

}  // namespace bernal
