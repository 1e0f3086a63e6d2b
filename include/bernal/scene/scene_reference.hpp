#pragma once
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace bernal {

/// A key of a scene: what `bernal keys` says of it, as data.
struct ReferenceKey {
  std::string name;                           ///< "alpha"
  std::string help;                           ///< what it is, in a phrase
  std::string type;                           ///< "flag", "integer", "number", "length", "word", …
  std::string expectation;                    ///< what its value must be, for people: "a positive length"
  std::optional<std::string> otherwise = {};  ///< its default, as TOML; none where it may simply be absent
  double min = -std::numeric_limits<double>::infinity();  ///< of numbers and integers
  double max = std::numeric_limits<double>::infinity();
  bool above_min = false, below_max = false;  ///< the limit itself is excluded
  std::vector<std::string> words = {};        ///< that it takes, or takes besides
  /// Whether a file must have it, unless another set of a choice that it is in is given instead.
  bool required = false;
  bool is_diameter = false;  ///< a size that is a diameter by its name
  /// Of stages, where it acts: "everywhere", "in_bed" (between fixed walls) or "in_box" (in periodic boxes).
  std::string acts = "everywhere";
  /// Of what its numbers are: "none", "length", "diameter", "spread", "mass" or "density": in text they stand
  /// with their unit.
  std::string quantity = "none";
  std::string table = {};  ///< of tables that may stand there, by its name in the group "table"
};

/// What a scene may say in one of its tables: of one container, size distribution, stage or output, or in a
/// table that stands for itself.
struct ReferenceTable {
  std::string name;  ///< "relax"
  std::string help;
  std::vector<ReferenceKey> keys;
  /// For each choice the sets of keys of which exactly one is given, whole; an empty set where none need be.
  std::vector<std::vector<std::vector<std::string>>> choices = {};
};

/// Tables of which one is chosen by a word, or that all may be there.
struct ReferenceGroup {
  std::string name;      ///< where it stands: "container", "stage", "output", "engine"; "diameter" of sizes;
                         ///< "scene"; "table"
  std::string selector;  ///< the key whose word chooses: "kind", "distribution", "do", "format"; empty: none
  std::string title;     ///< for people
  std::vector<ReferenceTable> tables;
};

/// Everything that a scene may say, from the same tables that it is read by: what `bernal keys` prints, JSON
/// Schemas, the classes of other languages and the reference on paper are made from. Its keys at the top, in
/// [spheres] and in [accuracy] are the tables "scene", "spheres" and "accuracy" of the first group.
std::vector<ReferenceGroup> scene_reference();

/// Whether `reference` knows the name.
bool is_in_reference(std::string_view name);

/// The keys of scenes whose names or help speak of what the words ask for, such as "roundness of the top" or
/// "kg", the best first, with the places where they stand; empty where there is none.
std::string keys_about(std::string_view words);

/// How well a name, and a text about it, answer to words: each word that means something has to stand in one
/// of them as the beginning of a word, or another word for the same has to; else 0. More where it stands in
/// the name.
double relevance(std::string_view words, std::string_view name, std::string_view about);

}  // namespace bernal
