#include "scene/known_words.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/text.hpp"
#include "bernal/scene/scene_reference.hpp"

namespace bernal {

std::string remedy_of_word(std::string_view word, const std::vector<KnownWord>& known) {
  constexpr std::size_t most = 3;  // of a word that means so many, nobody means one
  std::vector<std::string_view> names, meant;
  double best = 0;
  for (const auto& [name, about] : known) {
    names.push_back(name);
    const double match = relevance(word, name, about);
    if (match > best) meant.clear();
    if (match > 0 && match >= best) meant.push_back(name);
    best = std::max(best, match);
  }
  if (meant.empty() || meant.size() > most || !nearest_name(word, names).empty()) return remedy(word, names);
  return fmt::format("; did you mean \"{}\"?", fmt::join(meant, "\" or \""));
}

}  // namespace bernal
