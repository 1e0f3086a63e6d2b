#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "bernal/core/monitor.hpp"
#include "bernal/core/random.hpp"
#include "bernal/domain/container.hpp"
#include "domain/places.hpp"
#include "work/reporter.hpp"
#include "work/spheres_in_bed.hpp"

namespace bernal {

inline constexpr std::size_t most_few = 128;
/// Whether so many spheres are few: these are packed as tightly as is found, in a container that has walls
/// all around.
bool are_few(std::size_t count, const Container& container);

/// The gaps that `place_few` leaves at least: in roundings of a coordinate on its way into the scene's unit,
/// what the rounding of two centres, of walls and of distances takes away. The search itself takes place in
/// the packer's frame, with the container's middle at the origin, and knows nothing of where that is.
double gap_of_few(const Container& container);

/// What a whole search takes, on one thread; where walls are many pieces some times as much.
double seconds_of_few(double count);
/// Of a search, what each sphere is worth that nobody has asked for by number: some 0.3 s at most.
double effort_of_one_more(double count);

/// How long it is searched, and for whom.
struct FewWish {
  /// It ends with the first arrangement in which all radii may be so many times as large.
  double enough;
  /// Share of the whole search, see `seconds_of_few`.
  double effort = 1;
  std::uint64_t seed = 1;
  const Monitor& monitor;
  /// Told now and then how much of the search is done, and the largest factor so far.
  std::function<void(double done, double size)> tell = {};
};

struct FewPacked {
  std::vector<Vector<3>> centers;  ///< in the order of the radii
  double size = 0;                 ///< factor for all radii at which nothing overlaps; 0: nothing was found
  std::uint64_t minima = 0;        ///< that were looked at
  bool cancelled = false;
};

/// Places for few spheres at which all radii may be as large as possible by one factor, see `FewEnergy`.
///
/// From the widest simple cubic lattice along the axes, and then from random places, from symmetric ones and
/// from lattices by turns, the spheres relax under a load; the tightest of these, and then others, hop from
/// minimum to minimum: all or those of a region are shaken, or some, the most or the least squeezed or any,
/// are put into holes, and what is not looser stays (Grosso, Jamali, Locatelli & Schoen, J. Global Optim. 47,
/// 63 (2010)). What may be the tightest yet relaxes under a tenth of the load, and if it still may be and
/// nothing near is tighter, its contacts are closed (`close_few`), to 1e-13 of the radii: the tightest of
/// these is the result. One sphere begins in the roomiest place that is known (`largest_room`), and that is
/// all.
///
/// One thread; the same bits each time, whatever the number of threads, and the same way whatever `enough`
/// is. A search that is not to be won is given up early: where the tightest after a quarter of it is less
/// than 0.95 of what is asked for. Cut short, it returns the tightest so far. Precondition: `are_few`.
FewPacked pack_few(const std::vector<double>& radii, const Container& container, const Places& places,
                   const FewWish& wish);

/// The end of a stage that packs a bed and ended like that: where fewer spheres stand than are asked for, or
/// as many as fit are to be placed, and these are few, searches for an arrangement of all, and of one more
/// than there are as long as there is one. Equal spheres that may are first laid out on a cubic lattice, which
/// in a box that they divide needs no play (`crystal_sites`); else gaps are `gap_of_few` at least: so it
/// finds a place for all where the tightest arrangement leaves a play of 1e-9 and is found. One that the task
/// brings with it is taken without a search. What stands is the start of the drawn sequence, and what stood
/// before where the search is cut short; `Reporter::account` says that one more was tried. Returns `full` for
/// an open target then, `converged` where all stand, else `end`.
StageEnd place_few(StageEnd end, SpheresInBed& in_bed, Reporter& report, bool may_be_lattice);

}  // namespace bernal
