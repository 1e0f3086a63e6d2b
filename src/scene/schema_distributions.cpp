#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "scene/schema.hpp"

namespace bernal::schema {
namespace {

[[noreturn]] void refuse(const Spec& spec, std::string_view key, const std::string& message) {
  throw Error(ErrorCode::bad_scene, message, spec.location(key));
}

void min_below_max(const Spec& spec, std::string_view where) {
  if (spec.has("min") && spec.has("max") && spec.number("min") >= spec.number("max"))
    refuse(spec, "min",
           fmt::format("\"min\" in {} must be below \"max\", but {} is not below {}", where,
                       spec.number("min"), spec.number("max")));
}

void lognormal_rule(const Spec& spec, std::string_view where) {
  min_below_max(spec, where);
  if (spec.has("d43") && spec.number("d43") <= spec.number("d32"))
    refuse(spec, "d43",
           fmt::format("\"d43\" in {} must be above \"d32\", but {} is not above {}", where,
                       spec.number("d43"), spec.number("d32")));
}

void one_for_each(const Spec& spec, std::string_view key, std::size_t count, std::string_view of,
                  std::string_view where) {
  if (spec.numbers(key).size() != count)
    refuse(spec, key,
           fmt::format("\"{}\" in {} must have one number for each of \"{}\", but there are {} for {}", key,
                       where, of, spec.numbers(key).size(), count));
}

void all_differ(const Spec& spec, std::string_view key, std::string_view where) {
  std::vector<double> values = spec.numbers(key);
  std::ranges::sort(values);
  if (const auto twice = std::ranges::adjacent_find(values); twice != values.end())
    refuse(spec, key, fmt::format("\"{}\" in {} must differ, but {} is there twice", key, where, *twice));
}

void classes_rule(const Spec& spec, std::string_view where) {
  one_for_each(spec, "shares", spec.numbers("values").size(), "values", where);
  all_differ(spec, "values", where);
}

void table_rule(const Spec& spec, std::string_view where) {
  const std::vector<double>& x = spec.numbers("x");
  one_for_each(spec, "density", x.size(), "x", where);
  all_differ(spec, "x", where);
  if (x.size() < 2) refuse(spec, "x", fmt::format("\"x\" in {} must have two sizes or more", where));
  if (std::ranges::max(spec.numbers("density")) == 0)
    refuse(spec, "density", fmt::format("\"density\" in {} must not be 0 everywhere", where));
}

void sieve_rule(const Spec& spec, std::string_view where) {
  const std::vector<double>&sizes = spec.numbers("sizes"), &passing = spec.numbers("passing");
  one_for_each(spec, "passing", sizes.size(), "sizes", where);
  all_differ(spec, "sizes", where);
  if (sizes.size() < 2)
    refuse(spec, "sizes", fmt::format("\"sizes\" in {} must have two sieves or more", where));
  std::vector<std::pair<double, double>> curve;
  for (std::size_t i = 0; i < sizes.size(); ++i) curve.emplace_back(sizes[i], passing[i]);
  std::ranges::sort(curve);
  for (std::size_t i = 1; i < curve.size(); ++i)
    if (curve[i].second < curve[i - 1].second)
      refuse(spec, "passing",
             fmt::format("\"passing\" in {} must not fall with the size, but {} passes {} and only {} passes "
                         "{}; is it what each sieve retains?",
                         where, curve[i - 1].second, curve[i - 1].first, curve[i].second, curve[i].first));
  if (curve.front().second != 0)
    refuse(spec, "passing",
           fmt::format("\"passing\" in {} must begin at 0, but {} passes the finest sieve, {}; add the size "
                       "that no sphere is below, with 0",
                       where, curve.front().second, curve.front().first));
  if (curve.back().second != 1 && curve.back().second != 100)
    refuse(spec, "passing",
           fmt::format("\"passing\" in {} must end at 100 (per cent) or 1, but {} passes the coarsest sieve, "
                       "{}; add the size that no sphere is above",
                       where, curve.back().second, curve.back().first));
}

void mixture_rule(const Spec& spec, std::string_view where) {
  one_for_each(spec, "shares", spec.parts.size(), "of", where);
}

Key basis() {
  return {.name = "basis",
          .type = Type::word,
          .help = "what shares and densities count: spheres or their volume",
          .otherwise = "number",
          .words = {"number", "volume"}};
}

Key length(std::string_view name, std::string_view help) {
  return {.name = name, .type = Type::length, .help = help};
}

Key optional_length(std::string_view name, std::string_view help) {
  return {.name = name, .type = Type::length, .help = help, .optional = true};
}

Key diameter(std::string_view name, std::string_view help) {
  return {.name = name, .type = Type::length, .help = help, .is_diameter = true};
}

Key number(std::string_view name, std::string_view help, double above, double to) {
  return {.name = name, .type = Type::number, .help = help, .range = {above, to, true}};
}

Key file(std::string_view help) { return {.name = "file", .type = Type::file, .help = help}; }

}  // namespace

std::vector<Entry> size_distributions() {
  return {
      {.name = "constant",
       .help = "all spheres alike",
       .keys = {length("value", "the radius or diameter of every sphere")}},
      {.name = "classes",
       .help = "a few sizes and their shares",
       .keys = {{.name = "values", .type = Type::lengths, .help = "the sizes, each once"},
                {.name = "shares", .type = Type::shares, .help = "how much there is of each, in any scale"},
                basis()},
       .rule = classes_rule},
      {.name = "uniform",
       .help = "every size between two limits equally often",
       .keys = {length("min", "the smallest"), length("max", "the largest"), basis()},
       .rule = min_below_max},
      {.name = "normal",
       .help = "the size is normal",
       .keys = {length("mean", "of the basis, before any cut"),
                length("sd", "standard deviation, before any cut"), basis(),
                optional_length("min", "cut off below; if absent, six standard deviations below the mean"),
                optional_length("max", "cut off above; if absent, six standard deviations above the mean")},
       .rule = min_below_max},
      {.name = "lognormal",
       .help = "the logarithm of the size is normal",
       .keys = {length("median", "half of the basis lies below"),
                number("sigma", "standard deviation of the logarithm", 0, 5), basis(),
                diameter("d43", "volume-weighted mean diameter <d^4>/<d^3>, before any cut"),
                diameter("d32", "surface-weighted mean diameter <d^3>/<d^2>, before any cut"),
                optional_length("min", "cut off below"), optional_length("max", "cut off above")},
       .choices = {{{"median", "sigma", "basis"}, {"d43", "d32"}}},
       .rule = lognormal_rule},
      {.name = "table",
       .help = "a density through points, by a natural cubic spline; zero where that is negative",
       .keys = {{.name = "x", .type = Type::lengths, .help = "the sizes of the points, in any order"},
                {.name = "density", .type = Type::amounts, .help = "the density there, in any scale"},
                file("two columns, x and density"),
                basis()},
       .choices = {{{"x", "density"}, {"file"}}},
       .rule = table_rule,
       .columns = {"x", "density"}},
      {.name = "sieve",
       .help = "a sieve analysis by mass; straight between sieves over the logarithm of the size",
       .keys = {{.name = "sizes", .type = Type::lengths, .help = "the openings, in any order"},
                {.name = "passing", .type = Type::amounts, .help = "what passes, from 0 to 100 (or to 1)"},
                file("two columns, sizes and passing")},
       .choices = {{{"sizes", "passing"}, {"file"}}},
       .rule = sieve_rule,
       .columns = {"sizes", "passing"}},
      {.name = "rosin_rammler",
       .help = "Weibull by volume: 1 - exp(-(d / d63)^n) of it lies below d",
       .keys = {diameter("d63", "63.2 % of the volume lies below, before any cut"),
                number("n", "the slope; larger is narrower", 0, 100),
                length("min", "cut off below: by number there would be fines without end"),
                optional_length("max", "cut off above; if absent, where 0.1 % of the volume lies above")},
       .rule = min_below_max},
      {.name = "fuller",
       .help = "(d / max)^exponent of the volume lies below d, cut off below and scaled to the whole",
       .keys = {length("max", "the largest"),
                {.name = "exponent",
                 .type = Type::number,
                 .help = "0.5 after Fuller; 0.37 packs densest after Funk and Dinger",
                 .otherwise = 0.5,
                 .range = {0, 10, true}},
                length("min", "the smallest: without it there would be fines without end")},
       .rule = min_below_max},
      {.name = "mixture",
       .help = "several distributions at once",
       .keys = {{.name = "of", .type = Type::parts, .help = "the distributions, or plain lengths"},
                {.name = "shares", .type = Type::shares, .help = "how much there is of each, in any scale"},
                basis()},
       .rule = mixture_rule},
  };
}

}  // namespace bernal::schema
