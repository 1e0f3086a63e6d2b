#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace bernal {

/// The candidate nearest to `name` in edit distance (a letter inserted, left out, replaced or swapped with
/// its neighbour counts one, case does not count), the first of equals; "" when none is near enough to be
/// meant: more than a third of the letters of the longer word differ.
std::string_view nearest_name(std::string_view name, std::span<const std::string_view> candidates);

/// What to tell who wrote that name: `; did you mean "diameter"?` or, where nothing is near,
/// `; known: "count", "radius"`.
std::string remedy(std::string_view name, std::span<const std::string_view> candidates);

/// 28312 as "28,312".
std::string grouped(std::uint64_t n);

}  // namespace bernal
