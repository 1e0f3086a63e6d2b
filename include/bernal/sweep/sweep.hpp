#pragma once
#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bernal/core/monitor.hpp"
#include "bernal/scene/scene.hpp"
#include "bernal/version.hpp"

namespace bernal {

/// One of the scenes that a sweep asks for.
struct Cell {
  std::size_t number = 1;           ///< from 1 on, in the order of the sweep
  std::vector<std::string> values;  ///< of the swept keys, in their order; "" where its case does not say one
  Scene scene;                      ///< whole
  /// 16 hexadecimal digits: the beginning of the SHA-256 of the scene as TOML, every default and the seed
  /// included, with the SHA-256 of the CAD files and of the start in the place of their names. What is called
  /// the same is the same packing, whatever sweep asks for it and wherever its files lie.
  std::string hash;
};

/// A file that asks for many scenes: one that stands in a file of its own (`scene = "bed.toml"`) or in the
/// sweep ([scene]), and what becomes of its keys. Every way to take one value for each key of [grid] and one
/// of the tables [[case]] is a cell, and each of these runs `repeats` times with seeds of its own.
///
///   scene = "bed.toml"
///   repeats = 5                                    # seeds: that of the scene and those that follow it
///   [grid]
///   spheres.diameter.sigma = [0.1, 0.2, 0.3]       # any key of a scene, any list of values
///   "stage[0].alpha" = { from = 2, to = 32, count = 5, scale = "log" }
///   [[case]]                                       # keys that change together
///   container.radius = 5
///   container.height = 20
///
/// Cells are counted from 1, cases first, then the keys of the grid in the order of the file, the last of
/// them the fastest. A file that the sweep names is meant beside the sweep. Copies share what was read; no
/// two threads may ask the same sweep.
class Sweep {
 public:
  /// Reads and checks what the sweep itself says; a cell's scene is read when it is asked for. Throws
  /// Error{bad_scene} with file, line and remedy, also for more than a million cells.
  static Sweep read(const std::filesystem::path& file);

  const std::filesystem::path& file() const;
  /// "spheres.diameter.sigma", "seed": cases first, then the grid.
  const std::vector<std::string>& keys() const;
  std::size_t size() const;
  /// Of the sweep's file and of the scene's, as they were read: 16 hexadecimal digits.
  const std::string& digest() const;
  /// By its number. Throws Error{bad_scene} where its scene is none, with the place of what is wrong, in the
  /// sweep or in the scene, and Error{bad_mesh} where a file that it names cannot be read. Cost: that of
  /// reading a scene, and reading every CAD file once.
  Cell cell(std::size_t number) const;

 private:
  struct Read;
  std::shared_ptr<Read> read_;
};

/// How a cell of a sweep stands in its folder.
struct CellResult {
  enum class State {
    missing,  ///< nothing is known; or report and files are not as they were written, or of other packings
    packed,   ///< the folder holds a packing, whether or not it is what was asked for
    refused,  ///< bad input, which only shows when it is run: a part that is no container
    crashed,  ///< a signal ended it, memory or the disk were full: the next call tries again
  };
  State state = State::missing;
  /// Of a packing as the report has it, "converged", "full", …; else "refused", "crashed" or "missing".
  std::string outcome = "missing";
  std::optional<int> exit_code;  ///< that `bernal pack` has for it; 128 + signal; none where it is missing
  std::string reason;            ///< one sentence
  // Of a packing; see report.json.
  std::optional<std::size_t> n, rattlers;
  std::optional<double> phi, coordination, max_overlap, min_wall_gap, seconds, peak_memory_bytes;
  std::optional<bool> certified;
  std::string hash;
  Program program;  ///< that packed it; of a missing cell, that of other packings which had

  bool is_done() const { return exit_code == 0; }
};

/// A cell and how it stands.
struct SweepRow {
  std::size_t number = 0;
  std::vector<std::string> values;
  std::string cell_hash;
  CellResult result;
};

/// Where a cell's result stands in the folder of a sweep: "cells/3f9a…".
std::filesystem::path folder_of_cell(const std::string& hash);

/// What stands there. A packing does where a bernal of our packings number made it, nobody has changed its
/// report, and its scene and its spheres are those that it describes; else the cell is missing, and the
/// reason says why. Changes nothing. Cost: reading the report and the spheres, about 0.25 µs each.
CellResult read_cell(const std::filesystem::path& folder, const std::string& hash);

struct CellOptions {
  int threads = 0;                ///< 0: as many as the machine has
  std::optional<double> seconds;  ///< it ends then, with what it has, as `cancelled`
  bool view = false;              ///< report.html has a view to turn
  bool retry = false;             ///< what was refused runs again, too
  Monitor monitor = {};
};

/// Runs one cell in this process and writes its folder, whole or not at all, as `bernal pack` does. What the
/// cell's own input is to blame for is kept there (`failed.toml`) and thrown on; nothing is kept of what was
/// stopped by its monitor. Returns false, at once, where another process is at the same cell or has done it.
bool run_cell(const Cell& cell, const std::filesystem::path& folder, const CellOptions& options);

/// Exit code of a process for one cell that has left it to another.
inline constexpr int exit_code_left_to_another = 4;

struct SweepOptions {
  /// What runs one cell as a process of its own: program and arguments, without a shell. It must do
  /// `run_cell`, end with `exit_code_left_to_another` where that says false and soon after SIGTERM, and say
  /// in its last line on standard error why it failed.
  std::function<std::vector<std::string>(std::size_t cell, int threads)> call = {};
  int jobs = 0;     ///< that run at a time; 0: as many as the machine has threads and memory for
  int threads = 0;  ///< of each; 0: the machine's, divided by the jobs
  std::optional<double> seconds;  ///< of a cell; one that was stopped at fewer runs again
  bool retry = false;             ///< what was refused runs again, too
  std::size_t first = 1, last = static_cast<std::size_t>(-1);  ///< only these cells
  bool write = true;                                           ///< results.csv and results.svg, as cells end
  std::string plot;  ///< "x,y" or "x,y,colour": columns of results.csv; empty: see `sweep_svg`
  Monitor monitor = {};
};

struct SweepReport {
  std::vector<SweepRow> rows;
  int jobs = 0, threads = 0;
  std::size_t ran = 0;  ///< cells of this call's processes; of several calls each cell counts in one
  std::vector<SweepRow> distrusted;  ///< that were there and not as they were written, which the reason says
  std::vector<SweepRow> outdated;    ///< that a bernal of other packings had made, which the reason says
  bool cancelled = false;
  std::vector<std::filesystem::path> files;

  /// Whether every cell reached what it was asked for.
  bool is_done() const;
};

/// Checks all cells that are asked for before anything runs: reads every scene, and builds (see `build`) the
/// first that has a value, of every value of every key but seeds, where the container is a CAD file the first
/// with that container. Then runs those that are missing, crashed, or were stopped at fewer seconds than now,
/// in processes of their own, so that none of them takes another along. Any number of calls may work in one
/// folder at a time: who has claimed a cell by a lock has it, and what a dead process had claimed is free.
///
/// Once the monitor says stop, the processes are told so and waited for. Throws as `Sweep::cell` and `build`,
/// Error{bad_scene} where two cells are the same, and Error{cannot_write}.
SweepReport run_sweep(const Sweep& sweep, const std::filesystem::path& folder, const SweepOptions& options);

/// The same without running anything: how the cells stand. `write` and `plot` as above.
SweepReport collect_sweep(const Sweep& sweep, const std::filesystem::path& folder,
                          const SweepOptions& options);

/// A row a cell: number, the swept keys, folder, how it ended, what was measured.
std::string sweep_csv(const Sweep& sweep, const std::vector<SweepRow>& rows);

/// Two columns of that table over each other, and a third as colour. Without a choice: the first key with
/// several numbers but seeds, the packing fraction, the next key with two to eight values. Throws
/// Error{bad_argument} with the nearest name for a column that there is not.
std::string sweep_svg(const Sweep& sweep, const std::vector<SweepRow>& rows, const std::string& plot = {});

struct SlurmOptions {
  std::vector<std::string> call;     ///< what runs the cells `FIRST-LAST` that the script puts behind it
  std::vector<std::string> collect;  ///< what makes the table in the end
  int jobs = 0;                      ///< tasks that run at a time; 0: as many as the cluster lets
  int threads = 1;
  std::optional<double> seconds;  ///< of a cell
};

/// Writes `sweep.sbatch` into the folder, a job array of at most 1,000 tasks over the cells, and returns its
/// path. Memory is asked for as the plans expect it, time where `seconds` are given. Checks as `run_sweep`
/// does. Throws Error{cannot_write}, also where somebody else wrote or changed a file of that name.
std::filesystem::path write_slurm_script(const Sweep& sweep, const std::filesystem::path& folder,
                                         const SlurmOptions& options);

}  // namespace bernal
