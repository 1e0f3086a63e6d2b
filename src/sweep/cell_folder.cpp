#include "sweep/cell_folder.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "bernal/measure/measure.hpp"
#include "files/bytes_of_file.hpp"
#include "files/file_kind.hpp"
#include "files/put_in_place.hpp"
#include "files/seal.hpp"
#include "files/sha256.hpp"
#include "files/staged_folder.hpp"
#include "report/report.hpp"
#include "report/report_summary.hpp"
#include "result/result_folder.hpp"
#include "scene/read_spheres.hpp"
#include "scene/toml_text.hpp"
#include "scene/unpublished.hpp"
#include "sweep/claim.hpp"

namespace fs = std::filesystem;

namespace bernal {
namespace {

constexpr const char* failure_name = "failed.toml";

void take_report(const ReportSummary& report, CellResult& result) {
  result.state = CellResult::State::packed;
  result.outcome = report.outcome;
  result.exit_code = report.certified && report.outcome == "converged" ? 0 : 3;
  result.reason = report.reason;
  result.n = report.n;
  result.rattlers = report.rattlers;
  result.phi = report.phi;
  result.coordination = report.coordination;
  result.max_overlap = report.max_overlap;
  result.min_wall_gap = report.min_wall_gap;
  result.seconds = report.seconds;
  result.peak_memory_bytes = report.peak_memory_bytes;
  result.certified = report.certified;
  result.hash = report.hash;
  result.program = report.program;
}

/// What is wrong with a report or the files beside it; empty where they are those that it describes.
std::string complaint_about(const fs::path& folder, const std::string& cell, const std::string& report,
                            const ReportSummary& summary) {
  const auto is_regular = [](const fs::path& file) { return kind_of_file(file) == FileKind::regular; };
  const fs::path scene = where_it_stands(folder / "scene.toml"),
                 spheres = where_it_stands(spheres_file_in(folder));
  try {
    if (!is_sealed(report)) return "its report.json is not as bernal wrote it";
    if (summary.cell != cell) return "its report.json is that of another cell";
    if (!is_regular(spheres)) return "its spheres are not there";
    const Manifest files = manifest_in(report);
    const auto said = files.find("scene.toml");
    if (!is_regular(scene) ||
        (said != files.end() && !said->second.empty() && sha256_of(scene) != said->second))
      return "its scene.toml is not the one that its report describes";
    if (hash_of(read_spheres(spheres).spheres) == summary.hash) return {};
    return "its spheres are not those that its report describes";
  } catch (const Error& error) {
    return error.what();
  }
}

/// Whether a result is of the packings that this bernal makes; else the cell is missing, and why is said.
bool is_of_our_packings(const Program& by, CellResult& result) {
  if (by.packings_number == packings_number()) return true;
  result.program = by;
  result.reason = "it was made by " + beside_this(by);
  return false;
}

void take_failure(const fs::path& file, CellResult& result) {
  try {
    const toml::table failure = toml::parse_file(file.string());
    const Program by{failure["version"].value_or(std::string("0.1")),
                     failure["commit"].value_or(std::string()), failure["packings_number"].value_or(0)};
    if (!is_of_our_packings(by, result)) return;
    const auto state = failure["outcome"].value<std::string>();
    const auto exit_code = failure["exit_code"].value<std::int64_t>();
    if (!state || !exit_code || *exit_code < 0 || *exit_code > 255) return;
    result.state = *state == "refused" ? CellResult::State::refused : CellResult::State::crashed;
    result.outcome = *state == "refused" ? "refused" : "crashed";
    result.exit_code = static_cast<int>(*exit_code);
    result.reason = failure["reason"].value_or(std::string());
    result.program = by;
  } catch (const toml::parse_error&) {  // then nothing is known
  }
}

}  // namespace

fs::path folder_of_cell(const std::string& hash) { return fs::path("cells") / hash; }

CellResult read_cell(const fs::path& folder, const std::string& hash) {
  const fs::path there = folder / folder_of_cell(hash);
  CellResult result;
  std::error_code unknown;
  if (!fs::is_directory(there, unknown)) return result;
  const std::string report = bytes_of_file(where_it_stands(there / "report.json"));
  const auto summary = summary_of_report(report);
  if (summary && is_of_our_packings(summary->program, result)) {
    result.reason = complaint_about(there, hash, report, *summary);
    if (result.reason.empty()) take_report(*summary, result);
  } else if (fs::is_regular_file(there / failure_name, unknown)) {  // later than a result of other packings
    take_failure(there / failure_name, result);
  }
  return result;
}

namespace sweep {

fs::path claim_of_cell(const fs::path& folder, const std::string& hash) {
  return folder / "cells" / ".claims" / hash;
}

void require_no_links(const fs::path& folder, const std::string& hash) {
  const fs::path claims = claim_of_cell(folder, hash).parent_path();
  for (const fs::path& into : {folder / "cells", folder / folder_of_cell(hash), claims}) {
    std::error_code unknown;
    if (fs::is_symlink(into, unknown))
      throw Error(ErrorCode::cannot_write,
                  "is a link, and files of the sweep would go where it leads; remove it", {into.string()});
  }
}

void replace_file(const fs::path& file, const std::string& text) {
  StagedFolder staged(file.parent_path());
  const std::string name = file.filename().string();
  staged.write(name, text);
  std::error_code problem;
  fs::rename(staged.written(name), file, problem);
  if (problem)
    throw Error(ErrorCode::cannot_write, "cannot be replaced: " + problem.message(), {file.string()});
}

void write_failure(const fs::path& folder, const std::string& hash, const Failure& failure) {
  const bool refused = failure.state == CellResult::State::refused;
  replace_file(
      folder / folder_of_cell(hash) / failure_name,
      fmt::format("outcome = \"{}\"\nexit_code = {}\nreason = {}\nversion = \"{}\"\ncommit = \"{}\"\n"
                  "packings_number = {}\n",
                  refused ? "refused" : "crashed", failure.exit_code,
                  toml_string(plain_text(failure.reason, 1000)), version(), commit(), packings_number()));
}

void remove_failure(const fs::path& folder, const std::string& hash) {
  std::error_code ignored;
  fs::remove(folder / folder_of_cell(hash) / failure_name, ignored);
}

void tidy_cell(const fs::path& folder, const std::string& hash) {
  remove_abandoned(claim_of_cell(folder, hash));
  try {
    finish_publishing(folder / folder_of_cell(hash));
  } catch (const Error&) {  // the next call that reads it says so
  }
}

bool is_to_be_run(const CellResult& result, std::optional<double> seconds, bool retry) {
  switch (result.state) {
    case CellResult::State::missing:
    case CellResult::State::crashed:
      return true;
    case CellResult::State::refused:
      return retry;
    case CellResult::State::packed:
      // One that was stopped at its time gets more of it, and never the same again.
      return result.outcome == "cancelled" && (!seconds || *seconds > 1.2 * result.seconds.value_or(0) + 1);
  }
  return false;
}

}  // namespace sweep
}  // namespace bernal
