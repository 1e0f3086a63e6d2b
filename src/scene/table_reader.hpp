#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "scene/entry.hpp"
#include "scene/known_words.hpp"
#include "scene/said_in_phi.hpp"
#include "scene/toml_file.hpp"

namespace bernal {

/// Reads tables of a scene's file into the structs of their entries. Every error is an Error{bad_scene} with
/// the file, the line and the remedy; `where` is what it calls the table: "[container]".
class TableReader {
 public:
  explicit TableReader(const std::filesystem::path& file) : path_(file), file_(file.string()) {}

 protected:
  using Names = std::vector<std::string_view>;

  static Names names_of(const auto& entries) {
    Names names;
    for (const auto& entry : entries) names.push_back(entry.name);
    return names;
  }

  Location at(const toml::source_region& where) const { return location_of(where, file_); }

  /// Reports the first key, in the order of the file, that is neither one of the entry's nor one of `others`.
  void check_names(const toml::table& table, const schema::Entry& entry, const Names& others,
                   std::string_view where) const;

  /// Which of several words a table has under `selector`, by its place among them.
  std::size_t choose(const toml::table& table, std::string_view selector, const std::vector<KnownWord>& known,
                     std::string_view where) const;

  schema::Value read_value(const toml::node& node, const schema::Key& key, const std::string& where) const;

  /// All keys of an entry that the table has, besides `others`; what is missing, `complete` finds. Refuses
  /// unknown ones, except at the top of the file, where the tables stand between the keys: there
  /// `check_names` does.
  void read(const toml::table& table, const schema::Entry& entry, const Names& others,
            const std::string& where, void* options, Locations& locations) const;

  template <class... Args>
  [[noreturn]] void fail(const toml::source_region& where, fmt::format_string<Args...> format,
                         Args&&... args) const {
    throw Error(ErrorCode::bad_scene, fmt::format(format, std::forward<Args>(args)...), at(where));
  }

  std::filesystem::path path_;
  std::string file_;
  Unit unit_ = {};  ///< of the scene, once it is read
  bool sizes_are_diameters_ = false;
  mutable bool sizes_are_volumes_ = false;  ///< those that are just being read
  mutable SaidInPhi in_phi_;

 private:
  std::optional<schema::Value> value_of(const toml::node& node, const schema::Key& key,
                                        const std::string& where) const;
  void take_columns(const toml::node& node, const schema::Entry& entry, const std::string& where,
                    void* options, Locations& locations) const;
  SceneSizes read_sizes(const toml::node& node, const schema::Key& key, const std::string& where) const;
  std::vector<SceneSizes> read_parts(const toml::node& node, const schema::Key& key,
                                     const std::string& where) const;
  void read_table(const toml::node& node, const schema::Entry& entry, const std::string& where,
                  schema::Tables& into) const;
  std::vector<schema::Tables> read_tables(const toml::node& node, const schema::Key& key,
                                          const std::string& where) const;
  [[noreturn]] void refuse(const toml::node& node, const schema::Key& key, const std::string& where,
                           const std::optional<schema::Value>& value = {}) const;
};

}  // namespace bernal
