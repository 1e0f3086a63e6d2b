#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bernal/measure/measure.hpp"
#include "bernal/scene/packing.hpp"

namespace bernal {

/// A value for every sphere that the view can colour by.
struct ViewColumn {
  enum class Kind {
    length,    ///< in the scene's unit
    number,    ///< without a unit
    count,     ///< 0, 1, 2, …
    category,  ///< one of several, distinguished by colour, without order; counted from 1, 0 for none
  };
  std::string_view key;    ///< for programs
  std::string_view title;  ///< of the menu and the key
  Kind kind = Kind::number;
  std::vector<float> values = {};  ///< not finite if absent
};

/// The available columns for the spheres `of`. `measured` may be null. Precondition: two or three dimensions.
std::vector<ViewColumn> view_columns(const Packing&, const Measurements* measured,
                                     std::span<const std::uint32_t> of);

}  // namespace bernal
