#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace bernal {

// Common to all pictures of packings: the canvas, the colours of sizes, the legend.

inline constexpr double canvas_size = 1000;
inline constexpr double narrowest_canvas = 480;  ///< needed by the legend
inline constexpr double canvas_margin = 12;
inline constexpr double legend_height = 52;
inline constexpr std::string_view line_grey = "#8590a0";
inline constexpr int colour_classes = 9;

/// Maps radii to colour classes, evenly in ln r between the smallest and the largest.
class SizeScale {
 public:
  explicit SizeScale(const std::vector<double>& radii);

  bool empty() const { return empty_; }
  bool equal() const { return equal_; }
  double smallest() const { return smallest_; }
  double largest() const { return largest_; }
  int colour_class(double radius) const;

 private:
  double smallest_ = 1, largest_ = 1;
  bool empty_ = true;
  bool equal_ = true;
};

struct Canvas {
  double width, height;  ///< without the legend below
  double scale;          ///< canvas units per unit of length
};

/// The opening tag of an SVG with a legend.
std::string svg_head(double width, double height, std::size_t spheres);

/// A line of text centred at the point.
void append_words(std::string& out, double x, double y, double size, std::string_view words);

/// A scale bar and the key of the sizes; `fill` paints a colour class.
void append_legend(std::string& out, const Canvas& canvas, const SizeScale& sizes, std::string_view unit,
                   const std::function<std::string(int)>& fill);

}  // namespace bernal
