#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "bernal/core/error.hpp"
#include "bernal/scene/scene.hpp"
#include "scene/schema.hpp"

namespace bernal {

/// Reads tables of a scene's file as entries of the schema. Every error is an Error{bad_scene} with the file,
/// the line and the remedy; `where` is what it calls the table: "[container]".
class EntryReader {
 public:
  using Names = std::vector<std::string_view>;

  /// Columns of other files are looked for from the folder of this one.
  explicit EntryReader(const std::filesystem::path& file) : path_(file), file_(file.string()) {}

  /// Which of several entries a table is, by the word under `selector`.
  const schema::Entry& choose(const toml::table& table, std::string_view selector,
                              const std::vector<schema::Entry>& entries, std::string_view where) const;

  /// All keys of an entry but its radius or diameter, with defaults filled in. Refuses unknown ones, except
  /// at the top of the file, where the tables stand between the keys: there `check_names` does.
  Spec read(const toml::table& table, const schema::Entry& entry, std::string_view selector,
            const std::string& where) const;

  /// A plain length, whose key says what it must be, is a constant distribution.
  Spec read_distribution(const toml::node& node, const schema::Key& key, const std::string& where) const;

  /// Reports the first key, in the order of the file, that is neither one of the entry's nor one of `others`.
  void check_names(const toml::table& table, const schema::Entry& entry, const Names& others,
                   std::string_view where) const;

  template <class... Args>
  [[noreturn]] void fail(const toml::source_region& where, fmt::format_string<Args...> format,
                         Args&&... args) const {
    throw Error(ErrorCode::bad_scene, fmt::format(format, std::forward<Args>(args)...), at(where));
  }

 private:
  Location at(const toml::source_region& where) const;
  Names left_out(const toml::table& table, const schema::Entry& entry, std::string_view where) const;
  Value read_value(const toml::node& node, const schema::Key& key, std::string_view where) const;
  void take_columns(Spec& spec, const schema::Entry& entry, const std::string& where) const;
  std::vector<Spec> read_parts(const toml::node& node, const schema::Key& key,
                               const std::string& where) const;

  const schema::Schema& all_ = schema::schema();
  std::filesystem::path path_;
  std::string file_;
};

}  // namespace bernal
