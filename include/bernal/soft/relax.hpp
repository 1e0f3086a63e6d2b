#pragma once
#include <optional>

namespace bernal {

enum class RelaxMethod {
  fast,       ///< on neighbour lists, with over-relaxed steps
  reference,  ///< the published loop as it stands, a hundred times slower
};

/// Where spheres push each other.
enum class RelaxDevice {
  processor,
  gpu,  ///< an NVIDIA GPU, where bernal was built for it; the spheres in another order
};

/// Spheres start with overlaps and push each other apart (Zhao, Li & Liu 2007). In a periodic box the box
/// grows meanwhile; in a container the walls push too, and what is stuck is stirred.
struct Relax {
  // in periodic boxes
  double alpha = 17;  ///< sweeps between two growths of the box, in units of (log10 N)²
  /// Sweeps between two growths of the box, whatever N is, in place of those that alpha gives.
  std::optional<int> period = {};
  double beta = 30;  ///< the box grows by the largest overlap ratio divided by this
  /// Packing fraction at the start; without it 0.86, or what suits the dimension.
  std::optional<double> phi0 = {};
  double stop = 2e-4;  ///< largest overlap ratio that counts as none
  RelaxMethod method = RelaxMethod::fast;
  RelaxDevice device = RelaxDevice::processor;
  bool settle = false;  ///< reference: what touches nothing moves to touch its nearest neighbour
  // in both
  /// Spheres exchange their sizes while they push each other, which makes disordered packings of the same
  /// sizes denser by 0.03 to 0.07 where sizes come close to each other: lognormal with sigma 0.3 0.717 in
  /// place of 0.672. Such packings are optimised; nothing that is poured or shaken comes to be one.
  bool exchange = false;
  /// Gap and overlap ratio to which contacts, those with walls among them, are closed in the end; 0: not at
  /// all. A periodic box follows; in a container all sizes grow by one factor until the spheres jam.
  double polish = 0;
  // in containers
  int patience = 12;   ///< how often spheres that are stuck are stirred before some are taken out
  int sweeps = 40000;  ///< at most
  double seconds = 0;  ///< at most; 0: as long as it takes
};

}  // namespace bernal
