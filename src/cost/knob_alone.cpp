#include "cost/knob_alone.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "bernal/core/text.hpp"
#include "cost/cost_row.hpp"
#include "cost/verdict.hpp"

namespace bernal::cost {
namespace {

std::string times(double ratio) {
  if (std::abs(std::log(ratio)) < same_seconds) return "the same time";
  return ratio >= 100 ? fmt::format("{:.0f} times the time", ratio)
         : ratio >= 1 ? fmt::format("{:.3g} times the time", ratio)
                      : fmt::format("{:.2g} of the time", ratio);
}

double ratio_of(const CostRow& row, const CostRow& to) {
  return std::max(1e-6, row.seconds) / std::max(1e-6, to.seconds);
}

/// Less is told as nothing.
constexpr double smallest_gain = 5e-5;

/// What a knob does alone, the others as in the scene.
class KnobAlone {
 public:
  KnobAlone(const Search& search, std::size_t knob) : knob_(search.knobs()[knob]) {
    for (const std::size_t step : knob_.order) {
      Point point = search.own();
      point[knob] = step;
      const Search::Found* found = search.at(point);
      if (const auto why = search.refused().find(point); why != search.refused().end())
        failed_ += fmt::format("; {} is refused: {}", knob_.steps[step].text, plain_text(why->second));
      if (!found) continue;
      if (search.counts(found->row)) {
        if (step == knob_.own) own_ = seen_.size();
        seen_.push_back({knob_.steps[step].text, &found->row});
      } else if (found->row.slower || found->row.runs == search.at(search.own())->row.runs) {
        failed_ += fmt::format("; {} {}", knob_.steps[step].text,
                               found->row.slower       ? fmt::format("takes more than {}, and was cut off",
                                                                     seconds_in_words(found->row.seconds))
                               : !found->row.certified ? "is not certified"
                                                       : "does not reach what is asked");
      }
    }
  }

  std::string sentence() const {
    if (seen_.size() < 2)
      return fmt::format("{}: no other value was measured with every seed{}.", name(),
                         failed_.empty() ? ", for want of time" : failed_);
    std::string text = knob_.tells_all ? each() : changes_nothing() ? without_effect() : both_ways();
    return fmt::format("{}: {}{}.", name(), text, failed_);
  }

 private:
  struct Seen {
    std::string text;
    const CostRow* row;
  };

  std::string name() const {
    return knob_.note.empty() ? knob_.name : fmt::format("{} ({})", knob_.name, knob_.note);
  }
  /// "false: 200 spheres, packing fraction 0.1234, 0.3 s to prepare and 1 s to pack; true: …"
  std::string each() const {
    std::string text;
    for (const Seen& s : seen_)
      text += fmt::format("{}{}: {:.0f} spheres, packing fraction {:.4f}, {} to prepare and {} to pack",
                          text.empty() ? "" : "; ", s.text, s.row->spheres, s.row->phi,
                          seconds_in_words(s.row->prepare_seconds), seconds_in_words(s.row->seconds));
    return text;
  }
  bool changes_nothing() const {
    return std::ranges::all_of(seen_,
                               [&](const Seen& s) { return are_same_spheres(*s.row, *seen_.front().row); });
  }
  std::string without_effect() const {
    return fmt::format(
        "without effect on this scene: from {} to {} the same packing, sphere for sphere, for {}",
        seen_.front().text, seen_.back().text, times(ratio_of(*seen_.back().row, *seen_.front().row)));
  }

  std::string both_ways() const {
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
      text += bought(own, best);
    }
    if (*own_ > 0) {
      const auto end = seen_.begin() + static_cast<std::ptrdiff_t>(*own_);
      // The quickest that loses nothing, or else the quickest of all.
      const Seen* saving = nullptr;
      for (auto seen = seen_.begin(); seen != end; ++seen) {
        const bool as_good = is_no_loss(*seen->row, *own.row);
        if (as_good && (!saving || seen->row->seconds < saving->row->seconds)) saving = &*seen;
      }
      const bool saves = saving && ratio_of(*saving->row, *own.row) < 1 - same_seconds;
      if (!text.empty()) text += "; ";
      text += saves ? saved(own, *saving) : lost(own, seen_.front());
    }
    return text;
  }

  static std::string contacts(const Seen& from, const Seen& to) {
    const std::string sizes =
        to.row->size_scale == from.row->size_scale
            ? ""
            : fmt::format(", with all sizes {:.6g} times those asked for", to.row->size_scale);
    if (!from.row->held_from || !to.row->held_from || *from.row->held_from == *to.row->held_from)
      return sizes;
    return fmt::format("{}, and holds from gaps of {:g} in place of {:g}", sizes, *to.row->held_from,
                       *from.row->held_from);
  }
  /// "+0.0004 ± 0.0010 over the seeds"
  static std::string told_apart(const Difference& difference) {
    return change_in_words(difference.mean) +
           (difference.error ? fmt::format(" ± {:.4f} over the seeds", *difference.error) : " with one seed");
  }
  static std::string bought(const Seen& own, const Seen& other) {
    const Difference gain = difference_of(*other.row, *own.row);
    const std::string step = fmt::format("from {} to {}", own.text, other.text);
    const std::string price = times(ratio_of(*other.row, *own.row));
    if (are_same_spheres(*other.row, *own.row))
      return fmt::format("{} buys nothing, sphere for sphere, for {}", step, price);
    if (gain.mean > std::max(gain.error.value_or(0), smallest_gain))
      return fmt::format("{} buys {:.4f}{} for {}{}", step, gain.mean,
                         gain.error ? fmt::format(" ± {:.4f}", *gain.error) : " with one seed", price,
                         contacts(own, other));
    return fmt::format("{} buys no packing fraction ({}) for {}{}", step, told_apart(gain), price,
                       contacts(own, other));
  }
  static std::string saved(const Seen& own, const Seen& other) {
    return fmt::format("{} in place of {} would do: {} for {}{}", other.text, own.text,
                       told_apart(difference_of(*other.row, *own.row)), times(ratio_of(*other.row, *own.row)),
                       contacts(own, other));
  }
  static std::string lost(const Seen& own, const Seen& other) {
    const Difference change = difference_of(*other.row, *own.row);
    return fmt::format("{} in place of {} {} for {}{}", other.text, own.text,
                       std::abs(change.mean) < good_enough / 2
                           ? fmt::format("saves nothing ({})", told_apart(change))
                           : fmt::format("changes {}", told_apart(change)),
                       times(ratio_of(*other.row, *own.row)), contacts(own, other));
  }

  const Knob& knob_;
  std::vector<Seen> seen_;
  std::optional<std::size_t> own_;
  std::string failed_;
};

}  // namespace

std::string change_in_words(double change) {
  const std::string text = fmt::format("{:+.4f}", change);
  return text == "-0.0000" ? "+0.0000" : text;
}

std::string sentence_of_knob(const Search& search, std::size_t knob) {
  return KnobAlone(search, knob).sentence();
}

}  // namespace bernal::cost
