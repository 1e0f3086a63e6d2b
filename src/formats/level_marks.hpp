#pragma once
#include <functional>
#include <string>
#include <string_view>

#include "formats/foreign_lines.hpp"
#include "formats/levels.hpp"

namespace bernal {

// Comments in the files of levels, by which their readers find the spheres again: of each level how many
// lines of them follow, in the order of the packing, and the container that they lie in.

inline constexpr std::string_view level_mark = "level ", container_mark = "container = ";

/// Two comments, each between `before` and `after`; images follow the spheres, and are none of them. The
/// container is the domain for the outermost level, for others the ball that they fill.
std::string level_comments(const Level&, const Exported&, std::string_view before, std::string_view after);

/// Goes to the comments of the level that the options name, else of the first, and takes the container from
/// them. Returns how many spheres it has. Throws Error{bad_packing} where there are none, and
/// Error{bad_argument} that names the levels of the file where that one is not among them.
std::uint64_t find_level(ForeignLines&, const Reading&, FileContents&);

/// What formats of levels, which are in cm and read level by level, differ in.
struct LevelFormat {
  std::string_view name, file;
  std::string_view writes, reads;
  /// How the first line begins, and what stands there or in the next one besides.
  std::string_view begins, says;
  std::string (*write)(const Exported&, StagedFolder&);
  std::vector<std::string> (*beside)(const Packing&, const Output&) = nullptr;
  FileContents (*read)(const Reading&);
};

/// The entry of such a format in the list of all.
template <const LevelFormat& of>
Format format_of_levels() {
  return {.name = of.name,
          .writes = of.writes,
          .file = of.file,
          .unit = Unit::cm,
          .write_with_note = of.write,
          .holds_levels = [](const Output&) { return true; },
          .beside = of.beside,
          .reads = of.reads,
          .unit_from = "cm",
          .options = {"level"},
          .recognises = [](const FileBeginning& file) { return file.begins(of.begins) && file.has(of.says); },
          .read = of.read};
}

/// Appends to `parts` what stands in a line at the places of x, y, z and r; nothing where it has no sphere.
using NumbersOfLine = std::function<void(std::string_view line, std::vector<std::string_view>& parts)>;
/// Reads so many spheres, skipping lines that have none.
void read_spheres(ForeignLines&, std::uint64_t spheres, const NumbersOfLine&, FileContents&);
/// Both, of a file that has the spheres itself.
FileContents read_level(const Reading&, const NumbersOfLine&);

}  // namespace bernal
