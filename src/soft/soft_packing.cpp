#include "soft/soft_packing.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/large_pages.hpp"
#include "core/parallel.hpp"
#include "soft/fixed_point_grid.hpp"

namespace bernal {
namespace {

/// In mean radii. Larger ones make lists that last longer and are longer; from 0.3 to 0.5 it makes no
/// difference.
constexpr double relative_skin = 0.4;
/// Of lists, in sweeps: with half of the skin a sweep costs a quarter less, and a build as much as ten
/// sweeps.
constexpr int long_life = 80, short_life = 30;
/// Skin, in the thickest.
constexpr float thinnest = 0.25f;
constexpr int longest_patience = 16;
/// With fewer spheres a second thread does not pay.
constexpr std::size_t worth_threads = 20000;

double skin_for(const std::vector<double>& radii) {
  return relative_skin * std::accumulate(radii.begin(), radii.end(), 0.0) / static_cast<double>(radii.size());
}

std::vector<float> as_floats(const std::vector<double>& values, double factor = 1) {
  std::vector<float> floats;
  floats.reserve(values.size());
  for (const double v : values) floats.push_back(static_cast<float>(factor * v));
  return floats;
}

}  // namespace

Pace pace_for(double largest_overlap) {
  constexpr double crowded = 0.06;
  return largest_overlap > crowded ? Pace{5.6f, 2} : Pace{5, 0.9};
}

SoftPacking::SoftPacking(const std::vector<double>& radii, double most, int dimension,
                         const SoftKernels& kernels, bool by_octaves)
    : kernels_(kernels),
      count_(radii.size()),
      dimension_(dimension),
      sizes_(as_floats(radii, most)),
      skin_(static_cast<float>(skin_for(radii))),
      thickest_skin_(skin_),
      lists_(kernels, by_octaves),
      by_octaves_(by_octaves),
      spheres_(radii.size(), SoftSphere{}),
      sites_(radii.size()),
      id_of_site_(radii.size()),
      radii_(as_floats(radii)) {
  edges_.fill(smallest_edge(radii));  // of axes that are not there: all coordinates are 0
  std::iota(sites_.begin(), sites_.end(), 0u);
  id_of_site_ = sites_;
  for (std::size_t i = 0; i < count_; ++i) spheres_[i].r = radii_[i];
}

template <int D>
SoftPacking::SoftPacking(const Spheres<D>& spheres, const Vector<D>& edges, const SoftKernels& kernels,
                         bool by_octaves, std::size_t resting)
    : SoftPacking(spheres.r, 1, D, kernels, by_octaves) {
  if (resting > 0) movers_ = static_cast<std::uint32_t>(count_ - resting);
  for (std::size_t k = 0; k < D; ++k) edges_[k] = edges[static_cast<int>(k)];
  for (std::size_t i = 0; i < count_; ++i) set_place(spheres_[i], spheres.center(i));
}

SoftPacking::SoftPacking(const Spheres<3>& spheres, const Container& container, const SoftKernels& kernels)
    : SoftPacking(spheres.r, most_swelling, 3, kernels, false) {
  // Centres stay inside the bounds, so that images are a margin of this width apart; but for those along an
  // axis that repeats itself, which are meant.
  const double margin = most_swelling * smallest_edge(spheres.r);
  const Bounds<3> bounds = container.bounds();
  const Boundary<3>& boundary = container.boundary();
  corner_ = bounds.lower - Vector<3>::Constant(0.5 * margin);
  Vector<3> unit;
  for (int k = 0; k < 3; ++k) {
    double& edge = edges_[static_cast<std::size_t>(k)];
    edge = bounds.size()[k] + margin;
    if (boundary.repeats(k)) {
      edge = boundary.edges[k];
      corner_[k] = boundary.origin[k];
    }
    unit[k] = edge * 0x1p-32;
  }
  walls_ = std::make_unique<SoftWalls>(container, corner_, unit, count_);
  for (std::size_t i = 0; i < count_; ++i) set_place(spheres_[i], spheres.center(i));
}

double SoftPacking::smallest_edge(const std::vector<double>& radii) {
  return 4.001 * (std::ranges::max(radii) + skin_for(radii));
}

double SoftPacking::farthest_neighbor(double largest, double mean) {
  return 2 * (largest + relative_skin * mean);
}

float SoftPacking::move_all(float omega, bool measure, bool each) {
  keep_lists_valid(measure);
  if (each) {
    squeeze_.assign(spheres_.size(), 0);
    force_.assign(spheres_.size(), 0);
  }
  const SweepTask task{.spheres = spheres_.data(),
                       .first_group = 0,
                       .scale = scale_of(edges_),
                       .omega = omega,
                       .walls = walls_.get(),
                       .measure = measure,
                       .squeeze = each ? squeeze_.data() : nullptr,
                       .force = each ? force_.data() : nullptr};
  if (walls_) walls_->look_anew(measure);
  ++sweeps_;
  if (in_blocks_) return blocks_->sweep(task);
  const bool in_threads = count_ >= worth_threads;
  if (walls_ && !in_threads) walls_->push_ahead(spheres_);
  const float near = lists_.sweep(task, in_threads);
  if (far_images_.empty()) return near;
  return std::max(near, far_images_.push(spheres_, edges_, omega, task.squeeze, task.force));
}

void SoftPacking::sweep(float omega) { move_all(omega, false, false); }

double SoftPacking::measure(float omega, bool each) {
  patience_ = 0;  // what is measured is measured on lists that are known to be good
  return move_all(omega, true, each);
}

void SoftPacking::grow(double factor) {
  for (int k = 0; k < dimension_; ++k) edges_[static_cast<std::size_t>(k)] *= factor;
  if (factor < 1) stale_ = true;  // spheres that were not near each other may be now
}

void SoftPacking::swell(double factor) {
  if (factor > static_cast<double>(swelling_)) stale_ = true;  // who was not near may be now
  swelling_ = static_cast<float>(factor);
  for (std::size_t p = 0; p < spheres_.size(); ++p)
    if (spheres_[p].r > 0) spheres_[p].r = swelling_ * radii_[id_at(p)];
}

void SoftPacking::put(const std::vector<Move>& moves) {
  std::vector<std::size_t> place_of(count_);
  for (std::size_t p = 0; p < spheres_.size(); ++p)
    if (spheres_[p].r > 0) place_of[id_at(p)] = p;
  for (const Move& move : moves) {
    const std::size_t p = place_of[move.id];
    set_place(spheres_[p], move.to);
    if (lists_built_.calls > 0) built_at_[p] = spheres_[p];
    walls_->forget(sites_[p]);
  }
  stale_ = true;
}

template <int D>
void SoftPacking::set_place(SoftSphere& sphere, const Vector<D>& center) const {
  for (std::size_t k = 0; k < D; ++k) {
    const int axis = static_cast<int>(k);
    sphere.x[k] = static_cast<std::int32_t>(to_fixed(center[axis] - corner_[axis], edges_[k]));
  }
}

std::vector<float> SoftPacking::by_id(const std::vector<float>& in_sweep_order) const {
  std::vector<float> of_sphere(count_);
  for (std::size_t p = 0; p < in_sweep_order.size(); ++p)
    if (spheres_[p].r > 0) of_sphere[id_at(p)] = in_sweep_order[p];
  return of_sphere;
}

void SoftPacking::exchange(const std::vector<std::uint32_t>& to) {
  for (std::uint32_t& id : id_of_site_) id = to[id];
  float most = 0;
  for (std::size_t p = 0; p < spheres_.size(); ++p) {
    if (!(spheres_[p].r > 0)) continue;
    const float r = swelling_ * radii_[id_at(p)];
    most = std::max(most, r - spheres_[p].r);
    spheres_[p].r = r;
  }
  grown_ += most;
  patience_ = 0;  // what radii grew is looked at before the next sweep
}

/// Of most spheres: that of a part of some thousand in which they moved farther than in nine tenths of the
/// parts, which does not become the larger the more spheres there are; of very many parts some tell.
SoftPacking::Moves SoftPacking::farthest_moves(bool of_all) const {
  constexpr std::size_t part = 4096, enough_parts = 64;
  constexpr double most = 0.9;
  const std::array<float, 3> scale = scale_of(edges_);
  const std::size_t parts_there = (spheres_.size() + part - 1) / part;
  const std::size_t step = of_all ? 1 : std::max<std::size_t>(1, parts_there / enough_parts);
  std::vector<float> squares((parts_there + step - 1) / step);
  const auto look_at = [&](std::size_t n) {
    float largest = 0;
    for (std::size_t p = n * step * part; p < std::min(spheres_.size(), (n * step + 1) * part); ++p) {
      float square = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const float d = static_cast<float>(steps_between(built_at_[p], spheres_[p], k)) * scale[k];
        square += d * d;
      }
      largest = square > largest ? square : largest;
    }
    squares[n] = largest;
  };
  if (count_ < worth_threads) {
    for (std::size_t n = 0; n < squares.size(); ++n) look_at(n);
  } else {
    parallel_for(squares.size(), look_at);
  }
  const double all = std::sqrt(std::ranges::max(squares));
  const auto parts = static_cast<double>(squares.size());
  const auto nth = squares.begin() + static_cast<std::ptrdiff_t>(std::min(parts - 1, most * parts));
  std::ranges::nth_element(squares, nth);
  return {std::sqrt(*nth), all};
}

void SoftPacking::remember_places() {
  resize_anew(built_at_, spheres_.size());
  parallel_ranges(spheres_.size(), 1 << 16, [&](std::size_t first, std::size_t last) {
    std::copy(spheres_.begin() + static_cast<std::ptrdiff_t>(first),
              spheres_.begin() + static_cast<std::ptrdiff_t>(last),
              built_at_.begin() + static_cast<std::ptrdiff_t>(first));
  });
}

/// Where lists last long, shorter ones that do not last so long cost less.
void SoftPacking::choose_skin() {
  const float skin = skin_;
  if (age_ > long_life) skin_ = std::max(thinnest * thickest_skin_, 0.5f * skin);
  if (age_ < short_life) skin_ = std::min(thickest_skin_, 2 * skin);
}

/// In the box of that time; what is in `spare` is lost.
void SoftPacking::build_lists(std::vector<SoftSphere>& spheres, std::vector<std::uint32_t>& sites,
                              std::vector<SoftSphere>& spare) {
  in_blocks_ = !by_octaves_ && SoftBlocks::suit(count_, edges_then_, sizes_, skin_);
  if (in_blocks_) {
    if (!blocks_) blocks_ = std::make_unique<SoftBlocks>(kernels_);
    in_blocks_ = blocks_->build(spheres, sites, spare, count_, edges_then_, sizes_, skin_, movers_);
  }
  if (!in_blocks_) lists_.build(spheres, sites, edges_then_, sizes_, skin_, movers_);
  if (!walls_) far_images_.build(spheres, edges_then_, dimension_, wear_then_ * skin_);
}

/// Looks at what has moved only as often as the speed of the last sweeps suggests, and unless `for_all` not
/// at the few that moved farthest. A pair that is missed for some sweeps overlaps for so much longer, no
/// more.
void SoftPacking::keep_lists_valid(bool for_all) {
  if (!stale_ && sweeps_ < patience_) return;
  const double limit = wear_ * skin_;
  double moved = 0, judged = 0;
  if (lists_built_.calls > 0) {
    const Moves moves = farthest_moves(for_all);
    moved = moves.of_most + grown_;
    judged = (for_all ? moves.of_all : moves.of_most) + grown_;
  }
  // Nothing is known before the first sweep, when the spheres are at their fastest.
  const double speed = stale_ ? limit : std::max((moved - moved_) / std::max(1, sweeps_), 1e-9);
  if (stale_ || judged > limit) {
    if (walls_ && lists_built_.calls > 0) walls_->stop_strays(spheres_, built_at_, sites_);
    const EffectTimer timer(lists_built_);
    choose_skin();
    sites_then_ = sites_;
    edges_then_ = edges_;
    wear_then_ = wear_;
    build_lists(spheres_, sites_, built_at_);
    if (walls_) walls_->build(spheres_, sites_, skin_);
    remember_places();
    grown_ = 0;
    age_ = 0;
    stale_ = false;
    moved = 0;
  }
  moved_ = moved;
  age_ += sweeps_;
  sweeps_ = 0;
  patience_ = static_cast<int>(std::clamp(0.5 * (limit - moved) / speed, 1.0, double{longest_patience}));
}

void SoftPacking::archive(Archive& a) {
  a(edges_, skin_, spheres_, sites_, id_of_site_, squeeze_, force_, swelling_, stale_, lists_built_, grown_,
    moved_, wear_, age_, sweeps_, patience_);
  if (walls_) a(*walls_);
  if (lists_built_.calls > 0) build_again(a);
}

void SoftPacking::build_again(Archive& a) {
  a(built_at_, sites_then_, edges_then_, wear_then_);
  if (!a.reads() || stale_) return;  // they are built before they are used
  std::vector<SoftSphere> at_site(count_), spheres, spare;
  for (std::size_t p = 0; p < built_at_.size(); ++p)
    if (built_at_[p].r > 0) at_site[sites_[p]] = built_at_[p];
  std::vector<std::uint32_t> sites;
  for (const std::uint32_t site : sites_then_) {
    if (site >= count_) continue;  // a gap
    spheres.push_back(at_site[site]);
    sites.push_back(site);
  }
  build_lists(spheres, sites, spare);
}

template <int D>
void SoftPacking::write_to(Spheres<D>& spheres, Vector<D>& edges) const {
  for (int k = 0; k < D; ++k) edges[k] = edges_[static_cast<std::size_t>(k)];
  write_to(spheres);
}

template <int D>
void SoftPacking::write_to(Spheres<D>& spheres) const {
  std::vector<SoftSphere> stopped = spheres_;
  if (walls_ && lists_built_.calls > 0) walls_->stop_strays(stopped, built_at_, sites_);
  for (std::size_t p = 0; p < stopped.size(); ++p) {
    if (!(stopped[p].r > 0)) continue;
    for (std::size_t k = 0; k < D; ++k)
      spheres.x[k][id_at(p)] =
          corner_[static_cast<int>(k)] + static_cast<std::uint32_t>(stopped[p].x[k]) * (edges_[k] * 0x1p-32);
  }
}

#define BERNAL_INSTANTIATE(D)                                                                      \
  template SoftPacking::SoftPacking(const Spheres<D>&, const Vector<D>&, const SoftKernels&, bool, \
                                    std::size_t);                                                  \
  template void SoftPacking::write_to(Spheres<D>&) const;                                          \
  template void SoftPacking::write_to(Spheres<D>&, Vector<D>&) const;
BERNAL_INSTANTIATE(1)
BERNAL_INSTANTIATE(2)
BERNAL_INSTANTIATE(3)
#undef BERNAL_INSTANTIATE

}  // namespace bernal
