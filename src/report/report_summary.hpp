#pragma once
#include <cstddef>
#include <optional>
#include <string>

#include "bernal/version.hpp"

namespace bernal {

/// The main figures of a report.json.
struct ReportSummary {
  Program program;
  std::string outcome, reason, hash, cell;
  std::optional<std::size_t> n, rattlers;
  std::optional<double> phi, coordination, max_overlap, min_wall_gap, seconds, peak_memory_bytes;
  bool certified = false;
};

/// Absent if the text is not a report of bernal.
std::optional<ReportSummary> summary_of_report(const std::string& report);

}  // namespace bernal
