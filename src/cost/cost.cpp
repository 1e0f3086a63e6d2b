#include "bernal/cost/cost.hpp"

#include <algorithm>
#include <thread>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "bernal/scene/read_scene.hpp"
#include "cost/cost_folder.hpp"
#include "cost/search.hpp"
#include "cost/verdict.hpp"
#include "cost/write_cost.hpp"
#include "files/put_in_place.hpp"
#include "files/sha256.hpp"
#include "files/staged_folder.hpp"

namespace bernal {

CostReport measure_cost(const Scene& scene, const std::filesystem::path& folder, const CostOptions& options) {
  using namespace cost;
  if (!(options.seconds > 0) || options.seeds < 1)
    throw Error(ErrorCode::bad_argument, "a cost is measured in more than 0 seconds, with 1 seed or more");
  CostOptions rest = options;
  const Stopwatch watch;
  finish_publishing(folder);
  const std::filesystem::path record_file = folder / "trials.csv";
  check_outputs(folder, scene, TrialRecord::read(record_file, options.fresh));
  Subject subject = subject_of(scene);
  subject.with_limits = true;
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) throw Error(ErrorCode::cannot_write, "cannot be made: " + failed.message(), {folder.string()});
  TrialRecord record(record_file, options.fresh);
  std::string outdated;
  if (record.outdated() > 0)
    outdated = fmt::format(
        "{} run{} in trials.csv {} of packings {}, and this is bernal {}: what is needed of "
        "them is made anew",
        record.outdated(), record.outdated() == 1 ? "" : "s", record.outdated() == 1 ? "is" : "are",
        record.packings_of_outdated(), text_of(this_program()));
  const std::filesystem::path whole_folder = std::filesystem::absolute(folder).lexically_normal();
  std::vector<Knob> knobs = knobs_of(subject, whole_folder, record);
  rest.seconds = std::max(1e-3, options.seconds - watch.seconds());
  Search search(std::move(subject), std::move(knobs), record, rest);
  search.go();

  const Search::Found* own = search.at(search.own());
  if (search.cancelled() && !own) {
    CostReport nothing;
    nothing.cancelled = true;
    return nothing;
  }
  if (!own || own->row.slower)
    throw Error(ErrorCode::bad_argument,
                fmt::format("not one run of the scene as it is has ended in {}; give it more ‹time›, or the "
                            "scene fewer spheres",
                            seconds_in_words(options.seconds)));
  CostReport report = report_of(search, whole_folder);
  report.outdated = outdated;
  std::size_t runs = 0;
  for (const CostRow& row : report.rows) runs += static_cast<std::size_t>(row.runs);
  report.runs_kept = runs - std::min(runs, report.runs_made);
  const int threads =
      options.threads > 0 ? options.threads : static_cast<int>(std::thread::hardware_concurrency());
  const CostHeading heading{scene.file.empty() ? "a scene" : plain_text(scene.file.filename().string()),
                            fmt::format("{} thread{}", threads, threads == 1 ? "" : "s"), options.seeds};
  const std::string picture = cost_svg(report, heading);
  StagedFolder staged(folder);
  staged.write("cost.csv", cost_csv(report));
  staged.write("cost.md", cost_md(report, heading));
  staged.write("cost.svg", picture);
  staged.write("cost.html", cost_html(report, heading, picture));
  staged.write("recommended.toml", report.toml);
  for (const std::string& name : staged.names()) record.add_file(name, sha256_of(staged.written(name)));
  // What somebody wrote there meanwhile is kept under another name.
  report.files = staged.publish(files_of_earlier_call(folder, record));
  return report;
}

}  // namespace bernal
