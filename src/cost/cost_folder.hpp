#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "bernal/scene/scene.hpp"
#include "cost/rounds.hpp"

namespace bernal::cost {

/// The files that a call writes beside trials.csv, in this order.
const std::vector<std::string>& output_names();

/// Of those, what the record names with the digest that it has now: nobody else has written into it.
std::vector<std::string> files_of_earlier_call(const std::filesystem::path& folder,
                                               const TrialRecord& record);

/// Refuses by Error{cannot_write} what would take the place of somebody else's file, or of one that the scene
/// is read from.
void check_outputs(const std::filesystem::path& folder, const Scene& scene, const TrialRecord& record);

/// Writes a file of its own that may stand there already, by the same rule.
void write_beside(const std::filesystem::path& file, const std::string& text, TrialRecord& record);

}  // namespace bernal::cost
