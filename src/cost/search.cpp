#include "cost/search.hpp"

#include "cost/cost_row.hpp"
#include "cost/front.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace bernal::cost {
namespace {

/// The part of the time that goes into steps of one knob at most.
constexpr double share_of_single_steps = 0.6;
/// Settings that are measured together, in rounds over the seeds.
constexpr std::size_t batch = 6;
/// A setting is cut off after so many times what the scene as it is takes, or that share of all the time if
/// it is more; and never takes more than a quarter of the time that is left.
constexpr double longest_ratio = 10, longest_share = 0.05, longest_of_the_rest = 0.25;
/// One that was cut off before it had so many times what the scene takes had no fair try.
constexpr double fair_ratio = 3;
/// What is run first runs slower than the same run again, until threads, caches and memory are there: so much
/// of the time, and no more than these seconds, goes into a run that does not count.
constexpr double warming_share = 0.03, most_warming = 1;
/// A knob that changes the seconds by less than this share, and the packing fraction by less than can be
/// told, makes no difference.
constexpr double telling_share = 0.1;
/// Combinations that are looked at: of so many knobs.
constexpr std::size_t most_combined = 3;

double logarithm(double seconds) { return std::log(std::max(1e-6, seconds)); }

}  // namespace

Search::Search(Subject subject, std::vector<Knob> knobs, TrialRecord& record, const CostOptions& options)
    : subject_(std::move(subject)), knobs_(std::move(knobs)), record_(record), options_(options) {
  for (int k = 0; k < options.seeds; ++k)
    seeds_.push_back((subject_.scene.seed + static_cast<std::uint64_t>(k)) & ((std::uint64_t{1} << 63) - 1));
  budget_end_ = options.seconds;
  for (Knob& knob : knobs_)
    if (knob.is_limit) limits_.push_back(knob);
  std::erase_if(knobs_, [](const Knob& knob) { return knob.is_limit; });
}

const Search::Found* Search::at(const Point& point) const {
  const auto found = index_.find(point);
  return found == index_.end() ? nullptr : &found_[found->second];
}

Point Search::own() const {
  Point point;
  for (const Knob& knob : knobs_) point.push_back(knob.own);
  return point;
}

Setting Search::setting_of(const Point& point) const {
  Setting setting{"", subject_.scene};
  std::vector<std::string> changes;
  for (std::size_t k = 0; k < knobs_.size(); ++k) {
    if (point[k] == knobs_[k].own) continue;
    const Step& step = knobs_[k].steps[point[k]];
    step.turn(setting);
    changes.push_back(fmt::format("{} = {}", knobs_[k].name, step.text));
  }
  setting.name = changes.empty() ? "as it is" : fmt::format("{}", fmt::join(changes, ", "));
  return setting;
}

bool Search::counts(const CostRow& row) const {
  const Found* own_row = at(own());
  const bool own_converged = own_row && own_row->row.outcome == Outcome::converged;
  return own_row && row.runs == own_row->row.runs && !row.slower && row.certified && row.spheres > 0 &&
         (row.outcome == Outcome::converged || !own_converged);
}

double Search::phi_step() const {
  constexpr double least = 1e-5;
  const Found* own_row = at(own());
  std::vector<double> errors;
  for (const Found& found : found_) {
    if (!counts(found.row) || are_same_spheres(found.row, own_row->row)) continue;
    if (const auto error = difference_of(found.row, own_row->row).error) errors.push_back(*error);
  }
  return errors.empty() ? least : std::clamp(spread_of(std::move(errors)).median, least, most_tolerated);
}

bool Search::measure(const std::vector<Point>& points) {
  if (points.empty()) return true;
  std::vector<Setting> settings;
  for (const Point& point : points) settings.push_back(setting_of(point));
  const Found* own_row = at(own());
  const double end = std::min(options_.seconds, budget_end_) - watch_.seconds();
  RoundOptions rounds{.seeds = seeds_, .threads = options_.threads, .budget = std::max(0.0, end)};
  rounds.pass_over_refused = own_row != nullptr;
  if (own_row)
    rounds.limit = std::min(longest_of_the_rest * left(), std::max(longest_ratio * own_row->row.wall_seconds,
                                                                   longest_share * options_.seconds));
  if (own_row) rounds.fair = fair_ratio * own_row->row.wall_seconds;
  if (generous_) rounds.limit = 0.5 * left();
  rounds.monitor.cancelled = options_.monitor.cancelled;
  rounds.monitor.on_progress = [&](const Progress& progress) {
    options_.monitor.report(
        {"cost", std::min(1.0, watch_.seconds() / options_.seconds),
         fmt::format("{} settings known, {}: {}", found_.size(), phase_, progress.detail)});
  };
  const Rounds made = interleaved(settings, record_, rounds);
  made_ += made.made;
  tried_.insert(points.begin(), points.end());
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (!made.series[k].refused.empty()) refused_[points[k]] = made.series[k].refused;
    made.series[k].unfair ? unfair_.insert(points[k]).second : unfair_.erase(points[k]) > 0;
    if (made.series[k].trials.empty()) continue;
    double deviation = 0;
    for (std::size_t i = 0; i < knobs_.size(); ++i)
      deviation = std::max(deviation, knobs_[i].steps[points[k][i]].wall_deviation);
    CostRow row = row_of(made.series[k], deviation, subject_.mean_radius);
    row.setting = settings[k].name;
    for (std::size_t i = 0; i < knobs_.size(); ++i)
      if (points[k][i] != knobs_[i].own) row.changed.push_back(knobs_[i].name);
    const auto [place, is_new] = index_.try_emplace(points[k], found_.size());
    if (is_new)
      found_.push_back({points[k], std::move(row)});
    else
      found_[place->second].row = std::move(row);
  }
  cancelled_ = cancelled_ || made.cancelled;
  return !made.cancelled && !made.out_of_time;
}

void Search::go() {
  phase_ = "the scene as it is";
  warm_up();
  if (!measure({own()}) || !at(own()) || at(own())->row.slower) return;
  if (at(own())->row.outcome == Outcome::hit_limit) turn_limits();
  budget_end_ = watch_.seconds() + share_of_single_steps * left();
  phase_ = "one key at a time";
  one_at_a_time();
  budget_end_ = options_.seconds;
  phase_ = "combinations";
  if (cancelled_ || !combinations()) return;
  phase_ = "one key at a time";
  complete_ = one_at_a_time() && slower_ones() && one_at_a_time() && unfair_.empty() && !capped_;
}

void Search::turn_limits() {
  for (Knob& knob : limits_) knobs_.push_back(std::move(knob));
  limits_.clear();
  index_.clear();
  for (std::size_t k = 0; k < found_.size(); ++k) index_[found_[k].point = own()] = k;
  tried_ = {own()};
}

void Search::warm_up() {
  Setting as_it_is = setting_of(own());
  const double limit = std::min(most_warming, warming_share * options_.seconds);
  const bool is_known = std::ranges::all_of(seeds_, [&](std::uint64_t seed) {
    return record_.find(as_it_is, seed, threads_of(options_.threads)) != nullptr;
  });
  if (!is_known)
    run_trial(as_it_is.scene, {.seed = seeds_.front(),
                               .threads = options_.threads,
                               .limit = limit,
                               .monitor = {{}, options_.monitor.cancelled}});
}

bool Search::repeats(const Found& found) const {
  return std::ranges::any_of(found_, [&](const Found& other) {
    const std::size_t changes = found.row.changed.size(), fewer = other.row.changed.size();
    return &other != &found && are_same_spheres(other.row, found.row) &&
           std::tuple(fewer, other.row.seconds, &other) < std::tuple(changes, found.row.seconds, &found);
  });
}

bool Search::one_at_a_time() {
  struct Way {
    std::size_t knob;
    int direction;
    bool open = true;
  };
  std::vector<Way> ways;
  for (const int direction : {-1, 1})
    for (std::size_t k = 0; k < knobs_.size(); ++k) ways.push_back({k, direction});
  const auto point_on = [&](const Way& way, int distance) -> std::optional<Point> {
    const Knob& knob = knobs_[way.knob];
    const auto place = static_cast<std::ptrdiff_t>(knob.place_of(knob.own)) + way.direction * distance;
    if (place < 0 || place >= static_cast<std::ptrdiff_t>(knob.order.size())) return {};
    Point point = own();
    point[way.knob] = knob.order[static_cast<std::size_t>(place)];
    return point;
  };
  for (int distance = 1;; ++distance) {
    std::vector<Point> points;
    for (Way& way : ways) {
      const std::optional<Point> point = way.open ? point_on(way, distance) : std::nullopt;
      way.open = point.has_value();
      if (point) points.push_back(*point);
    }
    if (points.empty()) return true;
    // The cheaper ones first; in parts, so that what has been begun is known with every seed.
    for (std::size_t k = 0; k < points.size(); k += batch)
      if (!measure({points.begin() + static_cast<std::ptrdiff_t>(k),
                    points.begin() + static_cast<std::ptrdiff_t>(std::min(points.size(), k + batch))}))
        return false;
    for (Way& way : ways) {
      if (!way.open) continue;
      const Found* found = at(*point_on(way, distance));
      way.open = found && !(found->row.slower && way.direction > 0);
    }
  }
}

std::vector<std::size_t> Search::points_of_front() const {
  std::vector<Offer> offers;
  std::vector<std::size_t> which;
  for (std::size_t k = 0; k < found_.size(); ++k) {
    if (!counts(found_[k].row) || repeats(found_[k])) continue;
    offers.push_back({found_[k].row.seconds, found_[k].row.phi});
    which.push_back(k);
  }
  std::vector<std::size_t> front;
  for (const std::size_t k : front_of(offers, phi_step())) front.push_back(which[k]);
  return front;
}

/// Combinations of single steps whose effects, added up, are beyond the front: packing fractions add up, and
/// the logarithms of seconds. The most promising first.
std::vector<Point> Search::promising() const {
  const CostRow& base = at(own())->row;
  const double tell = phi_step();
  struct Effect {
    std::size_t knob, step;
    double phi, log_seconds;
  };
  std::vector<std::vector<Effect>> effects(knobs_.size());
  std::vector<std::pair<double, std::size_t>> by_weight;
  for (std::size_t k = 0; k < knobs_.size(); ++k) {
    double weight = 0;
    for (const std::size_t step : knobs_[k].order) {
      Point point = own();
      point[k] = step;
      const Found* found = at(point);
      if (!found || step == knobs_[k].own || !counts(found->row) || !differ(found->row, base)) continue;
      const Effect effect{k, step, found->row.phi - base.phi,
                          logarithm(found->row.seconds) - logarithm(base.seconds)};
      effects[k].push_back(effect);
      weight = std::max(weight, std::abs(effect.phi) / tell + std::abs(effect.log_seconds) / telling_share);
    }
    if (weight > 0) by_weight.emplace_back(weight, k);
  }
  std::ranges::sort(by_weight, std::greater<>{});
  if (by_weight.size() > 2 * most_combined) by_weight.resize(2 * most_combined);

  std::vector<Offer> known;
  for (const Found& found : found_)
    if (counts(found.row)) known.push_back({logarithm(found.row.seconds), found.row.phi});
  std::vector<std::pair<double, Point>> candidates;
  const auto combine = [&](auto&& self, std::size_t next, std::size_t depth, Point point, double phi,
                           double log_seconds) -> void {
    if (depth > 1 && !tried_.contains(point)) {
      const double gain = phi - worth_for(known, log_seconds);
      // Between what gains most and what is known soonest.
      if (gain > tell) candidates.emplace_back(std::min(gain, 1.0) * std::exp(-0.5 * log_seconds), point);
    }
    if (depth == most_combined) return;
    for (std::size_t i = next; i < by_weight.size(); ++i)
      for (const Effect& effect : effects[by_weight[i].second]) {
        Point other = point;
        other[effect.knob] = effect.step;
        self(self, i + 1, depth + 1, std::move(other), phi + effect.phi, log_seconds + effect.log_seconds);
      }
  };
  combine(combine, 0, 0, own(), base.phi, logarithm(base.seconds));
  std::ranges::sort(candidates, std::greater<>{});
  std::vector<Point> best;
  for (auto& [gain, point] : candidates) {
    if (best.size() == batch) break;
    best.push_back(point);
  }
  return best;
}

/// Steps between neighbours on the front, where it has its widest gaps, and a step of each knob away from it.
std::vector<Point> Search::between_front() {
  const std::vector<std::size_t> front = points_of_front();
  std::vector<Point> points;
  const auto add = [&](const Point& point) {
    if (points.size() < batch && !tried_.contains(point) && std::ranges::find(points, point) == points.end())
      points.push_back(point);
  };
  std::vector<std::pair<double, std::size_t>> gaps;
  for (std::size_t i = 1; i < front.size(); ++i) {
    const CostRow &a = found_[front[i - 1]].row, &b = found_[front[i]].row;
    if (b.phi - a.phi < 2 * phi_step()) continue;  // nothing that lies between can be told from both
    gaps.emplace_back(
        (b.phi - a.phi) / std::max(1e-9, found_[front.back()].row.phi - found_[front[0]].row.phi) +
            (logarithm(b.seconds) - logarithm(a.seconds)) /
                std::max(1e-9, logarithm(found_[front.back()].row.seconds) -
                                   logarithm(found_[front[0]].row.seconds)),
        i);
  }
  std::ranges::sort(gaps, std::greater<>{});
  for (const auto& [width, i] : gaps) {
    const Point cheap = found_[front[i - 1]].point, dear = found_[front[i]].point;
    for (std::size_t k = 0; k < knobs_.size() && points.size() < batch; ++k) {
      if (cheap[k] == dear[k] || !makes_a_difference(k)) continue;
      Knob& knob = knobs_[k];
      const std::size_t a = knob.place_of(cheap[k]), b = knob.place_of(dear[k]);
      const auto [low, high] = std::minmax(a, b);
      std::optional<std::size_t> middle = knob.order[(low + high) / 2];
      if (high == low + 1) middle = knob.insert_between(knob.order[low], knob.order[high]);
      if (!middle) continue;
      Point point = cheap;
      point[k] = *middle;
      add(point);
      point = dear;
      point[k] = *middle;
      add(point);
    }
  }
  for (const std::size_t i : front)
    for (std::size_t k = 0; k < knobs_.size(); ++k)
      for (const int direction : {-1, 1}) {
        const Point point = found_[i].point;
        const Knob& knob = knobs_[k];
        const auto place = static_cast<std::ptrdiff_t>(knob.place_of(point[k])) + direction;
        if (place < 0 || place >= static_cast<std::ptrdiff_t>(knob.order.size())) continue;
        Point other = point;
        other[k] = knob.order[static_cast<std::size_t>(place)];
        if (makes_a_difference(k)) add(other);
      }
  return points;
}

/// Single keys that were cut off, again, now that there is time for them; the quickest first.
bool Search::slower_ones() {
  std::vector<std::pair<double, Point>> slower;
  for (const Found& found : found_)
    if (found.row.slower && found.row.changed.size() == 1)
      slower.emplace_back(found.row.seconds, found.point);
  for (const Point& point : unfair_) slower.emplace_back(0, point);
  std::ranges::sort(slower);
  generous_ = true;
  for (const auto& [seconds, point] : slower)
    if (!measure({point})) return false;
  generous_ = false;
  return true;
}

/// Whether some step of the knob alone has made one that can be told.
bool Search::makes_a_difference(std::size_t knob) const {
  const CostRow& base = at(own())->row;
  return std::ranges::any_of(knobs_[knob].order, [&](std::size_t step) {
    Point single = own();
    single[knob] = step;
    const Found* alone = at(single);
    return alone && counts(alone->row) && differ(alone->row, base);
  });
}

bool Search::differ(const CostRow& a, const CostRow& b) const {
  return a.hash != b.hash && (std::abs(a.phi - b.phi) > phi_step() ||
                              std::abs(logarithm(a.seconds) - logarithm(b.seconds)) > telling_share);
}

bool Search::combinations() {
  while (found_.size() < options_.most_settings) {
    std::vector<Point> points = promising();
    if (points.empty()) points = between_front();
    if (points.empty()) return true;
    if (!measure(points)) return false;
  }
  capped_ = true;
  return true;
}

}  // namespace bernal::cost
