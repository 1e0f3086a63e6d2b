#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bernal/core/quantity.hpp"

/// What follows an option: a number, in `unit` where it is a length, or one with its unit. Throws
/// Error{bad_argument} for other text, and for a length with its unit where `unit` is not known.
double number_of(std::string_view option, const std::string& text, bernal::Quantity of,
                 std::optional<bernal::Unit> unit);

/// The lengths between commas: "1,2,3", "1 mm,2 mm,3 mm".
std::vector<double> lengths_of(std::string_view option, const std::string& text,
                               std::optional<bernal::Unit> unit);
