#include "soft/soft_packing.hpp"

#include <numeric>
#include <utility>

#include "core/large_pages.hpp"
#include "core/parallel.hpp"
#include "soft/fixed_point_grid.hpp"

namespace bernal {
namespace {

/// In mean radii. With a larger skin lists last longer and are longer; from 0.3 to 0.5 it makes no
/// difference.
constexpr double relative_skin = 0.4;

std::vector<float> as_floats(const std::vector<double>& values, double factor = 1) {
  std::vector<float> floats;
  floats.reserve(values.size());
  for (const double v : values) floats.push_back(static_cast<float>(factor * v));
  return floats;
}

/// An edge so long that no two images of a sphere are neighbours of one.
double surely_wide(const std::vector<double>& radii) {
  return 4.001 * (std::ranges::max(radii) + SoftPacking::usual_skin(radii));
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
      life_(static_cast<float>(usual_skin(radii))),
      lists_(kernels, by_octaves),
      by_octaves_(by_octaves),
      spheres_(radii.size(), SoftSphere{}),
      sites_(radii.size()),
      id_of_site_(radii.size()),
      radii_(as_floats(radii)) {
  edges_.fill(surely_wide(radii));  // of axes that are not there: all coordinates are 0
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

SoftPacking::SoftPacking(const Spheres<3>& spheres, const Container& container, const SoftKernels& kernels,
                         bool by_octaves)
    : SoftPacking(spheres.r, most_swelling, 3, kernels, by_octaves) {
  // Centres stay inside the bounds, so that images are apart by a margin of this width; along an axis that
  // repeats itself there is none.
  const double margin = most_swelling * surely_wide(spheres.r);
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

double SoftPacking::usual_skin(const std::vector<double>& radii) {
  return relative_skin * std::accumulate(radii.begin(), radii.end(), 0.0) / static_cast<double>(radii.size());
}

double SoftPacking::farthest_neighbor(double largest, double mean) {
  return 2 * (largest + relative_skin * mean);
}

void SoftPacking::keep_between_walls(const std::vector<bool>& walls, double share) {
  walled_axes_ = 0;
  wall_share_ = share;
  for (std::size_t k = 0; k < walls.size(); ++k)
    if (walls[k]) walled_axes_ |= 1u << k;
  for (SoftSphere& sphere : spheres_) stop_at_walls(sphere);
}

void SoftPacking::stop_at_walls(SoftSphere& sphere) const {
  for (std::size_t k = 0; k < 3; ++k) {
    if (!(walled_axes_ >> k & 1)) continue;
    const double distance = static_cast<double>(above_rounding) * wall_share_ *
                            static_cast<double>(sphere.r) / edges_[k] * 0x1p32;
    const auto lowest =
        static_cast<std::uint32_t>(std::min(distance, static_cast<double>(most_from_wall))) + 1;
    sphere.x[k] =
        static_cast<std::int32_t>(std::clamp(static_cast<std::uint32_t>(sphere.x[k]), lowest, 0u - lowest));
  }
}

/// As `SweepTask::narrow_axes`. Across walls no sphere meets an image.
unsigned SoftPacking::narrow_axes() const {
  constexpr double rounding = 1e-6;
  const double least = 4 * (1 + rounding) * static_cast<double>(sizes_.largest);
  unsigned axes = 0;
  for (int k = 0; k < dimension_; ++k)
    if (edges_[static_cast<std::size_t>(k)] < least) axes |= 1u << k;
  return axes & ~walled_axes_;
}

/// In edges / 2^32, where all spheres and edges are alike and there are no walls; else 0.
float SoftPacking::diameter_of_all() const {
  const bool alike = sizes_.equal && edges_[0] == edges_[1] && edges_[1] == edges_[2];
  return alike && !walls_ && walled_axes_ == 0 ? 2 * swelling_ * radii_[0] / scale_of(edges_)[0] : 0;
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
                       .diameter = diameter_of_all(),
                       .omega = omega,
                       .walls = walls_.get(),
                       .measure = measure,
                       .squeeze = each ? squeeze_.data() : nullptr,
                       .force = each ? force_.data() : nullptr,
                       .narrow_axes = narrow_axes(),
                       .walled_axes = walled_axes_,
                       .wall_share = static_cast<float>(wall_share_)};
  if (walls_) walls_->look_anew(measure);
  life_.swept();
  if (in_blocks_) return blocks_->sweep(task);
  const bool in_threads = count_ >= SoftLists::worth_threads;
  if (walls_ && !in_threads) walls_->push_ahead(spheres_);
  return lists_.sweep(task, in_threads);
}

void SoftPacking::sweep(float omega) { move_all(omega, false, false); }

double SoftPacking::measure(float omega, bool each) {
  life_.look_soon();  // what is measured is measured on lists that are known to be good
  return move_all(omega, true, each);
}

void SoftPacking::grow(double factor) {
  for (int k = 0; k < dimension_; ++k) edges_[static_cast<std::size_t>(k)] *= factor;
  if (factor < 1) life_.end();  // spheres that were not near each other may be now
}

void SoftPacking::swell(double factor) {
  if (factor > static_cast<double>(swelling_)) life_.end();  // who was not near may be now
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
  life_.end();
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
  take_radii();
}

void SoftPacking::resize(const std::vector<float>& radii) {
  radii_ = radii;
  take_radii();
}

void SoftPacking::take_radii() {
  float most = 0;
  for (std::size_t p = 0; p < spheres_.size(); ++p) {
    if (!(spheres_[p].r > 0)) continue;
    const float r = swelling_ * radii_[id_at(p)];
    most = std::max(most, r - spheres_[p].r);
    spheres_[p].r = r;
  }
  life_.radii_grew(most);
}

/// Unless it is asked for all, it looks at some of very many parts. Those in a container are small: from
/// random places a few spheres in ten thousand are thrown about by large overlaps for a hundred sweeps, and
/// would have the lists of all built in every one of these.
FarthestMoves SoftPacking::farthest_moves(bool of_all) const {
  constexpr std::size_t small_part = 256;
  const std::size_t part = walls_ ? small_part : FarthestMoves::part;
  const std::size_t enough_parts = walls_ ? 512 : 64;
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
  parallel_for_if(count_ >= SoftLists::worth_threads, squares.size(), look_at);
  return FarthestMoves::of_parts(std::move(squares));
}

void SoftPacking::remember_places() {
  resize_anew(built_at_, spheres_.size());
  parallel_ranges(spheres_.size(), 1 << 16, [&](std::size_t first, std::size_t last) {
    std::copy(spheres_.begin() + static_cast<std::ptrdiff_t>(first),
              spheres_.begin() + static_cast<std::ptrdiff_t>(last),
              built_at_.begin() + static_cast<std::ptrdiff_t>(first));
  });
}

/// In the box `edges_then_`. `spare` is scratch memory.
void SoftPacking::build_lists(std::vector<SoftSphere>& spheres, std::vector<std::uint32_t>& sites,
                              std::vector<SoftSphere>& spare) {
  in_blocks_ = !by_octaves_ && SoftBlocks::suit(count_, edges_then_, sizes_, life_.skin());
  if (in_blocks_) {
    if (!blocks_) blocks_ = std::make_unique<SoftBlocks>(kernels_);
    in_blocks_ = blocks_->build(spheres, sites, spare, count_, edges_then_, sizes_, life_.skin(), movers_);
  }
  if (!in_blocks_) lists_.build(spheres, sites, edges_then_, sizes_, life_.skin(), movers_);
}

void SoftPacking::keep_lists_valid(bool for_all) {
  const bool are_there = lists_built_.calls > 0;
  life_.keep(
      for_all, are_there, [&] { return farthest_moves(for_all); },
      [&] {
        if (walls_ && are_there) walls_->stop_strays(spheres_, built_at_, sites_);
        const EffectTimer timer(lists_built_);
        sites_then_ = sites_;
        edges_then_ = edges_;
        build_lists(spheres_, sites_, built_at_);
        if (walls_) walls_->build(spheres_, sites_, life_.skin());
        remember_places();
      });
}

void SoftPacking::archive(Archive& a) {
  a(edges_, life_, spheres_, sites_, id_of_site_, squeeze_, force_, swelling_, lists_built_);
  if (walls_) a(*walls_);
  if (lists_built_.calls > 0) build_again(a);
}

void SoftPacking::build_again(Archive& a) {
  a(built_at_, sites_then_, edges_then_);
  if (!a.reads() || life_.is_over()) return;  // they are built before they are used
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
