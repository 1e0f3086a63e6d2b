#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "bernal/core/vector.hpp"

namespace bernal {

/// A point in canvas units: x to the right, y down, depth towards the eye.
struct CanvasPoint {
  double x = 0;
  double y = 0;
  double depth = 0;
};

/// An orthographic three-quarter view with +z up, scaled to fill the canvas.
class View {
 public:
  /// `corners` are the points that must lie on the canvas, whose longer side is `longest`, with `margin`
  /// around them; the canvas is at least `narrowest` wide.
  View(std::span<const Vector<3>> corners, double longest, double margin, double narrowest);

  CanvasPoint operator()(const Vector<3>& p) const;
  double scale() const { return scale_; }  ///< canvas units per unit of length
  double width() const { return width_; }
  double height() const { return height_; }

  /// Unit vector from the scene to the eye.
  static const Vector<3>& towards_eye();

 private:
  Vector<3> origin_ = Vector<3>::Zero();
  double scale_ = 1;
  double x_ = 0, y_ = 0;
  double width_ = 0, height_ = 0;
};

/// The nearest object to the eye at each point of a raster over the canvas. Depths are stored as float.
class DepthBuffer {
 public:
  static constexpr std::uint32_t nothing = UINT32_MAX;

  /// `pitch` is the distance of raster points in canvas units.
  DepthBuffer(double width, double height, double pitch);

  void draw_ball(const CanvasPoint& center, double radius, std::uint32_t id);
  void draw_triangle(const CanvasPoint& a, const CanvasPoint& b, const CanvasPoint& c, std::uint32_t id);

  /// Whether something nearer than the whole ball covers every raster point that it could reach.
  /// Conservative, because it tests tiles: false is possible for hidden balls. For drawing from front to back
  /// this test usually suffices.
  bool hides_ball(const CanvasPoint& center, double radius) const;

  /// Depth at the nearest raster point; minus infinity if nothing was drawn.
  double depth(double x, double y) const;
  /// The farthest depth over the 3 x 3 raster points around (x, y).
  double farthest_depth(double x, double y) const;
  std::span<const std::uint32_t> ids() const { return ids_; }

 private:
  /// Raster points, both ends included; empty if first > last.
  struct Range {
    std::int64_t first, last;
  };
  Range range(double from, double to, std::int64_t count) const;
  template <class DepthAt>
  void draw_row(std::int64_t row, Range columns, std::uint32_t id, const DepthAt& depth_at);
  void refresh_tiles(Range columns, Range rows);
  std::int64_t index(double x, double y) const;

  double pitch_;
  std::int64_t columns_, rows_;
  std::vector<float> depths_;
  std::vector<std::uint32_t> ids_;
  std::int64_t tile_columns_;
  std::vector<float> farthest_in_tile_;
};

}  // namespace bernal
