#include "domain/places.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.hpp"

namespace bernal {
namespace {

constexpr double cells_wanted = 30000;
/// A grid of more cells than so many times those wanted is that of a plate: one layer of cells without
/// number.
constexpr double most_times_wanted = 4;
/// What the cells of the grid may be of the container, and what is aimed at where they are more.
constexpr double most_waste = 16, good_waste = 3;
/// Halving asks no more often than so.
constexpr std::size_t most_questions = 150000;
constexpr double widening = 1.001;

/// Of bounds in the plane z = 0 the area.
double size_of(const Bounds<3>& bounds, int dimension) {
  return dimension == 2 ? bounds.size().head<2>().prod() : bounds.volume();
}

bool may_reach_into(const Container& container, const Bounds<3>& cell) {
  return container.clearance_within(cell.center(), 0) >= -widening * 0.5 * cell.diagonal();
}

}  // namespace

Places::Places(const Container& container) {
  if (take_grid(container)) return;
  cells_.clear();
  halve(container);
  volume_ = 0;
  for (const Bounds<3>& cell : cells_)
    volume_up_to_.push_back(volume_ += size_of(cell, container.dimension()));
}

/// False where the grid is not worth having.
bool Places::take_grid(const Container& container) {
  const Bounds<3> bounds = container.bounds();
  const int dimension = container.dimension();
  const double size = size_of(bounds, dimension) / cells_wanted;
  const double edge = dimension == 2 ? std::sqrt(size) : std::cbrt(size);
  std::array<int, 3> count;
  Vector<3> cell_size;
  double all = 1;
  for (int k = 0; k < 3; ++k) {
    count[k] = static_cast<int>(std::clamp(std::ceil(bounds.size()[k] / edge), 1.0, cells_wanted));
    cell_size[k] = bounds.size()[k] / count[k];
    all *= count[k];
  }
  if (all > most_times_wanted * cells_wanted) return false;
  const double half_diagonal = 0.5 * cell_size.norm();
  for (int i = 0; i < count[0]; ++i) {
    for (int j = 0; j < count[1]; ++j) {
      for (int k = 0; k < count[2]; ++k) {
        const Vector<3> lower = bounds.lower + cell_size.cwiseProduct(Vector<3>(i, j, k));
        if (container.clearance_within(lower + 0.5 * cell_size, 0) >= -widening * half_diagonal)
          cells_.push_back({lower, lower + cell_size});
      }
    }
  }
  volume_ = static_cast<double>(cells_.size()) * size_of({Vector<3>::Zero(), cell_size}, dimension);
  return volume_ <= most_waste * container.volume();
}

/// In the order in which they come, cells are in falling order of their volumes.
void Places::halve(const Container& container) {
  cells_ = {container.bounds()};
  volume_ = size_of(cells_.front(), container.dimension());
  std::size_t first = 0;
  for (std::size_t asked = 0; asked < most_questions && first < cells_.size(); ++first) {
    if (volume_ <= good_waste * container.volume()) break;
    const Bounds<3> cell = cells_[first];
    int axis = 0;
    cell.size().maxCoeff(&axis);
    for (const bool upper : {false, true}) {
      Bounds<3> half = cell;
      (upper ? half.lower : half.upper)[axis] = cell.center()[axis];
      ++asked;
      if (may_reach_into(container, half))
        cells_.push_back(half);
      else
        volume_ -= size_of(half, container.dimension());
    }
  }
  cells_.erase(cells_.begin(), cells_.begin() + static_cast<std::ptrdiff_t>(first));
}

Vector<3> Places::draw(Random& random) const {
  if (volume_up_to_.empty())
    return uniform_point(
        random, cells_[static_cast<std::size_t>(random.uniform() * static_cast<double>(cells_.size()))]);
  const auto cell = std::ranges::upper_bound(volume_up_to_, random.uniform() * volume_up_to_.back());
  return uniform_point(
      random, cells_[std::min(static_cast<std::size_t>(cell - volume_up_to_.begin()), cells_.size() - 1)]);
}

bool fills_its_bounds(const Container& container) {
  constexpr double least_share = 1. / 64;
  return container.volume() >= least_share * size_of(container.bounds(), container.dimension());
}

std::vector<Vector<3>> points_inside(const Container& container, std::size_t count, std::uint64_t seed,
                                     const std::function<Vector<3>(std::size_t)>& in_bounds) {
  constexpr std::size_t most_tries = 1000;  // for each point that is wanted
  std::vector<Vector<3>> points;
  const auto take = [&](const auto& point_at) {
    points.clear();
    for (std::size_t n = 0; points.size() < count && n < most_tries * count; ++n) {
      // Where the first of them are all outside, those that come after will be.
      if (n >= most_tries * (points.size() + 16)) break;
      throw_if_interrupted();
      const Vector<3> p = point_at(n);
      if (container.contains(p, 0)) points.push_back(p);
    }
  };
  if (fills_its_bounds(container)) take(in_bounds);
  if (points.size() == count) return points;
  const Places places(container);
  Random random(seed, stream(Stream::room, 1));
  take([&](std::size_t) { return places.draw(random); });
  return points;
}

}  // namespace bernal
