#pragma once
#include <cstddef>
#include <cstdlib>
#include <iostream>
#include <span>
#include <string>
#include <string_view>

#include "bernal/core/random.hpp"

namespace bernal::testing {

inline std::size_t below(Random& random, std::size_t n) { return static_cast<std::size_t>(random() % n); }

/// How many inputs a fuzzer tries: those of the variable BERNAL_FUZZ, which prints them, or a few.
inline std::size_t fuzz_inputs(std::size_t few) {
  const char* asked = std::getenv("BERNAL_FUZZ");
  if (asked == nullptr) return few;
  const std::size_t inputs = std::strtoull(asked, nullptr, 10);
  std::cout << inputs << " inputs\n";
  return inputs;
}

/// One to three random edits: bytes, pieces left out, repeated or put elsewhere, ends, tokens.
inline std::string mutated(std::string text, std::span<const std::string_view> tokens, Random& random) {
  const std::size_t edits = 1 + below(random, 3);
  for (std::size_t i = 0; i < edits && !text.empty(); ++i) {
    const std::size_t at = below(random, text.size()), length = 1 + below(random, 30);
    switch (below(random, 6)) {
      case 0:
        text[at] = static_cast<char>(random());
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.insert(at, text.substr(below(random, text.size()), length));
        break;
      case 3:
        text.resize(at);
        break;
      case 4: {  // a word or a number for another
        const std::size_t from = text.find_first_of("0123456789", at);
        if (from == std::string::npos) break;
        const std::size_t end = std::min(text.find_first_not_of("0123456789.e+-", from), text.size());
        text.replace(from, end - from, tokens[below(random, tokens.size())]);
        break;
      }
      default:
        text.insert(at, tokens[below(random, tokens.size())]);
    }
  }
  return text;
}

}  // namespace bernal::testing
