#pragma once
#include <string>

#include "bernal/cost/cost.hpp"

namespace bernal::cost {

/// What the pages say of the measurement itself.
struct CostHeading {
  std::string scene;    ///< its file's name
  std::string machine;  ///< "2 threads"
  int seeds = 2;
};

std::string cost_csv(const CostReport&);
std::string cost_md(const CostReport&, const CostHeading&);
/// A page that needs no other file, in the style of report.html.
std::string cost_html(const CostReport&, const CostHeading&, std::string_view picture);
/// Packing fraction over seconds, the front as a stair; a marker a setting, by the knob that was turned.
std::string cost_svg(const CostReport&, const CostHeading&);

/// The rows of the front, in their order, numbered from 1 in pages and picture.
std::vector<std::size_t> front_rows(const CostReport&);

}  // namespace bernal::cost
