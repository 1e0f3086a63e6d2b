#include "say.hpp"

#include <algorithm>

#include "bernal/core/text.hpp"

std::string in_words_of_command(std::string_view message) {
  return bernal::with_options(message, [](std::string_view name, std::string_view value) -> std::string {
    if (name == "folder") return "folder with -o";
    if (name == "file") return "name with -o";
    std::string option(name == "format" ? "from" : name);
    std::ranges::replace(option, '_', '-');
    return fmt::format("--{}{}{}", option, value.empty() ? "" : " ", value);
  });
}
