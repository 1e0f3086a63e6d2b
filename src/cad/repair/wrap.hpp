#pragma once
#include "bernal/core/monitor.hpp"
#include "cad/repair/repaired_mesh.hpp"

namespace bernal::cad {

/// Replaces a surface, whatever it is like, by a closed one that does not meet itself and that balls of the
/// radius `alpha` reach as near as `offset`: CGAL's alpha wrapping (Portaneri et al. 2022).
///
/// Where the surface has an inside, its chambers are wrapped from there, and the result is contained in them:
/// its corners are `offset` away from the surface, which it nowhere crosses; gaps narrower than alpha are
/// closed, and what is narrower than that inside is lost. A point is inside if most of the six ways from it
/// along the axes cross the surface an odd number of times; orientation does not matter, and holes matter
/// little. Where there is none, the surface is wrapped from outside and so lies within the result. What is
/// open to the outside through gaps wider than alpha is not wrapped, nor is a sheet, of which there would be
/// but the skin. `done` says which, and alpha and offset.
///
/// alpha or offset 0: the diagonal of the bounds / 100, and alpha / 30. Cost: some 200 µs for each of about
/// 3 A / alpha² faces that the result has for a surface of area A; it ends with the mesh as it was when these
/// become more than a million or the monitor stops it, and soon where it gets out of the inside.
RepairedMesh wrap(Mesh mesh, double alpha = 0, double offset = 0, const Monitor& monitor = {});

/// The same with the default offset and an alpha so small that no place is lost where a sphere of that radius
/// fits, or the default alpha if that is smaller. Where the result would have more than a million faces, or
/// leaves the part through gaps that wide, alpha is as small as it can be to a factor of 2, and `done` says
/// for which spheres that is too wide. Radius 0: the default.
RepairedMesh wrap_for_spheres(const Mesh& mesh, double radius, const Monitor& monitor = {});

}  // namespace bernal::cad
