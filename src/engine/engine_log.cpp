#include "engine/engine_log.hpp"

#include <algorithm>
#include <charconv>
#include <csignal>
#include <cstring>

#include <fmt/format.h>

#include "bernal/core/text.hpp"
#include "engine/script_parts.hpp"
#include "files/input_file.hpp"

namespace bernal::engine {
namespace {

/// Taken in at a time.
constexpr std::uintmax_t most_of_log = 1 << 20;

/// The first line that holds the text, from where it stands; empty where there is none.
std::string_view line_with(std::string_view text, std::string_view what) {
  const std::size_t at = text.find(what);
  if (at == std::string_view::npos) return {};
  return trimmed(text.substr(at, text.find('\n', at) - at));
}

/// "ERROR: Lost atoms: original 10 current 9 (../thermo.cpp:481)" without the place in the engine's source.
std::string error_in(std::string_view text) {
  std::string_view line;
  for (const std::string_view mark : {"ERROR on proc", "ERROR:", "ERROR "})
    if (line = line_with(text, mark); !line.empty()) break;
  if (const std::size_t place = line.rfind(" ("); place != std::string_view::npos && line.ends_with(')'))
    line = line.substr(0, place);
  return plain_text(line, 300);
}

bool holds(std::string_view text, std::string_view what) { return text.find(what) != std::string_view::npos; }

/// What a launcher says that did not start the ranks.
std::optional<std::string> of_launcher(std::string_view output) {
  if (holds(output, "not enough slots"))
    return "mpirun has not enough slots for so many ranks: give fewer \"ranks\" in [engine], or a "
           "\"command\" "
           "that names hosts";
  if (holds(output, "mpirun has detected an attempt to run as root"))
    return "mpirun refuses to be started by root: set OMPI_ALLOW_RUN_AS_ROOT=1 and "
           "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1, or start bernal as another user";
  if (holds(output, "mpirun was unable to launch") || holds(output, "could not be found"))
    return "mpirun could not launch the engine: see what it says";
  return std::nullopt;
}

std::string remedy_for(std::string_view error) {
  if (holds(error, "Lost atoms")) return "give fewer \"ranks\", or another \"seed\"";
  if (holds(error, "Unknown") || holds(error, "Unrecognized") || holds(error, "Illegal") ||
      holds(error, "Invalid"))
    return "it is of another version, or built without its package for granular matter; name one that has it "
           "by \"executable\"";
  if (holds(error, "memory") || holds(error, "llocate"))
    return "give fewer spheres, or more ranks on more machines";
  if (holds(error, "esh") || holds(error, "STL"))
    return "its meshes must not be finer than the spheres by much; coarsen the part";
  return "see its log";
}

}  // namespace

std::optional<std::int64_t> LogWatch::new_step() {
  InputFile in(log_);
  if (!in) return std::nullopt;
  in.seekg(static_cast<std::streamoff>(read_));
  std::string more(most_of_log, '\0');
  in.read(more.data(), static_cast<std::streamsize>(more.size()));
  more.resize(static_cast<std::size_t>(in.gcount()));
  read_ += more.size();
  rest_ += more;
  const std::int64_t before = step_;
  std::size_t from = 0;
  for (std::size_t to; (to = rest_.find('\n', from)) != std::string::npos; from = to + 1)
    take(std::string_view(rest_).substr(from, to - from));
  rest_.erase(0, from);
  if (rest_.size() > most_of_log) rest_.clear();
  return step_ == before ? std::nullopt : std::optional(step_);
}

void LogWatch::take(std::string_view line) {
  line = trimmed(line);
  if (line.starts_with("Step ")) {
    in_table_ = true;
    return;
  }
  std::int64_t step = 0;
  const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), step);
  const bool is_row = error == std::errc() && end != line.data() + line.size() && *end == ' ';
  in_table_ = in_table_ && is_row;
  if (in_table_) step_ = step;
}

std::optional<std::string> what_is_wrong(const Dialect& dialect, const ChildEnd& end, std::string_view log,
                                         std::string_view output) {
  std::string error = error_in(log);
  if (error.empty()) error = error_in(output);
  if (!error.empty()) return fmt::format("{} ended with \"{}\": {}", dialect.title, error, remedy_for(error));
  if (end.code != 0)
    if (const std::optional<std::string> refused = of_launcher(output)) return refused;
  if (end.signal != 0)
    return fmt::format(
        "{} was ended by a signal ({}): {}", dialect.title, strsignal(end.signal),
        end.signal == SIGKILL ? "if nobody did that, memory has run out; give fewer spheres" : "see its log");
  // A shell and mpirun report the signal of what they started as a code.
  if (end.code > 128 && end.code < 160)
    return fmt::format("{} was ended by a signal ({}): see its log", dialect.title,
                       strsignal(end.code - 128));
  if (end.code != 0)
    return fmt::format("{} ended with exit code {} and without a word why: see its log", dialect.title,
                       end.code);
  if (!holds(log, last_words) && !holds(output, last_words))
    return fmt::format("{} ended before its script did: see its log", dialect.title);
  return std::nullopt;
}

bool says_it_is_alone(std::string_view log) { return holds(log, "  1 by 1 by 1 MPI processor grid"); }

std::string tail_of(const std::filesystem::path& file, std::uintmax_t most) {
  std::error_code missing;
  const std::uintmax_t size = std::filesystem::file_size(file, missing);
  if (missing) return {};
  InputFile in(file);
  in.seekg(static_cast<std::streamoff>(size > most ? size - most : 0));
  std::string text(static_cast<std::size_t>(std::min(size, most)), '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  return text;
}

}  // namespace bernal::engine
