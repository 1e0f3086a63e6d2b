#pragma once
#include <cstddef>
#include <string>

#include "bernal/core/monitor.hpp"
#include "bernal/core/spheres.hpp"
#include "bernal/domain/domain.hpp"
#include "bernal/solids/contact_treatment.hpp"

namespace bernal {

/// The treatment of contacts and its result. Gaps are ratios: for two spheres over the sum of their radii,
/// for a sphere and a wall over the radius.
struct ContactReport {
  ContactTreatment treatment = ContactTreatment::none;
  double gap = 0;                              ///< as requested
  std::size_t spheres = 0;                     ///< all spheres
  std::size_t changed = 0;                     ///< spheres that were changed
  std::size_t pairs = 0;                       ///< pairs closer than the gap, images included
  std::size_t walls = 0;                       ///< places on the wall closer to a sphere than the gap
  double largest_change = 0;                   ///< of a radius, over the radius
  double volume_before = 0, volume_after = 0;  ///< of all solids, each counted once
  double domain_volume = 0;
  double contact_area = 0;    ///< bridges: their cross-sections; caps: the flat faces
  double smallest_angle = 0;  ///< between surfaces at the rim of a bridge, in degrees
  /// Caps: how many meet another on the same sphere. Bridges: how many meet a third sphere or each other.
  std::size_t meetings = 0;
  /// The gap proven in exact arithmetic, see `solids_of`; 0 if none.
  double proven_gap = 0;

  double change_of_porosity() const {
    return domain_volume > 0 ? (volume_before - volume_after) / domain_volume : 0;
  }
};

/// The report in one line.
std::string contact_text(const ContactReport&);

/// Shrinks radii until the gap is kept. gap: each to r_i · min(1, min_j d_ij / ((1 + gap)(r_i + r_j)),
/// clearance_i / ((1 + gap) r_i)): both spheres of a pair by one factor, and each as far as its nearest
/// neighbour requires; the result does not depend on an order, and isolated spheres do not change. shrink:
/// all by the least of these factors. Then the certificate of spheres of radius r (1 + gap), rounded up,
/// proves |ci - cj| >= (1 + gap)(ri + rj) for all pairs and images, and clearance >= (1 + gap) r. If rounding
/// prevents this, changed spheres lose some more roundoffs. `single`: diameters stay in single precision.
///
/// Precondition: treatment is gap or shrink. Throws Error{bad_argument} if spheres have centres outside the
/// walls or coincident centres, Cancelled. Cost: O(N), two certificates, and a container for a mesh.
ContactReport shrink_contacts(Spheres<dynamic>&, const Domain&, ContactTreatment, double gap, bool single,
                              const Monitor& monitor = {});

/// Whether |ci - cj| >= (1 + gap)(ri + rj) for all pairs and images and clearance >= (1 + gap) r: exact.
bool has_gap(const Spheres<dynamic>&, const Domain&, double gap, const Monitor& monitor = {});

/// Total volume of whole balls of any dimension.
double volume_of_balls(const Spheres<dynamic>&);

}  // namespace bernal
