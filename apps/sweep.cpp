#include "bernal/sweep/sweep.hpp"

#include <sys/prctl.h>

#include <atomic>
#include <charconv>
#include <csignal>
#include <map>
#include <ranges>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "commands.hpp"
#include "progress_bar.hpp"
#include "say.hpp"

using namespace bernal;

namespace {

struct SweepCall {
  std::filesystem::path sweep;
  std::filesystem::path folder;
  int jobs = 0, threads = 0;
  std::string time, plot, cells, as_of;
  bool retry = false, view = false;
  bool list = false, collect = false, slurm = false, here = false;
  bool json = false, quiet = false;
};

/// The cells that "7" or "6-10" names, counted from 1.
std::optional<std::pair<std::size_t, std::size_t>> cells_of(std::string_view text) {
  const auto number = [](std::string_view digits) {
    std::size_t value = 0;
    const char* const end = digits.data() + digits.size();
    const auto [stop, error] = std::from_chars(digits.data(), end, value);
    return error == std::errc{} && stop == end ? value : 0;
  };
  const std::size_t dash = text.find('-');
  const std::size_t first = number(text.substr(0, dash));
  const std::size_t last = dash == text.npos ? first : number(text.substr(dash + 1));
  if (first == 0 || last < first) return {};
  return std::pair{first, last};
}

std::optional<double> seconds_a_cell(const SweepCall& call) {
  return call.time.empty() ? std::nullopt : seconds_of(call.time);
}

/// The program that runs, even if its file has been replaced since.
std::string program() {
  const std::filesystem::path self = "/proc/self/exe";
  std::error_code unknown;
  const std::filesystem::path file = std::filesystem::read_symlink(self, unknown);
  return std::filesystem::exists(file, unknown) ? file.string() : self.string();
}

/// The arguments that a process of the pool and a task of Slurm have in common.
std::vector<std::string> call_of_cells(const SweepCall& call, const Sweep& sweep, int threads,
                                       bool absolute) {
  const auto named = [&](const std::filesystem::path& path) {
    if (absolute) return std::filesystem::absolute(path).lexically_normal().string();
    return path.string().starts_with('-') ? "./" + path.string() : path.string();  // no option
  };
  std::vector<std::string> words = {
      program(), "sweep",        named(call.sweep), "--output=" + named(call.folder),
      "--as-of", sweep.digest(), "--threads",       std::to_string(threads)};
  if (!call.time.empty()) words.insert(words.end(), {"--time", call.time});
  if (call.view) words.emplace_back("--view");
  return words;
}

std::string words_of(const Sweep& sweep, const SweepRow& row) {
  std::vector<std::string> words;
  for (std::size_t k = 0; k < row.values.size(); ++k)
    if (!row.values[k].empty())
      words.push_back(fmt::format("{} = {}", sweep.keys()[k], plain_text(row.values[k], 80)));
  return fmt::format("{}", fmt::join(words, ", "));
}

std::atomic<bool> told_to_stop = false;
extern "C" void on_telling(int) { told_to_stop = true; }

/// Runs one cell in this process, which a pool has started. It ends if the pool ends.
int run_here(const SweepCall& call, const Sweep& sweep, std::size_t number) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  for (const int signal : {SIGTERM, SIGINT, SIGHUP}) std::signal(signal, on_telling);
  const CellOptions options{.threads = call.threads,
                            .seconds = seconds_a_cell(call),
                            .view = call.view,
                            .retry = call.retry,
                            .monitor = {{}, [] { return told_to_stop.load(); }}};
  const Cell cell = sweep.cell(number);
  try {
    if (!run_cell(cell, call.folder, options)) return exit_code_left_to_another;
  } catch (const Cancelled&) {
    say(stderr, "bernal: stopped; nothing is kept of cell {}\n", number);
    return exit_code::not_reached;
  }
  const CellResult result = read_cell(call.folder, cell.hash);
  return result.is_done() ? exit_code::done : exit_code::not_reached;
}

std::string counts_of(const SweepReport& report) {
  std::map<std::string, std::size_t> counts;
  for (const SweepRow& row : report.rows) ++counts[row.result.outcome];
  std::vector<std::string> words;
  for (const auto& [outcome, count] : counts) words.push_back(fmt::format("{} {}", grouped(count), outcome));
  return fmt::format("{}", fmt::join(words, ", "));
}

void print_sweep_json(const Sweep& sweep, const SweepReport& report) {
  nlohmann::ordered_json outcomes = nlohmann::ordered_json::object();
  for (const SweepRow& row : report.rows) {
    auto& count = outcomes[row.result.outcome];
    count = count.is_number() ? count.get<std::size_t>() + 1 : 1;
  }
  nlohmann::ordered_json files = nlohmann::ordered_json::array();
  for (const auto& file : report.files) files.push_back(plain_text(file.string(), 5000));
  const nlohmann::ordered_json json = {{"cells", report.rows.size()},
                                       {"keys", sweep.keys()},
                                       {"outcomes", outcomes},
                                       {"ran", report.ran},
                                       {"jobs", report.jobs},
                                       {"threads", report.threads},
                                       {"distrusted", report.distrusted.size()},
                                       {"outdated", report.outdated.size()},
                                       {"done", report.is_done()},
                                       {"stopped", report.cancelled},
                                       {"files", files}};
  say(stdout, "{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

/// Prints the first cells that failed, each with its reason.
void print_reasons(const Sweep& sweep, const std::vector<SweepRow>& rows, const char* others) {
  constexpr std::size_t most = 5;
  for (const SweepRow& row : rows | std::views::take(most))
    say(stderr, "cell {:<5} {}: {}: {}\n", row.number, words_of(sweep, row), row.result.outcome,
        plain_text(row.result.reason, 400));
  if (rows.size() > most) say(stderr, "           and {} others{}\n", grouped(rows.size() - most), others);
}

void print_sweep_words(const Sweep& sweep, const SweepReport& report) {
  say(stderr, "cells      {}: {}\n", grouped(report.rows.size()), counts_of(report));
  if (report.ran > 0)
    say(stderr, "ran        {} of them now, {} at a time on {} thread{} each\n", grouped(report.ran),
        report.jobs, report.threads, report.threads == 1 ? "" : "s");
  if (!report.outdated.empty())
    say(stderr, "again      {} of other packings; of the first: {}\n", grouped(report.outdated.size()),
        plain_text(report.outdated.front().result.reason, 400));
  if (!report.distrusted.empty())
    say(stderr, "again      {} that were there and not as they were written\n",
        grouped(report.distrusted.size()));
  print_reasons(sweep, report.distrusted, "");
  std::vector<SweepRow> short_of_it = report.rows;
  std::erase_if(short_of_it, [](const SweepRow& row) {
    return row.result.is_done() || (!row.result.exit_code && row.result.reason.empty());
  });
  print_reasons(sweep, short_of_it, ", see the column \"reason\"");
}

int finish(const SweepCall& call, const Sweep& sweep, const SweepReport& report) {
  if (call.json)
    print_sweep_json(sweep, report);
  else {
    if (!call.quiet) print_sweep_words(sweep, report);
    for (const auto& file : report.files) say(stdout, "{}\n", plain_text(file.string(), 5000));
  }
  if (report.cancelled) say(stderr, "bernal: stopped; the same call goes on from here\n");
  return report.is_done() && !report.cancelled ? exit_code::done : exit_code::not_reached;
}

int list_cells(const SweepCall& call, const Sweep& sweep, const SweepOptions& options) {
  const SweepReport report = collect_sweep(sweep, call.folder, options);
  for (const SweepRow& row : report.rows)
    say(stdout, "{:>6}  {}  {:<9}  {}\n", row.number, row.cell_hash, row.result.outcome,
        words_of(sweep, row));
  if (!call.quiet) say(stderr, "{} cells: {}\n", grouped(report.rows.size()), counts_of(report));
  return report.cancelled ? exit_code::not_reached : exit_code::done;
}

int write_script(const SweepCall& call, const Sweep& sweep) {
  const int threads = call.threads > 0 ? call.threads : 1;
  std::vector<std::string> cells = call_of_cells(call, sweep, threads, true);
  cells.insert(cells.end(), {"--jobs", "1", "--cell"});
  std::vector<std::string> collect = call_of_cells(call, sweep, threads, true);
  collect.resize(4);
  collect.emplace_back("--collect");
  const std::filesystem::path script = write_slurm_script(sweep, call.folder,
                                                          {.call = cells,
                                                           .collect = collect,
                                                           .jobs = call.jobs,
                                                           .threads = threads,
                                                           .seconds = seconds_a_cell(call)});
  if (!call.quiet)
    say(stderr, "submit     sbatch {}\ncollect    bernal sweep {} -o {} --collect\n",
        plain_text(script.string(), 5000), plain_text(call.sweep.string(), 5000),
        plain_text(call.folder.string(), 5000));
  say(stdout, "{}\n", plain_text(script.string(), 5000));
  return exit_code::done;
}

int sweep(const SweepCall& call) {
  const Sweep cells = Sweep::read(call.sweep);
  if (!call.as_of.empty() && call.as_of != cells.digest())
    throw Error(ErrorCode::bad_argument,
                "the sweep or its scene has changed since this call was made (--as-of); make it anew",
                {call.sweep.string()});
  const auto chosen =
      call.cells.empty() ? std::pair<std::size_t, std::size_t>{1, cells.size()} : *cells_of(call.cells);
  if (chosen.second > cells.size())
    throw Error(ErrorCode::bad_argument,
                fmt::format("--cell {}: the sweep has {} cells", call.cells, grouped(cells.size())));
  if (call.here) {
    if (chosen.first != chosen.second || call.cells.empty())
      throw Error(ErrorCode::bad_argument, "--here runs one cell; say which, such as --cell 7");
    return run_here(call, cells, chosen.first);
  }
  if (call.slurm) return write_script(call, cells);

  ProgressBar bar(call.quiet);
  SweepOptions options{.call =
                           [&](std::size_t cell, int threads) {
                             std::vector<std::string> words = call_of_cells(call, cells, threads, false);
                             words.insert(words.end(), {"--here", "--quiet", "--cell", std::to_string(cell)});
                             if (call.retry) words.emplace_back("--retry");
                             return words;
                           },
                       .jobs = call.jobs,
                       .threads = call.threads,
                       .seconds = seconds_a_cell(call),
                       .retry = call.retry,
                       .first = chosen.first,
                       .last = chosen.second,
                       // A call for some of the cells, which runs beside others, writes no table.
                       .write = !call.list && call.cells.empty(),
                       .plot = call.plot,
                       .monitor = bar.monitor()};
  if (call.list) {
    bar.clear();
    return list_cells(call, cells, options);
  }
  const SweepReport report =
      call.collect ? collect_sweep(cells, call.folder, options) : run_sweep(cells, call.folder, options);
  bar.clear();
  return finish(call, cells, report);
}

}  // namespace

Command sweep_command() {
  const auto call = std::make_shared<SweepCall>();
  const auto complaint = [](const std::string& text) {
    return cells_of(text)
               ? std::string()
               : fmt::format("must be the number of a cell, from 1 on, or two of them such as 6-10, not {}",
                             text);
  };
  return {
      "sweep",
      "Run a grid of scenes: over any keys, in processes side by side, into one table",
      {file(required(
                {"SWEEP", &call->sweep, "The sweep, a TOML file that names a scene and values for its keys"}),
            {".toml"}),
       folder(required(
           {"-o,--output", &call->folder, "Folder for the results; made if it does not exist", "DIR"})),
       within({"--jobs", &call->jobs,
               "Cells that run at a time; as many as the machine has threads and memory for if absent", "N"},
              1, 1024),
       within({"--threads", &call->threads,
               "Of each cell; those of the machine divided by the jobs if absent", "N"},
              1, 1024),
       time_option(call->time,
                   "For each cell; it ends then with what it has, and runs again where it is given more"),
       {"--plot", &call->plot, "Columns of results.csv that results.svg shows", "X,Y[,COLOUR]"},
       {"--retry", &call->retry, "Run again what was refused as bad input, too"},
       {"--view", &call->view, "Put the view to turn into each report.html, which is then larger"},
       {"--list", &call->list, "Print the cells and how they stand; run nothing"},
       excludes(
           {"--collect", &call->collect, "Write the table and the picture of what is there; run nothing"},
           "--list"),
       excludes(
           excludes(
               {"--slurm", &call->slurm,
                "Write sweep.sbatch, a job array for Slurm, with --jobs at a time and --threads each; run "
                "nothing"},
               "--list"),
           "--collect"),
       checked(
           {"--cell", &call->cells, "Only these, by their numbers, and no table: a task of Slurm", "N|M-N"},
           complaint),
       {"--here", &call->here,
        "One --cell in this process, as --jobs are run; not kept when stopped. Ends with 4 where another "
        "process is at it or has done it"},
       {"--as-of", &call->as_of,
        "Refuse where the sweep is no longer that of this digest, as sweep.sbatch says", "DIGEST"},
       json_option(call->json),
       quiet_option(call->quiet)},
      {.text = "A sweep is a TOML file: a scene, by its path or as a table [scene], a [grid] with a list or "
               "a range "
               "of values for any of its keys, and tables [[case]] of keys that change together; every "
               "combination "
               "is a cell. \"repeats\" runs each with so many seeds. All cells are checked before anything "
               "runs.\n\n"
               "Every cell is a process of its own: what fails, crashes or is killed for its memory is "
               "recorded with "
               "its reason and stops nothing else. The same call again runs only what is missing or crashed, "
               "whatever "
               "ended the last one; a sweep that has been changed uses all cells that it still asks for. "
               "Several calls, "
               "on several machines that share the folder, work side by side.",
       .lists = {{.title = "A sweep",
                  .text = {},
                  .entries = {{"scene = \"bed.toml\"", "beside the sweep; or [scene], [scene.container], …"},
                              {"repeats = 5", "each cell with five seeds, from that of the scene on"},
                              {"[grid]", "keys that vary by themselves:"},
                              {"spheres.diameter.sigma = [0.1, 0.2]",
                               "any key of the scene and any list of values"},
                              {"\"stage[0].alpha\" = {from = 2, to = 17, count = 4}",
                               "of a list, counted from 0; values evenly, or by scale = \"log\""},
                              {"seed = {from = 1, to = 20}", "whole numbers; or with step = 0.5"},
                              {"[[case]]", "keys that change together, one table a case:"},
                              {"container = {kind = \"box\", size = [9, 9, 9]}", "whole tables, too"}}},
                 {.title = "Files",
                  .text = "what is written into DIR.",
                  .entries = {{"results.csv",
                               "a row a cell: the swept keys, how it ended, what was measured"},
                              {"results.svg", "two columns of it over each other"},
                              {"cells/HASH/",
                               "what bernal pack writes, or failed.toml; named after all that "
                               "the scene says and the files that it names"},
                              {"sweep.sbatch", "with --slurm"}}}},
       .examples = {{"bernal sweep data/sweeps/exchange.toml -o out",
                     "on all cores; Ctrl-C, and the same again"},
                    {"bernal sweep data/sweeps/exchange.toml -o out --plot spheres.diameter.sigma,seconds",
                     "another picture"},
                    {"bernal sweep sweep.toml -o out --slurm --jobs 50 --time 30m", "for a cluster"},
                    {"bernal verify out/cells/HASH", "a cell is a result as any other"}},
       .exit_codes = {{"0", "every cell reached what its scene asks"},
                      {"2", "bad input, nothing run"},
                      {"3", "some did not, or it was stopped; results.csv says why"}}},
      [call] { return sweep(*call); }};
}
