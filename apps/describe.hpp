#pragma once
#include <string>

#include "bernal/core/text.hpp"
#include "bernal/run/run.hpp"

/// Lines that tell what was understood: the container, what the importer did to it, the spheres.
std::string describe(const bernal::Plan& plan);

/// "diameter in mm: lognormal, basis number, median 1, sigma 0.3": what was understood, with the unit and
/// with the word radius or diameter, which users mix up.
std::string describe_sizes(const bernal::Scene& scene);

/// "lammps.data, for lammps, in m"; precondition: it is complete.
std::string describe_output(const bernal::Output& output);

/// "as many as fit", "10,000", "up to packing fraction 0.45".
std::string describe_target(const bernal::Plan& plan);
