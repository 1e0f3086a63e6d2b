#pragma once
#include <cstdio>
#include <string>
#include <utility>

#include <fmt/format.h>

/// Prints words beside a result, which is not lost where nobody takes them: a stream that is full or whose
/// reader has left is passed over. `main` looks at standard output in the end.
template <class... Args>
void say(std::FILE* stream, fmt::format_string<Args...> words, Args&&... args) {
  const std::string text = fmt::format(words, std::forward<Args>(args)...);
  std::fwrite(text.data(), 1, text.size(), stream);
}
