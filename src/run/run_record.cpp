#include "run/run_record.hpp"

#include <cstdint>
#include <vector>

namespace bernal {

void RunRecord::conclude() {
  if (const Effect asked = asked_of_walls(); asked.calls > 0) effects_["walls"] += asked;
  packing_.effects = effects_.all();
}

void RunRecord::archive(Archive& a, Reporter* report) {
  std::vector<Effect> effects = effects_.all_so_far();
  Effect asked = asked_of_walls();
  double so_far = seconds();
  std::uint64_t streams = report ? report->streams_used : 0;
  a(effects, asked, packing_.history, packing_.resumed, so_far, streams);
  if (!a.reads()) return;
  effects_.go_on_from(effects);
  asked_before_ = asked;
  asked_anew_ = walls_ ? walls_->asked() : Effect{};
  if (!report) return;  // all of it comes again
  report->streams_used = streams;
  ++packing_.resumed;
  seconds_before_ = so_far - watch_.seconds();
}

/// So far, but for what is asked until a run goes on, which was asked before.
Effect RunRecord::asked_of_walls() const {
  Effect asked = walls_ ? walls_->asked() : Effect{};
  asked.name = "walls";
  asked.calls += asked_before_.calls - asked_anew_.calls;
  asked.seconds += asked_before_.seconds - asked_anew_.seconds;
  return asked;
}

}  // namespace bernal
