#include "soft/periodic_crowd.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/every_dimension.hpp"
#include "work/periodic_holes.hpp"
#include "work/resize_box.hpp"

namespace bernal {
namespace {

/// The margin takes D times as much off the packing fraction; so many resolutions of the coordinates at
/// least, and never more than the last.
constexpr double least_margin = 1e-4, resolutions_a_margin = 100, largest_margin = 0.01;
/// Of the margin, what single precision leaves to rely on.
constexpr double share_of_margin = 0.97;
/// After so many sweeps it is looked at how far things are.
constexpr int sweeps_a_look = 25;
/// Stuck: at so many looks in a row the strain is more than this share of the least so far.
constexpr double hardly_freer = 0.85;
constexpr int patience = 2;
/// Of the radii in a burst. Where there are more dimensions to give way in, more helps faster: N = 2,000, in
/// five dimensions at 0.302 and six at 0.197, 0.4 s and 0.85 s instead of 0.85 s and 1.3 s.
constexpr double swelling(int dimension) { return dimension <= 4 ? 1.02 : 1.04; }
constexpr int burst_sweeps = 50;
/// Sum of squared overlap ratios of a sphere that will not find its way by itself.
constexpr float severe_squeeze = 0.05f;

}  // namespace

template <int D>
PeriodicCrowd<D>::PeriodicCrowd(Spheres<D> spheres, const Vector<D>& edges, double allowed,
                                std::vector<bool> walls)
    : spheres_(std::move(spheres)), edges_(edges), allowed_(allowed), walls_(std::move(walls)) {
  const double resolution = 0x1p-32 * edges.maxCoeff() / std::ranges::min(spheres_.r);
  margin_ = std::clamp(resolutions_a_margin * resolution, least_margin, largest_margin);
  prepare();
}

template <int D>
template <class Act>
auto PeriodicCrowd<D>::with_engine(Act&& act) const {
  if constexpr (D <= 3) {
    if (wide_) return act(*wide_);
  }
  return act(*any_);
}

/// What matters is how distances compare with radii: instead of larger spheres there is a smaller box.
template <int D>
void PeriodicCrowd<D>::prepare() {
  if (wide_ || any_) list_builds_ = list_builds();
  Spheres<D> shrunk = spheres_;
  for (double& r : shrunk.r) r *= 1 - allowed_;
  Vector<D> edges = edges_;
  resize_box<D>(shrunk, edges, edges_ / (1 + margin_));
  wide_ = nullptr;
  any_ = nullptr;
  if constexpr (D <= 3) {
    if (walls_.empty() && edges.minCoeff() > swelling(D) * SoftPacking::smallest_edge(shrunk.r))
      wide_ = std::make_unique<SoftPacking>(shrunk, edges, soft_kernels().front());
  }
  if (wide_) return;
  any_ = std::make_unique<NeighborRelaxation<D>>(shrunk, edges);
  if (!walls_.empty()) any_->keep_between_walls(walls_, 1 / (1 - allowed_));
}

template <int D>
void PeriodicCrowd<D>::read_places() {
  Vector<D> edges;
  with_engine([&](auto& engine) { engine.write_to(spheres_, edges); });
  resize_box<D>(spheres_, edges, edges_);
}

template <int D>
std::uint64_t PeriodicCrowd<D>::list_builds() const {
  return list_builds_ + with_engine([](auto& engine) { return engine.builds(); });
}

template <int D>
void PeriodicCrowd<D>::sweep(int times, float omega) {
  with_engine([&](auto& engine) {
    for (int k = 0; k < times; ++k) engine.sweep(omega * D / 3);
  });
  sweeps_ += times;
}

template <int D>
void PeriodicCrowd<D>::measure() {
  const Pace pace = pace_for(0);
  with_engine([&](auto& engine) {
    engine.wear_lists(pace.wear);
    largest_overlap_ = engine.sweep_and_measure(pace.omega * D / 3);
    stress_ = engine.stress();
  });
  ++sweeps_;
  double sum = 0;
  for (const float s : stress_) sum += std::sqrt(s);
  strain_ = sum / static_cast<double>(size());
  severe_ =
      static_cast<std::size_t>(std::ranges::count_if(stress_, [](float s) { return s > severe_squeeze; }));
}

template <int D>
typename PeriodicCrowd<D>::Rest PeriodicCrowd<D>::settle(const Monitor& monitor, double most_sweeps) {
  Rest rest = Rest::stuck;
  double least_strain = 1e300;
  for (int slow = 0; slow < patience;) {
    const Pace pace = pace_for(largest_overlap_);
    with_engine([&](auto& engine) { engine.wear_lists(pace.wear); });
    bool cancelled = false;
    for (int k = 1; k < sweeps_a_look && !cancelled; ++k) {
      sweep(1, pace.omega);
      cancelled = monitor.stop();
    }
    measure();
    if (largest_overlap_ < share_of_margin * margin_) rest = Rest::free;
    if (rest == Rest::stuck && sweeps_ > most_sweeps) rest = Rest::over;
    if (cancelled) rest = Rest::cancelled;
    if (rest != Rest::stuck) break;
    slow = strain_ > hardly_freer * least_strain ? slow + 1 : 0;
    least_strain = std::min(least_strain, strain_);  // may swing: only a new low counts, so that this ends
  }
  read_places();
  return rest;
}

template <int D>
void PeriodicCrowd<D>::burst() {
  with_engine([](auto& engine) { engine.grow(1 / swelling(D)); });
  sweep(burst_sweeps, pace_for(0).omega);
  with_engine([](auto& engine) { engine.grow(swelling(D)); });
}

template <int D>
void PeriodicCrowd<D>::relocate(double share, Random& random) {
  const auto count = static_cast<std::size_t>(std::ceil(share * static_cast<double>(size())));
  move_to_holes(std::max(count, severe_), random);
}

template <int D>
void PeriodicCrowd<D>::drop_last(std::size_t count, Random& random) {
  count = std::min(count, size() - 1);
  spheres_.resize(size() - count);
  stress_.resize(size());
  move_to_holes(count, random);
}

template <int D>
void PeriodicCrowd<D>::move_to_holes(std::size_t count, Random& random) {
  std::vector<std::uint32_t> most_squeezed(size());
  std::iota(most_squeezed.begin(), most_squeezed.end(), 0u);
  std::ranges::stable_sort(most_squeezed, std::greater<>(), [&](std::uint32_t i) { return stress_[i]; });
  most_squeezed.resize(std::min(count, size() - 1));
  bernal::move_to_holes<D>(spheres_, edges_, std::move(most_squeezed), random, walls_);
  prepare();
}

#define BERNAL_INSTANTIATE(D) template class PeriodicCrowd<D>;
BERNAL_IN_EVERY_DIMENSION(BERNAL_INSTANTIATE)

}  // namespace bernal
