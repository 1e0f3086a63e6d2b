#include "viewer/view.hpp"

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
constexpr std::int64_t tile = 8;  // raster points

const Vector<3> eye(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                    std::sin(elevation));
const Vector<3> right(-std::sin(azimuth), std::cos(azimuth), 0);
const Vector<3> up = eye.cross(right);

}  // namespace

const Vector<3>& View::towards_eye() { return eye; }

View::View(std::span<const Vector<3>> corners, double longest, double margin, double narrowest) {
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
  if (extent > 0) scale_ = (longest - 2 * margin) / extent;
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
      ids_(depths_.size(), nothing),
      tile_columns_((columns_ + tile - 1) / tile),
      farthest_in_tile_(static_cast<std::size_t>(tile_columns_ * ((rows_ + tile - 1) / tile)), far_away) {}

DepthBuffer::Range DepthBuffer::range(double from, double to, std::int64_t count) const {
  const auto last = static_cast<double>(count - 1);
  return {static_cast<std::int64_t>(std::ceil(std::clamp(from / pitch_, 0.0, last + 1))),
          static_cast<std::int64_t>(std::floor(std::clamp(to / pitch_, -1.0, last)))};
}

template <class DepthAt>
void DepthBuffer::draw_row(std::int64_t row, Range columns, std::uint32_t id, const DepthAt& depth_at) {
  float* const depths = depths_.data() + row * columns_;
  std::uint32_t* const ids = ids_.data() + row * columns_;
  for (std::int64_t k = columns.first; k <= columns.last; ++k) {
    const float depth = depth_at(static_cast<float>(k));
    if (depth <= depths[k]) continue;
    depths[k] = depth;
    ids[k] = id;
  }
}

void DepthBuffer::draw_ball(const CanvasPoint& center, double radius, std::uint32_t id) {
  const Range rows = range(center.y - radius, center.y + radius, rows_);
  const Range columns = range(center.x - radius, center.x + radius, columns_);
  const auto pitch = static_cast<float>(pitch_), x = static_cast<float>(center.x / pitch_),
             z = static_cast<float>(center.depth);
  for (std::int64_t row = rows.first; row <= rows.last; ++row) {
    const double dy = static_cast<double>(row) * pitch_ - center.y;
    const double squared = std::max(0.0, radius * radius - dy * dy), half = std::sqrt(squared);
    const auto left = static_cast<float>(squared);
    draw_row(row, range(center.x - half, center.x + half, columns_), id, [=](float column) {
      const float dx = (column - x) * pitch;
      return z + std::sqrt(std::max(0.0f, left - dx * dx));
    });
  }
  refresh_tiles(columns, rows);
}

bool DepthBuffer::hides_ball(const CanvasPoint& center, double radius) const {
  const Range rows = range(center.y - radius, center.y + radius, rows_);
  const Range columns = range(center.x - radius, center.x + radius, columns_);
  if (rows.first > rows.last || columns.first > columns.last) return false;  // between the raster points
  const auto nearest = static_cast<float>(center.depth + radius);
  for (std::int64_t row = rows.first / tile; row <= rows.last / tile; ++row) {
    for (std::int64_t column = columns.first / tile; column <= columns.last / tile; ++column) {
      if (farthest_in_tile_[static_cast<std::size_t>(row * tile_columns_ + column)] <= nearest) return false;
    }
  }
  return true;
}

void DepthBuffer::refresh_tiles(Range columns, Range rows) {
  if (rows.first > rows.last || columns.first > columns.last) return;
  for (std::int64_t i = rows.first / tile; i <= rows.last / tile; ++i) {
    for (std::int64_t j = columns.first / tile; j <= columns.last / tile; ++j) {
      float farthest = std::numeric_limits<float>::infinity();
      for (std::int64_t row = i * tile; row < std::min(rows_, (i + 1) * tile); ++row) {
        const float* const depths = depths_.data() + row * columns_;
        for (std::int64_t k = j * tile; k < std::min(columns_, (j + 1) * tile); ++k)
          farthest = std::min(farthest, depths[k]);
      }
      farthest_in_tile_[static_cast<std::size_t>(i * tile_columns_ + j)] = farthest;
    }
  }
}

void DepthBuffer::draw_triangle(const CanvasPoint& a, const CanvasPoint& b, const CanvasPoint& c,
                                std::uint32_t id) {
  const double area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  if (area == 0) return;
  const auto [y0, y1] = std::minmax({a.y, b.y, c.y});
  const double slope_x = ((b.depth - a.depth) * (c.y - a.y) - (c.depth - a.depth) * (b.y - a.y)) / area;
  const double slope_y = ((c.depth - a.depth) * (b.x - a.x) - (b.depth - a.depth) * (c.x - a.x)) / area;
  const Range rows = range(y0, y1, rows_);
  for (std::int64_t row = rows.first; row <= rows.last; ++row) {
    const double y = static_cast<double>(row) * pitch_;
    double from = std::numeric_limits<double>::infinity(), to = -from;
    for (const auto& [p, q] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}}) {
      if (p.y == q.y || std::min(p.y, q.y) > y || std::max(p.y, q.y) < y) continue;
      const double x = p.x + (q.x - p.x) * ((y - p.y) / (q.y - p.y));
      from = std::min(from, x);
      to = std::max(to, x);
    }
    if (!(from <= to)) continue;
    const auto start = static_cast<float>(a.depth - slope_x * a.x + slope_y * (y - a.y)),
               step = static_cast<float>(slope_x * pitch_);
    draw_row(row, range(from, to, columns_), id, [=](float column) { return start + step * column; });
  }
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
