#include "figures/page.hpp"

#include <cmath>
#include <fstream>

#include <fmt/format.h>

namespace bernal::figures {

std::string markdown_table(const std::vector<std::string>& head,
                           const std::vector<std::vector<std::string>>& rows) {
  std::string out;
  const auto append = [&](const std::vector<std::string>& cells) {
    for (const std::string& cell : cells) out += "| " + cell + " ";
    out += "|\n";
  };
  append(head);
  for (std::size_t k = 0; k < head.size(); ++k) out += k == 0 ? "|---" : "|---:";
  out += "|\n";
  for (const auto& row : rows) append(row);
  return out;
}

std::string MeanOfSeeds::text(int digits) const {
  const std::string alone = fmt::format("{:.{}f}", mean, digits);
  return count > 1 ? fmt::format("{} ± {:.{}f}", alone, deviation, digits) : alone;
}

MeanOfSeeds mean_of(std::span<const double> values) {
  MeanOfSeeds result{.count = values.size()};
  const auto n = static_cast<double>(values.size());
  for (const double v : values) result.mean += v / n;
  for (const double v : values) result.deviation += (v - result.mean) * (v - result.mean);
  result.deviation = values.size() > 1 ? std::sqrt(result.deviation / (n - 1)) : 0;
  return result;
}

PowerLaw fitted_power(std::span<const double> xs, std::span<const double> ys) {
  const auto n = static_cast<double>(xs.size());
  double mean_x = 0, mean_y = 0, xx = 0, xy = 0, rest = 0;
  for (std::size_t k = 0; k < xs.size(); ++k) {
    mean_x += std::log(xs[k]) / n;
    mean_y += std::log(ys[k]) / n;
  }
  for (std::size_t k = 0; k < xs.size(); ++k) {
    const double dx = std::log(xs[k]) - mean_x;
    xx += dx * dx;
    xy += dx * (std::log(ys[k]) - mean_y);
  }
  PowerLaw law{.exponent = xy / xx};
  for (std::size_t k = 0; k < xs.size(); ++k) {
    const double off = std::log(ys[k]) - mean_y - law.exponent * (std::log(xs[k]) - mean_x);
    rest += off * off;
  }
  if (xs.size() > 2) law.error = std::sqrt(rest / (n - 2) / xx);
  return law;
}

std::string processor_name() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("model name"))
      if (const std::size_t colon = line.find(": "); colon != line.npos) return line.substr(colon + 2);
  return "unknown";
}

}  // namespace bernal::figures
