#pragma once
#include <filesystem>
#include <string>

namespace bernal {

/// Where a program is: as a shell finds it. Empty where there is none.
std::filesystem::path program_at(const std::string& name);

}  // namespace bernal
