#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "engine/engine_files.hpp"
#include "process/child.hpp"

namespace bernal::engine {

/// Reads what is added to a log while an engine works.
class LogWatch {
 public:
  explicit LogWatch(std::filesystem::path log) : log_(std::move(log)) {}

  /// The step that the engine has last reported, where it has reported another since the last call.
  std::optional<std::int64_t> new_step();

 private:
  void take(std::string_view line);

  std::filesystem::path log_;
  std::uintmax_t read_ = 0;
  std::string rest_;  // of a line that is not whole yet
  bool in_table_ = false;
  std::int64_t step_ = -1;
};

/// Why an engine that has ended has no result, in one line with the remedy, by how it ended and what its log
/// and its output say; nothing where nothing is wrong with these.
std::optional<std::string> what_is_wrong(const Dialect& dialect, const ChildEnd& end, std::string_view log,
                                         std::string_view output);

/// Whether the engine says that it is one process. Where several were started, each then did not know of the
/// others and packed everything by itself: the launcher is of another MPI than the engine.
bool says_it_is_alone(std::string_view log);

/// The last `most` bytes of a file; empty where there is none.
std::string tail_of(const std::filesystem::path& file, std::uintmax_t most);

}  // namespace bernal::engine
