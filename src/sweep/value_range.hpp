#pragma once
#include <string>

#include <toml++/toml.h>

#include "sweep/key_path.hpp"

namespace bernal::sweep {

/// Whether a table of a grid is a range of values: { from = 1, to = 20 }.
bool is_range(const toml::table&);

/// Its values, which stand where the range does: whole numbers in steps of one; with `step` so far apart;
/// with `count` so many, evenly or, with scale = "log", evenly in the logarithm. Both ends are among them,
/// `to` where the steps lead there. Numbers have twelve digits, and are whole where the key takes whole ones
/// alone. Throws Error{bad_scene} with file and line.
toml::array values_of_range(const toml::table&, const KeyPath& key, const std::string& file);

/// An array of numbers written in TOML, each of whose nodes stands at that line of the file.
toml::array array_at(const std::string& numbers, const toml::source_region& where, const std::string& file);

}  // namespace bernal::sweep
