#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "bernal/core/dimension.hpp"
#include "bernal/measure/cells.hpp"
#include "core/parallel.hpp"

namespace bernal {
namespace {

constexpr std::size_t shapes_a_range = 256;

struct PlacesOfCell {
  std::vector<std::vector<Vector<3>>> loops;  ///< as seen from outside
  std::vector<Vector<3>> corners;
};

/// What of a cell stands where.
PlacesOfCell places_of(const Cells& cells, std::uint32_t cell, CellShape& shape) {
  PlacesOfCell made;
  std::vector<Cells::Corner> all;
  std::uint32_t ends = 0;
  for (const Cells::Side& side : cells.sides_of(cell)) {
    const Cells::Image image = cells.image_of(side);
    std::vector<Vector<3>>& loop = made.loops.emplace_back();
    for (Cells::Corner corner : cells.corners_of(side.face)) {
      loop.push_back(cells.place(corner, image));
      for (std::size_t k = 0; k < 3; ++k)
        corner.image[k] = static_cast<std::int8_t>(corner.image[k] + image[k]);
      all.push_back(corner);
    }
    ends += static_cast<std::uint32_t>(loop.size());
    if (side.beyond) std::ranges::reverse(loop);
    ++shape.faces;
    shape.neighbours += cells.neighbour(side) != Cells::none;
  }
  std::ranges::sort(all, [](const Cells::Corner& a, const Cells::Corner& b) {
    return std::tie(a.corner, a.image) < std::tie(b.corner, b.image);
  });
  const auto twins = std::ranges::unique(all);
  all.erase(twins.begin(), twins.end());
  for (const Cells::Corner& corner : all) made.corners.push_back(cells.place(corner));
  shape.corners = static_cast<std::uint32_t>(all.size());
  shape.edges = cells.dimension == 3 ? ends / 2 : shape.faces;
  return made;
}

/// The point from which a face is divided into triangles: the middle of its corners, which both of its cells
/// have.
Vector<3> mean_of(const std::vector<Vector<3>>& loop) {
  Vector<3> sum = Vector<3>::Zero();
  for (const Vector<3>& p : loop) sum += p;
  return sum / static_cast<double>(loop.size());
}

CellStatistics::Moments moments_of(const std::vector<double>& values) {
  CellStatistics::Moments made;
  if (values.empty()) return made;
  const auto n = static_cast<double>(values.size());
  for (const double v : values) made.mean += v / n;
  double second = 0, third = 0, fourth = 0;
  for (const double v : values) {
    const double d = v - made.mean;
    second += d * d / n;
    third += d * d * d / n;
    fourth += d * d * d * d / n;
  }
  made.deviation = std::sqrt(second);
  constexpr double rounding = 1e-12;
  if (made.deviation > rounding * std::abs(made.mean)) {
    made.skewness = third / (second * made.deviation);
    made.kurtosis = fourth / (second * second);
  }
  const auto [least, most] = std::ranges::minmax(values);
  made.least = least;
  made.most = most;
  return made;
}

}  // namespace

CellShape shape_of(const Cells& cells, std::uint32_t cell) {
  CellShape shape;
  if (cells.is_empty(cell)) return shape;
  const PlacesOfCell places = places_of(cells, cell, shape);
  const Vector<3> apex = mean_of(places.corners);
  const int dimension = cells.dimension;
  Vector<3> moment = Vector<3>::Zero();
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();  // ∫ x xᵀ dV about the apex
  for (const std::vector<Vector<3>>& loop : places.loops) {
    if (dimension == 2) {
      const Vector<3> a = loop[0] - apex, b = loop[1] - apex;
      const double area = 0.5 * (a[0] * b[1] - a[1] * b[0]);
      shape.volume += area;
      shape.surface += (b - a).norm();
      moment += area / 3 * (a + b);
      spread += area / 12 * (a * a.transpose() + b * b.transpose() + (a + b) * (a + b).transpose());
      continue;
    }
    const Vector<3> middle = mean_of(loop) - apex;
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const Vector<3> a = loop[k] - apex, b = loop[(k + 1) % loop.size()] - apex;
      const Vector<3> twice = (a - middle).cross(b - middle);
      const double sixth = middle.dot(twice) / 6;
      shape.volume += sixth;
      shape.surface += 0.5 * twice.norm();
      const Vector<3> sum = middle + a + b;
      moment += sixth / 4 * sum;
      spread += sixth / 20 *
                (middle * middle.transpose() + a * a.transpose() + b * b.transpose() + sum * sum.transpose());
    }
  }
  shape.centroid = apex;
  if (shape.volume > 0) shape.centroid += moment / shape.volume;
  if (shape.surface > 0) {
    const double unit = ball_volume(dimension, 1.0);
    const double radius = std::pow(std::max(shape.volume, 0.0) / unit, 1.0 / dimension);
    shape.sphericity = dimension * unit * std::pow(radius, dimension - 1) / shape.surface;
  }
  if (shape.volume <= 0) return shape;
  spread -= moment * moment.transpose() / shape.volume;
  const Eigen::Vector3d along =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread, Eigen::EigenvaluesOnly).eigenvalues();
  const double least = along[3 - dimension];
  shape.aspect = least > 0 ? std::sqrt(along[2] / least) : 0;
  return shape;
}

std::vector<CellShape> shapes_of(const Cells& cells) {
  std::vector<CellShape> shapes(cells.size());
  parallel_ranges(cells.size(), shapes_a_range, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) shapes[i] = shape_of(cells, static_cast<std::uint32_t>(i));
  });
  return shapes;
}

CellStatistics statistics_of(const Cells& cells, const std::vector<CellShape>& shapes) {
  CellStatistics made;
  std::vector<double> volumes, diameters, faces, sphericity, aspect, edges;
  const double unit = ball_volume(cells.dimension, 1.0);
  for (const CellShape& shape : shapes) {
    made.volume += shape.volume;
    if (shape.faces == 0) {
      ++made.empty;
      continue;
    }
    ++made.cells;
    made.not_euler += shape.euler(cells.dimension) != (cells.dimension == 3 ? 2 : 0);
    volumes.push_back(shape.volume);
    diameters.push_back(2 * std::pow(std::max(shape.volume, 0.0) / unit, 1.0 / cells.dimension));
    faces.push_back(shape.faces);
    sphericity.push_back(shape.sphericity);
    aspect.push_back(shape.aspect);
    if (made.with_faces.size() <= shape.faces) made.with_faces.resize(shape.faces + 1);
    ++made.with_faces[shape.faces];
  }
  made.corners = cells.corners.size();
  made.faces = cells.faces.size();
  for (std::uint32_t f = 0; f < cells.faces.size(); ++f)
    edges.push_back(static_cast<double>(cells.corners_of(f).size()));
  made.edges = cells.dimension == 2 ? made.faces : edges_of(cells).size();
  made.euler =
      static_cast<std::int64_t>(made.corners) - static_cast<std::int64_t>(made.edges) +
      (cells.dimension == 2 ? static_cast<std::int64_t>(made.cells)
                            : static_cast<std::int64_t>(made.faces) - static_cast<std::int64_t>(made.cells));
  made.volume_error = std::abs(made.volume - cells.volume) / cells.volume;
  made.volumes = moments_of(volumes);
  made.diameters = moments_of(diameters);
  made.faces_a_cell = moments_of(faces);
  made.edges_a_face = moments_of(edges);
  made.sphericity = moments_of(sphericity);
  made.aspect = moments_of(aspect);
  return made;
}

CellEdge cell_edge(Cells::Corner a, Cells::Corner b) {
  CellEdge edge{a.corner, b.corner, {}};
  for (std::size_t k = 0; k < 3; ++k) edge.image[k] = static_cast<std::int8_t>(b.image[k] - a.image[k]);
  const CellEdge back{b.corner,
                      a.corner,
                      {static_cast<std::int8_t>(-edge.image[0]), static_cast<std::int8_t>(-edge.image[1]),
                       static_cast<std::int8_t>(-edge.image[2])}};
  const bool is_forwards = a.corner != b.corner ? a.corner < b.corner : edge.image > back.image;
  return is_forwards ? edge : back;
}

std::vector<CellEdge> edges_of(const Cells& cells) {
  std::vector<CellEdge> all;
  for (std::uint32_t f = 0; f < cells.faces.size(); ++f) {
    const auto loop = cells.corners_of(f);
    const std::size_t count = cells.dimension == 2 ? 1 : loop.size();
    for (std::size_t k = 0; k < count; ++k) all.push_back(cell_edge(loop[k], loop[(k + 1) % loop.size()]));
  }
  std::ranges::sort(all);
  const auto twins = std::ranges::unique(all);
  all.erase(twins.begin(), twins.end());
  return all;
}

}  // namespace bernal
