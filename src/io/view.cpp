#include "io/view.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace bernal {
namespace {

constexpr double elevation = 24 * std::numbers::pi / 180;
constexpr double azimuth = -62 * std::numbers::pi / 180;
constexpr float far_away = -std::numeric_limits<float>::infinity();

const Vector<3> eye(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                    std::sin(elevation));
const Vector<3> right(-std::sin(azimuth), std::cos(azimuth), 0);
const Vector<3> up = eye.cross(right);

}  // namespace

const Vector<3>& View::towards_eye() { return eye; }

View::View(std::span<const Vector<3>> corners, double canvas_size, double margin, double narrowest) {
  if (corners.empty()) return;
  origin_ = corners.front();  // keeps the differences below exact for shapes far from zero
  constexpr double infinity = std::numeric_limits<double>::infinity();
  double left = infinity, rightmost = -infinity, bottom = infinity, top = -infinity;
  for (const Vector<3>& p : corners) {
    const Vector<3> q = p - origin_;
    left = std::min(left, q.dot(right));
    rightmost = std::max(rightmost, q.dot(right));
    bottom = std::min(bottom, q.dot(up));
    top = std::max(top, q.dot(up));
  }
  const double extent = std::max(rightmost - left, top - bottom);
  if (extent > 0) scale_ = (canvas_size - 2 * margin) / extent;
  y_ = margin + scale_ * top;
  width_ = std::max(scale_ * (rightmost - left) + 2 * margin, narrowest);
  height_ = scale_ * (top - bottom) + 2 * margin;
  x_ = 0.5 * (width_ - scale_ * (left + rightmost));
}

CanvasPoint View::operator()(const Vector<3>& p) const {
  const Vector<3> q = p - origin_;
  return {x_ + scale_ * q.dot(right), y_ - scale_ * q.dot(up), scale_ * q.dot(eye)};
}

DepthBuffer::DepthBuffer(double width, double height, double pitch)
    : pitch_(pitch),
      columns_(static_cast<std::int64_t>(std::ceil(width / pitch)) + 1),
      rows_(static_cast<std::int64_t>(std::ceil(height / pitch)) + 1),
      depths_(static_cast<std::size_t>(columns_ * rows_), far_away),
      ids_(depths_.size(), nothing) {}

/// `depth_at` answers minus infinity off the thing that is drawn.
template <class DepthAt>
void DepthBuffer::draw(double x0, double x1, double y0, double y1, std::uint32_t id,
                       const DepthAt& depth_at) {
  const auto first = [&](double v) {
    return std::max<std::int64_t>(0, static_cast<std::int64_t>(std::ceil(v / pitch_)));
  };
  const auto last = [&](double v, std::int64_t count) {
    return std::min<std::int64_t>(count - 1, static_cast<std::int64_t>(std::floor(v / pitch_)));
  };
  const std::int64_t column_end = last(x1, columns_), row_end = last(y1, rows_);
  for (std::int64_t row = first(y0); row <= row_end; ++row) {
    for (std::int64_t column = first(x0); column <= column_end; ++column) {
      const auto depth = static_cast<float>(
          depth_at(static_cast<double>(column) * pitch_, static_cast<double>(row) * pitch_));
      const auto k = static_cast<std::size_t>(row * columns_ + column);
      if (depth > depths_[k]) {
        depths_[k] = depth;
        ids_[k] = id;
      }
    }
  }
}

void DepthBuffer::draw_ball(const CanvasPoint& center, double radius, std::uint32_t id) {
  draw(center.x - radius, center.x + radius, center.y - radius, center.y + radius, id,
       [&](double x, double y) {
         const double dx = x - center.x, dy = y - center.y;
         const double squared = radius * radius - dx * dx - dy * dy;
         return squared >= 0 ? center.depth + std::sqrt(squared) : double{far_away};
       });
}

void DepthBuffer::draw_triangle(const CanvasPoint& a, const CanvasPoint& b, const CanvasPoint& c,
                                std::uint32_t id) {
  const auto twice_area = [](const CanvasPoint& p, const CanvasPoint& q, double x, double y) {
    return (q.x - p.x) * (y - p.y) - (q.y - p.y) * (x - p.x);
  };
  const double area = twice_area(a, b, c.x, c.y);
  if (area == 0) return;
  const auto [x0, x1] = std::minmax({a.x, b.x, c.x});
  const auto [y0, y1] = std::minmax({a.y, b.y, c.y});
  draw(x0, x1, y0, y1, id, [&](double x, double y) {
    const double u = twice_area(b, c, x, y) / area, v = twice_area(c, a, x, y) / area, w = 1 - u - v;
    if (u < 0 || v < 0 || w < 0) return double{far_away};
    return u * a.depth + v * b.depth + w * c.depth;
  });
}

std::int64_t DepthBuffer::index(double x, double y) const {
  const auto column = static_cast<std::int64_t>(std::lround(x / pitch_));
  const auto row = static_cast<std::int64_t>(std::lround(y / pitch_));
  return column < 0 || row < 0 || column >= columns_ || row >= rows_ ? -1 : row * columns_ + column;
}

double DepthBuffer::depth(double x, double y) const {
  const std::int64_t k = index(x, y);
  return k < 0 ? double{far_away} : double{depths_[static_cast<std::size_t>(k)]};
}

double DepthBuffer::farthest_depth(double x, double y) const {
  double farthest = std::numeric_limits<double>::infinity();
  for (int row = -1; row <= 1; ++row) {
    for (int column = -1; column <= 1; ++column) {
      farthest = std::min(farthest, depth(x + column * pitch_, y + row * pitch_));
    }
  }
  return farthest;
}

}  // namespace bernal
