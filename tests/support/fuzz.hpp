#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <iostream>
#include <span>
#include <string>
#include <string_view>

#include "bernal/core/random.hpp"

namespace bernal::testing {

inline std::size_t below(Random& random, std::size_t n) { return static_cast<std::size_t>(random() % n); }

/// How many inputs a fuzzer tries: those of the variable BERNAL_FUZZ, or one in so many of them where each
/// takes that much longer, which it prints; or a few.
inline std::size_t fuzz_inputs(std::size_t few, std::size_t one_in = 1) {
  const char* asked = std::getenv("BERNAL_FUZZ");
  if (asked == nullptr) return few;
  const std::size_t inputs = std::strtoull(asked, nullptr, 10) / one_in;
  std::cout << inputs << " inputs\n";
  return inputs;
}

/// One to four random edits: bytes, pieces left out, repeated or put elsewhere, ends, tokens, numbers and the
/// values behind equals signs. `others` lend pieces, too.
inline std::string mutated(std::string text, std::span<const std::string_view> tokens, Random& random,
                           std::span<const std::string> others = {}) {
  const auto token = [&] { return tokens[below(random, tokens.size())]; };
  const auto replace = [&](std::size_t from, std::size_t end) {
    if (from <= end && end <= text.size()) text.replace(from, end - from, token());
  };
  const std::size_t edits = 1 + below(random, 4);
  for (std::size_t i = 0; i < edits && !text.empty(); ++i) {
    const std::size_t at = below(random, text.size()), length = 1 + below(random, 40);
    switch (below(random, 7)) {
      case 0:
        text[at] = static_cast<char>(random());
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2: {
        const std::string& source = others.empty() ? text : others[below(random, others.size())];
        text.insert(at, source.substr(below(random, source.size()), length));
        break;
      }
      case 3:
        text.resize(at);
        break;
      case 4: {
        constexpr std::string_view digits = "0123456789";
        const std::size_t from = text.find_first_of(digits, at);
        replace(from, std::min(text.find_first_not_of("0123456789.e+-", from), text.size()));
        break;
      }
      case 5:
        if (const std::size_t sign = text.find('=', at); sign != std::string::npos)
          replace(sign + 1, text.find('\n', sign));
        break;
      default:
        text.insert(at, token());
    }
  }
  return text;
}

}  // namespace bernal::testing
