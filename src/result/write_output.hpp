#pragma once
#include <string>

#include "bernal/core/monitor.hpp"
#include "bernal/scene/packing.hpp"
#include "files/staged_folder.hpp"

namespace bernal {

/// Adds a packing as other programs read it to the files of a folder, under the output's own name; see
/// `write_export`. Returns its note; throws Cancelled once the monitor says stop. formats/ has it, and the
/// formats. Precondition: the output is complete.
std::string write_output(const Packing&, const Output&, StagedFolder&, const Monitor& monitor = {});

}  // namespace bernal
