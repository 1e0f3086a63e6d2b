#pragma once
#include <string_view>
#include <vector>

#include "scene/entry.hpp"

namespace bernal::schema {

// What the keys of size distributions demand of each other. Each throws Error{bad_scene}.

/// `what` is what there must be one of for each.
void one_for_each(std::string_view key, std::size_t given, std::string_view of, std::size_t count,
                  const Section&, std::string_view what = "number");
void all_differ(std::string_view key, std::vector<double> values, const Section&);

void sieve_rule(const Sieve&, const Section&);
void percentiles_rule(const Percentiles&, const Section&);
void histogram_rule(const Histogram&, const Section&);

}  // namespace bernal::schema
