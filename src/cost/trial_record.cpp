#include <unistd.h>

#include <charconv>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/scene/read_scene.hpp"
#include "bernal/version.hpp"
#include "core/fnv.hpp"
#include "cost/rounds.hpp"

namespace bernal::cost {
namespace {

constexpr std::string_view header =
    "key,setting,seed,threads,outcome,reason,cut_off,spheres,packing_fraction,certified,max_overlap,"
    "early_overlap,protrusion,wall_gap,held_from,contact_ratio,rattlers,coordination,hash,seconds,cpu_"
    "seconds,"
    "prepare_seconds,peak_bytes,effects";
constexpr std::size_t columns = 24;

std::string in_quotes(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c == '\n' || c == '\r' ? ' ' : c;
  }
  return out + '"';
}

/// The cells of a line whose texts may be quoted.
std::vector<std::string> cells_of(std::string_view line) {
  std::vector<std::string> cells(1);
  bool inside = false;
  for (std::size_t k = 0; k < line.size(); ++k) {
    const char c = line[k];
    if (c == '"' && inside && k + 1 < line.size() && line[k + 1] == '"')
      cells.back() += line[++k];
    else if (c == '"')
      inside = !inside;
    else if (c == ',' && !inside)
      cells.emplace_back();
    else
      cells.back() += c;
  }
  return cells;
}

std::string text_of(const std::optional<double>& value) { return value ? fmt::format("{}", *value) : ""; }

std::string text_of(const std::vector<Effect>& effects) {
  std::string text;
  for (const Effect& effect : effects)
    text += fmt::format("{}{}:{}:{}", text.empty() ? "" : ";", effect.name, effect.calls, effect.seconds);
  return text;
}

/// Takes the cells one after the other; throws where one is no such value.
class Cells {
 public:
  explicit Cells(std::vector<std::string> cells) : cells_(std::move(cells)) {
    if (cells_.size() != columns) refuse();
  }
  std::string text() { return cells_[next_++]; }
  bool flag() {
    const std::string cell = text();
    if (cell != "yes" && cell != "no") refuse();
    return cell == "yes";
  }
  template <class Number>
  Number number() {
    return parsed<Number>(text());
  }
  std::optional<double> number_or_none() {
    const std::string cell = text();
    return cell.empty() ? std::nullopt : std::optional(parsed<double>(cell));
  }
  Outcome outcome() {
    const std::string cell = text();
    for (const Outcome o : {Outcome::converged, Outcome::full, Outcome::hit_limit, Outcome::cancelled})
      if (name_of(o) == cell) return o;
    refuse();
  }
  std::vector<Effect> effects() {
    std::vector<Effect> all;
    std::istringstream parts(text());
    for (std::string part; std::getline(parts, part, ';');) {
      const std::size_t second = part.rfind(':');
      const std::size_t first = second == part.npos || second == 0 ? part.npos : part.rfind(':', second - 1);
      if (first == part.npos) refuse();
      all.push_back({part.substr(0, first), parsed<std::uint64_t>(part.substr(first + 1, second - first - 1)),
                     parsed<double>(part.substr(second + 1))});
    }
    return all;
  }

 private:
  template <class Number>
  static Number parsed(const std::string& cell) {
    Number value{};
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (error != std::errc{} || end != cell.data() + cell.size()) refuse();
    return value;
  }
  [[noreturn]] static void refuse() {
    throw Error(ErrorCode::bad_argument, "this line is no trial; remove the file, or name another folder");
  }

  std::vector<std::string> cells_;
  std::size_t next_ = 0;
};

std::string line_of(const std::string& key, const std::string& name, const Trial& t) {
  const auto flag = [](bool value) { return value ? "yes" : "no"; };
  return fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", key,
                     in_quotes(name), t.seed, t.threads, name_of(t.outcome), in_quotes(t.reason),
                     flag(t.cut_off), t.spheres, t.packing_fraction, flag(t.certified), t.max_overlap,
                     t.early_overlap, t.protrusion, text_of(t.wall_gap), text_of(t.held_from),
                     text_of(t.contact_ratio), t.rattlers, t.coordination, t.hash, t.seconds, t.cpu_seconds,
                     t.prepare_seconds, text_of(t.peak_bytes), in_quotes(text_of(t.effects)));
}

Trial trial_of(Cells& cells) {
  Trial t;
  t.seed = cells.number<std::uint64_t>();
  t.threads = cells.number<int>();
  t.outcome = cells.outcome();
  t.reason = cells.text();
  t.cut_off = cells.flag();
  t.spheres = cells.number<std::uint64_t>();
  t.packing_fraction = cells.number<double>();
  t.certified = cells.flag();
  t.max_overlap = cells.number<double>();
  t.early_overlap = cells.number<double>();
  t.protrusion = cells.number<double>();
  t.wall_gap = cells.number_or_none();
  t.held_from = cells.number_or_none();
  t.contact_ratio = cells.number_or_none();
  t.rattlers = cells.number<std::uint64_t>();
  t.coordination = cells.number<double>();
  t.hash = cells.text();
  t.seconds = cells.number<double>();
  t.cpu_seconds = cells.number<double>();
  t.prepare_seconds = cells.number<double>();
  t.peak_bytes = cells.number_or_none();
  t.effects = cells.effects();
  return t;
}

std::string key_of(const Scene& stated, const bool stands_for_another) {
  Scene scene = stated;
  scene.seed = 0;
  complete(scene);
  return hash_of_text(scene_as_toml(scene) + std::string(version()) + (stands_for_another ? "*" : ""));
}

std::string key_of_trial(const std::string& key, std::uint64_t seed, int threads) {
  return fmt::format("{} {} {}", key, seed, threads);
}

}  // namespace

std::string hash_of_text(std::string_view text) {
  Fnv1a fnv;
  fnv.absorb(text);
  return fmt::format("{:016x}", fnv.hash());
}

TrialRecord::TrialRecord(std::filesystem::path file) : file_(std::move(file)) {
  std::string whole;
  if (std::ifstream in(file_, std::ios::binary); in) whole.assign(std::istreambuf_iterator<char>(in), {});
  const std::size_t end = whole.rfind('\n') + 1;  // 0 where there is none
  int number = 0;
  std::istringstream lines(whole.substr(0, end));
  for (std::string line; std::getline(lines, line);) {
    const Location here{file_.string(), ++number};
    if (number == 1 && line != header)
      throw Error(ErrorCode::bad_argument, "is no record of trials; remove it, or name another folder", here);
    if (number == 1) continue;
    try {
      Cells cells(cells_of(line));
      const std::string key = cells.text();
      cells.text();  // the name that the setting had
      const Trial trial = trial_of(cells);
      trials_[key_of_trial(key, trial.seed, trial.threads)] = trial;
    } catch (const Error& error) {
      throw Error(error.code(), error.what(), here);
    }
  }
  // What was cut off in the middle would run into the next line.
  if (end < whole.size() && ::truncate(file_.c_str(), static_cast<off_t>(end)) != 0)
    throw Error(ErrorCode::cannot_write, "cannot be written", {file_.string()});
  if (number == 0) {
    std::ofstream out(file_, std::ios::app);
    if (!(out << header << '\n' << std::flush))
      throw Error(ErrorCode::cannot_write, "cannot be written", {file_.string()});
  }
}

const Trial* TrialRecord::find(const Setting& setting, std::uint64_t seed, int threads) const {
  const auto found =
      trials_.find(key_of_trial(key_of(setting.scene, setting.meant != nullptr), seed, threads));
  return found == trials_.end() ? nullptr : &found->second;
}

void TrialRecord::add(const Setting& setting, const Trial& trial) {
  const std::string key = key_of(setting.scene, setting.meant != nullptr);
  trials_[key_of_trial(key, trial.seed, trial.threads)] = trial;
  if (file_.empty()) return;
  std::ofstream out(file_, std::ios::app);
  if (!(out << line_of(key, setting.name, trial) << std::flush))
    throw Error(ErrorCode::cannot_write, "cannot be written", {file_.string()});
}

}  // namespace bernal::cost
