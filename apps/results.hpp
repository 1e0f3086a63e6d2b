#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <tbb/global_control.h>

#include "bernal/scene/packing.hpp"

// What commands share that read a result, or write files, all or none.

/// Prints a note if the result is read from the place where a killed run left it.
void say_if_unpublished(const std::filesystem::path& folder);

/// Reads a result, and says where it was left.
bernal::Packing read_result(const std::filesystem::path& folder);

/// Holds the library to so many threads as long as it lives; 0: to none.
std::optional<tbb::global_control> limited_to(int threads);

/// Throws Error{bad_argument} for "-": a format may need several files.
void require_named_file(const std::filesystem::path&);

/// Says which files there are, a line each.
void say_files(const std::vector<std::filesystem::path>&);
/// Says what they hold before.
void say_written(const std::string& format, const std::string& note,
                 const std::vector<std::filesystem::path>& files);

/// What `write` returns; where it is stopped by the user, the exit code that says so.
int all_or_nothing(bool quiet, const std::function<int()>& write);

/// The names of formats, such as `--to` takes.
template <class Format>
std::vector<std::string> names_of(const std::vector<Format>& formats) {
  std::vector<std::string> names;
  for (const Format& format : formats) names.push_back(format.name);
  return names;
}

/// The option of a key: "--contact-gap" of contact_gap.
std::string option_of_key(std::string key);
