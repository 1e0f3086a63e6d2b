#include "bernal/measure/structure_factor.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>

#include "bernal/core/dimension.hpp"
#include "core/parallel.hpp"
#include "measure/wave_vectors.hpp"

namespace bernal {
namespace {

/// The number of spheres whose waves are summed together, so that their tables stay in the cache; and of
/// partial sums, which are added in a fixed order.
constexpr std::size_t spheres_together = 32, most_parts = 64;
constexpr double fewest_vectors = 8, most_vectors = 400;  // a bin
/// Of large packings so many a bin at least, and where the first peak is, so that its height is known to a
/// fourteenth.
constexpr double enough_vectors = 24, enough_at_peak = 200;
constexpr double peak_from = 4, peak_to = 10;  // inverse mean diameters
// Standard deviations: one box of random points in a hundred has such a bin.
constexpr double surely_higher = 4.5;

/// exp(i 2π n x) of some spheres along one axis, for any n: from a table unless it would be too large.
class Waves {
 public:
  /// `x` in periods.
  void fill(const std::vector<double>& x, std::size_t first, std::size_t count, int largest) {
    for (std::size_t j = 0; j < spheres_together; ++j) {
      is_there_[j] = j < count ? 1 : 0;
      turn_[j] = j < count ? 2 * std::numbers::pi * std::remainder(x[first + j], 1.0) : 0;
    }
    in_table_ = std::min(largest, largest_table);
    table_.resize((static_cast<std::size_t>(in_table_) + 1) * 2 * spheres_together);
    if (in_table_ > 0) compute(1, step_.data());
    for (int n = 0; n <= in_table_; ++n) {
      double* cosine = row(n);
      if (n % steps_taken == 0) {  // a product loses a roundoff
        compute(n, cosine);
        continue;
      }
      double* sine = cosine + spheres_together;
      const double *c = row(n - 1), *s = c + spheres_together;
      const double *step_c = step_.data(), *step_s = step_c + spheres_together;
      for (std::size_t j = 0; j < spheres_together; ++j) {
        cosine[j] = c[j] * step_c[j] - s[j] * step_s[j];
        sine[j] = s[j] * step_c[j] + c[j] * step_s[j];
      }
    }
  }
  /// The cosines, then the sines; 0 for missing spheres. Precondition: n >= 0.
  const double* of(int n) {
    if (n <= in_table_) return row(n);
    compute(n, one_.data());
    return one_.data();
  }

 private:
  static constexpr int largest_table = 1000, steps_taken = 16;
  double* row(int n) { return table_.data() + static_cast<std::size_t>(2 * n) * spheres_together; }
  void compute(int n, double* cosine) const {
    for (std::size_t j = 0; j < spheres_together; ++j) {
      cosine[j] = is_there_[j] * std::cos(n * turn_[j]);
      cosine[spheres_together + j] = is_there_[j] * std::sin(n * turn_[j]);
    }
  }

  std::array<double, spheres_together> turn_, is_there_;
  std::array<double, 2 * spheres_together> step_, one_;
  std::vector<double> table_;
  int in_table_ = 0;
};

template <int D>
class WaveSums {
 public:
  WaveSums(Spheres<D> spheres, const TiltedBoundary<D>& boundary,
           const std::vector<std::vector<WaveVector<D>>>& bins)
      : in_periods_(std::move(spheres)) {
    for (std::size_t i = 0; i < in_periods_.size(); ++i)
      in_periods_.set_center(i, boundary.in_cell_vectors(in_periods_.center(i)));
    largest_.setZero();
    for (const auto& bin : bins)
      for (const auto& vector : bin) {
        vectors_.push_back(vector.n);
        largest_ = largest_.cwiseMax(vector.n.cwiseAbs());
      }
  }

  /// |Σ exp(i k·c)|² of every vector.
  std::vector<double> squares() const {
    const std::size_t n = in_periods_.size(), groups = (n + spheres_together - 1) / spheres_together;
    const std::size_t parts = std::min(groups, most_parts);
    std::vector<std::vector<std::complex<double>>> sums(parts);
    parallel_for(parts, [&](std::size_t part) {
      sums[part].resize(vectors_.size());
      std::array<Waves, D> waves;
      for (std::size_t group = part * groups / parts; group < (part + 1) * groups / parts; ++group) {
        throw_if_interrupted();
        const std::size_t first = group * spheres_together;
        for (int k = 0; k < D; ++k)
          waves[k].fill(in_periods_.x[k], first, std::min(spheres_together, n - first), largest_[k]);
        for (std::size_t v = 0; v < vectors_.size(); ++v) sums[part][v] += sum(waves, vectors_[v]);
      }
    });
    std::vector<double> squares;
    for (std::size_t v = 0; v < vectors_.size(); ++v) {
      std::complex<double> all = 0;
      for (const auto& part : sums) all += part[v];
      squares.push_back(std::norm(all));
    }
    return squares;
  }

 private:
  /// Pairwise, which is faster than sequential sums.
  static double sum_in_halves(std::array<double, spheres_together>& values) {
    static_assert(std::has_single_bit(spheres_together));
    for (std::size_t half = spheres_together / 2; half > 0; half /= 2)
      for (std::size_t j = 0; j < half; ++j) values[j] += values[half + j];
    return values[0];
  }

  static std::complex<double> sum(std::array<Waves, D>& waves, const Eigen::Matrix<int, D, 1>& n) {
    std::array<double, spheres_together> re, im;
    const double *c = waves[0].of(std::abs(n[0])), *s = c + spheres_together;
    const double sign = n[0] < 0 ? -1 : 1;
    for (std::size_t j = 0; j < spheres_together; ++j) {
      re[j] = c[j];
      im[j] = sign * s[j];
    }
    for (int k = 1; k < D; ++k) {
      if (n[k] == 0) continue;
      c = waves[k].of(std::abs(n[k]));
      s = c + spheres_together;
      const double turn = n[k] < 0 ? -1 : 1;
      for (std::size_t j = 0; j < spheres_together; ++j) {
        const double real = re[j] * c[j] - turn * im[j] * s[j];
        im[j] = turn * re[j] * s[j] + im[j] * c[j];
        re[j] = real;
      }
    }
    return {sum_in_halves(re), sum_in_halves(im)};
  }

  Spheres<D> in_periods_;
  std::vector<Eigen::Matrix<int, D, 1>> vectors_;
  Eigen::Matrix<int, D, 1> largest_;
};

/// Mean and standard error of a bin.
template <int D>
void add_bin(const std::vector<WaveVector<D>>& vectors, std::span<const double> squares, double spheres,
             StructureFactor& found) {
  const auto n = static_cast<double>(vectors.size());
  double k = 0, s = 0, scatter = 0;
  for (const auto& vector : vectors) k += vector.length / n;
  for (const double square : squares) s += square / spheres / n;
  for (const double square : squares) scatter += (square / spheres - s) * (square / spheres - s);
  found.k.push_back(k);
  found.s.push_back(s);
  found.error.push_back((n < fewest_vectors ? s : std::sqrt(scatter / (n - 1))) / std::sqrt(n));
  found.vectors.push_back(static_cast<std::uint32_t>(vectors.size()));
  found.references += vectors.size();
}

}  // namespace

std::optional<StructureFactor::Peak> StructureFactor::peak() const {
  std::optional<std::size_t> highest;
  for (std::size_t b = 0; b < k.size(); ++b)
    if (k[b] * mean_diameter > peak_from && k[b] * mean_diameter < peak_to &&
        (!highest || s[b] > s[*highest]))
      highest = b;
  if (!highest || *highest == 0 || *highest + 1 == k.size()) return {};
  const std::size_t b = *highest;
  // Random centres have 1 ± 1/√vectors in every bin; the highest of thirty bins must exceed this.
  const double by_chance = 1 + surely_higher / std::sqrt(static_cast<double>(vectors[b]));
  if (!(vectors[b] >= fewest_vectors && s[b] > s[b - 1] && s[b] > s[b + 1] && s[b] > by_chance)) return {};
  return Peak{k[b], s[b], error[b]};
}

std::optional<StructureFactor> structure_factor(const Spheres<dynamic>& spheres, const Domain& domain,
                                                const StructureOptions& options) {
  if (has_walls(domain) || spheres.size() < 2 || spheres.size() > options.most_spheres) return {};
  const auto n = static_cast<double>(spheres.size());
  StructureFactor found;
  found.mean_diameter = 2 * std::accumulate(spheres.r.begin(), spheres.r.end(), 0.0) / n;
  found.bin_width = options.bin / found.mean_diameter;
  const auto bins = static_cast<std::size_t>(std::ceil(options.reach / options.bin));
  const double affordable = options.work / n / static_cast<double>(bins);
  std::vector<std::size_t> a_bin(bins);
  for (std::size_t bin = 0; bin < bins; ++bin) {
    const double k = options.bin * static_cast<double>(bin);
    const double enough = k + options.bin > peak_from && k < peak_to ? enough_at_peak : enough_vectors;
    a_bin[bin] = static_cast<std::size_t>(std::clamp(affordable, enough, most_vectors));
  }
  with_dimension(spheres.dimension(), EveryDimension{}, [&](auto dimension) {
    constexpr int D = dimension;
    const TiltedBoundary<D> boundary = tilted_boundary_of<D>(domain);
    const auto vectors = wave_vectors<D>(boundary, found.bin_width, a_bin);
    const std::vector<double> squares = WaveSums<D>(spheres.in<D>(), boundary, vectors).squares();
    std::size_t first = 0;
    for (const auto& bin : vectors) {
      if (bin.empty()) continue;
      add_bin<D>(bin, std::span(squares).subspan(first, bin.size()), n, found);
      first += bin.size();
    }
  });
  if (found.k.empty()) return {};
  return found;
}

}  // namespace bernal
