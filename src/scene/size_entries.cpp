#include <algorithm>
#include <cmath>
#include <initializer_list>

#include <fmt/format.h>

#include "scene/scene_entries.hpp"

namespace bernal::schema {
namespace {

void min_below_max(double min, double max, const Section& section) {
  if (min >= max)
    section.refuse("min", fmt::format("must be below \"max\", but {} is not below {}", min, max));
}

template <class T>
void limits_rule(const T& of, const Section& section) {
  if constexpr (requires { of.min.has_value(); }) {
    if (of.min && of.max) min_below_max(*of.min, *of.max, section);
  } else if constexpr (requires { of.max.has_value(); }) {
    if (of.max) min_below_max(of.min, *of.max, section);
  } else {
    min_below_max(of.min, of.max, section);
  }
}

void lognormal_rule(const Lognormal& of, const Section& section) {
  limits_rule(of, section);
  if (of.d43 && *of.d43 <= *of.d32)
    section.refuse("d43", fmt::format("must be above \"d32\", but {} is not above {}", *of.d43, *of.d32));
}

using Numbers = std::function<std::optional<double>(std::string_view)>;

/// Of m = exp(ln median + sigma²/2) and s² = m² (exp(sigma²) - 1).
std::string instead_in_lognormal(std::string_view key, const Numbers& number) {
  if (key == "d50") return "; that of a sieve analysis is the \"median\" with basis = \"volume\"";
  if (key == "mu") return "; the mean of the logarithm, mu, is that of the \"median\", exp(mu)";
  const auto is_one_of = [&](std::initializer_list<std::string_view> names) {
    return std::ranges::find(names, key) != names.end();
  };
  if (!is_one_of({"mean", "sd", "std", "stdev", "std_dev", "standard_deviation", "variance", "cv"}))
    return {};
  const std::string formulas =
      "; of a mean m and a standard deviation s of the size: median = m / sqrt(1 + (s/m)^2), sigma = "
      "sqrt(ln(1 + "
      "(s/m)^2))";
  std::optional<double> mean = number("mean"), deviation = number("sd");
  for (const std::string_view other : {"std", "stdev", "std_dev", "standard_deviation"})
    if (!deviation) deviation = number(other);
  if (!mean || !deviation || !(*mean > 0) || !(*deviation > 0)) return formulas;
  const double spread = 1 + std::pow(*deviation / *mean, 2);
  return formulas + fmt::format("; here median = {:.6g}, sigma = {:.6g}", *mean / std::sqrt(spread),
                                std::sqrt(std::log(spread)));
}

std::string instead_in_normal(std::string_view key, const Numbers&) {
  for (const std::string_view same : {"sigma", "std", "stdev", "std_dev", "standard_deviation"})
    if (key == same) return "; did you mean \"sd\"?";
  return key == "mu" ? "; did you mean \"mean\"?" : "";
}

void one_for_each(std::string_view key, std::size_t given, std::string_view of, std::size_t count,
                  const Section& section) {
  if (given != count)
    section.refuse(key, fmt::format("must have one number for each of \"{}\", but there are {} for {}", of,
                                    given, count));
}

void all_differ(std::string_view key, std::vector<double> values, const Section& section) {
  std::ranges::sort(values);
  if (const auto twice = std::ranges::adjacent_find(values); twice != values.end())
    section.refuse(key, fmt::format("must differ, but {} is there twice", *twice));
}

void classes_rule(const Classes& of, const Section& section) {
  one_for_each("shares", of.shares.size(), "values", of.values.size(), section);
  all_differ("values", of.values, section);
}

void table_rule(const Tabulated& of, const Section& section) {
  one_for_each("density", of.density.size(), "x", of.x.size(), section);
  all_differ("x", of.x, section);
  if (of.x.size() < 2) section.refuse("x", "must have two sizes or more");
  if (std::ranges::max(of.density) == 0) section.refuse("density", "must not be 0 everywhere");
}

void sieve_rule(const Sieve& of, const Section& section) {
  one_for_each("passing", of.passing.size(), "sizes", of.sizes.size(), section);
  all_differ("sizes", of.sizes, section);
  if (of.sizes.size() < 2) section.refuse("sizes", "must have two sieves or more");
  std::vector<std::pair<double, double>> curve;
  for (std::size_t i = 0; i < of.sizes.size(); ++i) curve.emplace_back(of.sizes[i], of.passing[i]);
  std::ranges::sort(curve);
  for (std::size_t i = 1; i < curve.size(); ++i)
    if (curve[i].second < curve[i - 1].second)
      section.refuse("passing",
                     fmt::format("must not fall with the size, but {} passes {} and only {} passes "
                                 "{}; is it what each sieve retains?",
                                 curve[i - 1].second, curve[i - 1].first, curve[i].second, curve[i].first));
  if (curve.front().second != 0)
    section.refuse("passing", fmt::format("must begin at 0, but {} passes the finest sieve, {}; add the size "
                                          "that no sphere is below, with 0",
                                          curve.front().second, curve.front().first));
  if (curve.back().second != 1 && curve.back().second != 100)
    section.refuse("passing",
                   fmt::format("must end at 100 (per cent) or 1, but {} passes the coarsest sieve, "
                               "{}; add the size that no sphere is above",
                               curve.back().second, curve.back().first));
}

void mixture_rule(const Mixture& of, const Section& section) {
  one_for_each("shares", of.shares.size(), "of", of.of.size(), section);
}

/// A diameter by its name.
Key diameter(Member member, Text name, Text help) {
  Key key = required(length(std::move(member), name, help));
  key.is_diameter = true;
  return key;
}

template <class T>
Key basis(Basis T::*member) {
  return word(member, "basis", "what shares and densities count: spheres or their volume",
              {"number", "volume"});
}

Key file(std::string_view help) { return required(key(Type::file, {}, "file", help)); }

}  // namespace

std::string instead_of(const Entry& sizes, std::string_view key, const Numbers& number) {
  if (&sizes == &size_entries()[SceneSizes(Lognormal{}).index()]) return instead_in_lognormal(key, number);
  if (&sizes == &size_entries()[SceneSizes(Normal{}).index()]) return instead_in_normal(key, number);
  return {};
}

/// Lengths are diameters of grains there, but for what says otherwise.
static std::vector<Entry> of_grains(std::vector<Entry> entries) {
  for (Entry& entry : entries)
    for (Key& key : entry.keys)
      if (key.quantity == Quantity::none && (key.type == Type::length || key.type == Type::lengths))
        key.quantity = Quantity::diameter;
  return entries;
}

const std::vector<Entry>& size_entries() {
  static const std::vector<Entry> all = of_grains({
      entry<Constant>(
          {.name = "constant",
           .help = "all spheres alike",
           .keys = {required(length(&Constant::value, "value", "the radius or diameter of every sphere"))}}),
      entry<Classes>(
          {.name = "classes",
           .help = "a few sizes and their shares",
           .keys = {required(key(Type::lengths, &Classes::values, "values", "the sizes, each once")),
                    required(key(Type::shares, &Classes::shares, "shares",
                                 "how much there is of each, in any scale")),
                    basis(&Classes::basis)},
           .rule = rule(classes_rule)}),
      entry<Uniform>({.name = "uniform",
                      .help = "every size between two limits equally often",
                      .keys = {required(length(&Uniform::min, "min", "the smallest")),
                               required(length(&Uniform::max, "max", "the largest")), basis(&Uniform::basis)},
                      .rule = rule(limits_rule<Uniform>)}),
      entry<Normal>(
          {.name = "normal",
           .help = "the size is normal",
           .keys = {required(length(&Normal::mean, "mean", "of the basis, before any cut")),
                    required(of_quantity(Quantity::length,
                                         length(&Normal::sd, "sd", "standard deviation, before any cut"))),
                    basis(&Normal::basis),
                    length(&Normal::min, "min",
                           "cut off below; if absent, six standard deviations below the mean"),
                    length(&Normal::max, "max",
                           "cut off above; if absent, six standard deviations above the mean")},
           .rule = rule(limits_rule<Normal>)}),
      entry<Lognormal>(
          {.name = "lognormal",
           .help = "the logarithm of the size is normal",
           .keys = {required(length(&Lognormal::median, "median", "half of the basis lies below")),
                    required(of_quantity(Quantity::spread,
                                         number(&Lognormal::sigma, "sigma",
                                                "standard deviation of the logarithm", above(0, 5)))),
                    basis(&Lognormal::basis),
                    diameter(&Lognormal::d43, "d43",
                             "volume-weighted mean diameter <d^4>/<d^3>, before any cut"),
                    diameter(&Lognormal::d32, "d32",
                             "surface-weighted mean diameter <d^3>/<d^2>, before any cut"),
                    length(&Lognormal::min, "min", "cut off below"),
                    length(&Lognormal::max, "max", "cut off above")},
           .choices = {{{"median", "sigma", "basis"}, {"d43", "d32"}}},
           .rule = rule(lognormal_rule)}),
      entry<Tabulated>(
          {.name = "table",
           .help = "a density through points, by a natural cubic spline; zero where that is negative",
           .keys = {required(key(Type::lengths, &Tabulated::x, "x", "the sizes of the points, in any order")),
                    required(key(Type::amounts, &Tabulated::density, "density",
                                 "the density there, in any scale")),
                    file("two columns, x and density"), basis(&Tabulated::basis)},
           .choices = {{{"x", "density"}, {"file"}}},
           .rule = rule(table_rule),
           .columns = {"x", "density"}}),
      entry<Sieve>(
          {.name = "sieve",
           .help = "a sieve analysis by mass; straight between sieves over the logarithm of the size",
           .keys = {required(key(Type::lengths, &Sieve::sizes, "sizes", "the openings, in any order")),
                    required(key(Type::amounts, &Sieve::passing, "passing",
                                 "what passes, from 0 to 100 (or to 1)")),
                    file("two columns, sizes and passing")},
           .choices = {{{"sizes", "passing"}, {"file"}}},
           .rule = rule(sieve_rule),
           .columns = {"sizes", "passing"}}),
      entry<RosinRammler>(
          {.name = "rosin_rammler",
           .help = "Weibull by volume: 1 - exp(-(d / d63)^n) of it lies below d",
           .keys = {diameter(&RosinRammler::d63, "d63", "63.2 % of the volume lies below, before any cut"),
                    required(number(&RosinRammler::n, "n", "the slope; larger is narrower", above(0, 100))),
                    required(length(&RosinRammler::min, "min",
                                    "cut off below: by number there would be fines without end")),
                    length(&RosinRammler::max, "max",
                           "cut off above; if absent, where 0.1 % of the volume lies above")},
           .rule = rule(limits_rule<RosinRammler>)}),
      entry<Fuller>(
          {.name = "fuller",
           .help = "(d / max)^exponent of the volume lies below d, cut off below and scaled to the whole",
           .keys = {required(length(&Fuller::max, "max", "the largest")),
                    number(&Fuller::exponent, "exponent",
                           "0.5 after Fuller; 0.37 packs densest after Funk and Dinger", above(0, 10)),
                    required(length(&Fuller::min, "min",
                                    "the smallest: without it there would be fines without end"))},
           .rule = rule(limits_rule<Fuller>)}),
      entry<Mixture>(
          {.name = "mixture",
           .help = "several distributions at once",
           .keys = {required(key(Type::parts, &Mixture::of, "of", "the distributions, or plain lengths")),
                    required(key(Type::shares, &Mixture::shares, "shares",
                                 "how much there is of each, in any scale")),
                    basis(&Mixture::basis)},
           .rule = rule(mixture_rule)}),
  });
  return all;
}

}  // namespace bernal::schema
