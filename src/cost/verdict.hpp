#pragma once
#include "bernal/cost/cost.hpp"
#include "cost/search.hpp"

namespace bernal::cost {

/// Rows, fronts, recommendation and sentences of what a search has found; the scene is one to be read from
/// the folder. Precondition: the scene as it is was measured.
CostReport report_of(const Search& search, const std::filesystem::path& folder);

/// "0.0123 s", "12.3 s", "12 min"
std::string seconds_in_words(double seconds);

}  // namespace bernal::cost
