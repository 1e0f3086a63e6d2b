#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "meshes/mesh_quality.hpp"
#include "meshes/volume_mesh.hpp"

namespace bernal {

/// The tetrahedra of a mesh while some are replaced by others, and for vertices near those that are looked
/// at the tetrahedra around them.
class TetrahedraNear {
 public:
  static constexpr std::uint32_t none = 0xFFFFFFFF;

  /// Vertices of triangles are fixed.
  TetrahedraNear(VolumeMesh& mesh, bool for_gradients);

  /// Looks at those of SICN below the goal, and keeps the stars of all vertices of tetrahedra that share a
  /// corner with one of them. Returns them, the worst first.
  std::vector<std::uint32_t> look(double goal);

  const Vector<3>& at(std::uint32_t vertex) const { return mesh_.vertices[vertex]; }
  void move(std::uint32_t vertex, const Vector<3>& to) { mesh_.vertices[vertex] = to; }
  const TetrahedronCorners& corners(std::uint32_t t) const { return mesh_.tetrahedra[t]; }
  std::uint32_t region(std::uint32_t t) const { return mesh_.region[t]; }
  bool is_there(std::uint32_t t) const { return mesh_.region[t] != none; }
  bool is_free(std::uint32_t vertex) const { return !is_fixed_[vertex]; }

  double quality(std::uint32_t t) const { return quality(corners(t)); }
  /// The SICN; for gradients no more than `most_of_ill_posed` where the faces inside of the mesh do not
  /// determine a gradient from the fluxes through them: where two faces lie on the outside, or inner faces
  /// are nearly parallel to one direction.
  double quality(const TetrahedronCorners&) const;
  static constexpr double most_of_ill_posed = 0.1;
  /// Of the sum of n n^T over inner faces, n being a face's area over the mean of them, by 8, what it is for
  /// a cube. Faces at ends of periods are inner ones. OpenFOAM's checkMesh asks for 0.001.
  double determinant_of_inner_faces(const TetrahedronCorners&) const;
  static constexpr double least_determinant = 0.00105;
  double least_quality(std::span<const std::uint32_t> of) const;

  bool has_star(std::uint32_t vertex) const { return slot_[vertex] != none; }
  /// Precondition: `has_star`. It changes with `replace`.
  const std::vector<std::uint32_t>& star(std::uint32_t vertex) const { return stars_[slot_[vertex]]; }
  /// Those around an edge. Precondition: its first vertex has a star.
  std::vector<std::uint32_t> around(std::uint32_t a, std::uint32_t b) const;
  /// The one behind the face opposite a corner; none at triangles of the surface and where no star is kept.
  std::uint32_t behind(std::uint32_t t, int corner) const;

  /// Puts the new ones in the place of the old ones, of one region, which fill the same space.
  void replace(std::span<const std::uint32_t> old, std::span<const TetrahedronCorners> by);
  std::uint32_t add_vertex(const Vector<3>& at);
  /// Takes the vertex away that was added last. Precondition: no tetrahedron has it.
  void drop_vertex();
  /// Marks the corners of one that changes its shape, as `replace` does.
  void touch(std::uint32_t t) {
    for (const std::uint32_t vertex : corners(t)) is_touched_[vertex] = 1;
  }
  /// Which vertices are marked; none is afterwards.
  std::vector<std::uint8_t> take_touched();
  /// Leaves no gaps in the mesh: what was replaced and vertices without a tetrahedron go.
  void close();

 private:
  void keep_star(std::uint32_t vertex);
  bool is_outside(std::uint32_t a, std::uint32_t b, std::uint32_t c) const;

  VolumeMesh& mesh_;
  std::vector<std::uint8_t> is_fixed_, is_touched_;
  /// Triangles on the outside by their least vertex v, from first_outside_[v] to first_outside_[v + 1]: their
  /// other vertices, in order.
  std::vector<std::uint32_t> first_outside_;
  std::vector<std::array<std::uint32_t, 2>> outside_;
  std::vector<std::uint32_t> slot_;  ///< of each vertex
  std::vector<std::vector<std::uint32_t>> stars_;
  std::vector<std::uint32_t> gaps_;  ///< tetrahedra that are not there
};

}  // namespace bernal
