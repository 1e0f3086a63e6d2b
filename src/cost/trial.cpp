#include "cost/trial.hpp"

#include <malloc.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <fstream>
#include <ranges>
#include <thread>

#include "bernal/measure/measure.hpp"
#include "bernal/run/run.hpp"
#include "bernal/verify/certificate.hpp"

namespace bernal::cost {
namespace {

/// Of /proc/self/status, in bytes.
std::optional<double> status_of_process(std::string_view name) {
  std::ifstream status("/proc/self/status");
  for (std::string key; status >> key;) {
    double kibibytes = 0;
    if (key == name && status >> kibibytes) return 1024 * kibibytes;
    status.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  }
  return {};
}

/// The peak of this process's memory from now on, beyond what it has now.
class PeakMemory {
 public:
  PeakMemory() {
    malloc_trim(0);  // what earlier runs have freed would hide what this one takes
    std::ofstream reset("/proc/self/clear_refs");
    if (reset << "5" << std::flush) before_ = status_of_process("VmRSS:");
  }
  std::optional<double> bytes() const {
    const std::optional<double> peak = status_of_process("VmHWM:");
    if (!before_ || !peak) return {};
    return std::max(0.0, *peak - *before_);
  }

 private:
  std::optional<double> before_;
};

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

/// Seconds that all threads of this process have computed, and children that have ended.
double processor_seconds() {
  rusage own{}, children{};
  getrusage(RUSAGE_SELF, &own);
  getrusage(RUSAGE_CHILDREN, &children);
  return seconds_of(own.ru_utime) + seconds_of(own.ru_stime) + seconds_of(children.ru_utime) +
         seconds_of(children.ru_stime);
}

double early_overlap_of(const Packing& packing) {
  for (const Milestone& milestone : packing.history | std::views::reverse)
    if (milestone.max_overlap > 0) return milestone.max_overlap;
  return 0;
}

void certify_trial(Trial& trial, const Packing& packing, const TrialOptions& options) {
  // More than the machine has would be told by the library of threads, on the terminal.
  const int threads = std::min(options.threads, static_cast<int>(std::thread::hardware_concurrency()));
  const auto certified_in = [&](const Domain& domain) {
    return certify(packing.spheres, domain,
                   {.allowed_overlap = packing.scene.overlap,
                    .gap = packing.scene.gap,
                    .wall_gap = packing.scene.wall_gap,
                    .threads = threads});
  };
  const Certificate own = certified_in(packing.domain);
  const Certificate meant = options.meant ? certified_in(*options.meant) : own;
  trial.certified = own.certified;
  trial.max_overlap = std::max(0.0, own.max_overlap);
  if (meant.worst_wall) trial.wall_gap = meant.min_wall_gap;
  trial.protrusion = std::max(0.0, -meant.min_wall_gap);
  trial.size_scale = packing.size_scale;
  trial.packed_fraction = packing.packing_fraction();
  trial.packing_fraction =
      packing_fraction(packing.spheres, options.meant ? *options.meant : packing.domain) *
      std::pow((1 - trial.max_overlap) / trial.size_scale, packing.spheres.dimension());
}

void count_contacts(Trial& trial, const Packing& packing) {
  const double usual = MeasureOptions().contact_gap;
  std::vector<double> gaps = MeasureOptions().gaps;
  std::ranges::sort(gaps);
  gaps.push_back(usual);
  const std::vector<Contacts> by_gap = measure_contacts_across(
      packing.scene.gap, packing.scene.wall_gap, packing.spheres, packing.domain, gaps, packing.container);
  trial.coordination = by_gap.back().coordination;
  for (const Contacts& contacts : by_gap | std::views::take(gaps.size() - 1)) {
    if (contacts.contact_gap < trial.max_overlap) continue;
    if (2 * contacts.rattlers > packing.spheres.size()) continue;
    trial.held_from = contacts.contact_gap;
    trial.rattlers = contacts.rattlers;
    if (contacts.isostatic && *contacts.isostatic > 0)
      trial.contact_ratio =
          static_cast<double>(contacts.backbone_contacts()) / static_cast<double>(*contacts.isostatic);
    return;
  }
}

}  // namespace

Trial run_trial(const Scene& scene, const TrialOptions& options) {
  Trial trial;
  trial.seed = options.seed;
  const Stopwatch watch;
  const Plan plan = build(scene);
  trial.prepare_seconds = watch.seconds();

  Monitor monitor = options.monitor;
  std::atomic<bool> too_long = false;  // loops in threads ask, too
  monitor.cancelled = [&] {
    if (watch.seconds() > options.limit) too_long = true;
    return too_long || options.monitor.stop();
  };
  const PeakMemory memory;
  const double before = processor_seconds();
  const Packing packing = run(plan, {options.seed, options.threads, monitor});
  trial.cpu_seconds = processor_seconds() - before;
  trial.peak_bytes = memory.bytes();
  trial.seconds = packing.seconds;
  trial.threads = packing.threads;
  trial.outcome = packing.outcome;
  trial.reason = packing.reason;
  trial.cut_off = too_long && packing.outcome == Outcome::cancelled;
  trial.spheres = packing.spheres.size();
  trial.effects = packing.effects;
  trial.early_overlap = early_overlap_of(packing);
  trial.hash = hash_of(packing.spheres);
  if (packing.outcome == Outcome::cancelled || packing.spheres.empty()) return trial;
  certify_trial(trial, packing, options);
  count_contacts(trial, packing);
  return trial;
}

}  // namespace bernal::cost
