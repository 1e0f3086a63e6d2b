#include "writing.hpp"

#include <algorithm>

#include "bernal/core/error.hpp"
#include "bernal/core/monitor.hpp"
#include "bernal/core/text.hpp"
#include "commands.hpp"
#include "say.hpp"

using namespace bernal;

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
