#pragma once
#include <string>

#include "bernal/verify/certificate.hpp"

namespace bernal {

/// The certificate as one JSON object, two spaces a level: what `verify --json` prints and what stands under
/// `certificate` in report.json. Its keys are the members of Certificate. `worst_pair` is null where no two
/// spheres are near, twice the same index for a sphere and its own image; `worst_wall` and `min_wall_gap` are
/// null where no sphere is near a wall. `overlaps` and `protrusions` are there where a list was asked for and
/// has entries. Numbers that are not finite become null.
std::string certificate_as_json(const Certificate&);

}  // namespace bernal
