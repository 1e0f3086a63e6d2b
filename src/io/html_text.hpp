#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace bernal {

/// Text made safe inside HTML elements and quoted attributes.
inline std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

/// 1234567 as 1,234,567.
inline std::string grouped(std::uint64_t n) {
  std::string out = std::to_string(n);
  for (std::size_t place = out.size(); place > 3; place -= 3) out.insert(place - 3, 1, ',');
  return out;
}

}  // namespace bernal
