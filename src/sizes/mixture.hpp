#pragma once
#include <memory>
#include <string_view>
#include <vector>

#include "bernal/sizes/size_distribution.hpp"

namespace bernal {

/// The public make_mixture under another name, for distributions that are made of several.
std::unique_ptr<SizeDistribution> make_mixture(std::string_view name,
                                               std::vector<std::unique_ptr<SizeDistribution>> of,
                                               std::vector<double> shares, Basis);

}  // namespace bernal
