#pragma once
#include <string>
#include <vector>

#include "bernal/domain/mesh_file.hpp"
#include "cad/repair/plane_cut.hpp"

namespace bernal::cad {

/// What stands beside a surface to tell which space is meant.
struct InteriorRequest {
  std::vector<CutPlane> planes;
  std::variant<Interior, Vector<3>> interior = Interior::solid;
};

struct ChosenInterior {
  Mesh mesh;                               ///< the walls of the space that is meant, not yet turned outward
  std::vector<std::string> notes;          ///< what was done, one phrase each
  std::vector<std::string> cautions = {};  ///< what may not be as it is meant
};

/// The walls of the space that is meant: what the planes cut off is outside, and of what is left either what
/// the surface encloses, or its hollow, or the space around a point. Of hollows that no plane closes the
/// largest counts, closed across its openings or up to its brim. Corners within `tolerance` of a plane lie on
/// it. Throws Error{bad_mesh}, in one line, where there is no such space, and where none of several hollows
/// is clearly the largest, with a point of each. Cost: O(n log n) a plane, with two choices of its side for
/// each that leaves it open; that of `hollows_of` and `hollows_below_planes` for a hollow.
ChosenInterior choose_interior(const Mesh& surface, const InteriorRequest& request, double tolerance);

}  // namespace bernal::cad
