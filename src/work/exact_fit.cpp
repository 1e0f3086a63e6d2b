#include "work/exact_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/every_dimension.hpp"
#include "domain/dyadic.hpp"
#include "work/free_of_overlap.hpp"

namespace bernal {
namespace {

/// Of an edge, what rounding and what stages leave for it; of the sum of two radii, what is looked at
/// exactly.
constexpr double nearly = 1e-9;
/// Pairs of images that are looked at in a round.
constexpr double most_pairs = 1e6;
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

/// A sphere and the image of another that overlap, decided exactly.
template <int D>
struct Overlap {
  std::size_t i, j;
  Vector<D> apart;  ///< from the image of j to i
};

/// The first of them. Precondition: centres in [0, edge).
template <int D>
std::optional<Overlap<D>> overlap_in(const Spheres<D>& spheres, const Vector<D>& edges) {
  std::optional<Overlap<D>> found;
  for (std::size_t i = 0; i < spheres.size() && !found; ++i)
    for (std::size_t j = 0; j < i && !found; ++j)
      for_each_image<D>([&](const Vector<D>& periods) {
        const Vector<D> apart = spheres.center(i) - spheres.center(j) - periods.cwiseProduct(edges);
        const double sum = spheres.r[i] + spheres.r[j];
        if (found || apart.norm() > (1 + nearly) * sum) return;
        Dyadic squared;
        for (int k = 0; k < D; ++k) {
          const auto& x = spheres.x[static_cast<std::size_t>(k)];
          squared = squared + square(Dyadic(x[i]) - Dyadic(x[j]) - Dyadic(periods[k]) * Dyadic(edges[k]));
        }
        if (squared < square(Dyadic(spheres.r[i]) + Dyadic(spheres.r[j]))) found = {i, j, apart};
      });
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
  for (int round = 0; round < most_rounds; ++round) {
    const std::optional<Overlap<D>> overlap = overlap_in<D>(spheres, edges);
    if (!overlap) return true;
    const double distance = overlap->apart.norm(), sum = spheres.r[overlap->i] + spheres.r[overlap->j];
    if (!(distance > 0)) return false;
    const double rounding = 4 * std::numeric_limits<double>::epsilon() * edges.maxCoeff();
    const Vector<D> way = (std::max(0.0, sum - distance) + rounding) / distance * overlap->apart;
    for (int k = 0; k < D; ++k) {
      double& x = spheres.x[static_cast<std::size_t>(k)][overlap->i];
      x = wrapped(x + way[k], edges[k]);
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
  return !overlap_in<D>(spheres, edges);
}

template <int D>
void fit_exactly_in(SpheresInBox& in_box) {
  const Vector<D> target = *in_box.task.target_edges;
  Vector<D> edges = in_box.edges;
  Spheres<D> spheres = in_box.spheres.in<D>();
  const auto n = static_cast<double>(spheres.size());
  if (n * n * std::pow(3, D) > most_pairs) return;
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
