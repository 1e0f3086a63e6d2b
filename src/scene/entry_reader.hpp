#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "bernal/core/error.hpp"
#include "scene/entry.hpp"

namespace bernal {

/// Reads tables of a scene's file into the structs of their entries. Every error is an Error{bad_scene} with
/// the file, the line and the remedy; `where` is what it calls the table: "[container]".
class EntryReader {
 public:
  using Names = std::vector<std::string_view>;

  /// Columns of other files are looked for from the folder of this one.
  explicit EntryReader(const std::filesystem::path& file) : path_(file), file_(file.string()) {}

  /// Which of several names a table has under `selector`, by its place among them.
  std::size_t choose(const toml::table& table, std::string_view selector, const Names& names,
                     std::string_view where) const;

  /// All keys of an entry that the table has. Refuses what is missing, and unknown ones, except at the top of
  /// the file, where the tables stand between the keys: there `check_names` does.
  void read(const toml::table& table, const schema::Entry& entry, std::string_view selector,
            const std::string& where, void* options, Locations& locations) const;

  /// Reports the first key, in the order of the file, that is neither one of the entry's nor one of `others`.
  void check_names(const toml::table& table, const schema::Entry& entry, const Names& others,
                   std::string_view where) const;

  Location at(const toml::source_region& where) const;

  template <class... Args>
  [[noreturn]] void fail(const toml::source_region& where, fmt::format_string<Args...> format,
                         Args&&... args) const {
    throw Error(ErrorCode::bad_scene, fmt::format(format, std::forward<Args>(args)...), at(where));
  }

 private:
  schema::Value read_value(const toml::node& node, const schema::Key& key, const std::string& where) const;
  SceneSizes read_sizes(const toml::node& node, const schema::Key& key, const std::string& where) const;
  std::vector<SceneSizes> read_parts(const toml::node& node, const schema::Key& key,
                                     const std::string& where) const;
  void take_columns(const toml::node& node, const schema::Entry& entry, const std::string& where,
                    void* options, Locations& locations) const;

  std::filesystem::path path_;
  std::string file_;
};

}  // namespace bernal
