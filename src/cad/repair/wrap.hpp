#pragma once
#include "bernal/core/monitor.hpp"
#include "cad/repair/repaired_mesh.hpp"

namespace bernal::cad {

/// Replaces any surface by a closed one without self-intersections, which balls of the radius `alpha` reach
/// as near as `offset`: CGAL's alpha wrapping (Portaneri et al. 2022).
///
/// If the surface has an inside, its chambers are wrapped from inside, and the result lies within them: its
/// corners are `offset` away from the surface, which it does not cross; gaps narrower than alpha are closed,
/// and parts of the inside narrower than that are lost. A point is inside if at least five of the six rays
/// from it along the axes cross the surface an odd number of times; orientation does not matter, and holes
/// matter little. Otherwise the surface is wrapped from outside and lies within the result. Spaces open to
/// the outside through gaps wider than alpha are not wrapped, nor is a sheet, of which only the skin would
/// result. `done` states the case, alpha and offset.
///
/// alpha or offset 0: the diagonal of the bounds / 100, and alpha / 30. Cost: about 200 µs for each of the
/// result's faces, about 3 A / alpha² for a surface of area A. The mesh is unchanged if these exceed a
/// million, if the monitor stops, or if a wrap from inside gets out.
RepairedMesh wrap(Mesh mesh, double alpha = 0, double offset = 0, const Monitor& monitor = {});

/// The same with the default offset and the largest alpha that loses no place where a sphere of that radius
/// fits, or the default alpha if that is smaller. If the result would have more than a million faces, or
/// would leave the part through its gaps, alpha is the smallest that works, to a factor of 2, and `done`
/// names the spheres for which it is too coarse. Radius 0: the default.
RepairedMesh wrap_for_spheres(const Mesh& mesh, double radius, const Monitor& monitor = {});

}  // namespace bernal::cad
