#pragma once
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace bernal {

/// Division of an axis: even; even in the logarithm; or of decimal logarithms.
enum class Scale { linear, logarithmic, exponents };

struct Axis {
  double from = 0, to = 1;  ///< from < to; positive if logarithmic
  std::string_view label = {};
  Scale scale = Scale::linear;
};

/// Position of the axes in picture units; y grows downwards.
struct PlotArea {
  double left, top, right, bottom;
};

/// The numbers at an axis, and their format.
class Ticks {
 public:
  explicit Ticks(const Axis&);
  const std::vector<double>& values() const { return values_; }
  std::string text(double value) const;

 private:
  Scale scale_;
  double step_ = 1;
  std::vector<double> values_;
};

/// A plot area with two axes, drawn as SVG text; the style sheet must define the classes grid, axis and
/// label.
class Plot {
 public:
  Plot(const PlotArea& area, const Axis& x, const Axis& y) : area_(area), x_(x), y_(y) {}

  const PlotArea& area() const { return area_; }
  double x(double v) const { return area_.left + (area_.right - area_.left) * share(x_, v); }
  double y(double v) const { return area_.bottom - (area_.bottom - area_.top) * share(y_, v); }

  /// The inverse: the value at a position in the picture.
  double x_at(double place) const { return value(x_, (place - area_.left) / (area_.right - area_.left)); }
  double y_at(double place) const { return value(y_, (area_.bottom - place) / (area_.bottom - area_.top)); }

  template <class... Args>
  void add(fmt::format_string<Args...> format, Args&&... args) {
    out_ += fmt::format(format, std::forward<Args>(args)...);
  }
  /// Grid lines, numbers and labels, the y label above the axis.
  void axes();
  /// A line through points given in axis units.
  void line(std::span<const double> xs, std::span<const double> ys, std::string_view classes);

  std::string finish() && { return std::move(out_); }

 private:
  static double share(const Axis&, double value);
  static double value(const Axis&, double share);

  PlotArea area_;
  Axis x_, y_;
  std::string out_;
};

}  // namespace bernal
