#include "cost/verdict.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "bernal/predict/predict.hpp"
#include "bernal/run/run.hpp"
#include "bernal/scene/read_scene.hpp"
#include "cost/front.hpp"

namespace bernal::cost {
namespace {

/// Packing fractions that differ by less are as good as equal to whoever asks for advice.
constexpr double good_enough = 0.001;
/// Seconds that differ by less than this share are told as equal.
constexpr double same_seconds = 0.05;
/// How much further, in the gap at which they hold, contacts are closed on the front of contacts from one
/// setting to the next: gaps are looked at in decades.
constexpr double contact_step = 0.5;

/// Of both fronts.
void mark_fronts(const Search& search, std::vector<CostRow>& rows, double phi_step) {
  const auto mark = [&](auto worth, double step, bool CostRow::*flag) {
    std::vector<Offer> offers;
    std::vector<std::size_t> which;
    for (std::size_t k = 0; k < rows.size(); ++k)
      if (const std::optional<double> value = worth(rows[k]); value && search.counts(rows[k])) {
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
  const bool contacts = !own.held_from || (row.held_from && *row.held_from <= *own.held_from);
  return contacts && row.max_overlap <= own.max_overlap && row.wall_error <= own.wall_error;
}

std::string times(double ratio) {
  if (std::abs(std::log(ratio)) < same_seconds) return "the same time";
  return ratio >= 100 ? fmt::format("{:.0f} times the time", ratio)
         : ratio >= 1 ? fmt::format("{:.3g} times the time", ratio)
                      : fmt::format("{:.2g} of the time", ratio);
}

double ratio_of(const CostRow& row, const CostRow& to) {
  return std::max(1e-6, row.seconds) / std::max(1e-6, to.seconds);
}

/// What a knob does alone, the others as in the scene.
class KnobAlone {
 public:
  KnobAlone(const Search& search, std::size_t knob) : knob_(search.knobs()[knob]) {
    for (const std::size_t step : knob_.order) {
      Point point = search.own();
      point[knob] = step;
      const Search::Found* found = search.at(point);
      if (!found) continue;
      if (search.counts(found->row)) {
        if (step == knob_.own) own_ = seen_.size();
        seen_.push_back({knob_.steps[step].text, &found->row});
      } else if (found->row.slower || found->row.runs == search.at(search.own())->row.runs) {
        failed_ += fmt::format("; {} {}", knob_.steps[step].text,
                               found->row.slower
                                   ? fmt::format("takes more than {}", seconds_in_words(found->row.seconds))
                               : !found->row.certified ? "is not certified"
                                                       : "does not reach what is asked");
      }
    }
  }

  std::string sentence(double phi_step) const {
    if (seen_.size() < 2)
      return failed_.empty() ? fmt::format("{}: not measured with every seed, for want of time.", knob_.name)
                             : fmt::format("{}: only {} works{}.", knob_.name,
                                           seen_.empty() ? "none" : seen_[0].text, failed_);
    std::string text = changes_nothing() ? without_effect() : both_ways(phi_step);
    return fmt::format("{}: {}{}.", knob_.name, text, failed_);
  }

 private:
  struct Seen {
    std::string text;
    const CostRow* row;
  };

  bool changes_nothing() const {
    return std::ranges::all_of(seen_, [&](const Seen& s) { return s.row->hash == seen_.front().row->hash; });
  }
  std::string without_effect() const {
    return fmt::format(
        "without effect on this scene: from {} to {} the same packing, sphere for sphere, for {}",
        seen_.front().text, seen_.back().text, times(ratio_of(*seen_.back().row, *seen_.front().row)));
  }

  std::string both_ways(double phi_step) const {
    const auto by_phi = [](const Seen& s) { return s.row->phi; };
    if (!own_) {
      return fmt::format("from {} to {} the packing fraction goes from {:.4f} to {:.4f}, for {}",
                         seen_.front().text, seen_.back().text, seen_.front().row->phi, seen_.back().row->phi,
                         times(ratio_of(*seen_.back().row, *seen_.front().row)));
    }
    const Seen& own = seen_[*own_];
    std::string text;
    // Dearer: the densest of them, and the cheapest that is as dense.
    if (*own_ + 1 < seen_.size()) {
      const auto begin = seen_.begin() + static_cast<std::ptrdiff_t>(*own_) + 1;
      const Seen& best = *std::max_element(
          begin, seen_.end(), [&](const Seen& a, const Seen& b) { return by_phi(a) < by_phi(b); });
      text += bought(own, best, phi_step);
    }
    if (*own_ > 0) {
      const auto end = seen_.begin() + static_cast<std::ptrdiff_t>(*own_);
      // The quickest that loses nothing, or else the quickest of all.
      const Seen* saving = nullptr;
      for (auto seen = seen_.begin(); seen != end; ++seen) {
        const bool as_good = seen->row->phi >= own.row->phi - std::max(phi_step, good_enough / 2);
        if (as_good && (!saving || seen->row->seconds < saving->row->seconds)) saving = &*seen;
      }
      const bool saves = saving && ratio_of(*saving->row, *own.row) < 1 - same_seconds;
      if (!text.empty()) text += "; ";
      text += saves ? saved(own, *saving) : lost(own, seen_.front());
    }
    return text;
  }

  static std::string contacts(const Seen& from, const Seen& to) {
    if (!from.row->held_from || !to.row->held_from || *from.row->held_from == *to.row->held_from) return "";
    return fmt::format(", and holds from gaps of {:g} in place of {:g}", *to.row->held_from,
                       *from.row->held_from);
  }
  static std::string bought(const Seen& own, const Seen& other, double phi_step) {
    const double gain = other.row->phi - own.row->phi;
    const std::string step = fmt::format("from {} to {}", own.text, other.text);
    const std::string price = times(ratio_of(*other.row, *own.row));
    if (other.row->hash == own.row->hash)
      return fmt::format("{} buys nothing, sphere for sphere, for {}", step, price);
    if (gain > phi_step)
      return fmt::format("{} buys {:.4f} for {}{}", step, gain, price, contacts(own, other));
    const std::string why =
        gain < -phi_step ? "" : fmt::format(", within what seeds differ by, {:.2g}", phi_step);
    return fmt::format("{} buys no packing fraction ({:+.4f}{}) for {}{}", step, gain, why, price,
                       contacts(own, other));
  }
  static std::string saved(const Seen& own, const Seen& other) {
    return fmt::format("{} in place of {} would do: {:+.4f} for {}{}", other.text, own.text,
                       other.row->phi - own.row->phi, times(ratio_of(*other.row, *own.row)),
                       contacts(own, other));
  }
  static std::string lost(const Seen& own, const Seen& other) {
    const double change = other.row->phi - own.row->phi;
    return fmt::format("{} in place of {} {} for {}{}", other.text, own.text,
                       std::abs(change) < good_enough / 2 ? fmt::format("saves nothing ({:+.4f})", change)
                                                          : fmt::format("changes {:+.4f}", change),
                       times(ratio_of(*other.row, *own.row)), contacts(own, other));
  }

  const Knob& knob_;
  std::vector<Seen> seen_;
  std::optional<std::size_t> own_;
  std::string failed_;
};

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
      "rods: {} of them predict what {} do within {:.1e}, in {:.2g} ms in place of {:.2g} ms: nothing to buy "
      "here.",
      rods.front(), rods.back(), most - least, 1e3 * seconds.front(), 1e3 * seconds.back());
}

std::string reaches(const CostRow& row) {
  return fmt::format("packing fraction {:.4f} in {} of processor time", row.phi,
                     seconds_in_words(row.seconds));
}

/// The densest that counts, and the quickest as dense as that and as accurate as the scene.
void recommend(const Search& search, CostReport& report) {
  const auto counts = [&](const CostRow& row) { return search.counts(row); };
  const CostRow& own = report.rows[report.own];
  std::size_t densest = report.own;
  for (std::size_t k = 0; k < report.rows.size(); ++k)
    if (counts(report.rows[k]) && is_as_accurate(report.rows[k], own) &&
        report.rows[k].phi > report.rows[densest].phi)
      densest = k;
  const double tolerance = std::max(good_enough, report.phi_step);
  report.recommended = densest;
  for (std::size_t k = 0; k < report.rows.size(); ++k) {
    const CostRow& row = report.rows[k];
    if (counts(row) && is_as_accurate(row, own) && row.phi >= report.rows[densest].phi - tolerance &&
        row.seconds < report.rows[report.recommended].seconds)
      report.recommended = k;
  }
  // Of those that take the same time the one that changes least.
  const double quickest = report.rows[report.recommended].seconds;
  for (std::size_t k = 0; k < report.rows.size(); ++k) {
    const CostRow& row = report.rows[k];
    if (counts(row) && is_as_accurate(row, own) && row.phi >= report.rows[densest].phi - tolerance &&
        row.seconds <= (1 + same_seconds) * quickest &&
        row.changed.size() < report.rows[report.recommended].changed.size())
      report.recommended = k;
  }
  const CostRow &chosen = report.rows[report.recommended], &best = report.rows[densest];
  report.recommendation = report.recommended == report.own
                              ? fmt::format("Leave the scene as it is: {}", reaches(chosen))
                              : fmt::format("Take {}: {}", chosen.setting, reaches(chosen));
  if (densest != report.recommended)
    report.recommendation +=
        fmt::format(", within {:.2g} of the densest measured that is as accurate ({:.4f}, which took {})",
                    tolerance, best.phi, seconds_in_words(best.seconds));
  else
    report.recommendation += ", the densest measured that is as accurate";
  if (report.recommended != report.own)
    report.recommendation +=
        fmt::format("; the scene as it is reaches {:.4f} in {}", own.phi, seconds_in_words(own.seconds));
  report.recommendation += ".";
}

/// What there is for whoever has less time.
std::optional<std::string> sentence_for_less(const CostReport& report, double share) {
  const CostRow& chosen = report.rows[report.recommended];
  const CostRow* best = nullptr;
  for (const CostRow& row : report.rows)
    if (row.pareto && row.seconds <= share * chosen.seconds && (!best || row.phi > best->phi)) best = &row;
  if (!best) return {};
  for (const CostRow& row : report.rows)  // as dense and as quick, and nearer to the scene
    if (!row.slower && row.certified && row.phi >= best->phi - report.phi_step &&
        row.seconds <= (1 + 2 * same_seconds) * best->seconds && row.changed.size() < best->changed.size())
      best = &row;
  return fmt::format("With {} of that time: {}, {}.", share == 0.1 ? "a tenth" : "half", best->setting,
                     reaches(*best));
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
  }
  mark_fronts(search, report.rows, report.phi_step);
  recommend(search, report);
  for (const double share : {0.5, 0.1})
    if (auto sentence = sentence_for_less(report, share)) report.verdicts.push_back(std::move(*sentence));
  for (std::size_t k = 0; k < search.knobs().size(); ++k)
    report.verdicts.push_back(KnobAlone(search, k).sentence(report.phi_step));
  if (search.subject().is_predicted)
    if (auto sentence = sentence_of_rods(search.subject().scene))
      report.verdicts.push_back(std::move(*sentence));
  const Setting recommended = search.setting_of(found[report.recommended]->point);
  Scene scene = recommended.scene;
  complete(scene);
  report.toml = scene_as_toml(scene, folder);
  report.runs_made = search.runs_made();
  report.complete = search.complete();
  report.cancelled = search.cancelled();
  return report;
}

}  // namespace bernal::cost
