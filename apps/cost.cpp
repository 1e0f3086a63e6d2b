#include "bernal/cost/cost.hpp"
#include "bernal/cost/mesh_cost.hpp"

#include <memory>

#include <nlohmann/json.hpp>

#include "bernal/core/text.hpp"
#include "bernal/result/write_packing.hpp"
#include "bernal/scene/read_scene.hpp"
#include "commands.hpp"
#include "progress_bar.hpp"
#include "say.hpp"

using namespace bernal;

namespace {

struct CostCall {
  std::filesystem::path scene;
  std::filesystem::path folder;
  std::string time = "10m";
  int seeds = 2;
  int threads = 0;
  bool fresh = false, meshes = false;
  bool json = false;
  bool quiet = false;
};

template <class Number>
nlohmann::ordered_json or_null(const std::optional<Number>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
}

nlohmann::ordered_json json_of_row(const CostRow& row) {
  return {{"setting", row.setting},
          {"phi", row.phi},
          {"phi_scatter", row.phi_scatter},
          {"seconds", row.seconds},
          {"wall_seconds", row.wall_seconds},
          {"largest_overlap", row.early_overlap},
          {"overlap_left", row.max_overlap},
          {"held_from", or_null(row.held_from)},
          {"contacts_over_isostatic", or_null(row.contact_ratio)},
          {"wall_error", row.wall_error},
          {"memory_bytes", or_null(row.memory_bytes)},
          {"size_scale", row.size_scale},
          {"phi_change", row.phi_change},
          {"phi_change_error", or_null(row.phi_change_error)},
          {"same_as_another", row.is_repeat},
          {"runs", row.runs},
          {"slower", row.slower},
          {"outcome", name_of(row.outcome)},
          {"reason", plain_text(row.reason)},
          {"certified", row.certified},
          {"pareto", row.pareto},
          {"pareto_contacts", row.pareto_contacts}};
}

void print_json(const CostReport& report) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const CostRow& row : report.rows) rows.push_back(json_of_row(row));
  nlohmann::ordered_json files = nlohmann::ordered_json::array();
  for (const auto& file : report.files) files.push_back(plain_text(file.string(), 5000));
  const nlohmann::ordered_json json = {{"recommendation", report.recommendation},
                                       {"recommended", report.recommended},
                                       {"scene_as_it_is", report.own},
                                       {"settings", std::move(rows)},
                                       {"verdicts", report.verdicts},
                                       {"phi_step", report.phi_step},
                                       {"runs_made", report.runs_made},
                                       {"runs_kept", report.runs_kept},
                                       {"outdated", report.outdated},
                                       {"complete", report.complete},
                                       {"ending", report.ending},
                                       {"refused", report.refused},
                                       {"stopped", report.cancelled},
                                       {"toml", report.toml},
                                       {"files", std::move(files)}};
  say(stdout, "{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

void print_words(const CostReport& report, bool quiet) {
  if (!quiet) {
    std::size_t on_front = 0;
    for (const CostRow& row : report.rows) on_front += row.pareto;
    say(stderr, "measured   {} settings, {} on the front; {} runs, {} of them known before\n",
        report.rows.size(), on_front, report.runs_made + report.runs_kept, report.runs_kept);
    say(stderr, "           {}\n", report.ending);
    if (!report.outdated.empty()) say(stderr, "again      {}\n", report.outdated);
    for (const std::string& refused : report.refused) say(stderr, "refused    {}\n", refused);
    for (const std::string& verdict : report.verdicts) say(stderr, "{}\n", verdict);
    say(stderr, "advice     {}\n", report.recommendation);
  }
  for (const auto& file : report.files) say(stdout, "{}\n", plain_text(file.string(), 5000));
}

void print_meshes_as_json(const MeshCostReport& report) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const MeshCostRow& row : report.rows) {
    rows.push_back({{"mesh_size", row.sphere_edge},
                    {"neck_size", row.neck_edge},
                    {"expected",
                     {{"tetrahedra", row.expected.tetrahedra},
                      {"seconds", row.expected.seconds},
                      {"memory_bytes", row.expected.bytes}}},
                    {"measured", nullptr}});
    if (row.measured)
      rows.back()["measured"] = {{"tetrahedra", row.measured->tetrahedra},
                                 {"seconds", row.seconds()},
                                 {"memory_bytes", row.bytes()},
                                 {"least_sicn", row.measured->least_sicn},
                                 {"porosity", row.measured->porosity},
                                 {"meshed_porosity", row.measured->meshed_porosity}};
  }
  const nlohmann::ordered_json json = {{"spheres", report.spheres},
                                       {"meshes", std::move(rows)},
                                       {"files", {plain_text(report.file.string(), 5000)}}};
  say(stdout, "{}\n", json.dump(2));
}

void print_meshes(const MeshCostReport& report) {
  say(stderr, "{:>9} {:>9} {:>24} {:>20} {:>16} {:>10} {:>14}\n", "mesh-size", "neck-size",
      "tetrahedra (expected)", "seconds", "GB", "least SICN", "porosity off");
  for (const MeshCostRow& row : report.rows) {
    const MeshPrice& expected = row.expected;
    std::string cells, seconds, memory, quality = "-", error = "-";
    const auto both = [](const std::string& measured, const std::string& asked) {
      return fmt::format("{} ({})", measured, asked);
    };
    const auto count = [](double n) { return grouped(static_cast<std::uint64_t>(n)); };
    cells = both(row.measured ? grouped(row.measured->tetrahedra) : "-", count(expected.tetrahedra));
    seconds = both(row.measured ? fmt::format("{:.1f}", row.seconds()) : "-",
                   fmt::format("{:.1f}", expected.seconds));
    memory = both(row.measured ? fmt::format("{:.2f}", row.bytes() / 1e9) : "-",
                  fmt::format("{:.2f}", expected.bytes / 1e9));
    if (row.measured) {
      quality = fmt::format("{:.3f}", row.measured->least_sicn);
      error = fmt::format("{:+.4f}", row.porosity_error());
    }
    say(stderr, "{:>9} {:>9} {:>24} {:>20} {:>16} {:>10} {:>14}\n", row.sphere_edge, row.neck_edge, cells,
        seconds, memory, quality, error);
  }
}

/// The topmost folder that has to be made so that this one exists; empty if it exists.
std::filesystem::path to_be_made(const std::filesystem::path& folder) {
  std::error_code unknown;
  std::filesystem::path top = std::filesystem::absolute(folder).lexically_normal();
  if (std::filesystem::exists(top, unknown)) return {};
  while (top.has_relative_path() && !std::filesystem::exists(top.parent_path(), unknown))
    top = top.parent_path();
  return top;
}

/// Measures what accuracy costs, or what meshes do. If the call is refused, the folders that it has made go
/// again.
template <class Measure>
auto measured(const CostCall& call, ProgressBar& bar, const Measure& measure) {
  const Scene scene = read_scene(call.scene);
  const std::filesystem::path made = to_be_made(call.folder);
  try {
    check_writable(call.folder);
    return measure(scene, call.folder,
                   CostOptions{.seconds = *seconds_of(call.time),
                               .seeds = call.seeds,
                               .threads = call.threads,
                               .fresh = call.fresh,
                               .monitor = bar.monitor()});
  } catch (const Error&) {
    std::error_code unknown;
    if (!made.empty()) std::filesystem::remove_all(made, unknown);
    throw;
  }
}

int cost(const CostCall& call) {
  ProgressBar bar(call.quiet);
  bar.now("read");
  const CostReport report = measured(call, bar, measure_cost);
  bar.clear();
  if (report.rows.empty()) {
    say(stderr, "bernal: stopped before the scene as it is was measured; what is known stands in {}\n",
        plain_text((call.folder / "trials.csv").string(), 5000));
    return exit_code::not_reached;
  }
  call.json ? print_json(report) : print_words(report, call.quiet);
  return report.cancelled ? exit_code::not_reached : exit_code::done;
}

int cost_of_meshes(const CostCall& call) {
  ProgressBar bar(call.quiet);
  bar.now("read");
  const MeshCostReport report = measured(call, bar, measure_mesh_cost);
  bar.clear();
  if (call.json) {
    print_meshes_as_json(report);
  } else {
    if (!call.quiet) print_meshes(report);
    say(stdout, "{}\n", plain_text(report.file.string(), 5000));
  }
  return report.cancelled ? exit_code::not_reached : exit_code::done;
}

}  // namespace

Command cost_command() {
  const auto call = std::make_shared<CostCall>();
  return {
      "cost",
      "Run a scene at several accuracies: what each costs in time, what it buys, what to take",
      {file(required({"SCENE", &call->scene, "The scene, a TOML file"}), {".toml"}),
       folder(required(
           {"-o,--output", &call->folder, "Folder for the results; made if it does not exist", "DIR"})),
       time_option(call->time, "For all of it on the wall; 10m if absent"),
       within(
           {"--seeds", &call->seeds, "Runs of every setting, each with a seed of its own; 2 if absent", "N"},
           1, 100),
       threads_option(call->threads, "every packing"),
       {"--meshes", &call->meshes,
        "Pack the scene once, then mesh it with shorter and shorter edges: cells, seconds, memory, quality"},
       {"--fresh", &call->fresh, "Forget what an earlier call measured in this folder"},
       json_option(call->json),
       quiet_option(call->quiet)},
      {.text =
           "Runs the scene as it is, then with other values of the keys that buy accuracy in its stages "
           "(alpha, "
           "stop, patience, polish, rate, …), in [accuracy] and in its container, one at a time and "
           "combined, "
           "every setting with several seeds, in an order that a machine that slows down hurts all alike. "
           "Seconds are those of the processor, all threads together. On a machine with nothing else to do "
           "the "
           "times are better.\n\nWith --meshes what bernal mesh makes of the packing is measured instead, as "
           "far as the "
           "time goes; beyond it only what is expected is said, in brackets.\n\nFiles of the names below "
           "that it did not write, or that were changed since, "
           "are refused before anything runs.",
       .lists = {{.title = "Files",
                  .text = "what is written into DIR.",
                  .entries = {{"cost.csv, cost.md, cost.html, cost.svg", "what was measured"},
                              {"meshes.csv", "with --meshes alone: a row for each length of edges"},
                              {"recommended.toml", "the scene as is advised"},
                              {"trials.csv",
                               "every run: the same call again goes on where the last one ended"}}}},
       .examples = {{"bernal cost data/scenes/relax_equal.toml -o out", "ten minutes"},
                    {"bernal cost data/scenes/hopper.toml -o out --time 1h", "an hour"},
                    {"bernal cost bed.toml -o out --meshes", "what bernal mesh would need by --mesh-size"},
                    {"bernal pack out/recommended.toml", "what is advised"}},
       .exit_codes = {{"0", "done, also when the time is over"},
                      {"2", "bad input, or not one run ends in the time"},
                      {"3", "stopped by Ctrl-C: what was measured is written"}}},
      [call] { return call->meshes ? cost_of_meshes(*call) : cost(*call); }};
}
