#pragma once
#include <map>
#include <set>
#include <string>
#include <vector>

#include "bernal/cost/cost.hpp"
#include "cost/knobs.hpp"

namespace bernal::cost {

/// For each knob the step at which it stands.
using Point = std::vector<std::size_t>;

/// The settings of a scene that have been measured, and the way from one to the next.
class Search {
 public:
  Search(Subject subject, std::vector<Knob> knobs, TrialRecord& record, const CostOptions& options);

  /// Measures until the time is over, the monitor stops it, or nothing is left to try.
  void go();

  /// What is known, in the order in which it was measured.
  struct Found {
    Point point;
    CostRow row;
  };
  const std::vector<Found>& found() const { return found_; }
  const std::vector<Knob>& knobs() const { return knobs_; }
  const Subject& subject() const { return subject_; }
  const Found* at(const Point& point) const;
  Point own() const;
  /// The scene of a setting.
  Setting setting_of(const Point& point) const;
  /// See `CostReport::phi_step`.
  double phi_step() const;
  /// Whether another setting gives the same spheres with fewer changes, or with as many and quicker.
  bool repeats(const Found& found) const;
  /// Settings that cannot be run, and why.
  const std::map<Point, std::string>& refused() const { return refused_; }
  /// Whether it may be on the front.
  bool counts(const CostRow& row) const;

  bool cancelled() const { return cancelled_; }
  bool complete() const { return complete_; }
  bool capped() const { return capped_; }  ///< the most settings were tried
  std::size_t runs_made() const { return made_; }

 private:
  void warm_up();
  void turn_limits();  ///< too, once it is known that the scene ends at one. Precondition: no more is known
  bool measure(const std::vector<Point>& points);  ///< false once there is nothing more to be measured
  bool one_at_a_time();                            ///< true where nothing is left; so the next one
  bool combinations();
  bool slower_ones();
  bool makes_a_difference(std::size_t knob) const;
  bool differ(const CostRow&, const CostRow&) const;
  std::vector<Point> promising() const;
  std::vector<Point> between_front();
  std::vector<std::size_t> points_of_front() const;
  double left() const { return options_.seconds - watch_.seconds(); }

  const Stopwatch watch_;
  Subject subject_;
  std::vector<Knob> knobs_, limits_;
  TrialRecord& record_;
  CostOptions options_;
  std::vector<std::uint64_t> seeds_;
  std::vector<Found> found_;
  std::map<Point, std::size_t> index_;
  std::set<Point> tried_;   // those that cannot be run, too
  std::set<Point> unfair_;  // had no fair try yet
  std::map<Point, std::string> refused_;
  std::string phase_;
  bool generous_ = false;  ///< a run may take half of the time that is left
  double budget_end_ = 0;  ///< seconds at which the part of the search that is on ends
  std::size_t made_ = 0;
  bool cancelled_ = false, complete_ = false, capped_ = false;
};

}  // namespace bernal::cost
