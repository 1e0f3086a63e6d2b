#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace bernal {

/// A word that a scene takes, and a phrase on what it is.
struct KnownWord {
  std::string_view name, about;
  KnownWord(std::string_view word, std::string_view phrase = {}) : name(word), about(phrase) {}
};

/// Those by which the tables are chosen: entries, or tables that have theirs as `keys`.
template <class Tables>
std::vector<KnownWord> known_words_in(const Tables& tables) {
  std::vector<KnownWord> words;
  for (const auto& table : tables)
    if constexpr (requires { table->keys; })
      words.emplace_back(table->keys.name, table->keys.help);
    else
      words.emplace_back(table.name, table.help);
  return words;
}

/// What to tell who wrote another word than these: see `remedy`; where none is near by its letters, those
/// that mean the same, see `relevance`: `; did you mean "tube"?` of "annulus".
std::string remedy_of_word(std::string_view word, const std::vector<KnownWord>& known);

}  // namespace bernal
