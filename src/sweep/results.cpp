#include "sweep/results.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "files/bytes_of_file.hpp"
#include "files/input_file.hpp"
#include "files/seal.hpp"
#include "files/staged_folder.hpp"
#include "sweep/cell_folder.hpp"

namespace fs = std::filesystem;

namespace bernal {
namespace sweep {
namespace {

constexpr const char* table_name = "results.csv";
constexpr const char* picture_name = "results.svg";
/// In the first line of every table, behind the swept keys.
constexpr std::string_view mark_of_table = ",folder,outcome,exit_code,";

std::string in_table(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == text.npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c == '\n' || c == '\r' ? ' ' : c;
  }
  return quoted + '"';
}

template <class Number>
std::string text_of(const std::optional<Number>& value) {
  return value ? fmt::format("{}", *value) : std::string();
}

void refuse_foreign(const fs::path& file, bool is_ours) {
  if (stands(file) && !is_ours)
    throw Error(ErrorCode::cannot_write,
                "is not as bernal sweep wrote it, and would be replaced; remove it, or give another ‹folder›",
                {file.string()});
}

bool is_regular(const fs::path& file) {
  std::error_code unknown;
  return fs::is_regular_file(fs::symlink_status(file, unknown));
}

bool is_table_of_ours(const fs::path& file) {
  if (!is_regular(file)) return false;
  InputFile in(file);
  std::string first;
  std::getline(in, first);
  return first.starts_with("cell,") && first.find(mark_of_table) != first.npos;
}

}  // namespace

const std::vector<std::string_view>& result_columns() {
  static const std::vector<std::string_view> columns = {
      "folder",       "outcome",      "exit_code", "n",
      "phi",          "coordination", "rattlers",  "max_overlap",
      "min_wall_gap", "certified",    "seconds",   "peak_memory_bytes",
      "hash",         "version",      "commit",    "packings_number",
      "reason"};
  return columns;
}

std::string value_in(const SweepRow& row, std::string_view column) {
  const CellResult& r = row.result;
  if (column == "folder") return folder_of_cell(row.cell_hash).string();
  if (column == "outcome") return r.outcome;
  if (column == "exit_code") return text_of(r.exit_code);
  if (column == "n") return text_of(r.n);
  if (column == "phi") return text_of(r.phi);
  if (column == "coordination") return text_of(r.coordination);
  if (column == "rattlers") return text_of(r.rattlers);
  if (column == "max_overlap") return text_of(r.max_overlap);
  if (column == "min_wall_gap") return text_of(r.min_wall_gap);
  if (column == "certified") return text_of(r.certified);
  if (column == "seconds") return text_of(r.seconds);
  if (column == "peak_memory_bytes")
    return r.peak_memory_bytes ? fmt::format("{:.0f}", *r.peak_memory_bytes) : "";
  if (column == "hash") return r.hash;
  if (column == "version") return r.program.version;
  if (column == "commit") return r.program.commit;
  if (column == "packings_number")
    return r.program.packings_number > 0 ? fmt::format("{}", r.program.packings_number) : "";
  return r.reason;
}

std::vector<std::string> column_of(const Sweep& sweep, const std::vector<SweepRow>& rows,
                                   const std::string& name) {
  const auto key = std::ranges::find(sweep.keys(), name);
  const auto k = static_cast<std::size_t>(key - sweep.keys().begin());
  std::vector<std::string> values;
  for (const SweepRow& row : rows)
    values.push_back(name == "cell"              ? fmt::format("{}", row.number)
                     : key != sweep.keys().end() ? row.values[k]
                                                 : value_in(row, name));
  return values;
}

ResultFiles::ResultFiles(const Sweep& sweep, const fs::path& folder, const std::string& plot)
    : sweep_(sweep), folder_(folder), plot_(plot) {
  refuse_foreign(folder / table_name, is_table_of_ours(folder / table_name));
  refuse_foreign(folder / picture_name,
                 is_regular(folder / picture_name) && is_sealed(bytes_of_file(folder / picture_name)));
  plotted_columns(sweep, {}, plot);
}

void ResultFiles::write(const std::vector<SweepRow>& rows) {
  replace_file(folder_ / table_name, sweep_csv(sweep_, rows));
  replace_file(folder_ / picture_name, sealed(sweep_svg(sweep_, rows, plot_), "<!-- ", " -->\n"));
}

std::vector<fs::path> ResultFiles::files() const { return {folder_ / table_name, folder_ / picture_name}; }

}  // namespace sweep

std::string sweep_csv(const Sweep& sweep, const std::vector<SweepRow>& rows) {
  std::string csv = "cell";
  for (const std::string& key : sweep.keys()) csv += ',' + sweep::in_table(key);
  csv += fmt::format(",{}\n", fmt::join(sweep::result_columns(), ","));
  for (const SweepRow& row : rows) {
    csv += fmt::format("{}", row.number);
    for (const std::string& value : row.values) csv += ',' + sweep::in_table(value);
    for (const std::string_view column : sweep::result_columns())
      csv += ',' + sweep::in_table(sweep::value_in(row, column));
    csv += '\n';
  }
  return csv;
}

}  // namespace bernal
