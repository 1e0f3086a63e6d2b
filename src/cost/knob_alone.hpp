#pragma once
#include <string>

#include "cost/search.hpp"

namespace bernal::cost {

/// Seconds that differ by less than this share are told as equal.
constexpr double same_seconds = 0.05;

/// What a knob does alone, the others as in the scene: "alpha: from 17 to 60 buys 0.0012 for 3 times the
/// time".
std::string sentence_of_knob(const Search& search, std::size_t knob);

/// "+0.0012"
std::string change_in_words(double change);

}  // namespace bernal::cost
