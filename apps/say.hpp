#pragma once
#include <cstdio>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

/// What the library says, its options as the command line has them: "give --unit mm" for "give ‹unit=mm›".
std::string in_words_of_command(std::string_view message);

/// From now on `say` speaks of a packing of so many dimensions: of discs in two.
void speak_of(int dimension);
/// The words as that has them.
std::string in_dimension_spoken_of(std::string_view words);

/// The same in amber where the stream is a terminal that shows colours, see https://no-color.org.
std::string in_amber(std::FILE* stream, std::string_view words);

/// Prints words of the command or of the library beside a result, which is not lost where nobody takes them:
/// a stream that is full or whose reader has left is passed over. `main` looks at standard output in the end.
template <class... Args>
void say(std::FILE* stream, fmt::format_string<Args...> words, Args&&... args) {
  std::string text = in_dimension_spoken_of(fmt::format(words, std::forward<Args>(args)...));
  if (stream == stderr) text = in_words_of_command(text);  // standard output has data, which stay as they are
  std::fwrite(text.data(), 1, text.size(), stream);
}
