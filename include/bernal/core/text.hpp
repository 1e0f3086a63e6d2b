#pragma once
#include <span>
#include <string>
#include <string_view>

namespace bernal {

/// The candidate nearest to `name` in edit distance, or "" when none is near enough to be meant
/// (more than a third of the letters differ).
std::string_view nearest_name(std::string_view name, std::span<const std::string_view> candidates);

}  // namespace bernal
