#pragma once
#include <memory>

#include "bernal/domain/domain.hpp"
#include "verify/ball.hpp"
#include "verify/mesh_wall.hpp"
#include "verify/tally.hpp"

namespace bernal::verify {

/// The extent of a mesh along an axis. Throws Error{bad_mesh} unless that difference is a double.
double period_of(const Mesh& mesh, int axis);

/// The triangles of a mesh that repeats itself, as a wall: for balls as a PeriodicSpace represents them, with
/// every centre coordinate at most half a period from zero.
///
/// Every point of the domain is at most R from a corner of a wall, if all its images count, with R² the sum
/// of the squared extents along axes without a period and of the squared halves of the periods. So a wall of
/// all images that reach R beyond the centres, closed at their ends, decides: a ball that an end could stop
/// is stopped by a wall. Images are at corner + k period, of which nothing is rounded. Openings are the
/// triangles that lie in an end plane, see Mesh::periodic.
class RepeatedWall {
 public:
  /// Throws Error{bad_mesh} as a MeshWall does, if there are no walls, if the ends of one period do not meet
  /// those of the next corner by corner, and if an image of a corner is no double.
  explicit RepeatedWall(const Mesh& mesh);

  WallState wall_state_of(const Ball<3>& ball, const CertifyOptions& options, Tally& tally) const {
    return wall_->wall_state_of(ball, options, tally);
  }

 private:
  std::unique_ptr<const Mesh> images_;
  std::unique_ptr<const MeshWall> wall_;  // of them
};

}  // namespace bernal::verify
