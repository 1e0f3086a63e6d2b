#include "measure/bed_surface.hpp"

#include <algorithm>
#include <cmath>

#include "core/parallel.hpp"

namespace bernal {
namespace {

constexpr double most_cells = 1 << 22;
constexpr double points_for_shares = 1 << 16;
constexpr double most_points_across = 8;  // of a cell
/// A sphere that reaches into a cell by less than this share of its squared radius is beside it.
constexpr double beside_cell = 1e-9;
/// A point of the surface is tested nearer to the floor by this share of its height, so that rounding does
/// not put it outside.
constexpr double lowered = 1e-6;

/// Directions normal to gravity and to each other; the first along a periodic axis, or any axis normal to
/// gravity.
std::array<Vector<3>, 2> across(const Vector<3>& down, const Container& container) {
  Vector<3> first = container.dimension() == 2 ? Vector<3>(down.cross(Vector<3>::UnitZ())).normalized()
                                               : Vector<3>(down.unitOrthogonal());
  for (const bool must_repeat : {false, true})
    for (int k = 2; k >= 0 && container.dimension() == 3; --k)
      if (down[k] == 0 && (!must_repeat || container.boundary().edges[k] > 0)) first = Vector<3>::Unit(k);
  return {first, down.cross(first)};
}

}  // namespace

BedSurface::BedSurface(const Spheres<3>& spheres, const Container& container, const Vector<3>& down,
                       double width)
    : up_(-down) {
  const Bounds<3> bounds = container.bounds();
  const std::array<Vector<3>, 2> along = across(down, container);
  std::array<double, 2> length;
  for (std::size_t a = 0; a < 2; ++a) {
    const double middle = along[a].dot(bounds.center());
    length[a] = along[a].cwiseAbs().dot(bounds.size());
    axes_[a] = {along[a], middle - 0.5 * length[a], 0, 1,
                along[a].cwiseAbs().dot(container.boundary().edges) > 0};
  }
  if (length[0] * length[1] > most_cells * width * width)
    width = std::sqrt(length[0] * length[1] / most_cells);
  for (std::size_t a = 0; a < 2; ++a) {
    axes_[a].cells = static_cast<std::size_t>(std::clamp(std::round(length[a] / width), 1.0, most_cells));
    axes_[a].width = length[a] > 0 ? length[a] / static_cast<double>(axes_[a].cells) : width;
  }
  heights_.assign(axes_[0].cells * axes_[1].cells, bare);
  for (std::size_t i = 0; i < spheres.size(); ++i) raise(spheres.center(i), spheres.r[i]);
}

std::size_t BedSurface::Axis::cell_of(double x) const {
  const double cell = std::floor((x - from) / width), n = static_cast<double>(cells);
  return static_cast<std::size_t>(repeats ? cell - n * std::floor(cell / n) : std::clamp(cell, 0.0, n - 1));
}

/// Raises the surface of all cells that a sphere reaches.
void BedSurface::raise(const Vector<3>& center, double r) {
  std::array<double, 2> at;
  std::array<std::ptrdiff_t, 2> first, last;
  for (std::size_t a = 0; a < 2; ++a) {
    const Axis& axis = axes_[a];
    at[a] = (axis.along.dot(center) - axis.from) / axis.width;
    const auto cells = static_cast<double>(axis.cells), reach = r / axis.width;
    const double end = axis.repeats ? 2 * cells : cells - 1, begin = axis.repeats ? -cells : 0;
    first[a] = static_cast<std::ptrdiff_t>(std::clamp(std::floor(at[a] - reach), begin, end));
    last[a] = static_cast<std::ptrdiff_t>(std::clamp(std::floor(at[a] + reach), begin, end));
  }
  const auto squared_distance = [&](std::size_t a, std::ptrdiff_t cell) {
    const double low = static_cast<double>(cell) - at[a];
    const double distance = axes_[a].width * std::max({low, -low - 1, 0.0});
    return distance * distance;
  };
  const auto place = [&](std::size_t a, std::ptrdiff_t cell) {
    const auto n = static_cast<std::ptrdiff_t>(axes_[a].cells);
    return static_cast<std::size_t>(((cell % n) + n) % n);
  };
  const double height = up_.dot(center);
  for (std::ptrdiff_t j = first[1]; j <= last[1]; ++j) {
    const double left = r * r - squared_distance(1, j);
    for (std::ptrdiff_t i = first[0]; i <= last[0]; ++i) {
      const double squared = left - squared_distance(0, i);
      if (!(squared > beside_cell * r * r)) continue;
      double& surface = heights_[place(1, j) * axes_[0].cells + place(0, i)];
      surface = std::max(surface, height + std::sqrt(squared));
    }
  }
}

double BedSurface::height_over(const Vector<3>& p) const {
  const auto cell = [&](const Axis& axis) { return axis.cell_of(axis.along.dot(p)); };
  return heights_[cell(axes_[1]) * axes_[0].cells + cell(axes_[0])];
}

std::vector<BedSurface::Cell> BedSurface::cells(const Container& container, double floor) const {
  double sum = 0, covered = 0;
  for (const double height : heights_) {
    sum += height > bare ? height : 0;
    covered += height > bare;
  }
  const double otherwise = covered > 0 ? sum / covered : floor;
  const auto across = static_cast<int>(std::clamp(
      std::sqrt(points_for_shares / static_cast<double>(heights_.size())), 1.0, most_points_across));
  const int across_second = container.dimension() == 2 ? 1 : across;
  std::vector<Cell> cells(heights_.size());
  parallel_for(cells.size(), [&](std::size_t cell) {
    const double height = heights_[cell] > bare ? heights_[cell] : otherwise;
    const auto corner = [&](std::size_t a, std::size_t at, int k, int of) {
      return axes_[a].from + axes_[a].width * (static_cast<double>(at) + (k + 0.5) / of);
    };
    int inside = 0;
    for (int j = 0; j < across_second; ++j)
      for (int i = 0; i < across; ++i) {
        Vector<3> p = (height - lowered * (height - floor)) * up_ +
                      corner(0, cell % axes_[0].cells, i, across) * axes_[0].along;
        if (container.dimension() == 3)
          p += corner(1, cell / axes_[0].cells, j, across_second) * axes_[1].along;
        inside += container.contains(p, 0);
      }
    cells[cell] = {heights_[cell], static_cast<double>(inside) / (across * across_second)};
  });
  return cells;
}

}  // namespace bernal
