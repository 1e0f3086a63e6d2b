#pragma once
#include <string>
#include <string_view>

namespace bernal {

/// Escapes text for HTML elements and quoted attributes.
inline std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    constexpr std::string_view unsafe = "&<>\"", names[] = {"&amp;", "&lt;", "&gt;", "&quot;"};
    const std::size_t k = unsafe.find(c);
    out += k == unsafe.npos ? std::string_view(&c, 1) : names[k];
  }
  return out;
}

}  // namespace bernal
