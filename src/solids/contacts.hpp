#pragma once
#include <cstddef>
#include <string>

#include "bernal/core/monitor.hpp"
#include "bernal/core/spheres.hpp"
#include "bernal/domain/domain.hpp"
#include "bernal/solids/contact_treatment.hpp"

namespace bernal {

/// What was done about contacts, and what is there now. Gaps are ratios: of two spheres over the sum of their
/// radii, of a sphere and a wall over the radius.
struct ContactReport {
  ContactTreatment treatment = ContactTreatment::none;
  double gap = 0;             ///< asked for
  std::size_t spheres = 0;    ///< in all
  std::size_t changed = 0;    ///< of these
  std::size_t pairs = 0;      ///< that were nearer than the gap, of spheres and images
  std::size_t walls = 0;      ///< places of the wall that were nearer to a sphere than the gap
  double largest_change = 0;  ///< of a radius, over the radius
  double volume_before = 0, volume_after = 0;  ///< of all solids, each once
  double domain_volume = 0;
  double contact_area = 0;    ///< of bridges: their cross-sections; of caps: the flat faces
  double smallest_angle = 0;  ///< between the surfaces that meet at the rim of a bridge, in degrees
  /// Caps: how many of one sphere meet another of the same. Bridges: how many meet a third sphere or each
  /// other.
  std::size_t meetings = 0;
  /// The gap that was proven in exact arithmetic, see `solids_of`; 0 where none was.
  double proven_gap = 0;

  double change_of_porosity() const {
    return domain_volume > 0 ? (volume_before - volume_after) / domain_volume : 0;
  }
};

/// One line for people.
std::string words_on(const ContactReport&);

/// How far radii have to fall. gap: each to r_i · min(1, min_j d_ij / ((1 + gap)(r_i + r_j)), clearance_i /
/// ((1 + gap) r_i)): both spheres of a pair by one factor, and each as far as the nearest of its neighbours
/// asks for; that depends on no order, and leaves spheres that are nobody's neighbour as they are. shrink:
/// all by the least of these factors. Then, proven by the certificate of spheres of radius r (1 + gap),
/// rounded up: |ci - cj| >= (1 + gap)(ri + rj) for all pairs and images, clearance >= (1 + gap) r. Where
/// rounding got in the way, those that have changed lose some roundoffs more. `single`: diameters stay in
/// single precision.
///
/// Precondition: treatment is gap or shrink. Throws Error{bad_argument} for spheres whose centres are outside
/// the walls or coincide, Cancelled. Cost: O(N), that of two certificates, and a container's for a mesh.
ContactReport shrink_contacts(Spheres<dynamic>&, const Domain&, ContactTreatment, double gap, bool single,
                              const Monitor& monitor = {});

/// Whether |ci - cj| >= (1 + gap)(ri + rj) for all pairs and images and clearance >= (1 + gap) r: exact.
bool has_gap(const Spheres<dynamic>&, const Domain&, double gap, const Monitor& monitor = {});

/// Of whole balls of any dimension.
double volume_of_balls(const Spheres<dynamic>&);

}  // namespace bernal
