#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace bernal::cad {

/// "1 open edge", "72 open edges".
std::string counted(std::uint64_t count, std::string_view one, std::string_view many);

}  // namespace bernal::cad
