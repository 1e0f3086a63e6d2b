#pragma once
#include <string>
#include <vector>

namespace bernal::cost {

/// Of every effect what it buys in packing fraction, left, and how many times as long it takes, right.
struct EffectsPicture {
  struct Row {
    std::string name;
    double gain, gain_scatter;
    double ratio, ratio_scatter;  ///< of seconds, with over without
  };
  std::vector<Row> rows;
};

/// An SVG file. Precondition: there is a row.
std::string draw(const EffectsPicture&);

}  // namespace bernal::cost
