#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "scene/layer_entry.hpp"
#include "scene/scene_entries.hpp"
#include "scene/size_kinds.hpp"
#include "scene/size_rules.hpp"

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
  // Beyond, sigma would be 0 to rounding, or more than the most that it may be.
  constexpr double narrowest = 1e-7, widest = 1e5;
  if (of.mean && of.sd && *of.sd < narrowest * *of.mean)
    section.refuse(
        "sd",
        fmt::format("must be at least {:g} of \"mean\"; spheres of one size are a plain length", narrowest));
  if (of.mean && of.sd && *of.sd > widest * *of.mean)
    section.refuse("sd", fmt::format("must be at most {:g} times \"mean\"", widest));
}

using Numbers = std::function<std::optional<double>(std::string_view)>;

std::string instead_in_lognormal(std::string_view key, const Numbers& number) {
  const bool is_percentile =
      std::ranges::find(named_percentiles, key, &NamedPercentile::name) != named_percentiles.end();
  if (is_percentile && key != "d50") return "; percentiles are of distribution = \"percentiles\"";
  if (key == "d50")
    return "; that of a sieve analysis is the \"median\" with basis = \"volume\", and with other percentiles "
           "distribution = \"percentiles\"";
  if (key == "mu") return "; the mean of the logarithm, mu, is that of the \"median\", exp(mu)";
  for (const std::string_view same : {"std", "stdev", "std_dev", "standard_deviation"})
    if (key == same)
      return "; the standard deviation of the size is \"sd\", beside \"mean\"; that of its logarithm "
             "\"sigma\"";
  const bool is_variance = key == "variance";
  if (!is_variance && key != "cv") return {};
  const std::optional<double> mean = number("mean"), given = number(key);
  std::string text = is_variance
                         ? "; write its square root, the standard deviation, as \"sd\" beside \"mean\""
                         : "; write \"sd\", cv times the mean, beside \"mean\"";
  if (mean && given && *mean > 0 && *given > 0)
    text += fmt::format("; here sd = {:.6g}", is_variance ? std::sqrt(*given) : *given * *mean);
  return text;
}

std::string instead_in_normal(std::string_view key, const Numbers&) {
  for (const std::string_view same : {"sigma", "std", "stdev", "std_dev", "standard_deviation"})
    if (key == same) return "; did you mean \"sd\"?";
  return key == "mu" ? "; did you mean \"mean\"?" : "";
}

void classes_rule(const Classes& of, const Section& section) {
  one_for_each("shares", of.shares.size(), "values", of.values.size(), section);
  all_differ("values", of.values, section);
  if (!of.material_densities.empty())
    one_for_each("material_densities", of.material_densities.size(), "values", of.values.size(), section);
  if (!of.names.empty()) one_for_each("names", of.names.size(), "values", of.values.size(), section, "name");
  if (!of.layers.empty())
    one_for_each("layers", of.layers.size(), "values", of.values.size(), section, "list");
  for (std::size_t k = 0; k < of.layers.size(); ++k)
    layers_rule(of.layers[k], "layers", fmt::format("layers of class {} of {}", k + 1, section.name),
                section);
}

void table_rule(const Tabulated& of, const Section& section) {
  one_for_each("density", of.density.size(), "x", of.x.size(), section);
  all_differ("x", of.x, section);
  if (of.x.size() < 2) section.refuse("x", "must have two sizes or more");
  if (std::ranges::max(of.density) == 0) section.refuse("density", "must not be 0 everywhere");
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
  return word(
      member, "basis",
      "what shares and densities count: spheres, their volume or their mass, which is the same for one "
      "material",
      {"number", "volume", "mass"});
}

/// Lengths of which some may be 0.
Key lengths_from_zero(Member member, Text name, Text help) {
  return key(Type::lengths, std::move(member), name, help, {0});
}

std::vector<Key> percentile_keys() {
  static constexpr std::array<std::string_view, named_percentiles.size()> help = {
      "3 % of the basis lies below",
      "5 %",
      "10 %",
      "16 %",
      "20 %",
      "25 %",
      "30 %",
      "half of it",
      "60 %",
      "70 %",
      "75 %",
      "80 %",
      "84 %",
      "90 %",
      "95 %",
      "97 %",
      "99 %"};
  std::vector<Key> keys;
  for (std::size_t k = 0; k < help.size(); ++k) {
    keys.push_back(length(named_percentiles[k].member, named_percentiles[k].name, help[k]));
    keys.back().is_diameter = true;
  }
  return keys;
}

/// Of a list: the values, unless a writer has put them into a file.
Member listed_values() {
  Member member(&ListedSizes::values);
  member.get = [](const void* list) -> std::optional<Value> {
    const auto& of = *static_cast<const ListedSizes*>(list);
    return of.beside.empty() ? value_of(of.values) : std::nullopt;
  };
  return member;
}

/// The name of that file, which is only written: a reader takes the values.
Key listed_file() {
  Key made =
      required(key(Type::file, {}, "file", "one column of sizes, as text or as an array of NumPy's (.npy)"));
  made.member.get = [](const void* list) -> std::optional<Value> {
    const auto& beside = static_cast<const ListedSizes*>(list)->beside;
    return beside.empty() ? std::nullopt : std::optional<Value>(beside.string());
  };
  return made;
}

Key file(std::string_view help) { return required(key(Type::file, {}, "file", help)); }

}  // namespace

std::string instead_of(const Entry& sizes, std::string_view key, const Numbers& number) {
  if (&sizes == &size_entries()[SceneSizes(Lognormal{}).index()]) return instead_in_lognormal(key, number);
  if (&sizes == &size_entries()[SceneSizes(Normal{}).index()]) return instead_in_normal(key, number);
  if (&sizes != &thickness_entry()) return {};
  if (std::ranges::any_of(size_entries(), [&](const Entry& other) { return other.find(key) != nullptr; }))
    return "; the thickness of layers has distribution = \"normal\" only, by number: give its \"mean\" and "
           "\"sd\"";
  return instead_in_normal(key, number);
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
                    basis(&Classes::basis),
                    of_quantity(Quantity::density,
                                key(Type::shares, &Classes::material_densities, "material_densities",
                                    "of each class in kg/m3, where they are not of one material")),
                    key(Type::names, &Classes::names, "names", "of each class, for reports"),
                    table_lists(&Classes::layers, layer_entry, "class", "layers",
                                "of the spheres of each class, from the centre out; [] of a class without")},
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
                    required(length(&Lognormal::mean, "mean", "of the size, of the basis, before any cut")),
                    required(of_quantity(
                        Quantity::length,
                        length(&Lognormal::sd, "sd",
                               "standard deviation of the size, of the basis, before any cut"))),
                    diameter(&Lognormal::d43, "d43",
                             "volume-weighted mean diameter <d^4>/<d^3>, before any cut"),
                    diameter(&Lognormal::d32, "d32",
                             "surface-weighted mean diameter <d^3>/<d^2>, before any cut"),
                    length(&Lognormal::min, "min", "cut off below"),
                    length(&Lognormal::max, "max", "cut off above")},
           .choices = {{{"median", "sigma", "basis"}, {"mean", "sd", "basis"}, {"d43", "d32"}}},
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
           .keys = {required(lengths_from_zero(&Sieve::sizes, "sizes",
                                               "the openings, in any order; 0 is the pan")),
                    required(key(Type::amounts, &Sieve::passing, "passing",
                                 "what passes, from 0 to 100 (or to 1)")),
                    required(key(Type::amounts, &Sieve::retained, "retained",
                                 "what lies on each sieve, in any scale; where the sizes fall, one more is "
                                 "what is in the pan")),
                    file("two columns, sizes and passing"),
                    length(&Sieve::pan, "pan",
                           "what is in the pan is this large at least; if absent half of the finest sieve")},
           .choices = {{{"sizes", "passing"}, {"sizes", "retained"}, {"file"}}},
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
      entry<Percentiles>(
          {.name = "percentiles",
           .help = "D10, D50, D90 and the like, and the law that goes through them, or nearest to them",
           .keys = joined(percentile_keys(),
                          {word(&Percentiles::law, "law",
                                "lognormal, rosin_rammler, normal: fitted, of three or more not exactly; "
                                "through: a curve exactly through them, straight over the logarithm of the "
                                "size",
                                {"lognormal", "rosin_rammler", "normal", "through"}),
                           basis(&Percentiles::basis),
                           length(&Percentiles::min, "min",
                                  "cut off below; of \"through\" the smallest: if absent, where its first "
                                  "straight line ends"),
                           length(&Percentiles::max, "max",
                                  "cut off above; of \"through\" the largest: if absent, where its last "
                                  "straight line ends")}),
           .rule = rule(percentiles_rule)}),
      entry<Histogram>(
          {.name = "histogram",
           .help = "what is in each bin between two edges, evenly over the size",
           .keys = {required(lengths_from_zero(&Histogram::edges, "edges",
                                               "the limits of the bins, ascending: one more than bins")),
                    required(key(Type::amounts, &Histogram::counts, "counts",
                                 "how many spheres are in each, in any scale")),
                    required(key(Type::amounts, &Histogram::masses, "masses",
                                 "the mass, or volume, that is in each, in any scale"))},
           .choices = {{{"counts"}, {"masses"}}},
           .rule = rule(histogram_rule)}),
      entry<ListedSizes>(
          {.name = "list",
           .help = "sizes one by one, such as measured ones",
           .keys = {required(key(Type::lengths, listed_values(), "values", "the sizes, in any order")),
                    listed_file(),
                    word(&ListedSizes::draw, "draw",
                         "each: every one exactly once, so that there are as many spheres; resample: drawn "
                         "from them",
                         {"each", "resample"})},
           .choices = {{{"values"}, {"file"}}},
           .columns = {"values"}}),
  });
  return all;
}

}  // namespace bernal::schema
