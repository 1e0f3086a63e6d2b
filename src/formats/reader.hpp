#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bernal/core/error.hpp"
#include "bernal/core/monitor.hpp"
#include "bernal/core/spheres.hpp"
#include "bernal/core/unit.hpp"
#include "bernal/formats/import.hpp"

namespace bernal {

/// How an axis of a file's box ends: `wrapped` where the box is only as long as its centres reach, `unsaid`
/// where the format does not tell.
enum class AxisEnd : std::uint8_t { period, wall, wrapped, unsaid };

struct FileBox {
  std::vector<double> lower, upper;
  std::vector<AxisEnd> ends;
};

/// What a file says of a packing, in the file's own unit and frame.
struct FileContents {
  Spheres<dynamic> spheres;  ///< `r` is empty where the file has no sizes
  std::optional<Unit> unit = {};
  std::optional<FileBox> box = {};
  bool is_flat = false;  ///< it says that it has two dimensions: a third coordinate is of no matter
  std::string note = {};

  std::size_t size() const { return spheres.x.front().size(); }
};

struct Reading {
  const std::filesystem::path& file;
  const ImportOptions& options;
  const Monitor& monitor;
};

/// By what a format is recognised.
struct FileBeginning {
  const std::filesystem::path& file;
  std::string ending;  ///< ".data", in lower case
  std::string bytes;   ///< the first of them, at most some thousand
  bool has(std::string_view text) const { return bytes.find(text) != bytes.npos; }
  bool begins(std::string_view text) const { return bytes.starts_with(text); }
};

/// A format: how it is called and recognised, and what reads it.
struct PackingReader {
  ImportFormat about;
  bool (*recognises)(const FileBeginning&) = nullptr;
  FileContents (*read)(const Reading&) = nullptr;
};

std::span<const PackingReader* const> packing_readers();
/// That of the options, or of the file. Throws Error{bad_argument} for an unknown one and for options that it
/// has not.
const PackingReader& reader_of(const std::filesystem::path& file, const ImportOptions& options);

/// The clauses of a remark: what stands between its marks, semicolons and commas. What a remark says counts
/// where it is a clause of its own: of "bond lengths in nm" nothing follows.
std::vector<std::string_view> clauses_of(std::string_view remark);
/// "mm" of "lengths in mm" and "unit: mm"; "1000 mm" of "lengths in 1000 mm". None of other clauses.
std::optional<std::string_view> unit_in_clause(std::string_view clause);
/// `unit` becomes that of a clause "lengths in mm" or "unit: mm", as bernal's own files say it. Throws
/// Error{bad_packing} for one that is unknown and where `unit` is another already.
void take_unit_of_remark(std::string_view remark, std::optional<Unit>& unit, const Location& where);
/// Throws Error{bad_packing} for a box that is no cuboid.
[[noreturn]] void refuse_skewed(const std::filesystem::path& file, int line);
/// Which of so many frames is meant, from 1. Throws Error{bad_argument} for one that there is not.
int frame_of(const Reading& reading, int frames);

}  // namespace bernal
