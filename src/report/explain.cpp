#include <cmath>
#include <sstream>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/text.hpp"
#include "bernal/plan/layer_shares.hpp"
#include "bernal/report/describe.hpp"
#include "bernal/scene/read_scene.hpp"
#include "report/describe.hpp"
#include "report/size_summary.hpp"

namespace bernal {
namespace {

/// To two digits, the precision of the estimate.
std::string duration_in_words(double seconds) {
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

/// Wraps text into lines of at most 100 columns, each indented by `blanks`.
std::string in_lines(const std::string& words, std::size_t blanks) {
  constexpr std::size_t longest = 100;
  std::istringstream all(words);
  std::string text, line(blanks, ' ');
  for (std::string word; all >> word;) {
    if (line.size() > blanks && line.size() + 1 + word.size() > longest) {
      text += line + '\n';
      line.assign(blanks, ' ');
    }
    line += (line.size() > blanks ? " " : "") + word;
  }
  return text + line + '\n';
}

/// Two lines an effect: name and price; explanation. Times included in others are in brackets.
std::string effects_in_words(const Plan& plan) {
  std::string text =
      fmt::format("What would run:\n  {:<16}  {:>10}  {:>7}  {}\n", "effect", "time", "memory", "cost");
  bool any_part = false;
  for (const PlanItem& item : plan.items) {
    const bool takes_time = item.seconds > 0, is_part = item.part && takes_time;
    const std::string time = takes_time ? duration_in_words(item.seconds) : item.if_needed ? "if needed" : "";
    any_part = any_part || is_part;
    std::string line =
        fmt::format("  {:<16}  {:>10}  {:>7}  {}", item.name, is_part ? "(" + time + ")" : time,
                    item.bytes > 0 ? bytes_in_words(item.bytes) : "", item.cost);
    line.erase(line.find_last_not_of(' ') + 1);
    text += fmt::format("{}\n{}", line,
                        in_lines((item.if_needed && takes_time ? "if needed: " : "") + item.what, 6));
  }
  text += fmt::format("  {:<16}  {:>10}  {:>7}  with what the program itself takes\n", "together",
                      duration_in_words(plan.expected_seconds), bytes_in_words(plan.expected_memory_bytes));
  if (any_part) text += "Times in brackets are parts of others.\n";
  return text;
}

std::string_view density_in_words(const BedTarget& bed) {
  if (bed.porosity) return "as asked,";
  switch (bed.density.value_or(BedTarget::Density::poured)) {
    case BedTarget::Density::vibrated:
      return "vibrated,";
    case BedTarget::Density::loose:
      return "loose,";
    case BedTarget::Density::poured:
      break;
  }
  return "poured,";
}

/// 312,345 as 310,000.
std::uint64_t in_two_digits(double count) {
  const double unit = std::pow(10, std::max(0.0, std::floor(std::log10(std::max(1.0, count))) - 1));
  return static_cast<std::uint64_t>(unit * std::round(count / unit));
}

}  // namespace

std::string explain(const Plan& plan) {
  const Scene& scene = plan.scene;
  std::string text = describe(plan);
  text += summary_in_words(summary_of(scene, *plan.radii), scene);
  text += fmt::format("accuracy   walls {}, overlap {}\n", name_of(scene.walls), scene.overlap);
  if (const auto& bed = plan.expected_bed)
    text += fmt::format(
        "bed        {} porosity about {:.3g}, its {} about {:.4g} {} above the lowest point\n",
        density_in_words(scene.target.bed), bed->porosity,
        scene.target.bed.top == BedTarget::Top::heap ? "tip" : "surface", bed->height, name_of(scene.unit));
  text += fmt::format("expected   {}, packing fraction {:.3f}\n", spheres_in_words(plan.expected_count),
                      plan.expected_packing_fraction);
  if (!plan.insides.empty()) {
    const std::optional<double> mass = expected_mass(plan);
    text += fmt::format(
        "           with what lies inside of them about {:.4g} spheres, which stand for themselves{}\n",
        expected_count_of_all_levels(plan), mass ? fmt::format(", and {:.4g} kg", *mass) : std::string());
  }
  text += fmt::format("           about {} to pack them on one core, {} of memory\n",
                      duration_in_words(plan.expected_seconds), bytes_in_words(plan.expected_memory_bytes));
  if (const std::optional<MeshPrice> mesh = price_of_mesh(plan))
    text += fmt::format("           a mesh around them by bernal mesh: about {} tetrahedra, {}, {}\n",
                        grouped(in_two_digits(mesh->tetrahedra)), duration_in_words(mesh->seconds),
                        bytes_in_words(mesh->bytes));
  text += '\n';

  text += effects_in_words(plan);
  if (!plan.absent.empty())
    text += fmt::format("\nNot called for, not built:\n{}",
                        in_lines(fmt::format("{}.", fmt::join(plan.absent, ", ")), 2));
  if (scene.stages_are_default)
    text += fmt::format("\nThe scene names no stages. This protocol runs; paste it to change it:\n\n{}",
                        stages_as_toml(scene));
  return in_dimension(scene.dimension(), text);
}

}  // namespace bernal
