#include <cmath>
#include <filesystem>
#include <memory>
#include <sstream>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "bernal/run/run.hpp"
#include "bernal/scene/read_scene.hpp"
#include "commands.hpp"
#include "describe.hpp"
#include "progress_bar.hpp"

using namespace bernal;

namespace {

struct ExplainCall {
  std::filesystem::path scene;
  bool json = false;
};

/// To two digits: what is expected is no better known.
std::string in_words(double seconds) {
  const auto two_digits = [](double x, const char* unit) {
    return x < 9.95 ? fmt::format("{:.1f} {}", x, unit)
                    : fmt::format("{:.0f} {}", x < 99.5 ? x : 10 * std::round(x / 10), unit);
  };
  if (seconds < 1e-4) return "under 0.1 ms";
  if (seconds < 0.995) return two_digits(1e3 * seconds, "ms");
  if (seconds < 99.5) return two_digits(seconds, "s");
  return seconds < 5970 ? two_digits(seconds / 60, "min") : two_digits(seconds / 3600, "h");
}
std::string bytes_in_words(double bytes) {
  if (bytes < 1e6) return fmt::format("{:.0f} kB", std::ceil(bytes / 1e3));
  if (bytes < 1e9) return fmt::format("{:.0f} MB", bytes / 1e6);
  return fmt::format("{:.1f} GB", bytes / 1e9);
}

/// Words in lines of at most 100 columns, so many blanks before each.
std::string in_lines(const std::string& words, std::size_t blanks) {
  constexpr std::size_t width = 100;
  std::istringstream all(words);
  std::string text, line(blanks, ' ');
  for (std::string word; all >> word;) {
    if (line.size() > blanks && line.size() + 1 + word.size() > width) {
      text += line + '\n';
      line.assign(blanks, ' ');
    }
    line += (line.size() > blanks ? " " : "") + word;
  }
  return text + line + '\n';
}

/// Two lines an effect: its name and price; what it is. Times within others stand in brackets.
void print_effects(const Plan& plan) {
  fmt::print("What would run:\n  {:<16}  {:>10}  {:>7}  {}\n", "effect", "time", "memory", "cost");
  bool any_part = false;
  for (const PlanItem& item : plan.items) {
    const bool takes_time = item.seconds > 0, is_part = item.part && takes_time;
    const std::string time = takes_time ? in_words(item.seconds) : item.if_needed ? "if needed" : "";
    any_part = any_part || is_part;
    std::string line =
        fmt::format("  {:<16}  {:>10}  {:>7}  {}", item.name, is_part ? "(" + time + ")" : time,
                    item.bytes > 0 ? bytes_in_words(item.bytes) : "", item.cost);
    line.erase(line.find_last_not_of(' ') + 1);
    fmt::print("{}\n{}", line, in_lines((item.if_needed && takes_time ? "if needed: " : "") + item.what, 6));
  }
  fmt::print("  {:<16}  {:>10}  {:>7}  with what the program itself takes\n", "together",
             in_words(plan.expected_seconds), bytes_in_words(plan.expected_memory_bytes));
  if (any_part) fmt::print("Times in brackets are parts of others.\n");
}

void print(const Plan& plan) {
  const Scene& scene = plan.scene;
  fmt::print("{}", describe(plan));
  fmt::print("accuracy   walls {}, overlap {}\n", name_of(scene.walls), scene.overlap);
  fmt::print("expected   about {:.3g} spheres, packing fraction {:.3f}\n", plan.expected_count,
             plan.expected_packing_fraction);
  fmt::print("           about {} to pack them on one core, {} of memory\n\n",
             in_words(plan.expected_seconds), bytes_in_words(plan.expected_memory_bytes));

  print_effects(plan);
  if (!plan.absent.empty())
    fmt::print("\nNot called for, not built:\n{}",
               in_lines(fmt::format("{}.", fmt::join(plan.absent, ", ")), 2));
  if (scene.stages_are_default)
    fmt::print("\nThe scene names no stages. This protocol runs; paste it to change it:\n\n{}",
               stages_as_toml(scene));
}

nlohmann::ordered_json as_json(const Plan& plan) {
  using nlohmann::ordered_json;
  ordered_json container = {{"kind", kind_of(plan.domain)}, {"volume", volume_of(plan.domain)}};
  if (!plan.scene.is_periodic()) {
    const Bounds<3> bounds = bounds_of(plan.domain);
    container["bounds"] = {bounds.lower, bounds.upper};
  } else {
    const Vector<dynamic> edges = bounds_of<dynamic>(plan.domain).size();
    container["edges"] = std::vector<double>(edges.begin(), edges.end());
    container["scalable"] = plan.box_follows;
  }
  container["notes"] = plan.container_notes;
  ordered_json items = ordered_json::array();
  for (const PlanItem& item : plan.items)
    items.push_back({{"name", item.name},
                     {"what", item.what},
                     {"cost", item.cost},
                     {"seconds", item.seconds},
                     {"bytes", item.bytes},
                     {"part", item.part},
                     {"if_needed", item.if_needed}});
  ordered_json outputs = ordered_json::array();
  for (const Output& output : plan.scene.outputs)
    outputs.push_back({{"format", output.format},
                       {"file", plain_text(output.file.string())},
                       {"unit", name_of(output.unit.value_or(Unit::m))}});
  return {{"unit", name_of(plan.scene.unit)},
          {"container", container},
          {"spheres",
           {{"target", describe_target(plan)},
            {"sizes", describe_sizes(plan.scene)},
            {"gap", plan.scene.gap},
            {"wall_gap", plan.scene.wall_gap}}},
          {"accuracy", {{"walls", name_of(plan.scene.walls)}, {"overlap", plan.scene.overlap}}},
          {"expected",
           {{"count", plan.expected_count},
            {"packing_fraction", plan.expected_packing_fraction},
            {"seconds", plan.expected_seconds},
            {"memory_bytes", plan.expected_memory_bytes}}},
          {"caution", plan.caution.empty() ? ordered_json() : ordered_json(plan.caution)},
          {"outputs", outputs},
          {"items", items},
          {"absent", plan.absent},
          {"stages_are_default", plan.scene.stages_are_default},
          {"stages", stages_as_toml(plan.scene)}};
}

int explain(const ExplainCall& call) {
  ProgressBar bar(call.json);
  bar.now("estimate");
  const Plan plan = build(read_scene(call.scene));
  bar.clear();
  if (call.json)
    fmt::print("{}\n", as_json(plan).dump(2));
  else
    print(plan);
  return exit_code::done;
}

}  // namespace

Command explain_command() {
  const auto call = std::make_shared<ExplainCall>();
  return {
      "explain",
      "Say what a scene would run and cost; run nothing",
      {file(required({"SCENE", &call->scene, "The scene, a TOML file"}), {".toml"}), json_option(call->json)},
      {.text = "Prints what was understood, what would run, how many spheres to expect and, where the scene "
               "names no stages, those that run, with all their defaults. Times are those of packing on "
               "one core; with the memory they are estimates by each stage's own model: of the 32 scenes "
               "that were measured 27 took between half and twice the time expected, the worst a fourth of "
               "it or five times as long.",
       .examples = {{"bernal explain data/scenes/hopper.toml", "what would run, and what it would cost"}},
       .exit_codes = {{"0", "done"}, {"2", "bad input"}}},
      [call] { return explain(*call); }};
}
