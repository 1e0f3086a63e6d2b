#include "figures/packings.hpp"

#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <ctime>
#include <mutex>
#include <numeric>
#include <thread>
#include <utility>

#include "bernal/core/error.hpp"
#include "bernal/measure/contacts.hpp"
#include "bernal/run/run.hpp"
#include "bernal/verify/certificate.hpp"
#include "core/parallel.hpp"

namespace bernal::figures {
namespace {

/// What all tasks together have done, told by whichever thread has news.
class SharedProgress {
 public:
  SharedProgress(const std::vector<PackingTask>& tasks, std::string_view figure, const Monitor& monitor)
      : tasks_(tasks), done_(tasks.size(), 0), figure_(figure), monitor_(monitor) {
    for (const PackingTask& task : tasks) total_ += task.cost;
  }

  Monitor of(std::size_t task) {
    return {[this, task](const Progress& progress) { tell(task, progress.fraction, progress.detail); },
            monitor_.cancelled};
  }
  void finished(std::size_t task) { tell(task, 1, {}); }

 private:
  void tell(std::size_t task, double fraction, std::string_view detail) {
    const std::lock_guard lock(mutex_);
    done_[task] = std::max(done_[task], std::clamp(fraction, 0.0, 1.0));
    double sum = 0;
    for (std::size_t k = 0; k < tasks_.size(); ++k) sum += done_[k] * tasks_[k].cost;
    monitor_.report({figure_, sum / total_, detail});
  }

  const std::vector<PackingTask>& tasks_;
  std::vector<double> done_;
  std::string_view figure_;
  const Monitor& monitor_;
  double total_ = 0;
  std::mutex mutex_;
};

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

DonePacking packed(const Scene& scene, const Monitor& monitor, int threads) {
  DonePacking done;
  const double before = thread_seconds();
  done.packing = run(build(scene), {{}, threads, monitor});
  done.seconds = thread_seconds() - before;
  const Packing& packing = done.packing;
  if (packing.outcome == Outcome::cancelled) throw Cancelled();
  if (!certify(packing.spheres, packing.domain, {.allowed_overlap = scene.overlap}).certified)
    throw Error(ErrorCode::bad_argument, "a packing for the figure is not certified");
  done.phi = packing.packing_fraction();
  for (const Contacts& contacts : measure_contacts(packing.spheres, packing.domain, counted_gaps))
    done.coordination.push_back(contacts.coordination);
  return done;
}

}  // namespace

std::optional<std::vector<DonePacking>> pack_all(const std::vector<PackingTask>& tasks,
                                                 std::string_view figure, const FigureOptions& options) {
  std::vector<DonePacking> done(tasks.size());
  SharedProgress progress(tasks, figure, options.monitor);
  const auto do_one = [&](std::size_t k, int threads) {
    done[k] = packed(tasks[k].scene, progress.of(k), threads);
    progress.finished(k);
  };

  std::vector<std::size_t> order(tasks.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
    return std::pair(tasks[a].alone, -tasks[a].cost) < std::pair(tasks[b].alone, -tasks[b].cost);
  });
  const auto first_alone = std::ranges::find_if(order, [&](std::size_t k) { return tasks[k].alone; });
  const auto beside = static_cast<std::size_t>(first_alone - order.begin());
  try {
    const Interruptible listening(options.monitor);
    // Each thread takes the next of the tasks. While it waits for a loop inside of one it takes no other: the
    // seconds of a packing are its own.
    std::atomic<std::size_t> next = 0;
    parallel_for(std::max(1u, std::thread::hardware_concurrency()), [&](std::size_t) {
      for (std::size_t k = next++; k < beside; k = next++)
        oneapi::tbb::this_task_arena::isolate([&] { do_one(order[k], 0); });
    });
    for (auto k = first_alone; k != order.end(); ++k) do_one(*k, 1);
  } catch (const Cancelled&) {
    return std::nullopt;
  }
  return done;
}

}  // namespace bernal::figures
