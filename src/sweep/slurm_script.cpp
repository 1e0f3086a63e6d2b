#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/result/write_packing.hpp"
#include "bernal/sweep/sweep.hpp"
#include "files/bytes_of_file.hpp"
#include "files/seal.hpp"
#include "files/staged_folder.hpp"
#include "sweep/cell_folder.hpp"
#include "sweep/check_cells.hpp"

namespace fs = std::filesystem;

namespace bernal {
namespace {

constexpr const char* script_name = "sweep.sbatch";
/// Slurm's own limit on the tasks of an array is 1,001, unless its administrator has set another.
constexpr std::size_t most_tasks = 1000;
constexpr const char* logs_name = "slurm";

/// A word of a shell.
std::string quoted(const std::string& word) {
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

std::string shell_line(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) {
    if (!line.empty()) line += ' ';
    line += quoted(word);
  }
  return line;
}

/// Days-hours:minutes:seconds, as Slurm has it.
std::string slurm_time(double seconds) {
  const auto all = static_cast<std::int64_t>(std::ceil(seconds));
  return fmt::format("{}-{:02}:{:02}:{:02}", all / 86400, all / 3600 % 24, all / 60 % 60, all % 60);
}

void require_plain(const fs::path& folder) {
  for (const char c : folder.string())
    if (static_cast<unsigned char>(c) < 0x20 || c == '%' || c == '\\' || c == '"')
      throw Error(
          ErrorCode::bad_argument,
          "Slurm takes no folder with control characters, %, \\ or \" in its name; give another ‹folder›",
          {folder.string()});
}

}  // namespace

fs::path write_slurm_script(const Sweep& sweep, const fs::path& folder, const SlurmOptions& options) {
  const fs::path there = fs::absolute(folder).lexically_normal();
  require_plain(there);
  check_writable(folder);
  const fs::path file = folder / script_name;
  if (stands(file) && !is_sealed(bytes_of_file(file)))
    throw Error(
        ErrorCode::cannot_write,
        "is not as bernal sweep wrote it, and would be replaced; remove it, or give another ‹folder›",
        {file.string()});
  const sweep::CheckedCells checked = sweep::check_cells(sweep, 1, sweep.size(), true, {});

  const std::size_t cells = sweep.size(), a_task = (cells + most_tasks - 1) / most_tasks;
  const std::size_t tasks = (cells + a_task - 1) / a_task;
  std::string script = fmt::format(
      "#!/bin/bash\n"
      "# {} cell{} of {}, {} a task: sbatch {}\n"
      "# Then, or meanwhile: {}\n"
      "#SBATCH --job-name=bernal-sweep\n"
      "#SBATCH --array=1-{}{}\n"
      "#SBATCH --nodes=1\n#SBATCH --ntasks=1\n"
      "#SBATCH --cpus-per-task={}\n"
      "#SBATCH --output=\"{}/{}/%A_%a.log\"\n",
      cells, cells == 1 ? "" : "s", quoted(fs::absolute(sweep.file()).lexically_normal().string()), a_task,
      quoted((there / script_name).string()), shell_line(options.collect), tasks,
      options.jobs > 0 ? fmt::format("%{}", options.jobs) : "", options.threads, there.string(), logs_name);
  // Plans are right within a factor of two three times in four; the rest is for what measures and writes.
  constexpr double room = 3, least = 512;
  script +=
      fmt::format("#SBATCH --mem={:.0f}M\n", std::max(least, std::ceil(room * checked.most_memory / 1e6)));
  constexpr double to_write = 300;
  if (options.seconds)
    script += fmt::format("#SBATCH --time={}\n",
                          slurm_time(static_cast<double>(a_task) * (*options.seconds + to_write)));
  script += "#SBATCH --signal=B:TERM@60\n";
  script += fmt::format(
      "\nfirst=$(( (SLURM_ARRAY_TASK_ID - 1) * {0} + 1 ))\nlast=$(( first + {1} ))\n"
      "(( last > {2} )) && last={2}\nexec {3} \"$first-$last\"",
      a_task, a_task - 1, cells, shell_line(options.call));
  std::error_code problem;
  fs::create_directories(folder / logs_name, problem);
  sweep::replace_file(file, sealed_script(std::move(script)));
  return file;
}

}  // namespace bernal
