#include "results.hpp"

#include <algorithm>

#include "bernal/core/error.hpp"
#include "bernal/core/monitor.hpp"
#include "bernal/core/text.hpp"
#include "bernal/result/read_packing.hpp"
#include "commands.hpp"
#include "say.hpp"

using namespace bernal;

void say_if_unpublished(const std::filesystem::path& folder) {
  if (is_unpublished(folder))
    say(stderr,
        "bernal: {}: a run was killed while it put its result there; this is that result, and nothing was "
        "moved: the next run that writes there puts it into place\n",
        plain_text(folder.string(), 5000));
}

Packing read_result(const std::filesystem::path& folder) {
  Packing packing = read_packing(folder);
  say_if_unpublished(folder);
  return packing;
}

std::optional<tbb::global_control> limited_to(int threads) {
  if (threads <= 0) return {};
  return std::optional<tbb::global_control>(std::in_place, tbb::global_control::max_allowed_parallelism,
                                            static_cast<std::size_t>(threads));
}

void require_named_file(const std::filesystem::path& file) {
  if (file == "-")
    throw Error(ErrorCode::bad_argument, "a format may need several files; give -o the name of one");
}

void say_files(const std::vector<std::filesystem::path>& files) {
  for (std::size_t i = 0; i < files.size(); ++i)
    say(stderr, "{:<10} {}\n", i == 0 ? "files" : "", plain_text(files[i].string(), 5000));
}

void say_written(const std::string& format, const std::string& note,
                 const std::vector<std::filesystem::path>& files) {
  say(stderr, "{:<10} {}\n", format, note);
  say_files(files);
}

int all_or_nothing(bool quiet, const std::function<int()>& write) try {
  return write();
} catch (const Cancelled&) {
  if (!quiet) say(stderr, "bernal: stopped by the user; nothing is written\n");
  return exit_code::not_reached;
}

std::string option_of_key(std::string key) {
  std::ranges::replace(key, '_', '-');
  return "--" + key;
}
