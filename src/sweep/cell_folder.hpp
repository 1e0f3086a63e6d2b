#pragma once
#include <filesystem>
#include <string>

#include "bernal/sweep/sweep.hpp"

namespace bernal::sweep {

/// The claim of a cell, in the folder of its sweep.
std::filesystem::path claim_of_cell(const std::filesystem::path& folder, const std::string& hash);

/// Throws Error{cannot_write} where a link stands in the place of a folder that the cell's files go into.
void require_no_links(const std::filesystem::path& folder, const std::string& hash);

/// Why there is no packing.
struct Failure {
  CellResult::State state = CellResult::State::crashed;  ///< or refused
  int exit_code = 2;
  std::string reason;
};

/// Keeps in the cell's folder why there is no packing. Throws Error{cannot_write}.
void write_failure(const std::filesystem::path& folder, const std::string& hash, const Failure& failure);

/// Forgets it.
void remove_failure(const std::filesystem::path& folder, const std::string& hash);

/// Writes a file as a whole: in the place of what stands there, or not at all. Throws Error{cannot_write}.
void replace_file(const std::filesystem::path& file, const std::string& text);

/// Removes what processes that were killed over the cell have left beside its result.
void tidy_cell(const std::filesystem::path& folder, const std::string& hash);

/// Whether a cell of that result is to be run, with so many seconds for it.
bool is_to_be_run(const CellResult& result, std::optional<double> seconds, bool retry);

}  // namespace bernal::sweep
