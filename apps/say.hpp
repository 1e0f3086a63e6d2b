#pragma once
#include <cstdio>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

/// What the library says, its options as the command line has them: "give --unit mm" for "give ‹unit=mm›".
std::string in_words_of_command(std::string_view message);

/// Prints words of the command or of the library beside a result, which is not lost where nobody takes them:
/// a stream that is full or whose reader has left is passed over. `main` looks at standard output in the end.
template <class... Args>
void say(std::FILE* stream, fmt::format_string<Args...> words, Args&&... args) {
  std::string text = fmt::format(words, std::forward<Args>(args)...);
  if (stream == stderr) text = in_words_of_command(text);  // standard output has data, which stay as they are
  std::fwrite(text.data(), 1, text.size(), stream);
}
