#pragma once
#include <optional>

namespace bernal {

enum class RelaxMethod {
  fast,       ///< on neighbour lists, with over-relaxed steps
  reference,  ///< the published loop as it stands, a hundred times slower
};

/// The processor on which spheres push each other.
enum class RelaxDevice {
  processor,
  gpu,  ///< an NVIDIA GPU, if bernal was built for it; another packing of the same kind
};

/// Spheres start with overlaps and push each other apart (Zhao, Li & Liu 2007). A periodic box grows
/// meanwhile; in a container the walls push too, and spheres that are stuck are stirred.
struct Relax {
  // in periodic boxes
  double alpha = 17;  ///< sweeps between two growths of the box, in units of (log10 N)²
  /// Sweeps between two growths of the box, for any N; it takes the place of alpha.
  std::optional<int> period = {};
  double beta = 30;  ///< the box grows by the largest overlap ratio divided by this
  /// Packing fraction at the start; if empty 0.86, or what suits the dimension.
  std::optional<double> phi0 = {};
  double stop = 2e-4;  ///< largest overlap ratio that counts as none
  RelaxMethod method = RelaxMethod::fast;
  RelaxDevice device = RelaxDevice::processor;
  bool settle = false;  ///< reference: a sphere that touches nothing moves to touch its nearest neighbour
  // in both
  /// Spheres exchange their sizes while they push each other. This makes disordered packings of the same
  /// sizes denser by 0.03 to 0.07, if the sizes come close to each other: 0.717 in place of 0.672 for
  /// lognormal sizes with sigma 0.3. Such packings are optimised; pouring and shaking do not make them.
  bool exchange = false;
  /// The gap and overlap ratio to which contacts, also those with walls, are closed at the end; 0: they are
  /// not. A periodic box adapts; in a container all sizes grow by one factor until the spheres jam.
  double polish = 0;
  // in containers
  int patience = 12;   ///< how often spheres that are stuck are stirred before some are taken out
  int sweeps = 40000;  ///< at most
  double seconds = 0;  ///< at most; 0: as long as it takes
};

}  // namespace bernal
