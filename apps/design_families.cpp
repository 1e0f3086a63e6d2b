#include "design_families.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/predict/design.hpp"
#include "design.hpp"

using namespace bernal;

namespace {

constexpr double most_ratio = 1e4;  ///< of diameters: more rods than anyone waits for, beyond
/// The largest ratio of two sizes where the user gives no limit.
constexpr double usual_ratio = 100;
/// ln of the least ratio that is tried: sizes below it pack as equal spheres do.
constexpr double narrow = 1e-4;
/// The widest lognormal sizes without limits; with them, the widest that a scene takes.
constexpr double widest_uncut_sigma = 3, widest_sigma = 5;

void refuse(const std::string& why) { throw Error(ErrorCode::bad_argument, why); }

double checked(std::optional<double> diameter, std::string_view option) {
  if (diameter && !(*diameter > 0 && std::isfinite(*diameter)))
    refuse(fmt::format("{}: a diameter must be positive and finite, not {}", option, *diameter));
  return diameter.value_or(0);
}

std::string limits_text(double min, double max) {
  return fmt::format("from {} to {}", number(min), number(max));
}

/// Sizes from a smallest to a largest diameter.
SizeFamily spread(std::string_view what, const SizeLimits& limits,
                  const std::function<std::string(double, double)>& table) {
  const double min = limits.min.value_or(1), max = limits.max.value_or(usual_ratio);
  const double widest = std::log(max / min);
  const auto ends = [=, above = limits.from_above](double t) {
    if (t >= widest) return std::pair(min, max);
    return above ? std::pair(max * std::exp(-t), max) : std::pair(min, min * std::exp(t));
  };
  return {.from = std::min(narrow, 0.5 * widest),
          .to = widest,
          .member =
              [=](double t) {
                const auto [low, high] = ends(t);
                return SizeFamily::Member{"max/min", high / low, table(low, high)};
              },
          .what = fmt::format("{} {}", what, limits_text(min, max)),
          .held = {}};
}

SizeFamily lognormal(const SizeLimits& limits) {
  const double median = limits.min ? std::sqrt(*limits.min) * std::sqrt(*limits.max) : 1;
  const std::string cut =
      limits.min ? fmt::format(", min = {}, max = {}", number(*limits.min), number(*limits.max)) : "";
  return {.from = 1e-3,
          .to = limits.min ? widest_sigma : widest_uncut_sigma,
          .member =
              [=](double sigma) {
                return SizeFamily::Member{
                    "sigma", sigma,
                    fmt::format(
                        "{{ distribution = \"lognormal\", median = {}, sigma = {}, basis = \"volume\"{} }}",
                        number(median), number(sigma), cut)};
              },
          .what = limits.min ? fmt::format("lognormal sizes {} and cut off there",
                                           limits_text(*limits.min, *limits.max))
                             : "lognormal sizes of sigma up to 3",
          .held = {}};
}

SizeFamily rosin_rammler(const SizeLimits& limits) {
  const double min = limits.min.value_or(1), max = limits.max.value_or(usual_ratio);
  const double d63 = std::sqrt(min) * std::sqrt(max);
  return {
      .from = -std::log(100),
      .to = -std::log(0.2),
      .member =
          [=](double t) {
            return SizeFamily::Member{
                "n", std::exp(-t),
                fmt::format("{{ distribution = \"rosin_rammler\", d63 = {}, n = {}, min = {}, max = {} }}",
                            number(d63), number(std::exp(-t)), number(min), number(max))};
          },
      .what = fmt::format("Rosin-Rammler sizes {} and cut off there", limits_text(min, max)),
      .held = {}};
}

SizeFamily two_sizes(const SizeLimits& limits, int rods) {
  const auto table = [](double low, double high, double share) {
    return fmt::format(
        "{{ distribution = \"classes\", values = [{}, {}], shares = [{}, {}], basis = \"volume\" }}",
        number(low), number(high), number(share), number(1 - share));
  };
  const auto best_share = [rods](double low, double high) {
    SearchOptions options;
    // A quarter of the rods is enough to find the best share, if there are many.
    options.rods = high / low < widest_ratio(rods / 4) ? rods / 4 : rods;
    options.from = {0.25, 0.75};
    return rounded_share(maximise_packing_fraction(std::vector{low, high}, options).shares[0]);
  };
  SizeFamily family = spread("two sizes, each mixture at its densest,", limits,
                             [=](double a, double b) { return table(a, b, best_share(a, b)); });
  family.held = [=](double t) {
    const double share = best_share(1, std::exp(t));
    return spread("", limits, [=](double a, double b) { return table(a, b, share); }).member;
  };
  return family;
}

}  // namespace

SizeLimits limits_of(std::optional<double> min, std::optional<double> max, std::optional<double> ratio) {
  checked(min, "--min");
  checked(max, "--max");
  if (ratio && !(*ratio > 1 && *ratio <= most_ratio))
    refuse(
        fmt::format("--max-ratio, the largest over the smallest diameter, must lie above 1 and not above "
                    "{:g}, not at {}",
                    most_ratio, *ratio));
  if (min && max && ratio) refuse("give two of --min, --max and --max-ratio; the third follows");
  if ((min || max) && !(min && max) && !ratio)
    refuse(fmt::format("{} alone limits nothing; give the other limit or --max-ratio too",
                       min ? "--min" : "--max"));
  SizeLimits limits{min, max, max.has_value()};
  if (ratio && !max) {
    limits.min = min.value_or(1);
    limits.max = *limits.min * *ratio;
  } else if (ratio) {
    limits.min = *max / *ratio;
  }
  if (!limits.min) return limits;
  if (!(*limits.min < *limits.max))
    refuse(fmt::format("--min {} is not below --max {}", *limits.min, *limits.max));
  if (!(*limits.max / *limits.min <= most_ratio * (1 + 1e-9)))
    refuse(fmt::format("the limits are farther apart than 1 : {:g}", most_ratio));
  require_usable_lengths(*limits.min, *limits.max);
  return limits;
}

std::vector<std::string> family_names() {
  return {"lognormal", "rosin_rammler", "uniform", "fuller", "two_sizes"};
}

SizeFamily family_of(std::string_view name, const SizeLimits& limits, double exponent, int rods) {
  if (name == "lognormal") return lognormal(limits);
  if (name == "rosin_rammler") return rosin_rammler(limits);
  if (name == "two_sizes") return two_sizes(limits, rods);
  if (name == "fuller")
    return spread(fmt::format("Fuller sizes of exponent {}", number(exponent)), limits,
                  [exponent](double low, double high) {
                    return fmt::format("{{ distribution = \"fuller\", max = {}, exponent = {}, min = {} }}",
                                       number(high), number(exponent), number(low));
                  });
  return spread("sizes uniform by volume", limits, [](double low, double high) {
    return fmt::format("{{ distribution = \"uniform\", min = {}, max = {}, basis = \"volume\" }}",
                       number(low), number(high));
  });
}
