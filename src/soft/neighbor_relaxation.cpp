// Registers of eight numbers never cross a call that is not inlined.
#pragma GCC diagnostic ignored "-Wpsabi"

#include "soft/neighbor_relaxation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "bernal/core/boundary.hpp"
#include "core/every_dimension.hpp"

namespace bernal {
namespace {

/// In mean diameters, by dimension: lists become longer by its D-th power.
constexpr double relative_skin[] = {0.4, 0.4, 0.4, 0.3, 0.25, 0.2, 0.17, 0.15};
/// Of lists, in sweeps; and the least skin over the largest.
constexpr int longest_life = 80, shortest_life = 20;
constexpr double thinnest_share = 0.125;
/// In a box with an edge below this number of largest radii, spheres may overlap in several images. It is a
/// little above 4, for rounding.
constexpr double narrow = 4.001;
/// Places are read four at a time.
constexpr std::size_t block = 4;
/// The longest move, in units of the coordinates.
constexpr float longest_move = 0x1p30f;
/// The distance, in sums of radii, that stands for that of spheres whose centres coincide.
constexpr float least_distance = 1e-3f;

}  // namespace

template <int D, bool tilted>
NeighborRelaxation<D, tilted>::NeighborRelaxation(const Spheres<D>& spheres, const Vector<D>& edges,
                                                  const Tilt& tilt)
    : count_(spheres.size()),
      edges_(edges),
      thickest_skin_(2 * relative_skin[D - 1] * std::accumulate(spheres.r.begin(), spheres.r.end(), 0.0) /
                     static_cast<double>(spheres.size())),
      skin_(thickest_skin_),
      places_(spheres.size() + block, Place{}),
      radii_(spheres.size() + block, std::numeric_limits<float>::quiet_NaN()),
      ids_(spheres.size()),
      squeeze_(spheres.size(), 0.0f),
      force_(spheres.size(), 0.0f) {
  if constexpr (tilted) cell_ = {edges, tilt};
  for (std::size_t i = 0; i < count_; ++i) {
    Vector<D> c = spheres.center(i);
    if constexpr (tilted) c = cell_.boundary(edges).in_cell_vectors(c).cwiseProduct(edges);
    for (int k = 0; k < D; ++k) places_[i].x[k] = to_fixed(c[k], edges[k]);
    radii_[i] = static_cast<float>(spheres.r[i]);
    largest_radius_ = std::max(largest_radius_, radii_[i]);
    ids_[i] = static_cast<Id>(i);
  }
  set_scale();
}

template <int D, bool tilted>
void NeighborRelaxation<D, tilted>::set_scale() {
  for (int k = 0; k < D; ++k) {
    scale_[k] = static_cast<float>(edges_[k] * 0x1p-32);
    inverse_scale_[k] = static_cast<float>(0x1p32 / edges_[k]);
  }
}

template <int D, bool tilted>
void NeighborRelaxation<D, tilted>::grow(double factor) {
  edges_ *= factor;
  if constexpr (tilted) cell_.grow(factor);
  set_scale();
  if (factor < 1) stale_ = true;
}

template <int D, bool tilted>
void NeighborRelaxation<D, tilted>::keep_between_walls(const std::vector<bool>& walls, double share) {
  walled_.clear();
  wall_share_ = share;
  for (int k = 0; k < D && !walls.empty(); ++k)
    if (walls[static_cast<std::size_t>(k)]) walled_.push_back(k);
  for (Id i = 0; i < count_; ++i) stop_at_walls(i);
  stale_ = true;
}

/// Coordinates have steps of 2^-32, radii are rounded to single precision: twice that error is added.
template <int D, bool tilted>
void NeighborRelaxation<D, tilted>::stop_at_walls(Id i) {
  constexpr double rounding = 1 + 0x1p-23;
  for (const int k : walled_) {
    const double low = std::min(rounding * wall_share_ * radii_[i] / edges_[k], 0.5);
    const auto lowest = static_cast<std::uint32_t>(std::ceil(low * 0x1p32));
    places_[i].x[k] = std::clamp<std::uint32_t>(places_[i].x[k], lowest, 0u - lowest);
  }
}

/// A step that would end beyond a wall ends at this wall; it does not wrap round to the other one.
template <int D, bool tilted>
void NeighborRelaxation<D, tilted>::move_between_walls(Id i, const Ints& step) {
  const Place before = places_[i];
  places_[i].x += __builtin_bit_cast(Whole, step);
  for (const int k : walled_) {
    const std::int64_t to = static_cast<std::int64_t>(before.x[k]) + step[k];
    places_[i].x[k] = static_cast<std::uint32_t>(std::clamp<std::int64_t>(to, 0, 0xffffffff));
  }
  stop_at_walls(i);
}

template <int D, bool tilted>
inline typename NeighborRelaxation<D, tilted>::Floats NeighborRelaxation<D, tilted>::away(
    const Place& from, const Place& to) const {
  const Floats way = __builtin_convertvector(__builtin_bit_cast(Ints, Whole(to.x - from.x)), Floats) * scale_;
  if constexpr (tilted)
    return cell_.way(way);
  else
    return way;
}

/// Whether an image of sphere j is nearer to sphere i.
template <int D, bool tilted>
bool NeighborRelaxation<D, tilted>::any_image_within(Id i, Id j, double limit) const {
  const Floats nearest = away(places_[j], places_[i]);
  Vector<D> displacement;
  for (int k = 0; k < D; ++k) displacement[k] = nearest[k];
  bool any = false;
  cell_.boundary(edges_).for_each_image(displacement, limit,
                                        [&](const Vector<D>& image) { any = any || image.norm() < limit; });
  return any;
}

/// The squared distances from four spheres.
template <int D, bool tilted>
inline __m128 NeighborRelaxation<D, tilted>::squares_of(const Place& from, Id a, Id b, Id c, Id d) const {
  const auto square = [&](Id k) {
    const Floats way = away(places_[k], from);
    return to_four(Floats(way * way));
  };
  return sums(square(a), square(b), square(c), square(d));
}

template <int D, bool tilted>
double NeighborRelaxation<D, tilted>::sweep_and_measure(float omega) {
  keep_lists_valid();
  const bool in_images = tilted ? is_narrow_ : edges_.minCoeff() < narrow * largest_radius_;
  float largest = 0;
  for (Id i = 0; i < count_; ++i) {
    const Id* end = find_overlapping(i);
    squeeze_[i] = force_[i] = 0;
    if (end == hits_.data()) continue;
    const Push push = in_images ? push_from_images(i, end) : push_from_nearest(i, end);
    squeeze_[i] = push.squeeze;
    force_[i] = radii_[i] * push.depth;
    largest = std::max(largest, push.largest);
    Floats way = push.sum * std::min(omega / push.contacts, 1.0f);
    if constexpr (tilted) way = cell_.along(way);
    const Floats step = way * inverse_scale_;
    const Floats limit = Floats{} + longest_move;
    const Floats capped = step < limit ? (step > -limit ? step : -limit) : limit;
    if (walled_.empty())
      places_[i].x += __builtin_bit_cast(Whole, __builtin_convertvector(capped, Ints));
    else
      move_between_walls(i, __builtin_convertvector(capped, Ints));
  }
  ++age_;
  return largest;
}

/// The spheres of its list whose nearest image overlaps it.
template <int D, bool tilted>
const typename NeighborRelaxation<D, tilted>::Id* NeighborRelaxation<D, tilted>::find_overlapping(Id i) {
  const Place me = places_[i];
  const __m128 r = _mm_set1_ps(radii_[i]);
  Id* end = hits_.data();
  if constexpr (tilted)
    if (is_narrow_) {  // whatever may overlap in some image
      for (std::size_t n = list_[i]; n < list_[i + 1]; ++n)
        if (neighbors_[n] != count_) *end++ = neighbors_[n];
      return end;
    }
  for (std::size_t n = list_[i]; n < list_[i + 1]; n += block) {
    const Id* j = &neighbors_[n];
    const __m128 squared = squares_of(me, j[0], j[1], j[2], j[3]);
    const __m128 reach = _mm_add_ps(r, _mm_setr_ps(radii_[j[0]], radii_[j[1]], radii_[j[2]], radii_[j[3]]));
    const int near = _mm_movemask_ps(_mm_cmplt_ps(squared, _mm_mul_ps(reach, reach)));
    for (std::size_t k = 0; k < block; ++k) {
      *end = j[k];
      end += near >> k & 1;
    }
  }
  return end;
}

/// What sphere j does to sphere i across this way, which leads from j to i.
template <int D, bool tilted>
inline void NeighborRelaxation<D, tilted>::add_to(Push& push, Id i, Id j, const Floats& way,
                                                  float distance) const {
  const float reach = radii_[i] + radii_[j], weight = 2 * radii_[j] / reach;
  const float ratio = 1 - distance / reach;
  push.squeeze += ratio * ratio;
  push.largest = ratio > push.largest ? ratio : push.largest;
  if (distance > 0)
    push.sum += way * (weight * (reach / distance - 1));
  else
    push.sum += any_direction(i, j) * (least_distance * reach) * (weight * (1 / least_distance - 1));
  push.contacts += weight;
  push.depth += weight * ratio * reach;
}

template <int D, bool tilted>
typename NeighborRelaxation<D, tilted>::Push NeighborRelaxation<D, tilted>::push_from_nearest(
    Id i, const Id* end) const {
  Push push;
  for (const Id* j = hits_.data(); j < end; ++j) {
    const Floats d = away(places_[*j], places_[i]);
    const __m128 four = to_four(Floats(d * d));
    add_to(push, i, *j, d, std::sqrt((four[0] + four[1]) + (four[2] + four[3])));
  }
  return push;
}

template <int D, bool tilted>
typename NeighborRelaxation<D, tilted>::Push NeighborRelaxation<D, tilted>::push_from_images(
    Id i, const Id* end) const {
  const auto boundary = [&] {
    if constexpr (tilted)
      return cell_.boundary(edges_);
    else
      return Boundary<D>{edges_};
  }();
  Push push;
  push.contacts =
      std::numeric_limits<float>::min();  // in case the nearest image is a contact to rounding only
  for (const Id* j = hits_.data(); j < end; ++j) {
    const float reach = radii_[i] + radii_[*j];
    const Floats nearest = away(places_[*j], places_[i]);
    Vector<D> displacement;
    for (int k = 0; k < D; ++k) displacement[k] = nearest[k];
    boundary.for_each_image(displacement, reach, [&](const Vector<D>& image) {
      const auto distance = static_cast<float>(image.norm());
      if (!(distance < reach)) return;
      Floats d{};
      for (int k = 0; k < D; ++k) d[k] = static_cast<float>(image[k]);
      add_to(push, i, *j, d, distance);
    });
  }
  return push;
}

/// The direction away from a sphere with the same centre; another one for each pair.
template <int D, bool tilted>
typename NeighborRelaxation<D, tilted>::Floats NeighborRelaxation<D, tilted>::any_direction(Id i,
                                                                                            Id j) const {
  const Id a = std::min(ids_[i], ids_[j]), b = std::max(ids_[i], ids_[j]);
  Vector<D> v;
  std::uint32_t state = a * 2654435761u ^ (b + 1) * 2246822519u;
  for (int k = 0; k < D; ++k) {
    state = (state ^ (state >> 15)) * 2654435769u + 1;
    v[k] = static_cast<double>(state >> 8) * 0x1p-23 - 1 + 0x1p-25;
  }
  v.normalize();
  Floats direction{};
  for (int k = 0; k < D; ++k) direction[k] = static_cast<float>(a == ids_[i] ? v[k] : -v[k]);
  return direction;
}

template <int D, bool tilted>
bool NeighborRelaxation<D, tilted>::moved_too_far() const {
  const double way = std::max(0.0, 0.5 * wear_ * skin_ - grown_);
  const auto limit = static_cast<float>(way * way);
  __m128 largest = _mm_setzero_ps();
  for (std::size_t i = 0; i < count_; i += block) {
    const auto squares = [&](std::size_t k) {
      const Floats d = away(built_at_[k], places_[k]);
      return to_four(Floats(d * d));
    };
    largest = _mm_max_ps(largest, sums(squares(i), squares(i + 1), squares(i + 2), squares(i + 3)));
  }
  return std::max({largest[0], largest[1], largest[2], largest[3]}) > limit;
}

template <int D, bool tilted>
void NeighborRelaxation<D, tilted>::keep_lists_valid() {
  if (!stale_ && !moved_too_far()) return;
  if (lists_built_.calls > 0 &&
      !stale_) {  // where lists last long, shorter ones that do not last so long cost less
    if (age_ > longest_life) skin_ = std::max(thinnest_share * thickest_skin_, skin_ / 1.4);
    if (age_ < shortest_life) skin_ = std::min(thickest_skin_, skin_ * 1.4);
  }
  const EffectTimer timer(lists_built_);
  build_lists();
  built_at_ = places_;
  stale_ = false;
  grown_ = 0;
  age_ = 0;
}

template <int D, bool tilted>
void NeighborRelaxation<D, tilted>::sort_into_cells(double reach) {
  Vector<D> widths = edges_;
  if constexpr (tilted) widths = cell_.widths(edges_);
  const std::vector<Id> to = grid_.sort(widths, reach, places_, count_);
  const std::vector<Place> places = places_;
  const std::vector<float> radii = radii_;
  const std::vector<Id> ids = ids_;
  for (std::size_t i = 0; i < count_; ++i) {
    places_[to[i]] = places[i];
    radii_[to[i]] = radii[i];
    ids_[to[i]] = ids[i];
  }
}

template <int D, bool tilted>
void NeighborRelaxation<D, tilted>::build_lists() {
  const double farthest = 2.0 * largest_radius_ + skin_;
  if constexpr (tilted) is_narrow_ = cell_.widths(edges_).minCoeff() < 2.001 * farthest;
  sort_into_cells(farthest);
  list_.resize(count_ + 1);
  std::vector<typename FixedPointGrid<D>::Row> rows;
  std::size_t used = 0, longest = 0;
  for (Id i = 0; i < count_; ++i) {
    list_[i] = used;
    grid_.rows_near(places_[i], rows);
    std::size_t candidates = 0;
    for (const auto& row : rows) candidates += row.last - row.first;
    if (neighbors_.size() < used + candidates + 2 * block)
      neighbors_.resize(2 * (used + candidates + 2 * block));
    Id* end = &neighbors_[used];
    const Place me = places_[i];
    const __m128 blown_up = _mm_set1_ps(radii_[i] + static_cast<float>(skin_));
    for (const auto& row : rows) {
      if (tilted && is_narrow_) {
        for (Id j = row.first; j < row.last; ++j)
          if (j != i && any_image_within(i, j, static_cast<double>(radii_[i]) + radii_[j] + skin_))
            *end++ = j;
        continue;
      }
      for (Id j = row.first; j < row.last; j += block) {
        const __m128 squared = squares_of(me, j, j + 1, j + 2, j + 3);
        const __m128 reach = _mm_add_ps(blown_up, _mm_loadu_ps(&radii_[j]));
        int near = _mm_movemask_ps(_mm_cmplt_ps(squared, _mm_mul_ps(reach, reach)));
        if (row.last - j < block) near &= (1 << (row.last - j)) - 1;
        if (i - j < block) near &= ~(1 << (i - j));
        for (Id k = 0; k < block; ++k) {
          *end = j + k;
          end += near >> k & 1;
        }
      }
    }
    longest = std::max(longest, static_cast<std::size_t>(end - &neighbors_[used]));
    used = static_cast<std::size_t>(end - neighbors_.data());
    while (used % block != 0) neighbors_[used++] = static_cast<Id>(count_);
  }
  list_[count_] = used;
  hits_.resize(longest + 2 * block);
}

template <int D, bool tilted>
std::vector<float> NeighborRelaxation<D, tilted>::by_id(const std::vector<float>& in_order) const {
  std::vector<float> of_sphere(count_);
  for (std::size_t i = 0; i < count_; ++i) of_sphere[ids_[i]] = in_order[i];
  return of_sphere;
}

template <int D, bool tilted>
void NeighborRelaxation<D, tilted>::resize(const std::vector<float>& radii) {
  float most = 0;
  for (Id i = 0; i < count_; ++i) {
    most = std::max(most, radii[ids_[i]] - radii_[i]);
    radii_[i] = radii[ids_[i]];
    if (!walled_.empty()) stop_at_walls(i);
  }
  grown_ += most;
}

template <int D, bool tilted>
void NeighborRelaxation<D, tilted>::write_to(Spheres<D>& spheres, Vector<D>& edges) const {
  edges = edges_;
  if constexpr (tilted) {
    const TiltedBoundary<D> least = cell_.boundary(edges_), given = cell_.given(edges_);
    for (std::size_t i = 0; i < count_; ++i) {
      Vector<D> c = Vector<D>::Zero();
      for (int k = 0; k < D; ++k) c += places_[i].x[k] * 0x1p-32 * least.cell_vector(k);
      spheres.set_center(ids_[i], given.wrap(c));
    }
    return;
  }
  for (std::size_t i = 0; i < count_; ++i)
    for (int k = 0; k < D; ++k)
      spheres.x[static_cast<std::size_t>(k)][ids_[i]] = places_[i].x[k] * (edges_[k] * 0x1p-32);
}

#define BERNAL_INSTANTIATE(D) template class NeighborRelaxation<D>;
BERNAL_IN_EVERY_DIMENSION(BERNAL_INSTANTIATE)
#undef BERNAL_INSTANTIATE
template class NeighborRelaxation<2, true>;
template class NeighborRelaxation<3, true>;

}  // namespace bernal
