#include "work/exact_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "bernal/core/boundary.hpp"
#include "domain/dyadic.hpp"
#include "work/free_of_overlap.hpp"

namespace bernal {
namespace {

/// The share of an edge, and of the sum of two radii, that rounding leaves: stages work in single precision.
constexpr double nearly = 1e-6;
/// Pairs of images in a round, and in all rounds together.
constexpr double most_pairs = 1e8, most_pairs_in_all = 2e9;
constexpr int most_rounds = 200;

/// Calls visit(offset) for all numbers of periods from -1 to 1 along each axis.
template <int D, class Visit>
void for_each_image(Visit&& visit) {
  Vector<D> offset = Vector<D>::Constant(-1);
  for (;;) {
    visit(offset);
    int k = 0;
    while (k < D && offset[k] == 1) offset[k++] = -1;
    if (k == D) return;
    ++offset[k];
  }
}

template <int D>
double pairs_of_images(const Spheres<D>& spheres) {
  const auto n = static_cast<double>(spheres.size());
  return n * n * std::pow(3, D);
}

/// A sphere and the image of another that overlap, decided exactly.
template <int D>
struct Overlap {
  std::size_t i, j;
  Vector<D> apart;  ///< from the image of j to i
};

/// All of them. Precondition: centres in [0, edge).
template <int D>
std::vector<Overlap<D>> overlaps_in(const Spheres<D>& spheres, const Vector<D>& edges) {
  std::vector<Overlap<D>> found;
  const Boundary<D> boundary{edges};
  for (std::size_t i = 0; i < spheres.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const Vector<D> from_j = spheres.center(i) - spheres.center(j);
      const double sum = spheres.r[i] + spheres.r[j], reach = (1 + 3 * nearly) * sum * sum;
      if (boundary.minimum_image(from_j).squaredNorm() > reach) continue;
      for_each_image<D>([&](const Vector<D>& periods) {
        const Vector<D> apart = from_j - periods.cwiseProduct(edges);
        if (apart.squaredNorm() > reach) return;
        Dyadic squared;
        for (int k = 0; k < D; ++k) {
          const auto& x = spheres.x[static_cast<std::size_t>(k)];
          squared = squared + square(Dyadic(x[i]) - Dyadic(x[j]) - Dyadic(periods[k]) * Dyadic(edges[k]));
        }
        if (squared < square(Dyadic(spheres.r[i]) + Dyadic(spheres.r[j]))) found.push_back({i, j, apart});
      });
    }
  return found;
}

/// In [0, edge).
double wrapped(double x, double edge) {
  x -= edge * std::floor(x / edge);
  return x >= 0 && x < edge ? x : 0;
}

/// Where they are, and where two overlap a little apart.
template <int D>
bool fits_apart(Spheres<D>& spheres, const Vector<D>& edges) {
  const double rounds = std::min<double>(most_rounds, most_pairs_in_all / pairs_of_images<D>(spheres));
  for (int round = 0; round < rounds; ++round) {
    const std::vector<Overlap<D>> overlaps = overlaps_in<D>(spheres, edges);
    if (overlaps.empty()) return true;
    for (const Overlap<D>& overlap : overlaps) {
      const double distance = overlap.apart.norm(), sum = spheres.r[overlap.i] + spheres.r[overlap.j];
      if (!(distance > 0)) return false;
      const double rounding = 4 * std::numeric_limits<double>::epsilon() * edges.maxCoeff();
      const Vector<D> way = (std::max(0.0, sum - distance) + rounding) / distance * overlap.apart;
      for (int k = 0; k < D; ++k) {
        double& x = spheres.x[static_cast<std::size_t>(k)][overlap.i];
        x = wrapped(x + way[k], edges[k]);
      }
    }
  }
  return false;
}

/// In the cells of a lattice as wide as the largest, the first along the first axis.
template <int D>
bool fits_on_lattice(Spheres<D>& spheres, const Vector<D>& edges) {
  const double width = 2 * std::ranges::max(spheres.r);
  std::vector<std::size_t> cells(D);
  double all = 1;
  for (int k = 0; k < D; ++k) {
    const double count = std::floor(edges[k] / width);
    cells[static_cast<std::size_t>(k)] = static_cast<std::size_t>(count);
    all *= count;
  }
  if (all < static_cast<double>(spheres.size())) return false;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    std::size_t number = i;
    for (std::size_t k = 0; k < D; ++k) {
      spheres.x[k][i] = static_cast<double>(number % cells[k]) * width;
      number /= cells[k];
    }
  }
  return overlaps_in<D>(spheres, edges).empty();
}

template <int D>
void fit_exactly_in(SpheresInBox& in_box) {
  const Vector<D> target = *in_box.task.target_edges;
  Vector<D> edges = in_box.edges;
  Spheres<D> spheres = in_box.spheres.in<D>();
  if (pairs_of_images<D>(spheres) > most_pairs) return;
  if (2 * std::ranges::max(spheres.r) > target.minCoeff()) return;  // by its own image
  resize_box<D>(spheres, edges, target);
  if (!fits_apart<D>(spheres, target) && !fits_on_lattice<D>(spheres, target)) return;
  in_box.spheres = std::move(spheres);
  in_box.edges = target;
}

}  // namespace

void fit_exactly(SpheresInBox& in_box) {
  const std::optional<Vector<dynamic>>& target = in_box.task.target_edges;
  if (!target || in_box.edges == *target || !in_box.task.walls.empty() || in_box.spheres.empty()) return;
  if (!((in_box.edges.array() <= (1 + nearly) * target->array()).all())) return;
  with_dimension(in_box.dimension(), EveryDimension{},
                 [&](auto dimension) { fit_exactly_in<decltype(dimension)::value>(in_box); });
}

}  // namespace bernal
