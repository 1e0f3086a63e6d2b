#pragma once
#include <cstddef>
#include <string>
#include <string_view>

#include "report/plot.hpp"

// What the pictures of maps, costs and sweeps have in common.
namespace bernal::drawing {

/// A whole SVG file. Style sheet, background and title are added to the body.
std::string svg_document(double width, double height, std::string_view title, std::string_view body);

/// A filled marker about a place of the picture.
void add_disc(Plot&, double x, double y);

/// Series that are told apart by shape and colour: the k-th of them, over and over again after some.
std::string_view series_colour(std::size_t k);
/// Its marker about a place of the picture, of about that radius; `style` is attributes of SVG.
std::string shape(std::size_t k, double x, double y, double r, std::string_view style);

/// Text in the axes' ink.
void add_text(Plot&, double x, double y, std::string_view anchor, std::string_view text);

}  // namespace bernal::drawing
