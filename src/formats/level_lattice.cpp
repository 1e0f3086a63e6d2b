#include "formats/level_lattice.hpp"

#include <algorithm>
#include <cmath>

namespace bernal {
namespace {

constexpr std::size_t most_without_lattice = 60;
constexpr double centres_an_element = 8;
constexpr double longest_axis = 1000;  // elements along one

/// Calls visit(element) for the elements that a sphere reaches into.
template <class Visit>
void for_each_element(const LevelLattice& lattice, const Vector<3>& at, double r, const Visit& visit) {
  // Rounding must not hide a sphere from an element; one too many does no harm.
  const double reach = r + 1e-9 * (r + lattice.pitch.maxCoeff());
  std::array<std::size_t, 3> from{}, to{};
  for (std::size_t k = 0; k < 3; ++k) {
    const int axis = static_cast<int>(k);
    const auto index = [&](double x) {
      const double i = std::floor((x - lattice.lower[axis]) / lattice.pitch[axis]);
      return static_cast<std::size_t>(std::clamp(i, 0.0, static_cast<double>(lattice.shape[k] - 1)));
    };
    from[k] = index(at[axis] - reach);
    to[k] = index(at[axis] + reach);
  }
  const auto gap = [&](int axis, std::size_t i) {
    const double low = lattice.lower[axis] + static_cast<double>(i) * lattice.pitch[axis];
    return std::max({low - at[axis], at[axis] - (low + lattice.pitch[axis]), 0.0});
  };
  for (std::size_t z = from[2]; z <= to[2]; ++z)
    for (std::size_t y = from[1]; y <= to[1]; ++y)
      for (std::size_t x = from[0]; x <= to[0]; ++x) {
        const double dx = gap(0, x), dy = gap(1, y), dz = gap(2, z);
        if (dx * dx + dy * dy + dz * dz <= reach * reach)
          visit(x + lattice.shape[0] * (y + lattice.shape[1] * z));
      }
}

}  // namespace

Vector<3> LevelLattice::center(std::size_t element) const {
  const std::size_t x = element % shape[0], y = element / shape[0] % shape[1],
                    z = element / (shape[0] * shape[1]);
  const Vector<3> index(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z));
  return lower + (index + Vector<3>::Constant(0.5)).cwiseProduct(pitch);
}

bool needs_lattice(const Level& level) { return level.size() > most_without_lattice; }

LevelLattice lattice_of(const Level& level) {
  LevelLattice lattice;
  lattice.lower = level.bounds.lower;
  const Vector<3> size = level.bounds.size();
  const double edge =
      std::cbrt(centres_an_element * level.bounds.volume() / static_cast<double>(level.size()));
  for (std::size_t k = 0; k < 3; ++k) {
    const int axis = static_cast<int>(k);
    const double elements = std::clamp(std::floor(size[axis] / edge), 1.0, longest_axis);
    lattice.shape[k] = static_cast<std::size_t>(elements);
    lattice.pitch[axis] = size[axis] / elements;
  }
  // Counted first, then put in their places.
  lattice.first.assign(lattice.size() + 1, 0);
  const auto each = [&](const auto& visit) {
    for (std::size_t i = 0; i < level.size(); ++i)
      for_each_element(lattice, level.center(i), level.spheres.r[i],
                       [&](std::size_t element) { visit(element, static_cast<std::uint32_t>(i)); });
  };
  each([&](std::size_t element, std::uint32_t) { ++lattice.first[element + 1]; });
  for (std::size_t e = 0; e < lattice.size(); ++e) lattice.first[e + 1] += lattice.first[e];
  lattice.spheres.resize(lattice.first.back());
  std::vector<std::uint32_t> next(lattice.first.begin(), lattice.first.end() - 1);
  each([&](std::size_t element, std::uint32_t i) { lattice.spheres[next[element]++] = i; });
  return lattice;
}

}  // namespace bernal
