#include <new>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/result/write_packing.hpp"
#include "bernal/run/run.hpp"
#include "sweep/cell_folder.hpp"
#include "sweep/claim.hpp"

namespace fs = std::filesystem;

namespace bernal {
namespace {

/// What `bernal pack` does; nothing is written of what the caller's monitor has stopped.
void pack_cell(const Cell& cell, const fs::path& folder, const CellOptions& options) {
  const WriteOptions write{
      .view = options.view, .monitor = options.monitor, .all_or_nothing = true, .cell = cell.hash};
  const Plan plan = build(cell.scene);
  check_writable(folder, cell.scene, write);
  const Stopwatch watch;
  Monitor monitor = options.monitor;
  monitor.cancelled = [&] {
    return options.monitor.stop() || (options.seconds && watch.seconds() > *options.seconds);
  };
  Packing packing = run(plan, {.seed = {}, .threads = options.threads, .monitor = monitor});
  if (options.monitor.stop()) throw Cancelled();
  if (packing.outcome == Outcome::cancelled)
    packing.reason =
        fmt::format("the {:.3g} s that the sweep gives a cell were over", options.seconds.value_or(0));
  write_packing(packing, folder, write);
}

}  // namespace

bool run_cell(const Cell& cell, const fs::path& folder, const CellOptions& options) {
  sweep::require_no_links(folder, cell.hash);
  const sweep::Claim claim(sweep::claim_of_cell(folder, cell.hash));
  if (!claim.is_ours()) return false;
  // Whoever had the claim before may have just done it.
  if (!sweep::is_to_be_run(read_cell(folder, cell.hash), options.seconds, options.retry)) return false;
  sweep::remove_failure(folder, cell.hash);
  const auto keep = [&](CellResult::State state, const std::string& reason) {
    sweep::write_failure(folder, cell.hash, {.state = state, .exit_code = 2, .reason = reason});
  };
  try {
    pack_cell(cell, folder / folder_of_cell(cell.hash), options);
    sweep::remove_failure(folder, cell.hash);
  } catch (const std::bad_alloc&) {
    keep(CellResult::State::crashed, "out of memory");
    throw;
  } catch (const Error& error) {
    // What the disk or the folder is to blame for may be mended.
    const bool may_pass = error.code() == ErrorCode::cannot_write;
    keep(may_pass ? CellResult::State::crashed : CellResult::State::refused, error.what());
    throw;
  }
  return true;
}

}  // namespace bernal
