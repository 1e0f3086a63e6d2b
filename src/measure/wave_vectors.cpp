#include "measure/wave_vectors.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "bernal/core/random.hpp"
#include "core/every_dimension.hpp"
#include "core/order.hpp"

namespace bernal {
namespace {

/// The most vectors that are enumerated.
constexpr double most_looked_through = 2e5;
constexpr std::size_t tries_a_vector = 20;
constexpr double largest_multiple = 1e9;

template <int D>
using Multiples = Eigen::Matrix<int, D, 1>;

/// One of n and -n, and not zero: the last nonzero component is positive.
template <int D>
bool is_representative(const Multiples<D>& n) {
  for (int k = D; k-- > 0;)
    if (n[k] != 0) return n[k] > 0;
  return false;
}

template <int D>
Vector<D> steps_of(const Vector<D>& lengths) {
  return (2 * std::numbers::pi * lengths.cwiseInverse()).eval();
}

/// The wave vector k with k·a = 2π n for each cell vector a; `step` is 2π / edge.
template <int D>
Vector<D> wave_of(const Multiples<D>& n, const Vector<D>& step, const TiltedBoundary<D>& boundary) {
  Vector<D> wave = n.template cast<double>().cwiseProduct(step);
  for (int k = 1; k < D; ++k)
    for (int j = 0; j < k; ++j) wave[k] -= boundary.along(k, j) * wave[j] / boundary.edges[k];
  return wave;
}
/// The inverse, in numbers that need not be whole.
template <int D>
Vector<D> multiples_of(const Vector<D>& wave, const Vector<D>& step, const TiltedBoundary<D>& boundary) {
  Vector<D> multiples = wave.cwiseQuotient(step);
  for (int k = 1; k < D; ++k)
    for (int j = 0; j < k; ++j) multiples[k] += wave[j] * boundary.along(k, j) / (2 * std::numbers::pi);
  return multiples;
}

/// The largest number of bins whose vectors are few enough to be enumerated.
template <int D>
std::size_t bins_looked_through(const Vector<D>& step, double width, std::size_t bins) {
  const auto vectors = [&](std::size_t count) {
    double product = 0.5;
    for (const double s : step) product *= 2 * std::floor(static_cast<double>(count) * width / s) + 1;
    return product;
  };
  std::size_t low = 0, high = bins;
  while (low < high) {
    const std::size_t middle = (low + high + 1) / 2;
    if (vectors(middle) <= most_looked_through)
      low = middle;
    else
      high = middle - 1;
  }
  return low;
}

template <int D, class Visit>
void for_each_multiple(const Vector<D>& step, double longest, Visit&& visit) {
  Multiples<D> limit, n;
  for (int k = 0; k < D; ++k) limit[k] = static_cast<int>(std::floor(longest / step[k]));
  n = -limit;
  for (int k = 0; k < D;) {
    if (is_representative<D>(n)) visit(n);
    for (k = 0; k < D && ++n[k] > limit[k]; ++k) n[k] = -limit[k];
  }
}

/// Keeps `most` of them, evenly.
template <int D>
void thin_out(std::vector<WaveVector<D>>& vectors, std::size_t most) {
  if (vectors.size() <= most) return;
  std::vector<double> lengths;
  for (const WaveVector<D>& vector : vectors) lengths.push_back(vector.length);
  const std::vector<std::uint32_t> order = smallest_first(lengths);
  std::vector<WaveVector<D>> some;
  for (std::size_t k = 0; k < most; ++k)
    some.push_back(vectors[order[(2 * k + 1) * order.size() / (2 * most)]]);
  vectors.swap(some);
}

}  // namespace

template <int D>
std::vector<std::vector<WaveVector<D>>> wave_vectors(const TiltedBoundary<D>& boundary, double width,
                                                     const std::vector<std::size_t>& most) {
  const std::size_t bins = most.size();
  const Vector<D> step = steps_of<D>(boundary.edges);
  const auto length_of = [&](const Multiples<D>& n) { return wave_of<D>(n, step, boundary).norm(); };
  // k·a = 2π n bounds n by the length of the cell vector a.
  Vector<D> least_step = step;
  if (boundary.is_tilted()) {
    Vector<D> lengths;
    for (int k = 0; k < D; ++k) lengths[k] = boundary.cell_vector(k).norm();
    least_step = steps_of<D>(lengths);
  }
  std::vector<std::vector<WaveVector<D>>> found(bins);
  const std::size_t looked_through = bins_looked_through<D>(least_step, width, bins);
  for_each_multiple<D>(least_step, static_cast<double>(looked_through) * width, [&](const Multiples<D>& n) {
    const double length = length_of(n);
    const auto bin = static_cast<std::size_t>(length / width);
    if (bin < looked_through) found[bin].push_back({n, length});
  });
  for (std::size_t bin = 0; bin < bins; ++bin) thin_out<D>(found[bin], most[bin]);

  const auto before = [](const Multiples<D>& a, const Multiples<D>& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  };
  for (std::size_t bin = looked_through; bin < bins; ++bin) {
    Random random(2, stream(Stream::measure, bin));
    std::set<Multiples<D>, decltype(before)> drawn(before);
    for (std::size_t k = 0; k < tries_a_vector * most[bin] && found[bin].size() < most[bin]; ++k) {
      const double wanted = (static_cast<double>(bin) + random.uniform()) * width;
      const Vector<D> direction = uniform_direction<D>(random);
      const Vector<D> multiples = wanted * multiples_of<D>(direction, step, boundary);
      if (!(multiples.cwiseAbs().maxCoeff() < largest_multiple)) continue;
      Multiples<D> n;
      for (int axis = 0; axis < D; ++axis) n[axis] = static_cast<int>(std::nearbyint(multiples[axis]));
      if (!is_representative<D>(n)) n = -n;
      const double length = length_of(n);
      if (!is_representative<D>(n) || static_cast<std::size_t>(length / width) != bin) continue;
      if (drawn.insert(n).second) found[bin].push_back({n, length});
    }
  }
  return found;
}

#define BERNAL_INSTANTIATE(D)                                                                     \
  template std::vector<std::vector<WaveVector<D>>> wave_vectors(const TiltedBoundary<D>&, double, \
                                                                const std::vector<std::size_t>&);
BERNAL_IN_EVERY_DIMENSION(BERNAL_INSTANTIATE)
#undef BERNAL_INSTANTIATE

}  // namespace bernal
