#pragma once
#include <string>
#include <string_view>

#include "bernal/measure/bed_profile.hpp"

namespace bernal {

/// "every sphere rests: …", or how many do not, and how far those that hang could fall.
std::string rest_text(const Rest&, std::string_view unit);

/// What `bernal measure` says of a bed.
void print_bed(const BedProfile&, std::string_view unit);

}  // namespace bernal
