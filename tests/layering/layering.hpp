#pragma once
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace bernal::layering {

/// What the files of one room may include, besides their own room.
struct Rule {
  bool public_headers_only = false;                    ///< apps: bernal/... of any room
  std::set<std::string> rooms;                         ///< all headers of these rooms
  std::map<std::string, std::set<std::string>> files;  ///< of these rooms only these files
};

/// One rule a room, read from the table in src/README.md; its last column says "nothing", "public headers",
/// "what stands above" or "A, B (file.hpp only)". Throws where that names a room that does not stand above.
std::map<std::string, Rule> read_rules(const std::filesystem::path& readme);

/// Every include below src/, include/ and apps/ of `root` that the rules forbid, as "file:line: why".
///
/// A file may include its own room and what its rule allows; a quoted include names a room; public headers
/// include public headers only; CGAL and assimp are seen by src/cad/*.cpp alone.
std::vector<std::string> violations(const std::filesystem::path& root,
                                    const std::map<std::string, Rule>& rules);

/// Every option of a command line in a string literal of C++ below src/ of `root`, as "file:line: --word":
/// the library leaves to the front ends what its options are called. Options of other programs, which have
/// their value behind "=", and properties of style sheets are none of these.
std::vector<std::string> option_words(const std::filesystem::path& root);

/// Every class that a file below src/ or include/ of `root` defines though another one defines a class of
/// that name in the same namespace, as "name: file, file": to the linker they are one, and what it makes of
/// one of them it uses for the other. Classes in namespaces without a name are none of these.
std::vector<std::string> doubled_classes(const std::filesystem::path& root);

}  // namespace bernal::layering
