#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "bernal/sweep/sweep.hpp"

namespace bernal::sweep {

/// What a row of results.csv has of a cell, besides its number and the swept keys, in this order.
const std::vector<std::string_view>& result_columns();
/// A value as the table has it; "" where there is none.
std::string value_in(const SweepRow& row, std::string_view result_column);

/// The columns of a picture, as results.csv calls them; no y where nothing can be drawn.
struct Plotted {
  std::string x, y, colour;
};
/// Throws Error{bad_argument} for columns that there are not, see `sweep_svg`.
Plotted plotted_columns(const Sweep& sweep, const std::vector<SweepRow>& rows, const std::string& plot);

/// Of every row what it has in a column, a swept key or a result.
std::vector<std::string> column_of(const Sweep& sweep, const std::vector<SweepRow>& rows,
                                   const std::string& name);

/// results.csv and results.svg of a folder.
class ResultFiles {
 public:
  /// Throws Error{cannot_write} where somebody else's file has one of the names, and Error{bad_argument} for
  /// a plot of columns that there are not.
  ResultFiles(const Sweep& sweep, const std::filesystem::path& folder, const std::string& plot);
  void write(const std::vector<SweepRow>& rows);
  std::vector<std::filesystem::path> files() const;

 private:
  const Sweep& sweep_;
  std::filesystem::path folder_;
  std::string plot_;
};

}  // namespace bernal::sweep
