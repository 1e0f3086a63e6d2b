#pragma once
#include <string>
#include <string_view>

namespace bernal {

/// The letters A to Z as a to z. Inline, since modules that link none of bernal use it too.
inline std::string in_lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lower;
}

}  // namespace bernal
