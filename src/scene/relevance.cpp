#include <algorithm>
#include <string>
#include <utility>

#include "bernal/scene/scene_reference.hpp"
#include "core/lower_case.hpp"

namespace bernal {
namespace {

/// Words that say nothing of what is looked for.
constexpr std::string_view empty_words[] = {"a",   "an", "and", "are", "as",  "at",  "by",   "does",  "for",
                                            "how", "i",  "in",  "is",  "it",  "key", "keys", "many",  "much",
                                            "of",  "on", "or",  "set", "the", "to",  "what", "which", "with"};

/// What people say, and the words under which scenes and commands have it.
constexpr std::pair<std::string_view, std::string_view> other_words[] = {
    {"kg kilogram gram g tonne weight weigh", "mass density"},
    {"neighbour neighbor touch coordination", "contact coordination neighbour"},
    {"round roundness dome pile mound cone slope repose", "heap"},
    {"void hollow empty", "porosity cavity"},
    {"dense denser density solid compact", "packing_fraction density porosity"},
    {"amount number quantity", "count"},
    {"size grain particle bead ball granule", "diameter radius spheres"},
    {"distance spacing clearance separation apart", "gap"},
    {"lid open opening close hole leak watertight", "cap holes repair"},
    {"gravity down pour fall", "direction bed settle"},
    {"random reproducible reproduce repeatable", "seed"},
    {"vibrate vibration tap", "shake vibrated"},
    {"deep depth high", "height"},
    {"percentile d10 d50 d90 median", "median percentiles"},
    {"inch mm metre meter millimetre scale", "unit"},
    {"precision tolerance accurate exactly", "accuracy overlap walls deflection stop"},
    {"penetration interpenetrate", "overlap"},
    {"assembly body part component", "solids"},
    {"pipe tube rod hindrance", "obstacles"},
    {"inside outside", "interior"},
    {"rotate turn upward", "up"},
    {"gradation gradings screen", "sieve passing"},
    {"continue restart initial", "start"},
    {"iterations limit time", "sweeps rounds patience"},
    {"wall border", "walls wall_gap"},
    {"ring annular pipe", "annulus"},
    {"cube cuboid brick", "box"},
    {"gaussian", "normal"},
    {"weibull", "rosin_rammler"},
    {"equal monodisperse", "constant"},
    {"binary bidisperse bimodal", "classes"},
    {"hexagonal", "hcp"},
    {"metre meter", "m"},
    {"millimetre millimeter", "mm"},
    {"micron", "um"},
    {"inch", "in"},
    {"foot feet", "ft"},
    {"silo jar bottle bucket tank bin", "vessel file"},
    {"fillet bevel chamfer", "rounding"},
    {"frustum funnel", "frustum cone hopper"},
    {"layer compartment gradient", "zone place"}};

bool is_of_word(char c) {
  return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || static_cast<unsigned char>(c) >= 0x80;
}

std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words(1);
  for (const char c : in_lower_case(text))
    if (is_of_word(c))
      words.back() += c;
    else if (!words.back().empty())
      words.emplace_back();
  if (words.back().empty()) words.pop_back();
  return words;
}

/// A word without the ending of a plural.
std::string_view stem_of(std::string_view word) {
  if (word.size() > 3 && word.ends_with('s') && !word.ends_with("ss")) word.remove_suffix(1);
  return word;
}

/// Whether a word of the text begins with this one.
bool has(const std::vector<std::string>& text, std::string_view word) {
  return std::ranges::any_of(
      text, [&](const std::string& each) { return word.size() < 3 ? each == word : each.starts_with(word); });
}
bool has_all(const std::vector<std::string>& text, const std::vector<std::string>& words) {
  return std::ranges::all_of(words, [&](const std::string& word) { return has(text, stem_of(word)); });
}

/// The words under which this one may stand instead.
std::vector<std::string_view> others_for(std::string_view word) {
  std::vector<std::string_view> found;
  for (const auto& [said, meant] : other_words) {
    const std::vector<std::string> all = words_of(said);
    if (std::ranges::find(all, word) == all.end()) continue;
    for (std::string_view rest = meant; !rest.empty();) {
      const std::size_t end = rest.find(' ');
      found.push_back(rest.substr(0, end));
      rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    }
  }
  return found;
}

}  // namespace

double relevance(std::string_view words, std::string_view name, std::string_view about) {
  constexpr double as_name = 8, in_name = 4, in_text = 2, another = 0.75;
  const std::vector<std::string> own = words_of(name), text = words_of(about);
  double sum = 0;
  bool any = false;
  for (const std::string& word : words_of(words)) {
    if (std::ranges::find(empty_words, word) != std::end(empty_words)) continue;
    any = true;
    const auto match = [&](const std::vector<std::string>& of) {
      return own.size() == of.size() && has_all(own, of) && has_all(of, own) ? as_name
             : has_all(own, of)                                              ? in_name
             : has_all(text, of)                                             ? in_text
                                                                             : 0.0;
    };
    double best = match({word});
    for (const std::string_view other : others_for(stem_of(word)))
      best = std::max(best, another * match(words_of(other)));
    if (best == 0) return 0;
    sum += best;
  }
  return any ? sum : 0;
}

}  // namespace bernal
