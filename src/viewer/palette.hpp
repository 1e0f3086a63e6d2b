#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>

#include <fmt/format.h>

namespace bernal {

/// A colour, each channel in [0, 1], gamma-encoded (sRGB).
struct Colour {
  double red = 0, green = 0, blue = 0;

  std::string text() const {
    const auto channel = [](double v) {
      return static_cast<int>(std::lround(255 * std::clamp(v, 0.0, 1.0)));
    };
    return fmt::format("#{:02x}{:02x}{:02x}", channel(red), channel(green), channel(blue));
  }
};

inline Colour mix(const Colour& a, const Colour& b, double share_of_b) {
  const auto channel = [&](double u, double v) { return u + share_of_b * (v - u); };
  return {channel(a.red, b.red), channel(a.green, b.green), channel(a.blue, b.blue)};
}

/// Colours of sphere sizes, small to large: from mint over teal to indigo, with monotonically falling
/// lightness, so that the order is readable without colour vision.
inline Colour size_colour(double t) {
  constexpr std::array<Colour, 6> stops = {{{0.871, 0.961, 0.898},
                                            {0.545, 0.855, 0.698},
                                            {0.263, 0.733, 0.678},
                                            {0.204, 0.561, 0.655},
                                            {0.227, 0.373, 0.624},
                                            {0.251, 0.227, 0.459}}};
  const double scaled = std::clamp(t, 0.0, 1.0) * (stops.size() - 1);
  const auto k = std::min(static_cast<std::size_t>(scaled), stops.size() - 2);
  return mix(stops[k], stops[k + 1], scaled - static_cast<double>(k));
}

/// Colours of what differs in kind, such as materials, apart for colour-blind eyes too: Paul Tol's "bright"
/// (2021), again after seven.
inline Colour kind_colour(std::size_t k) {
  constexpr std::array<Colour, 7> colours = {{{0.267, 0.467, 0.667},
                                              {0.933, 0.400, 0.467},
                                              {0.800, 0.733, 0.267},
                                              {0.133, 0.533, 0.200},
                                              {0.400, 0.800, 0.933},
                                              {0.667, 0.200, 0.467},
                                              {0.733, 0.733, 0.733}}};
  return colours[k % colours.size()];
}

}  // namespace bernal
