#pragma once
#include <vector>

#include "bernal/settle/refill.hpp"
#include "bernal/settle/shake.hpp"
#include "work/stage_entry.hpp"

namespace bernal {

/// Compression (Han, Feng & Owen 2005, section 2.1). In an iteration all spheres get a bounding box and all
/// neighbour lists are built together; then sphere after sphere, from the bottom up, moves along the global
/// direction to first touch, with its neighbours fixed, and slides on along its contacts. Once the bed is at
/// rest along the global direction, chains of spheres that support each other are broken by sweeps in which
/// every sphere moves along a random *local* direction about the global one. When no layer sinks any more
/// (see Compress::rest) every sphere rolls to rest, and the stage has converged; with a `tolerance`, when the
/// potential energy along the direction has stopped falling. The direction must be normal to the periodic
/// axes (see `require_support`), so that this energy is that of all images. Whether spheres still hang is
/// tested by the run.
///
/// Additions to the paper: sliding along contacts, which with the global direction alone fills Han's cylinder
/// to a packing fraction of 0.527 and with local directions to 0.58; skipping of spheres whose surroundings
/// have not changed; and the skin. Cost: about 0.5 µs a sphere and sweep; an iteration makes up to 8 sweeps
/// along the global direction, over the spheres that are awake, and 10 along local directions.
StageEnd compress(const Compress& options, SpheresInBed& in_bed, Reporter& report);

/// Shaking (Han, Feng & Owen 2005): iterations break arches that withstand compression. In them every sphere
/// moves along a random local direction *perpendicular* to the global one, to first touch and on along its
/// contacts. Then the bed is compressed again; the last of these compressions determines the result. Cost: 10
/// sweeps a round, and those of the compression.
StageEnd shake(const Shake& options, SpheresInBed& in_bed, Reporter& report);

/// How compression presses.
Pressing pressing_of_compression(const Compress&);

/// Throws Error{bad_scene} if spheres pressed along `direction` would fall for ever: it must have no
/// component along a periodic axis.
void require_support(const Boundary<3>& boundary, const Vector<3>& direction);
/// As a unit vector; in two dimensions in the plane z = 0.
Vector<3> direction_of(const Coordinates& direction);
/// Common to all stages that end with a compression: their keys, and their item of the plan.
std::vector<schema::Key> compression_keys();
std::vector<schema::Choice> ends_of_compression();

/// Their effects with their prices.
std::vector<PlanItem> effects_of_compression(const Compress& options, const Outlook& outlook);
std::vector<PlanItem> effects_of_shaking(const Shake& options, const Outlook& outlook);
std::vector<PlanItem> effects_of_refilling(const Refill& options, const Outlook& outlook);

/// One sweep: every sphere slides along a random direction of its own, the normalised `pull` + `tilt`·(random
/// unit vector, without its part along `across` if that is not zero), by at most `limit`. Compression and
/// shaking differ only in these arguments.
void sweep_at_random(Bed& bed, const Vector<3>& pull, double tilt, const Vector<3>& across, double limit,
                     Random& random);

}  // namespace bernal
