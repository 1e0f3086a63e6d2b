#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "bernal/core/vector.hpp"
#include "report/legend.hpp"

namespace bernal {

/// A disc as it is drawn, in the scene's lengths, the second axis pointing up; its colour is that of
/// `sphere_radius`.
struct Disc {
  Vector<2> center;
  double radius;
  double sphere_radius;
  bool sticks_out = false;  ///< of the outline: is cut off there and drawn faintly beyond
};

/// A closed line through these points.
using Loop = std::vector<Vector<2>>;

/// Discs and the outline around them: a packing of two dimensions, or a section of one of three.
struct DiscPicture {
  std::vector<Disc> discs;
  std::vector<Loop> outline;  ///< what is inside by the even-odd rule
  Bounds<2> window;           ///< what is shown, of positive size
  std::string caption = {};   ///< stands above, if there is one
  std::string remark = {};    ///< stands below, between the scale bar and the key
};

/// As `svg_of`: transparent background, middle greys, a scale bar and a key. Cost: O(discs + points).
std::string svg_of(const DiscPicture&, const SizeScale& sizes, std::size_t spheres, std::string_view unit);

}  // namespace bernal
