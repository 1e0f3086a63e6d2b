#pragma once
#include <string_view>
#include <vector>

#include "io/plot.hpp"

namespace bernal::cost {

/// Adds to the style of a picture: the colours of ten lines, c0 … c9, of their dots and words, and all of it
/// in the dark, for readers who have asked for that.
extern const std::string_view bench_style;

/// A rectangle of the picture.
struct Place {
  double left, top, right, bottom;
};

/// A line in the units of the picture and the words that shall stand beside it.
struct NamedLine {
  std::string_view text;
  int colour = 0;  ///< of bench_style
  std::vector<double> xs, ys;
};

/// What a text that starts there covers.
Place place_of_text(double x, double baseline, std::string_view text);

/// Writes the words of every line beside one of its points, where they cover least: no other words, none of
/// what is `taken`, few lines, and nothing beyond the area of the plot.
void add_names(Plot& plot, const std::vector<NamedLine>& lines, std::vector<Place> taken);

}  // namespace bernal::cost
