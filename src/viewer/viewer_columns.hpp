#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bernal/measure/measure.hpp"
#include "bernal/scene/packing.hpp"

namespace bernal {

/// A number of every sphere that the view colours by.
struct ViewColumn {
  enum class Kind {
    length,    ///< in the scene's unit
    number,    ///< without a unit
    count,     ///< 0, 1, 2, …
    category,  ///< one of some, which are told apart by colour and have no order; counted from 1, 0 for none
  };
  std::string_view key;    ///< for programs
  std::string_view title;  ///< of the menu and the key
  Kind kind = Kind::number;
  std::vector<float> values = {};  ///< not finite where there is none
};

/// Those that there are, of the spheres `of`. `measured` may be null. Precondition: two or three dimensions.
std::vector<ViewColumn> view_columns(const Packing&, const Measurements* measured,
                                     std::span<const std::uint32_t> of);

}  // namespace bernal
