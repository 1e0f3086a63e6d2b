#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace bernal::figures {

/// A table in Markdown: a row of heads, then rows of as many cells.
std::string markdown_table(const std::vector<std::string>& head,
                           const std::vector<std::vector<std::string>>& rows);

struct MeanOfSeeds {
  double mean = 0, deviation = 0;  ///< standard deviation of one of them; 0 where there is but one
  std::size_t count = 0;

  /// "0.6415 ± 0.0003" or, of one, "0.6415".
  std::string text(int digits) const;
};
MeanOfSeeds mean_of(std::span<const double> values);

/// Exponent b of y = a x^b by least squares of the logarithms, and its standard error (0 of two points).
/// Precondition: at least two different x, all positive.
struct PowerLaw {
  double exponent = 0, error = 0;
};
PowerLaw fitted_power(std::span<const double> xs, std::span<const double> ys);

/// This machine's processor by the name that the system has for it, or "unknown".
std::string processor_name();

}  // namespace bernal::figures
