#pragma once
#include <functional>
#include <string>

#include "cad/repair/repaired_mesh.hpp"

namespace bernal::cad {

/// Lets `repair` change the mesh in a child process, within so many seconds of processor time and 4 GiB of
/// memory and 20 kB a face: CGAL's exact numbers grow without a bound where many faces cross in a plane, and
/// it looks at no monitor. What it could not repair within these comes back as it was, and is told.
RepairedMesh repair_in_cage(const Mesh& mesh, double seconds, const std::function<RepairedMesh()>& repair);

/// "of 151 x 80 x 193 are left 122 x 54 x 55", where a repair took from the extent of a part, along some
/// axis, more than rounding edges off does; else nothing.
std::string what_is_left(const Mesh& before, const Mesh& after);

}  // namespace bernal::cad
