#include "scene/size_rules.hpp"

#include <algorithm>
#include <functional>
#include <limits>

#include <fmt/format.h>

#include "scene/size_kinds.hpp"

namespace bernal::schema {

void one_for_each(std::string_view key, std::size_t given, std::string_view of, std::size_t count,
                  const Section& section, std::string_view what) {
  if (given != count)
    section.refuse(key, fmt::format("must have one {} for each of \"{}\", but there are {} for {}", what, of,
                                    given, count));
}

void all_differ(std::string_view key, std::vector<double> values, const Section& section) {
  std::ranges::sort(values);
  if (const auto twice = std::ranges::adjacent_find(values); twice != values.end())
    section.refuse(key, fmt::format("must differ, but {} is there twice", *twice));
}

namespace {

void passing_rule(const SieveCurve& curve, const Section& section) {
  const auto& [openings, passing, in_pan, pan] = curve;
  for (std::size_t i = 1; i < openings.size(); ++i)
    if (passing[i] < passing[i - 1])
      section.refuse("passing",
                     fmt::format("must not fall with the size, but {} passes {} and only {} passes "
                                 "{}; what each sieve retains is \"retained\"",
                                 passing[i - 1], openings[i - 1], passing[i], openings[i]));
  if (passing.front() != 0 && pan > 0)
    section.refuse("passing", fmt::format("must be 0 at the size 0, but is {} there", passing.front()));
  if (passing.front() != 0)
    section.refuse("passing", fmt::format("must begin at 0, but {} passes the finest sieve, {}; add the size "
                                          "that no sphere is below, with 0, or the size 0 for the pan",
                                          passing.front(), openings.front()));
  if (passing.back() != 1 && passing.back() != 100)
    section.refuse("passing",
                   fmt::format("must end at 100 (per cent) or 1, but {} passes the coarsest sieve, "
                               "{}; add the size that no sphere is above",
                               passing.back(), openings.back()));
}

/// The coarsest sieve has nothing on it, or nobody knows how large that is.
void retained_rule(const Sieve& of, const Section& section) {
  const bool has_pan = of.retained.size() == of.sizes.size() + 1;
  if (!has_pan) one_for_each("retained", of.retained.size(), "sizes", of.sizes.size(), section);
  if (has_pan && std::ranges::find(of.sizes, 0.0) != of.sizes.end())
    section.refuse("retained",
                   fmt::format("must have one number for each of \"sizes\", which name the pan, 0, "
                               "themselves; but there are {} for {}",
                               of.retained.size(), of.sizes.size()));
  if (has_pan && !std::ranges::is_sorted(of.sizes, std::greater{}))
    section.refuse("retained",
                   "has one number more than \"sizes\": it is taken for the pan only where the sizes fall; "
                   "name the pan as the size 0");
  const auto coarsest = std::ranges::max_element(of.sizes);
  const double on_it = of.retained[static_cast<std::size_t>(coarsest - of.sizes.begin())];
  if (on_it > 0)
    section.refuse(
        "retained",
        fmt::format("must be 0 on the coarsest sieve, but {} lies on {}; add the size that no sphere "
                    "is above, with 0",
                    on_it, *coarsest));
  if (std::ranges::max(of.retained) == 0) section.refuse("retained", "must not be 0 everywhere");
}

}  // namespace

void sieve_rule(const Sieve& of, const Section& section) {
  all_differ("sizes", of.sizes, section);
  if (of.sizes.size() < 2) section.refuse("sizes", "must have two sieves or more");
  if (of.passing.empty()) {
    retained_rule(of, section);
  } else {
    one_for_each("passing", of.passing.size(), "sizes", of.sizes.size(), section);
    passing_rule(curve_of(of), section);
  }
  if (!of.pan) return;
  const SieveCurve curve = curve_of(of);
  if (curve.pan == 0)
    section.refuse("pan", "is the lower end of what is in the pan, but there is none: name it as the size 0");
  if (*of.pan >= curve.openings.at(1))
    section.refuse(
        "pan",
        fmt::format("is a size, which is below the finest sieve, but {} is not below {}; how much is in "
                    "the pan stands in the list, at the size 0",
                    *of.pan, curve.openings[1]));
}

namespace {

std::string_view in_words(PercentileLaw law) {
  return law == PercentileLaw::normal          ? "normal"
         : law == PercentileLaw::rosin_rammler ? "Rosin-Rammler"
                                               : "lognormal";
}

}  // namespace

void percentiles_rule(const Percentiles& of, const Section& section) {
  const NamedPercentile* last = nullptr;
  std::size_t given = 0;
  for (const NamedPercentile& each : named_percentiles) {
    const auto& size = of.*each.member;
    if (!size) continue;
    if (last && *size <= *(of.*last->member))
      section.refuse(each.name, fmt::format("must be above \"{}\", but {} is not above {}", last->name, *size,
                                            *(of.*last->member)));
    last = &each;
    ++given;
  }
  if (given < 2)
    section.fail("",
                 fmt::format("{} needs two percentiles or more, such as d10 and d90; with one of them give "
                             "a lognormal distribution its \"median\" and \"sigma\"",
                             section.name));
  const std::vector<Percentile> percentiles = given_percentiles(of);
  if (of.min && of.max && *of.min >= *of.max)
    section.refuse("min", fmt::format("must be below \"max\", but {} is not below {}", *of.min, *of.max));
  if (of.law == PercentileLaw::through) {
    if (of.min && *of.min >= percentiles.front().size)
      section.refuse("min", fmt::format("must be below all percentiles, but {} is not below {}", *of.min,
                                        percentiles.front().size));
    if (of.max && *of.max <= percentiles.back().size)
      section.refuse("max", fmt::format("must be above all percentiles, but {} is not above {}", *of.max,
                                        percentiles.back().size));
    return;
  }
  const FittedLaw law = fit_law(percentiles, of.law);
  if (of.law == PercentileLaw::rosin_rammler && !of.min)
    section.fail("law", fmt::format("law = \"rosin_rammler\" in {} needs \"min\", for by number it has fines "
                                    "without end; 1 % of this fit lies below {:.3g}",
                                    section.name, law.size_at(of.law, 0.01)));
  constexpr double far_off = 1.5;
  const NamedPercentile* worst = nullptr;
  double most = far_off, in_its_place = 0;
  for (const NamedPercentile& each : named_percentiles)
    if (const auto& size = of.*each.member) {
      const double fitted = law.size_at(of.law, each.share);
      const double times =
          fitted > 0 ? std::max(fitted / *size, *size / fitted) : std::numeric_limits<double>::infinity();
      if (times <= most) continue;
      worst = &each;
      most = times;
      in_its_place = fitted;
    }
  if (worst)
    section.fail(
        worst->name,
        fmt::format("no {} law goes near all percentiles in {}: the best would have {:.3g} "
                    "as \"{}\" in place of {:.6g}; say law = \"through\" for a curve "
                    "exactly through them",
                    in_words(of.law), section.name, in_its_place, worst->name, *(of.*worst->member)));
}

void histogram_rule(const Histogram& of, const Section& section) {
  const bool by_number = !of.counts.empty();
  const std::vector<double>& amounts = by_number ? of.counts : of.masses;
  const std::string_view key = by_number ? "counts" : "masses";
  if (of.edges.size() != amounts.size() + 1)
    section.refuse("edges", fmt::format("must be one more than \"{}\", but there are {} for {}", key,
                                        of.edges.size(), amounts.size()));
  const auto falls = std::ranges::adjacent_find(of.edges, std::greater_equal{});
  if (falls != of.edges.end())
    section.refuse("edges", fmt::format("must ascend, but {} stands before {}", falls[0], falls[1]));
  if (std::ranges::max(amounts) == 0) section.refuse(key, "must not be 0 everywhere");
  if (of.edges.front() == 0 && amounts.front() > 0)
    section.refuse("edges", fmt::format("must begin above 0 where the first bin holds anything, and here it "
                                        "holds {}: give the smallest size that there is",
                                        amounts.front()));
}

}  // namespace bernal::schema
