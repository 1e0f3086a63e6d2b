#pragma once
#include <filesystem>
#include <vector>

#include "figures/figure_files.hpp"

namespace bernal::figures {

/// Writes all of them or none; returns where they are.
std::vector<std::filesystem::path> write_files(const Files&, const std::filesystem::path& folder);

}  // namespace bernal::figures
