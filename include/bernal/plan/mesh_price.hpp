#pragma once

namespace bernal {

/// What `bernal mesh` needs for a bed.
struct MeshPrice {
  double tetrahedra = 0;
  double seconds = 0;  ///< of one core
  double bytes = 0;    ///< of bernal and the program that fills the surface, at one thread
};

/// The price of the fluid around so many spheres. `sphere_edge`: in radii, as in MeshFileOptions; edges where
/// bridges begin are half as long.
///
/// A sphere takes T(h) = a + b / h³ tetrahedra: the first are those around its contacts, whose edges follow
/// from gaps, the others fill its share of the pores with edges in proportion to h. Constants are measured:
/// for h from 0.2 to 0.6 the meshes of five packings of equal spheres, of packing fractions from 0.3 to 0.55
/// in cylinders and periodic boxes, have 0.7 to 1.3 times as many. Above a million triangles the surface is
/// filled in sections, which takes 1.65 times as long and a third of the memory or less: as 1,000 beads in a
/// column did. Precondition: h above 0.
MeshPrice price_of_mesh(double spheres, double sphere_edge = 0.3);

}  // namespace bernal
