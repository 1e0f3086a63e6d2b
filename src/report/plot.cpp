#include "report/plot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bernal/core/text.hpp"
#include "viewer/html.hpp"

namespace bernal {
namespace {

constexpr int most_ticks = 12;  // for an axis so short that adding a step changes nothing

/// 1, 2 and 5 times powers of ten; only powers if there are many.
std::vector<double> logarithmic_ticks(double from, double to) {
  std::vector<double> values;
  if (!(from > 0) || !(to < std::numeric_limits<double>::infinity())) return values;
  const bool powers_only = to / from > 2000;
  for (double decade = std::pow(10, std::floor(std::log10(from))); decade <= to * (1 + 1e-9); decade *= 10)
    for (const double v : {decade, 2 * decade, 5 * decade})
      if (v >= from * (1 - 1e-9) && v <= to * (1 + 1e-9) && (v == decade || !powers_only))
        values.push_back(v);
  return values;
}

}  // namespace

Ticks::Ticks(const Axis& axis) : scale_(axis.scale) {
  if (scale_ == Scale::logarithmic) {
    values_ = logarithmic_ticks(axis.from, axis.to);
    return;
  }
  const double raw = (axis.to - axis.from) / 5;
  const double decade = std::pow(10, std::floor(std::log10(raw)));
  step_ = decade * (raw > 5 * decade ? 10 : raw > 2 * decade ? 5 : raw > decade ? 2 : 1);
  if (scale_ == Scale::exponents) step_ = std::max(1.0, step_);
  const double first = std::ceil(axis.from / step_ - 1e-9);
  for (int k = 0; k < most_ticks && (first + k) * step_ <= axis.to + 1e-9 * step_; ++k)
    values_.push_back((first + k) * step_);
}

std::string Ticks::text(double value) const {
  if (scale_ == Scale::exponents) return fmt::format("1e{:.0f}", value);
  if (scale_ == Scale::logarithmic)
    return value >= 1e4 && value < 1e7 ? grouped(static_cast<std::uint64_t>(std::round(value)))
                                       : fmt::format("{:.4g}", value);
  const int decimals = static_cast<int>(std::ceil(-std::log10(step_) - 1e-9));
  if (decimals > 5 || std::abs(value) >= 1e6) return fmt::format("{:.3g}", value);
  return fmt::format("{:.{}f}", value == 0 ? 0.0 : value, std::max(0, decimals));
}

double Plot::share(const Axis& axis, double value) {
  if (axis.scale == Scale::logarithmic) return std::log(value / axis.from) / std::log(axis.to / axis.from);
  return (value - axis.from) / (axis.to - axis.from);
}

double Plot::value(const Axis& axis, double share) {
  if (axis.scale == Scale::logarithmic) return axis.from * std::pow(axis.to / axis.from, share);
  return axis.from + share * (axis.to - axis.from);
}

void Plot::axes() {
  const PlotArea& f = area_;
  const Ticks along(x_), across(y_);
  for (const double v : across.values()) {
    add("<path class=\"grid\" d=\"M{} {:.1f}H{}\"/>", f.left, y(v), f.right);
    add("<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>", f.left - 8, y(v) + 4, across.text(v));
  }
  for (const double v : along.values())
    add("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{}</text>", x(v), f.bottom + 18, along.text(v));
  add("<path class=\"axis\" d=\"M{} {}H{}\"/>", f.left, f.bottom, f.right);
  if (!x_.label.empty())
    add("<text class=\"label\" x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>", (f.left + f.right) / 2,
        f.bottom + 38, escaped(x_.label));
  if (!y_.label.empty())
    add("<text class=\"label\" x=\"{}\" y=\"{}\">{}</text>", f.left - 58, f.top - 30, escaped(y_.label));
}

void Plot::line(std::span<const double> xs, std::span<const double> ys, std::string_view classes) {
  std::string path;
  for (std::size_t i = 0; i < xs.size(); ++i)
    path += fmt::format("{}{:.1f} {:.1f}", i == 0 ? 'M' : 'L', x(xs[i]), y(ys[i]));
  add("<path class=\"{}\" d=\"{}\"/>", classes, path);
}

}  // namespace bernal
