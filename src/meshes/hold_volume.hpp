#pragma once
#include <functional>
#include <span>

#include "meshes/patch_mesh.hpp"

namespace bernal {

/// Moves the points that were added on a part of a sphere outwards, so that its triangles hold the volume of
/// what is between them and the centre below the true sphere: the sum over triangles of r³ Ω / 3, with the
/// solid angle Ω under which the centre sees one. Corners on the sphere hold less, by about h² / 8 r times
/// the area, with edges of length h; a point moves by β times the mean of (a² + b² + c²) / 24 r over the
/// triangles around it, weighted by area, where β is the same for all points of the part.
///
/// `boundary`: points that stay, about the centre, which corners count first. `room`: how far surfaces that
/// must not be met are from a point; no point moves by more than a fifth of that. Where this is too little
/// room, or few points are free, a part of the difference stays. Cost: O(triangles).
///
/// Source of the solid angle: van Oosterom and Strackee, IEEE Trans. Biomed. Eng. 30 (1983) 125.
void hold_volume(std::span<const Vector<3>> boundary, PatchMesh& mesh, double radius,
                 const std::function<double(const Vector<3>&)>& room);

}  // namespace bernal
