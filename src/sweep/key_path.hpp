#pragma once
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <toml++/toml.h>

namespace bernal::sweep {

/// Where a key stands in a scene: "spheres.diameter.sigma", "stage[0].alpha", "container.size[2]".
class KeyPath {
 public:
  /// Nothing where the text is no such path.
  static std::optional<KeyPath> parsed(std::string_view text);

  std::string text() const;
  /// "sigma"; of "size[2]" it is "size".
  const std::string& last_name() const;
  /// Whether one of them is the other, or stands in it.
  bool overlaps(const KeyPath&) const;

  struct Step {
    std::string name;  ///< of a key; empty for an index
    std::size_t index = 0;
    bool operator==(const Step&) const = default;
  };
  const std::vector<Step>& steps() const { return steps_; }

 private:
  std::vector<Step> steps_;
};

/// A node of TOML that can be taken out of one place and put into another without losing where it was
/// written, as copies do.
class Slot {
 public:
  Slot() = default;
  explicit Slot(toml::node& taken) { take(taken); }
  const toml::node& node() const { return *held_.get(0); }
  bool empty() const { return held_.empty(); }
  void take(toml::node&);
  void put_into(toml::table&, const toml::key&);
  void put_into(toml::array&, std::size_t at);

 private:
  toml::array held_;
};

/// What a sweep writes over a key of a scene.
struct Assignment {
  KeyPath path;
  toml::source_region where;  ///< of the key in the sweep
  Slot value;
};

/// Writes values over keys of a scene for as long as it lives; then the scene is as it was. Tables that are
/// missing on the way are made. Throws Error{bad_scene} where a path leads through what is no table.
class Overlay {
 public:
  explicit Overlay(toml::table& scene) : scene_(scene) {}
  ~Overlay();
  Overlay(const Overlay&) = delete;
  Overlay& operator=(const Overlay&) = delete;

  /// The assignment outlives the overlay.
  void put(Assignment&);

 private:
  struct Undo {
    toml::table* table = nullptr;
    toml::array* array = nullptr;
    toml::key key = {};
    std::size_t index = 0;
    std::optional<toml::key> key_before = {};
    Slot before = {};
    Assignment* from = nullptr;  ///< null for a table that was made on the way
  };
  toml::table& scene_;
  std::vector<std::unique_ptr<Undo>> undone_;
};

}  // namespace bernal::sweep
