#pragma once
#include <string>

#include "report/report.hpp"
#include "viewer/html.hpp"

namespace bernal {

// Sections of report.html.
void write_sizes(Page&, const Report&);
void write_layers(Page&, const Report&);
void write_levels(Page&, const Report&);
void write_contacts(Page&, const Report&);
void write_chambers(Page&, const Report&);
void write_bed(Page&, const Report&);
void write_walls(Page&, const Report&);
void write_structure(Page&, const Report&);

/// ", of the bed below 24.1 mm", if walls and pores are measured there.
std::string below_level(const Report&);

/// "every sphere rests".
std::string short_rest_text(const Rest&);

}  // namespace bernal
