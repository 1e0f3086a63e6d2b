#pragma once
#include <string>
#include <vector>

namespace bernal::cost {

/// Packing fraction over the seconds that it took, a line a method: what packs without walls above, what
/// packs between floor and lid below.
struct MethodsPicture {
  struct Point {
    double seconds, phi, scatter;
  };
  struct Line {
    std::string name;
    int colour;  ///< of bench_style
    bool between_lids;
    std::vector<Point> points;  ///< in the order of the knob
  };
  std::string title;
  double predicted;  ///< by the rod model: a dashed line
  std::vector<Line> lines;
};

/// An SVG file. Precondition: there is a line, and every line has a point.
std::string draw(const MethodsPicture&);

}  // namespace bernal::cost
