// Holds what `bernal explain` expects of a scene against what `bernal pack` takes, and prints the table of
// data/results/estimates.md: `bernal_estimates COMMAND`.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace {

using nlohmann::json;
namespace fs = std::filesystem;

const fs::path folder = fs::temp_directory_path() / ("bernal_estimates_" + std::to_string(getpid()));

/// What a process took.
struct Cost {
  int exit = -1;
  double processor = 0, wall = 0;  // seconds
  double memory = 0;               // bytes
};

Cost run(const std::vector<std::string>& words, const fs::path& output) {
  const auto start = std::chrono::steady_clock::now();
  std::fflush(stdout);
  const pid_t child = fork();
  if (child == 0) {
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    if (!freopen(output.c_str(), "w", stdout) || !freopen("/dev/null", "w", stderr)) _exit(127);
    execv(arguments[0], arguments.data());
    _exit(127);
  }
  int status = 0;
  rusage used{};
  wait4(child, &status, 0, &used);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, seconds(used.ru_utime) + seconds(used.ru_stime),
          std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
          1024.0 * static_cast<double>(used.ru_maxrss)};
}

struct Case {
  std::string name;
  fs::path scene;
};

/// Beside the example scenes: other sizes, other stages, and 10,000 and 100,000 spheres for the memory.
std::vector<Case> cases() {
  std::vector<Case> all;
  for (const auto& entry : fs::directory_iterator(BERNAL_DATA "/scenes"))
    if (entry.path().extension() == ".toml") all.push_back({entry.path().stem(), entry.path()});
  std::ranges::sort(all, {}, &Case::name);
  const auto add = [&](const std::string& name, const std::string& toml) {
    const fs::path file = folder / (name + ".toml");
    std::ofstream(file) << toml;
    all.push_back({name, file});
  };
  const std::string periodic = "[container]\nkind = \"periodic\"\n", equal = "radius = 1.0\n",
                    box = "[container]\nkind = \"box\"\nsize = [1.0, 1.0, 1.0]\n";
  const auto relax = [](int alpha) { return fmt::format("[[stage]]\ndo = \"relax\"\nalpha = {}\n", alpha); };
  const std::string grow = "[[stage]]\ndo = \"grow\"\n";
  add("relaxed_100000", periodic + "[spheres]\ncount = 100000\n" + equal + relax(1));
  add("relaxed_1_to_5",
      periodic +
          "[spheres]\ncount = 5000\nradius = { distribution = \"classes\", values = [5.0, 1.0], "
          "shares = [70, 30], basis = \"volume\" }\n" +
          relax(2));
  add("relaxed_in_4_dimensions",
      "[container]\nkind = \"periodic\"\ndimension = 4\n[spheres]\ncount = 1000\n" + equal + relax(5));
  add("relaxed_in_box_100000", box + "[spheres]\npacking_fraction = 0.5\nradius = 0.0106\n");
  add("relaxed_in_box_half_full", box + "[spheres]\npacking_fraction = 0.3\nradius = 0.02\n");
  add("relaxed_in_box_lognormal",
      box + "[spheres]\nradius = { distribution = \"lognormal\", median = 0.02, sigma = 0.4 }\n");
  add("grown_10000", periodic + "[spheres]\ncount = 10000\n" + equal + grow + "rate = 0.1\npressure = 1e3\n");
  add("grown_lognormal",
      periodic +
          "[spheres]\ncount = 1000\nradius = { distribution = \"lognormal\", median = 1.0, sigma = 0.5 }\n" +
          grow);
  add("grown_in_5_dimensions",
      "[container]\nkind = \"periodic\"\ndimension = 5\n[spheres]\ncount = 500\n" + equal + grow);
  add("settled_without_tilt", box +
                                  "[spheres]\nfill = true\nradius = 0.03\n[[stage]]\ndo = "
                                  "\"insert\"\n[[stage]]\ndo = \"compress\"\ntilt = 0\n");
  add("refilled", box +
                      "[spheres]\nfill = true\nradius = { distribution = \"uniform\", min = 0.02, max = 0.05 "
                      "}\n[[stage]]\ndo = \"insert\"\n[[stage]]\ndo = \"refill\"\n");
  add("flown", periodic + "[spheres]\ncount = 4000\npacking_fraction = 0.42\n" + equal +
                   "[[stage]]\ndo = \"fly\"\nmethod = \"flight\"\n");
  return all;
}

json read(const fs::path& file) {
  std::ifstream in(file);
  return json::parse(in, nullptr, false);
}

}  // namespace

int main(int count, char** words) {
  if (count != 2) {
    fmt::print(stderr, "usage: bernal_estimates COMMAND, the command `bernal`\n");
    return 2;
  }
  fs::create_directories(folder);
  const std::string command = words[1];
  fmt::print(
      "| scene | spheres | expected s | took s | ratio | expected MB | took MB | ratio "
      "|\n|---|---:|---:|---:|---:|---:|---:|---:|\n");
  double worst_time = 1, worst_memory = 1;
  std::vector<double> ratios;
  std::string slowest, largest;
  for (const auto& [name, scene] : cases()) {
    const fs::path out = folder / "out", plan = folder / "plan.json";
    fs::remove_all(out);
    const Cost explained = run({command, "explain", scene, "--json"}, plan);
    const Cost packed = run({command, "pack", scene, "-o", out, "--threads", "1", "--quiet"}, folder / "log");
    const json expected = read(plan), report = read(out / "report.json");
    if (explained.exit != 0 || !expected.is_object() || !report.is_object()) {
      fmt::print(stderr, "{} does not run\n", name);
      return 1;
    }
    // Its seconds are of the clock; other processes may have had a share of the core.
    const double took = report["seconds"].get<double>() * std::min(1.0, packed.processor / packed.wall);
    const double seconds = expected["expected"]["seconds"], memory = expected["expected"]["memory_bytes"];
    const double time_ratio = took / seconds, memory_ratio = packed.memory / memory;
    const auto factor = [](double ratio) { return std::max(ratio, 1 / ratio); };
    ratios.push_back(factor(time_ratio));
    if (factor(time_ratio) > worst_time) worst_time = factor(time_ratio), slowest = name;
    if (factor(memory_ratio) > worst_memory) worst_memory = factor(memory_ratio), largest = name;
    fmt::print("| {} | {} | {:.3g} | {:.3g} | {:.2f} | {:.0f} | {:.0f} | {:.2f} |\n", name,
               report["n"].get<std::uint64_t>(), seconds, took, time_ratio, memory / 1e6, packed.memory / 1e6,
               memory_ratio);
    std::fflush(stdout);
  }
  std::ranges::sort(ratios);
  fmt::print(
      "\nOf {} scenes {} take between half and twice the expected time; the median factor is {:.2f}, the "
      "worst {:.1f} ({}). "
      "Memory is within a factor of {:.2f} ({}).\n",
      ratios.size(), std::ranges::count_if(ratios, [](double r) { return r <= 2; }),
      ratios[ratios.size() / 2], worst_time, slowest, worst_memory, largest);
  fs::remove_all(folder);
}
