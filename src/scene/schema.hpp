#pragma once
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bernal/scene/scene.hpp"

namespace bernal::schema {

/// What a user may write for a key. Vectors have three components; arrays have at least one.
enum class Type {
  flag,          ///< true or false
  integer,       ///< within Key::range
  number,        ///< finite, within Key::range; or one of Key::words, if there are any
  length,        ///< positive, in the scene's unit
  word,          ///< one of Key::words
  unit,          ///< a name from core/unit.hpp
  file,          ///< a path, relative to the scene's folder
  direction,     ///< [x, y, z], not all zero
  position,      ///< [x, y, z] in the scene's unit
  extents,       ///< [a, b, c], each a length
  lengths,       ///< array of lengths
  shares,        ///< array of positive numbers
  amounts,       ///< array of numbers of at least 0
  distribution,  ///< a length, or a table of one of Schema::distributions
  parts,         ///< array of distributions
};

struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool above_min = false;  ///< min itself is excluded
  bool below_max = false;  ///< max itself is excluded

  bool contains(double v) const {
    return (above_min ? v > min : v >= min) && (below_max ? v < max : v <= max);
  }
};

struct Key {
  std::string_view name;
  Type type;
  std::string_view help;                ///< one line
  std::optional<Value> otherwise = {};  ///< its value where the scene does not give it
  bool optional = false;                ///< may be absent and stays so
  Range range = {};
  std::vector<std::string_view> words = {};
  bool is_diameter = false;  ///< a size that is a diameter by its name
};

/// Sets of keys of which exactly one is given, whole: the first that holds all that are given; other keys
/// stay absent. Where none is given, the first set that needs nothing is meant, if there is one.
using Choice = std::vector<std::vector<std::string_view>>;

/// A table of the scene: a container, a size distribution, a stage, or one that stands for itself.
struct Entry {
  std::string_view name;
  std::string_view help;
  std::vector<Key> keys;
  std::vector<Choice> choices = {};
  /// What the keys demand of each other; throws Error{bad_scene}. `where` is what errors call the table.
  void (*rule)(const Spec&, std::string_view where) = nullptr;
  /// Fills in what depends on the rest of the scene, where the user did not.
  void (*complete)(Spec&, const Scene&) = nullptr;
  /// Of a container: the stages of a scene that names none.
  std::vector<std::string_view> protocol = {};
  /// Of a distribution that may stand in a "file": the keys that the file's columns are.
  std::vector<std::string_view> columns = {};

  const Key* find(std::string_view key) const;
};

/// Everything that a scene may say. The reader, its errors, the defaults and the writer all follow this.
struct Schema {
  Entry scene;  ///< the keys at the top, before any table
  Entry spheres;
  Entry accuracy;
  std::vector<Entry> containers;
  std::vector<Entry> distributions;
  /// Those that can work there first: a name may have another meaning in the other domain.
  std::vector<Entry> stages_in_containers, stages_in_periodic_boxes;

  const std::vector<Entry>& stages_for(const Scene& of) const {
    return of.is_periodic() ? stages_in_periodic_boxes : stages_in_containers;
  }
  static const Entry* find(const std::vector<Entry>& entries, std::string_view name);
};
const Schema& schema();

/// The parts of the schema that schema_distributions.cpp and schema_stages.cpp hold.
std::vector<Entry> size_distributions();
std::vector<Entry> stages(bool in_container);

/// What a value of this key must be, for people: "a positive length", "a whole number from 1 to 100"; with
/// its limits where only they refuse the one that was `given`.
std::string expectation(const Key&, const std::optional<Value>& given = {});

/// Whether a value of the right kind is one that the key accepts. Lengths and coordinates beyond 1e±30 are
/// not: volumes must neither overflow nor vanish.
bool accepts(const Key&, const Value&);

}  // namespace bernal::schema
