#pragma once
#include <string>
#include <vector>

#include "bernal/domain/mesh_file.hpp"
#include "cad/repair/plane_cut.hpp"

namespace bernal::cad {

/// How a file's surface determines the container's space.
struct InteriorRequest {
  std::vector<CutPlane> planes;
  std::variant<Interior, Vector<3>> interior = Interior::solid;
};

struct ChosenInterior {
  Mesh mesh;                               ///< the walls of the chosen space, not yet oriented outwards
  std::vector<std::string> notes;          ///< what was done, one phrase each
  std::vector<std::string> cautions = {};  ///< what may not be as intended
};

/// The walls of the chosen space. What the planes cut off is outside; of the rest the space is either what
/// the surface encloses, or its hollow, or the space around a point. Among hollows that no plane closes the
/// largest is chosen, closed across its openings or up to its brim. Corners within `tolerance` of a plane lie
/// on it. Throws Error{bad_mesh}, in one line, if there is no such space, and if none of several hollows is
/// clearly the largest, with a point in each. Cost: O(n log n) a plane, with two trials for each plane whose
/// side is open; for a hollow, that of `hollows_of` and `hollows_below_planes`.
ChosenInterior choose_interior(const Mesh& surface, const InteriorRequest& request, double tolerance);

}  // namespace bernal::cad
