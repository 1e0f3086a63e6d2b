#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/plot.hpp"

namespace bernal::figures {

/// A whole SVG file. Style sheet, background and title are added to the body.
std::string svg_document(double width, double height, std::string_view title, std::string_view body);

/// A row of a legend: a stroke or a marker, and what it stands for.
void legend_line(Plot&, double x, double y, std::string_view classes, std::string_view text);

enum class Marker { triangle, disc, ring };
void add_marker(Plot&, Marker, double x, double y);
void legend_marker(Plot&, Marker, double x, double y, std::string_view text);
/// Series that are told apart by shape and colour: the k-th of them, over and over again after some.
std::string_view series_colour(std::size_t k);
/// Its marker about a place of the picture, of about that radius; `style` is attributes of SVG.
std::string shape(std::size_t k, double x, double y, double r, std::string_view style);
/// A vertical bar of ± error.
void add_error_bar(Plot&, double x, double y, double error);

/// A line through points, and a dot at each, of one of the four inks: "line two dashed".
void add_curve(Plot&, std::span<const double> xs, std::span<const double> ys, std::string_view classes);

/// A whole SVG file, such as the picture of a packing, as a part of another one.
std::string nested_svg(std::string svg, double x, double y, double width, double height);

/// Text in the axes' ink.
void add_text(Plot&, double x, double y, std::string_view anchor, std::string_view text);

/// `steps` + 1 numbers from `from` to `to`, evenly or evenly in the logarithm.
std::vector<double> spread(double from, double to, int steps, bool logarithmic = false);

}  // namespace bernal::figures
