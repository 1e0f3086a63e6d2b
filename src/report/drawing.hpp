#pragma once
#include <cstddef>
#include <string>
#include <string_view>

#include "report/plot.hpp"

// Common to the pictures of maps, costs and sweeps.
namespace bernal::drawing {

/// A complete SVG file: the body with style sheet, background and title.
std::string svg_document(double width, double height, std::string_view title, std::string_view body);

/// A filled marker at a point of the picture.
void add_disc(Plot&, double x, double y);

/// The colour of the k-th series, which differs from others in shape and colour; repeats after some.
std::string_view series_colour(std::size_t k);
/// Its marker at a point of the picture, with a radius of about r; `style` holds SVG attributes.
std::string shape(std::size_t k, double x, double y, double r, std::string_view style);

/// Text in the colour of the axes.
void add_text(Plot&, double x, double y, std::string_view anchor, std::string_view text);

}  // namespace bernal::drawing
