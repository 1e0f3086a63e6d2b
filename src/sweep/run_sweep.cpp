#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstring>
#include <deque>
#include <fstream>
#include <string>
#include <thread>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "bernal/result/write_packing.hpp"
#include "bernal/sweep/sweep.hpp"
#include "core/parallel.hpp"
#include "sweep/cell_folder.hpp"
#include "sweep/check_cells.hpp"
#include "sweep/children.hpp"
#include "sweep/claim.hpp"
#include "sweep/results.hpp"

namespace fs = std::filesystem;

namespace bernal {
namespace {

constexpr std::chrono::milliseconds between_looks(5);
constexpr double patience = 20;  ///< seconds that a process has to end once it is told to

/// That other programs leave; 0 where the system does not tell.
double free_memory() {
  std::ifstream in("/proc/meminfo");
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("MemAvailable:")) return 1024 * std::strtod(line.c_str() + 13, nullptr);
  return 0;
}

std::string about(double seconds) {
  if (seconds < 100) return fmt::format("about {:.0f} s", std::max(1.0, seconds));
  if (seconds < 6000) return fmt::format("about {:.0f} min", seconds / 60);
  return fmt::format("about {:.0f} h", seconds / 3600);
}

/// How all cells stand, in threads, as of each the spheres are read.
void look_at_all(std::vector<SweepRow>& rows, const fs::path& folder) {
  parallel_for(rows.size(), [&](std::size_t k) { rows[k].result = read_cell(folder, rows[k].cell_hash); });
}

/// The queue of a call, and who works it off.
class Pool {
 public:
  Pool(const Sweep& sweep, const fs::path& folder, const SweepOptions& options, sweep::CheckedCells checked)
      : folder_(folder), options_(options), results_(sweep, folder, options.plot) {
    report_.rows = std::move(checked.rows);
    look_at_all(report_.rows, folder_);
    for (std::size_t k = 0; k < report_.rows.size(); ++k) {
      if (!is_to_be_run(k)) continue;
      sweep::require_no_links(folder_, row(k).cell_hash);
      if (row(k).result.state == CellResult::State::missing && !row(k).result.reason.empty())
        (row(k).result.program.version.empty() ? report_.distrusted : report_.outdated).push_back(row(k));
      queue_.push_back(k);
    }
    share_machine(checked.most_memory);
  }

  SweepReport run() {
    write();
    total_ = queue_.size();
    Stopwatch told;
    while (!queue_.empty() || children_.size() > 0 || !elsewhere_.empty()) {
      if (options_.monitor.stop() && !report_.cancelled) {
        report_.cancelled = true;
        queue_.clear();
        elsewhere_.clear();
        children_.tell_to_stop();
        told = Stopwatch();
      }
      if (report_.cancelled && told.seconds() > patience) children_.kill_after(0);
      if (options_.seconds && !report_.cancelled) children_.kill_after(2 * *options_.seconds + 120);
      fill();
      bool news = false;
      for (const sweep::Children::Ended& ended : children_.ended()) {
        take(ended);
        news = true;
      }
      look_elsewhere();
      tell();
      if (news && since_written_.seconds() > next_write_) write();
      std::this_thread::sleep_for(between_looks);
    }
    look_again();
    write();
    for (const SweepRow& row : report_.rows) sweep::tidy_cell(folder_, row.cell_hash);
    if (options_.write) report_.files = results_.files();
    return std::move(report_);
  }

 private:
  SweepRow& row(std::size_t k) { return report_.rows[k]; }
  void look_at(std::size_t k) { row(k).result = read_cell(folder_, row(k).cell_hash); }
  bool is_to_be_run(std::size_t k) {
    return sweep::is_to_be_run(row(k).result, options_.seconds, options_.retry);
  }
  bool is_claimed(std::size_t k) {
    return sweep::is_claimed(sweep::claim_of_cell(folder_, row(k).cell_hash));
  }

  void share_machine(double memory) {
    const int machine = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    const int wanted = std::max<int>(1, static_cast<int>(std::min<std::size_t>(queue_.size(), 1024)));
    report_.jobs = options_.jobs;
    if (report_.jobs <= 0) {
      report_.jobs =
          std::min(options_.threads > 0 ? std::max(1, machine / options_.threads) : machine, wanted);
      const double free = free_memory();
      if (memory > 0 && free > 0)
        report_.jobs = std::clamp(static_cast<int>(std::min(1e3, 0.9 * free / memory)), 1, report_.jobs);
    }
    report_.threads = options_.threads > 0 ? options_.threads : std::max(1, machine / report_.jobs);
  }

  void fill() {
    while (!queue_.empty() && children_.size() < static_cast<std::size_t>(report_.jobs)) {
      const std::size_t k = queue_.front();
      queue_.pop_front();
      look_at(k);  // another call may have done it meanwhile
      if (!is_to_be_run(k)) continue;
      if (is_claimed(k)) {
        elsewhere_.push_back(k);
        continue;
      }
      if (!children_.start(k, options_.call(row(k).number, report_.threads))) {
        queue_.push_front(k);
        if (children_.size() == 0)
          throw Error(ErrorCode::bad_argument,
                      "the system has no room for another process; give fewer ‹jobs›");
        return;
      }
      row(k).result = {};
    }
  }

  void take(const sweep::Children::Ended& ended) {
    const bool is_left = ended.signal == 0 && ended.code == exit_code_left_to_another;
    // Asked before it is looked at: whoever has let go since has left what he did.
    const bool is_elsewhere = is_claimed(ended.of);
    look_at(ended.of);
    const CellResult& result = row(ended.of).result;
    const bool is_known = result.state == CellResult::State::crashed ||
                          result.state == CellResult::State::refused || !is_to_be_run(ended.of);
    if (!is_known) {
      if (report_.cancelled || options_.monitor.stop()) return;
      if (is_left || is_elsewhere) {
        elsewhere_.push_back(ended.of);
        return;
      }
      crashed(ended);
    } else if (is_left || ended.signal != 0) {
      return;  // it was another who did it
    }
    ++report_.ran;
  }

  /// What other calls have done since, of cells whose processes have crashed here.
  void look_again() {
    for (SweepRow& row : report_.rows) {
      if (row.result.state != CellResult::State::crashed && row.result.state != CellResult::State::missing)
        continue;
      const CellResult now = read_cell(folder_, row.cell_hash);
      if (now.state == CellResult::State::packed || now.state == CellResult::State::refused) row.result = now;
    }
  }

  void crashed(const sweep::Children::Ended& ended) {
    const std::string said =
        ended.last_line.empty()
            ? ""
            : ": " + plain_text(ended.last_line.substr(ended.last_line.starts_with("bernal: ") ? 8 : 0), 500);
    std::string why = fmt::format("its process ended with exit code {}{}", ended.code, said);
    if (ended.signal != 0)
      why = fmt::format("killed by signal {} ({}){}{}", ended.signal, strsignal(ended.signal),
                        ended.signal == SIGKILL ? ", as the system does where memory is short" : "", said);
    const int exit_code = ended.signal != 0 ? 128 + ended.signal : ended.code;
    CellResult& result = row(ended.of).result;
    result.state = CellResult::State::crashed;
    result.outcome = "crashed";
    result.exit_code = exit_code == 0 ? 3 : exit_code;
    result.reason = why;
    try {
      sweep::write_failure(folder_, row(ended.of).cell_hash, {.exit_code = *result.exit_code, .reason = why});
    } catch (const Error&) {  // a full disk: the table still has it
    }
  }

  void look_elsewhere() {
    if (elsewhere_.empty() || since_looked_.seconds() < 0.5) return;
    since_looked_ = Stopwatch();
    std::erase_if(elsewhere_, [&](std::size_t k) {
      if (is_claimed(k)) return false;
      look_at(k);
      if (is_to_be_run(k)) queue_.push_back(k);
      return true;
    });
  }

  void tell() {
    constexpr double between_words = 0.1;
    if (since_told_.seconds() < between_words) return;
    since_told_ = Stopwatch();
    const std::size_t left = queue_.size() + children_.size() + elsewhere_.size();
    std::size_t done = 0, short_of_it = 0;
    for (const SweepRow& r : report_.rows) {
      done += r.result.is_done();
      short_of_it += r.result.exit_code && !r.result.is_done();
    }
    const double elapsed = watch_.seconds();
    const auto ended = static_cast<double>(total_ - std::min(total_, left));
    const std::string to_go =
        ended > 0 ? fmt::format(", {} to go", about(elapsed / ended * static_cast<double>(left))) : "";
    const std::string detail = fmt::format("{} done, {} short of it, {} left{}", grouped(done),
                                           grouped(short_of_it), grouped(left), to_go);
    const auto all = static_cast<double>(report_.rows.size());
    options_.monitor.report(
        {report_.cancelled ? "stop" : "sweep", (all - static_cast<double>(left)) / all, detail});
  }

  void write() {
    if (!options_.write) return;
    const Stopwatch watch;
    results_.write(report_.rows);
    next_write_ = std::max(1.0, 50 * watch.seconds());
    since_written_ = Stopwatch();
  }

  const fs::path& folder_;
  const SweepOptions& options_;
  sweep::ResultFiles results_;
  SweepReport report_;
  std::deque<std::size_t> queue_;
  std::vector<std::size_t> elsewhere_;  ///< other processes are at them
  sweep::Children children_;
  std::size_t total_ = 0;
  Stopwatch watch_, since_written_, since_looked_, since_told_;
  double next_write_ = 1;  ///< seconds
};

}  // namespace

bool SweepReport::is_done() const {
  return std::ranges::all_of(rows, [](const SweepRow& row) { return row.result.is_done(); });
}

SweepReport run_sweep(const Sweep& sweep, const fs::path& folder, const SweepOptions& options) {
  check_writable(folder);
  sweep::CheckedCells checked;
  try {
    checked = sweep::check_cells(sweep, options.first, options.last, true, options.monitor);
  } catch (const Cancelled&) {
    SweepReport stopped;
    stopped.cancelled = true;
    return stopped;
  }
  return Pool(sweep, folder, options, std::move(checked)).run();
}

SweepReport collect_sweep(const Sweep& sweep, const fs::path& folder, const SweepOptions& options) {
  SweepReport report;
  try {
    report.rows = sweep::check_cells(sweep, options.first, options.last, false, options.monitor).rows;
  } catch (const Cancelled&) {
    report.cancelled = true;
    return report;
  }
  look_at_all(report.rows, folder);
  if (!options.write) return report;
  sweep::ResultFiles results(sweep, folder, options.plot);
  results.write(report.rows);
  report.files = results.files();
  return report;
}

}  // namespace bernal
