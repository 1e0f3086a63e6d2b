#include <fcntl.h>
#include <sys/stat.h>

#include <charconv>
#include <sstream>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/scene/read_scene.hpp"
#include "bernal/version.hpp"
#include "core/fnv.hpp"
#include "cost/rounds.hpp"
#include "files/descriptor.hpp"
#include "files/input_file.hpp"
#include "files/staged_folder.hpp"

namespace bernal::cost {
namespace {

constexpr std::string_view header =
    "key,setting,seed,threads,packings_number,outcome,reason,cut_off,spheres,packing_fraction,"
    "packed_fraction,size_scale,certified,max_overlap,early_overlap,protrusion,wall_gap,held_from,contact_"
    "ratio,rattlers,coordination,"
    "hash,seconds,cpu_seconds,prepare_seconds,peak_bytes,effects,seal";
constexpr std::size_t columns = 28;
/// With which the record of any version begins.
constexpr std::string_view begin_of_header = "key,setting,seed,threads,";
/// Of a line that names a file and its digest.
constexpr std::string_view file_mark = "# file,";

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

/// No number of a trial is larger, whatever it counts.
constexpr double longest = 1e15;

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
  /// In [least, most]; no number that is none, none without end.
  double number(double least, double most = std::numeric_limits<double>::max()) {
    return within(parsed<double>(text()), least, most);
  }
  std::optional<double> number_or_none(double least = 0) {
    const std::string cell = text();
    if (cell.empty()) return {};
    return within(parsed<double>(cell), least, std::numeric_limits<double>::max());
  }
  Outcome outcome() {
    const std::string cell = text();
    for (const Outcome o :
         {Outcome::converged, Outcome::loose, Outcome::full, Outcome::hit_limit, Outcome::cancelled})
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
                     within(parsed<double>(part.substr(second + 1)), 0, longest)});
    }
    return all;
  }

 private:
  static double within(double value, double least, double most) {
    if (!(value >= least && value <= most)) refuse();
    return value;
  }
  template <class Number>
  static Number parsed(const std::string& cell) {
    Number value{};
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (error != std::errc{} || end != cell.data() + cell.size()) refuse();
    return value;
  }
  [[noreturn]] static void refuse() {
    throw Error(ErrorCode::bad_argument, "this line is no trial; remove it, or name another folder");
  }

  std::vector<std::string> cells_;
  std::size_t next_ = 0;
};

/// Of all that stands before it in the line of a trial: whoever changes a figure breaks it.
std::string seal_of(std::string_view line) { return hash_of_text(line); }

std::string line_of(const std::string& key, const std::string& name, const Trial& t) {
  const auto flag = [](bool value) { return value ? "yes" : "no"; };
  std::string line = fmt::format(
      "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},", key,
      in_quotes(name), t.seed, t.threads, t.packings_number, name_of(t.outcome), in_quotes(t.reason),
      flag(t.cut_off), t.spheres, t.packing_fraction, t.packed_fraction, t.size_scale, flag(t.certified),
      t.max_overlap, t.early_overlap, t.protrusion, text_of(t.wall_gap), text_of(t.held_from),
      text_of(t.contact_ratio), t.rattlers, t.coordination, t.hash, t.seconds, t.cpu_seconds,
      t.prepare_seconds, text_of(t.peak_bytes), in_quotes(text_of(t.effects)));
  return line + seal_of(line) + '\n';
}

/// Throws where the line of a trial is not as it was written.
void require_sealed(std::string_view line) {
  const std::size_t end = line.rfind(',') + 1;
  if (line.substr(end) != seal_of(line.substr(0, end)))
    throw Error(ErrorCode::bad_argument,
                "this line is not as bernal cost wrote it; remove it, and the trial is made again, or name "
                "another folder");
}

Trial trial_of(Cells& cells) {
  Trial t;
  t.seed = cells.number<std::uint64_t>();
  t.threads = static_cast<int>(cells.number(1, 1e6));
  t.packings_number = static_cast<int>(cells.number(0, 1e9));
  t.outcome = cells.outcome();
  t.reason = cells.text();
  t.cut_off = cells.flag();
  t.spheres = cells.number<std::uint64_t>();
  t.packing_fraction = cells.number(0, 1);
  t.packed_fraction = cells.number(0, longest);
  t.size_scale = cells.number(1e-6, longest);
  t.certified = cells.flag();
  t.max_overlap = cells.number(0, 1);
  t.early_overlap = cells.number(0, longest);
  t.protrusion = cells.number(0, longest);
  t.wall_gap = cells.number_or_none(-longest);
  t.held_from = cells.number_or_none();
  t.contact_ratio = cells.number_or_none();
  t.rattlers = cells.number<std::uint64_t>();
  t.coordination = cells.number(0, longest);
  t.hash = cells.text();
  t.seconds = cells.number(0, longest);
  t.cpu_seconds = cells.number(0, longest);
  t.prepare_seconds = cells.number(0, longest);
  t.peak_bytes = cells.number_or_none();
  t.effects = cells.effects();
  return t;
}

std::string key_of(const Scene& stated, const bool stands_for_another) {
  Scene scene = stated;
  scene.seed = 0;
  complete(scene);
  return hash_of_text(scene_as_toml(scene) + (stands_for_another ? "*" : ""));
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

namespace {

std::string whole_text(const std::filesystem::path& file) {
  if (std::filesystem::is_directory(file))
    throw Error(ErrorCode::cannot_write,
                "is a folder, and a file is to be written there; remove it, or name another ‹folder›",
                {file.string()});
  InputFile in(file);
  if (!in && stands(file))
    throw Error(ErrorCode::cannot_write, "cannot be read; remove it, or name another ‹folder›",
                {file.string()});
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

TrialRecord TrialRecord::read(const std::filesystem::path& file, bool afresh) {
  TrialRecord record;
  record.file_ = file;
  const std::string whole = whole_text(file);
  record.read_whole(whole, afresh);
  return record;
}

TrialRecord::TrialRecord(std::filesystem::path file, bool afresh) : file_(std::move(file)) {
  const std::string whole = whole_text(file_);
  const std::size_t end = read_whole(whole, afresh);
  const auto cut = [&](std::size_t size) {
    std::error_code problem;
    if (std::filesystem::is_symlink(file_, problem) ||
        ::truncate(file_.c_str(), static_cast<off_t>(size)) != 0)
      throw Error(ErrorCode::cannot_write, "cannot be written", {file_.string()});
  };
  // What was cut off in the middle would run into the next line.
  if (end < whole.size()) cut(end);
  if (afresh && end > 0) cut(0);
  if (!afresh && end > 0) {
    append("");  // so that it is known before a run whether this can be
    return;
  }
  std::string text = std::string(header) + '\n';
  for (const auto& [name, sha256] : written_) text += fmt::format("{}{},{}\n", file_mark, name, sha256);
  append(text);
}

void TrialRecord::append(const std::string& text) const {
  // No link is followed, and no pipe waited for.
  const Descriptor file(
      ::open(file_.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666));
  struct stat facts {};
  const bool whole =
      file.is_open() && ::fstat(file.number(), &facts) == 0 && S_ISREG(facts.st_mode) && file.write(text);
  if (!whole)
    throw Error(ErrorCode::cannot_write, "cannot be written to; make it writable, or name another folder",
                {file_.string()});
}

void TrialRecord::add_file(const std::string& name, const std::string& sha256) {
  if (written_.emplace(name, sha256).second && !file_.empty())
    append(fmt::format("{}{},{}\n", file_mark, name, sha256));
}

std::size_t TrialRecord::read_whole(const std::string& whole, bool afresh) {
  const std::size_t end = whole.rfind('\n') + 1;  // 0 where there is none
  if (end == 0 && !header.starts_with(whole))
    throw Error(ErrorCode::bad_argument, "is no record of trials; remove it, or name another folder",
                {file_.string(), 1});
  int number = 0;
  std::istringstream lines(whole.substr(0, end));
  for (std::string line; std::getline(lines, line);) {
    const Location here{file_.string(), ++number};
    if (number == 1 && line != header && !(afresh && line.starts_with(begin_of_header)))
      throw Error(ErrorCode::bad_argument,
                  line.starts_with(begin_of_header)
                      ? fmt::format("is the record of another bernal, which keeps other things of a run than "
                                    "this one, {}; give ‹fresh›, or name another ‹folder›",
                                    text_of(this_program()))
                      : "is no record of trials; remove it, or name another folder",
                  here);
    if (number == 1) continue;
    if (line.starts_with(file_mark)) {
      const std::size_t comma = line.rfind(',');
      if (comma >= file_mark.size())
        written_.emplace(line.substr(file_mark.size(), comma - file_mark.size()), line.substr(comma + 1));
      continue;
    }
    if (afresh) continue;
    try {
      Cells cells(cells_of(line));
      require_sealed(line);
      const std::string key = cells.text();
      cells.text();  // the name that the setting had
      const Trial trial = trial_of(cells);
      (trial.packings_number == packings_number() ? trials_
                                                  : outdated_)[key_of_trial(key, trial.seed, trial.threads)] =
          trial;
    } catch (const Error& error) {
      throw Error(error.code(), error.what(), here);
    }
  }
  std::erase_if(outdated_, [&](const auto& trial) { return trials_.contains(trial.first); });
  return end;
}

const Trial* TrialRecord::find(const Setting& setting, std::uint64_t seed, int threads) const {
  const auto found =
      trials_.find(key_of_trial(key_of(setting.scene, setting.meant != nullptr), seed, threads));
  return found == trials_.end() ? nullptr : &found->second;
}

void TrialRecord::add(const Setting& setting, const Trial& trial) {
  const std::string key = key_of(setting.scene, setting.meant != nullptr);
  trials_[key_of_trial(key, trial.seed, trial.threads)] = trial;
  if (!file_.empty()) append(line_of(key, setting.name, trial));
}

}  // namespace bernal::cost
