#include "bernal/version.hpp"

#include <fmt/format.h>

namespace bernal {

std::string_view version() { return BERNAL_VERSION; }

/// Counted since the first table of pinned packings, tests/golden/hashes.csv: up to version 0.2.0, 25 of the
/// commits to that table gave rows that it had another hash, number, fraction or outcome. tests/golden/table
/// writes the next line.
constexpr int packings = 31;

int packings_number() { return packings; }

Program this_program() { return {std::string(version()), std::string(commit()), packings_number()}; }

std::string text_of(const Program& program) {
  if (program.version.empty()) return "of unknown version";  // of a packing whose files do not say
  if (program.packings_number == 0) return program.version;
  return fmt::format("{} (packings {}, commit {})", program.version, program.packings_number, program.commit);
}

std::string beside_this(const Program& program) {
  const std::string here = text_of(this_program());
  if (program.packings_number == 0)
    return fmt::format("bernal {}, which did not count its packings yet, and this is {}", program.version,
                       here);
  return fmt::format("bernal {}, and this is {}, which packs otherwise", text_of(program), here);
}

}  // namespace bernal
