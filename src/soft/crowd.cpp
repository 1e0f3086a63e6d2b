#include "soft/crowd.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "work/holes.hpp"

namespace bernal {
namespace {

/// Of the margin, what single precision leaves to rely on.
constexpr double share_of_margin = 0.97;
/// After so many sweeps it is looked at how far things are.
constexpr int sweeps_a_look = 25;
/// Stuck: at so many looks in a row the strain is more than this share of the least so far.
constexpr double hardly_freer = 0.85;
constexpr int patience = 2;
/// The margin is so many resolutions of the coordinates at least, and never more than this.
constexpr double resolutions_a_margin = 100, largest_margin = 0.01;
constexpr double burst_swelling = 1.02;
constexpr int burst_sweeps = 50;
/// Random places that are looked at for each sphere to find holes.
constexpr double probes_a_sphere = 2, least_probes = 1000;
/// Sum of squared overlap ratios of a sphere that will not find its way by itself.
constexpr float severe_squeeze = 0.05f;

/// The indices of the `count` largest, the largest first.
std::vector<std::uint32_t> most_squeezed(const std::vector<float>& stress, std::size_t count) {
  std::vector<std::uint32_t> ids(stress.size());
  std::iota(ids.begin(), ids.end(), 0u);
  count = std::min(count, ids.size());
  std::ranges::partial_sort(ids, ids.begin() + static_cast<std::ptrdiff_t>(count), [&](auto a, auto b) {
    return stress[a] != stress[b] ? stress[a] > stress[b] : a < b;
  });
  ids.resize(count);
  return ids;
}

}  // namespace

Crowd::Crowd(const Container& container, const Places& places, Spheres<3> spheres)
    : container_(container), places_(places), spheres_(std::move(spheres)) {
  prepare();
  const double resolution = packing_->resolution() / *std::ranges::min_element(spheres_.r);
  margin_ = std::max(margin_, resolutions_a_margin * resolution);
  if (margin_ > largest_margin)
    throw Error(ErrorCode::bad_scene,
                fmt::format("spheres {:.0e} times smaller than the container cannot be relaxed in it; name "
                            "other stages, such as \"insert\" and \"compress\"",
                            std::exp2(32) * resolution));
  packing_->swell(1 + margin_);
}

void Crowd::prepare() {
  if (packing_) {
    list_builds_ += packing_->builds();
    wall_queries_ += packing_->wall_queries();
  }
  packing_ = std::make_unique<SoftPacking>(spheres_, container_, soft_kernels().front());
  packing_->swell(1 + margin_);
}

void Crowd::measure() {
  const Pace pace = pace_for(0);
  packing_->wear_lists(pace.wear);
  largest_overlap_ = packing_->sweep_and_measure(pace.omega);
  ++sweeps_;
  double sum = 0;
  severe_ = 0;
  for (const float s : packing_->stress()) {
    sum += std::sqrt(s);
    if (s > severe_squeeze) ++severe_;
  }
  strain_ = sum / static_cast<double>(size());
}

Crowd::Rest Crowd::settle(const Monitor& monitor, const std::function<void()>& milestone) {
  int slow = 0;
  double least_strain = 1e300;
  for (;;) {
    const Pace pace = pace_for(largest_overlap_);
    packing_->wear_lists(pace.wear);
    for (int k = 1; k < sweeps_a_look; ++k) {
      packing_->sweep(pace.omega);
      ++sweeps_;
      if (monitor.stop()) {
        packing_->write_to(spheres_);
        return Rest::cancelled;
      }
    }
    measure();
    milestone();
    if (largest_overlap_ < share_of_margin * margin_) {
      packing_->write_to(spheres_);
      return Rest::free;
    }
    slow = strain_ > hardly_freer * least_strain ? slow + 1 : 0;
    if (slow == patience) return Rest::stuck;
    least_strain = std::min(least_strain, strain_);  // may swing: only a new low counts, so that this ends
  }
}

void Crowd::burst() {
  packing_->swell((1 + margin_) * burst_swelling);
  for (int k = 0; k < burst_sweeps; ++k) packing_->sweep(pace_for(0).omega);
  sweeps_ += burst_sweeps;
  packing_->swell(1 + margin_);
}

void Crowd::relocate(double share, Random& random) {
  const std::vector<float> stress = packing_->stress();
  const auto count = static_cast<std::size_t>(std::ceil(share * static_cast<double>(size())));
  packing_->write_to(spheres_);
  move_to_holes(most_squeezed(stress, std::max(count, severe_)), random);
}

void Crowd::move_to_holes(std::vector<std::uint32_t> ids, Random& random) {
  std::ranges::stable_sort(ids, std::greater<>(), [&](std::uint32_t i) { return spheres_.r[i]; });
  std::vector<double> radii;
  for (const std::uint32_t i : ids) radii.push_back(spheres_.r[i]);
  const std::vector<Hole> holes = holes_for(radii, container_, places_, spheres_, probes(), random);
  std::vector<SoftPacking::Move> moves;
  for (std::size_t k = 0; k < holes.size(); ++k) {
    spheres_.set_center(ids[k], holes[k].place);
    moves.push_back({ids[k], holes[k].place});
  }
  packing_->put(moves);
}

std::size_t Crowd::probes() const {
  return static_cast<std::size_t>(least_probes + probes_a_sphere * static_cast<double>(size()));
}

void Crowd::drop_last(std::size_t count, Random& random) {
  count = std::min(count, size() - 1);
  packing_->write_to(spheres_);
  std::vector<float> stress = packing_->stress();
  spheres_.resize(size() - count);
  stress.resize(size());
  prepare();
  move_to_holes(most_squeezed(stress, count), random);
}

std::size_t Crowd::add(std::span<const double> radii, Random& random) {
  packing_->write_to(spheres_);
  std::vector<std::size_t> order(radii.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater<>(), [&](std::size_t i) { return radii[i]; });
  std::vector<double> descending;
  for (const std::size_t i : order) descending.push_back(radii[i]);
  const std::vector<Hole> holes = holes_for(descending, container_, places_, spheres_, probes(), random);
  if (holes.size() < radii.size()) return 0;
  std::vector<Vector<3>> place(radii.size());
  for (std::size_t k = 0; k < order.size(); ++k) place[order[k]] = holes[k].place;
  for (std::size_t i = 0; i < radii.size(); ++i) spheres_.push_back(place[i], radii[i]);
  prepare();
  return radii.size();
}

void Crowd::restore(Spheres<3> spheres) {
  spheres_ = std::move(spheres);
  prepare();
}

}  // namespace bernal
