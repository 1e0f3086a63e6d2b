#include "say.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>

#include "bernal/core/text.hpp"

namespace {

int dimension_spoken_of = 3;

}  // namespace

void speak_of(int dimension) { dimension_spoken_of = dimension; }

std::string in_dimension_spoken_of(std::string_view words) {
  return bernal::in_dimension(dimension_spoken_of, words);
}

std::string in_amber(std::FILE* stream, std::string_view words) {
  const char *none = std::getenv("NO_COLOR"), *terminal = std::getenv("TERM");
  const bool shows = isatty(fileno(stream)) != 0 && !(none && *none != '\0') && terminal &&
                     std::string_view(terminal) != "dumb";
  return shows ? fmt::format("\x1b[33m{}\x1b[0m", words) : std::string(words);
}

std::string in_words_of_command(std::string_view message) {
  return bernal::with_options(message, [](std::string_view name, std::string_view value) -> std::string {
    if (name == "folder") return "folder with -o";
    if (name == "file") return "name with -o";
    std::string option(name == "format" ? "from" : name);
    std::ranges::replace(option, '_', '-');
    return fmt::format("--{}{}{}", option, value.empty() ? "" : " ", value);
  });
}
