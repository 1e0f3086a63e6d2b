#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "bernal/core/vector.hpp"
#include "report/legend.hpp"

namespace bernal {

/// A disc of a picture, in the scene's lengths, with the second axis upwards; coloured by `sphere_radius`.
struct Disc {
  Vector<2> center;
  double radius;
  double sphere_radius;
  bool sticks_out = false;  ///< beyond the outline, where it is drawn faintly
};

/// A closed polyline.
using Loop = std::vector<Vector<2>>;

/// Discs and the outline around them: a packing of two dimensions, or a section of three.
struct DiscPicture {
  std::vector<Disc> discs;
  std::vector<Loop> outline;  ///< the inside is by the even-odd rule
  Bounds<2> window;           ///< the visible part, of positive size
  std::string caption = {};   ///< above the picture, if not empty
  std::string remark = {};    ///< below it, between the scale bar and the key
};

/// As `svg_of`: transparent background, middle greys, a scale bar and a key. Cost: O(discs + points).
std::string svg_of(const DiscPicture&, const SizeScale& sizes, std::size_t spheres, std::string_view unit);

}  // namespace bernal
