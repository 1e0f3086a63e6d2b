#pragma once
#include <cstdint>
#include <optional>
#include <span>

#include "bernal/core/random.hpp"
#include "bernal/sizes/even_classes.hpp"
#include "bernal/sizes/size_distribution.hpp"

namespace bernal {

/// How the radii of a packing are drawn from their distribution.
enum class Draw {
  random,     ///< independently
  quantiles,  ///< evenly spread over the distribution, for any number of draws
};

/// The endless sequence of a packing's radii: a function of distribution, seed and `Draw`.
///
/// `quantiles` takes the k-th radius at u_k = frac(u_0 + k/φ), with φ the golden ratio and u_0 from the seed:
/// the first N are as even as N points can be, for every N. Classes come within one of their share for every
/// N, see `EvenClasses`. So the share of spheres up to any radius, and the mean of r³ for bounded r, match
/// the distribution up to O(log N / N); random draws leave O(1/√N). The order is not random: neighbours in
/// the sequence differ. The distribution must outlive the sequence, and so must `first`, radii that come
/// before any is drawn.
class RadiusSequence {
 public:
  RadiusSequence(const SizeDistribution& sizes, std::uint64_t seed, Draw draw,
                 std::span<const double> first = {})
      : sizes_(sizes), first_(first), random_(seed, stream(Stream::radii)), even_(draw == Draw::quantiles) {
    if (!even_) return;
    next_ = random_();
    classes_ = EvenClasses(sizes);
  }

  double next();

 private:
  const SizeDistribution& sizes_;
  std::span<const double> first_;
  Random random_;
  bool even_;
  std::uint64_t next_ = 0;              ///< u_k in units of 2^-64
  std::optional<EvenClasses> classes_;  ///< only for `quantiles`
};

}  // namespace bernal
