#pragma once
#include <string_view>

namespace bernal {

/// "0.1.0"
std::string_view version();

}  // namespace bernal
