#include "cost/verdict.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "bernal/core/text.hpp"
#include "bernal/plan/plan.hpp"
#include "bernal/predict/predict.hpp"
#include "bernal/scene/read_scene.hpp"
#include "cost/cost_row.hpp"
#include "cost/front.hpp"
#include "cost/knob_alone.hpp"

namespace bernal::cost {
namespace {

/// How much further, in the gap at which they hold, contacts are closed on the front of contacts from one
/// setting to the next: gaps are looked at in decades.
constexpr double contact_step = 0.5;

/// Of both fronts.
void mark_fronts(const Search& search, std::vector<CostRow>& rows, double phi_step) {
  const auto mark = [&](auto worth, double step, bool CostRow::*flag) {
    std::vector<Offer> offers;
    std::vector<std::size_t> which;
    for (std::size_t k = 0; k < rows.size(); ++k)
      if (const std::optional<double> value = worth(rows[k]);
          value && search.counts(rows[k]) && !rows[k].is_repeat) {
        offers.push_back({rows[k].seconds, *value});
        which.push_back(k);
      }
    for (const std::size_t k : front_of(offers, step)) rows[which[k]].*flag = true;
  };
  mark([](const CostRow& row) { return std::optional(row.phi); }, phi_step, &CostRow::pareto);
  mark(
      [](const CostRow& row) -> std::optional<double> {
        return row.held_from ? std::optional(-std::log10(*row.held_from)) : std::nullopt;
      },
      contact_step, &CostRow::pareto_contacts);
}

/// Whether it keeps what the scene as it is has in other respects than density.
bool is_as_accurate(const CostRow& row, const CostRow& own) {
  // What holds where a run gave up before all was in its place is no aim.
  const bool falls_short = own.outcome != Outcome::converged && row.outcome == Outcome::converged;
  const bool contacts = falls_short || !own.held_from || (row.held_from && *row.held_from <= *own.held_from);
  const bool sizes = own.size_scale != 1 || row.size_scale == 1;
  return contacts && sizes && row.max_overlap <= own.max_overlap && row.wall_error <= own.wall_error;
}

/// Where the number of spheres follows from a prediction: what more rods would change.
std::optional<std::string> sentence_of_rods(const Scene& scene) {
  const auto radii = radii_of(scene);
  if (scene.dimension() != 3) return {};
  constexpr std::array rods = {1000, 4000, 16000, 64000};
  double least = 1, most = 0;
  std::array<double, rods.size()> seconds{};
  for (std::size_t k = 0; k < rods.size(); ++k) {
    const Stopwatch watch;
    const double phi = predict_packing_fraction(*radii, rods[k]).phi;
    seconds[k] = watch.seconds();
    least = std::min(least, phi);
    most = std::max(most, phi);
  }
  return fmt::format(
      "rods (no key: of the prediction that is asked for): {} of them predict what {} do within {:.1e}, in "
      "{:.2g} ms in place of {:.2g} ms: nothing to buy "
      "here.",
      rods.front(), rods.back(), most - least, 1e3 * seconds.front(), 1e3 * seconds.back());
}

std::string reaches(const CostRow& row) {
  return fmt::format(
      "packing fraction {:.4f}{} in {} of processor time", row.phi,
      row.size_scale == 1
          ? ""
          : fmt::format(" at the sizes asked for, all sizes {:.6g} times those,", row.size_scale),
      seconds_in_words(row.seconds));
}

/// How it ends, where that is not as the scene asks.
std::string shortfall(const CostRow& row) {
  if (row.outcome == Outcome::converged) return "";
  return fmt::format(" It does not reach what the scene asks for and ends as {}: {}.", name_of(row.outcome),
                     plain_text(row.reason));
}

/// What the densest one has that another one lacks.
std::string given_up(const CostRow& chosen, const CostRow& densest) {
  const Difference loss = difference_of(chosen, densest);
  std::string text =
      fmt::format(", {} against the densest measured that is as accurate ({:.4f}, which took {}",
                  change_in_words(loss.mean), densest.phi, seconds_in_words(densest.seconds));
  if (!loss.error) return text + ')';
  return text +
         fmt::format("; seed by seed {} to {})", change_in_words(loss.least), change_in_words(loss.most));
}

/// The densest that counts, and the quickest as dense as that and as the scene, and as accurate.
void recommend(const Search& search, CostReport& report) {
  const CostRow& own = report.rows[report.own];
  const auto is_candidate = [&](const CostRow& row) {
    return search.counts(row) && !row.is_repeat && is_as_accurate(row, own);
  };
  const auto reaches_all = [](const CostRow& row) { return row.outcome == Outcome::converged; };
  // What reaches all that is asked for comes before what is dense and does not.
  const bool some_do = std::ranges::any_of(
      report.rows, [&](const CostRow& row) { return is_candidate(row) && reaches_all(row); });
  const auto may_be_taken = [&](const CostRow& row) {
    return is_candidate(row) && (!some_do || reaches_all(row));
  };
  std::size_t densest = report.own;
  for (std::size_t k = 0; k < report.rows.size(); ++k)
    if (may_be_taken(report.rows[k]) &&
        (!may_be_taken(report.rows[densest]) || report.rows[k].phi > report.rows[densest].phi))
      densest = k;
  const auto is_as_dense = [&](const CostRow& row) {
    return is_no_loss(row, report.rows[densest]) && is_no_loss(row, own);
  };
  report.recommended = densest;
  for (std::size_t k = 0; k < report.rows.size(); ++k) {
    const CostRow& row = report.rows[k];
    if (may_be_taken(row) && is_as_dense(row) && row.seconds < report.rows[report.recommended].seconds)
      report.recommended = k;
  }
  // Of those that take the same time the one that changes least.
  const double quickest = report.rows[report.recommended].seconds;
  for (std::size_t k = 0; k < report.rows.size(); ++k) {
    const CostRow& row = report.rows[k];
    if (may_be_taken(row) && is_as_dense(row) && row.seconds <= (1 + same_seconds) * quickest &&
        row.changed.size() < report.rows[report.recommended].changed.size())
      report.recommended = k;
  }
  const CostRow &chosen = report.rows[report.recommended], &best = report.rows[densest];
  report.recommendation = report.recommended == report.own
                              ? fmt::format("Leave the scene as it is: {}", reaches(chosen))
                              : fmt::format("Take {}: {}", chosen.setting, reaches(chosen));
  report.recommendation += densest != report.recommended
                               ? given_up(chosen, best)
                               : std::string(", the densest measured that is as accurate");
  if (report.recommended != report.own)
    report.recommendation +=
        fmt::format("; the scene as it is reaches {:.4f} in {}", own.phi, seconds_in_words(own.seconds));
  report.recommendation += ".";
  if (own.runs == 1) report.recommendation += " Of one seed: nothing is known of how seeds differ.";
  report.recommendation += shortfall(chosen);
}

/// What there is for whoever has less time: that share of it. Null where there is nothing.
const CostRow* best_for(const CostReport& report, double share) {
  const CostRow& chosen = report.rows[report.recommended];
  const CostRow* best = nullptr;
  for (const CostRow& row : report.rows)
    if (row.pareto && row.seconds <= share * chosen.seconds && (!best || row.phi > best->phi)) best = &row;
  if (!best) return best;
  for (const CostRow& row : report.rows)  // as dense and as quick, and nearer to the scene
    if (!row.slower && row.certified && row.runs == best->runs && !row.is_repeat && is_no_loss(row, *best) &&
        row.seconds <= (1 + 2 * same_seconds) * best->seconds && row.changed.size() < best->changed.size())
      best = &row;
  return best;
}

std::string sentence_for_less(std::string_view share, const CostRow& row) {
  return fmt::format("With {} of that time: {}, {}.", share, row.setting, reaches(row));
}

/// Of the search, why no more was measured.
std::string ending_of(const Search& search) {
  const auto cut_off = std::ranges::count_if(search.found(), [](const auto& f) { return f.row.slower; });
  if (search.cancelled()) return "stopped; the same call goes on from here";
  if (search.complete())
    return cut_off == 0 ? "nothing was left to try"
                        : fmt::format(
                              "nothing was left to try but {} that {} cut off as slower, for which more "
                              "time is needed",
                              cut_off, cut_off == 1 ? "was" : "were");
  if (search.capped()) return fmt::format("the most settings were tried, {}", search.found().size());
  return "the time was over; the same call goes on from here";
}

}  // namespace

std::string seconds_in_words(double seconds) {
  if (seconds < 100) return fmt::format("{:.3g} s", seconds);
  return seconds < 6000 ? fmt::format("{:.3g} min", seconds / 60) : fmt::format("{:.3g} h", seconds / 3600);
}

CostReport report_of(const Search& search, const std::filesystem::path& folder) {
  CostReport report;
  report.phi_step = search.phi_step();
  std::vector<const Search::Found*> found;
  for (const Search::Found& f : search.found()) found.push_back(&f);
  std::ranges::stable_sort(found, {},
                           [](const Search::Found* f) { return std::pair(f->row.slower, f->row.seconds); });
  for (const Search::Found* f : found) {
    if (f->point == search.own()) report.own = report.rows.size();
    report.rows.push_back(f->row);
    CostRow& row = report.rows.back();
    const Difference change = difference_of(row, search.at(search.own())->row);
    row.phi_change = change.mean;
    row.phi_change_error = change.error;
    row.is_repeat = search.repeats(*f);
  }
  for (const auto& [point, why] : search.refused())
    report.refused.push_back(fmt::format("{}: {}", search.setting_of(point).name, plain_text(why)));
  mark_fronts(search, report.rows, report.phi_step);
  recommend(search, report);
  const CostRow *half = best_for(report, 0.5), *tenth = best_for(report, 0.1);
  if (half && half != tenth) report.verdicts.push_back(sentence_for_less("half", *half));
  if (tenth) report.verdicts.push_back(sentence_for_less("a tenth", *tenth));
  for (std::size_t k = 0; k < search.knobs().size(); ++k)
    report.verdicts.push_back(sentence_of_knob(search, k));
  if (search.subject().is_predicted)
    if (auto sentence = sentence_of_rods(search.subject().scene))
      report.verdicts.push_back(std::move(*sentence));
  const Setting recommended = search.setting_of(found[report.recommended]->point);
  Scene scene = recommended.scene;
  complete(scene);
  if (const CostRow& chosen = report.rows[report.recommended]; chosen.outcome != Outcome::converged)
    report.toml = fmt::format("#{}\n", shortfall(chosen));
  report.toml += scene_as_toml(scene, folder);
  report.runs_made = search.runs_made();
  report.complete = search.complete();
  report.cancelled = search.cancelled();
  report.ending = ending_of(search);
  return report;
}

}  // namespace bernal::cost
