#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bernal/core/error.hpp"
#include "bernal/core/monitor.hpp"
#include "bernal/core/spheres.hpp"
#include "bernal/core/unit.hpp"
#include "bernal/formats/import.hpp"
#include "bernal/scene/packing.hpp"
#include "files/staged_folder.hpp"
#include "scene/output_table.hpp"
#include "solids/solids.hpp"

namespace bernal {

class TextFile;

/// A packing as a file is to hold it: every number is the one that its reader will have.
struct Exported {
  const Packing& packing;
  const Output& output;  ///< complete
  /// Lengths in the output's unit, rounded to the precision of the format, and the origin where the format
  /// has it. In the order of the packing.
  Spheres<dynamic> spheres;
  Domain domain;
  std::vector<std::uint32_t> types;  ///< of each sphere, from 1
  std::uint32_t type_count = 1;
  bool wrapped = false;  ///< centres outside the period, which stand for their images
  Monitor monitor = {};  ///< of what takes long to write
  /// What was done about contacts; `spheres` are those after it.
  ContactReport contacts = {};
  /// Of the packing itself, where whoever writes solids, triangles or images has to know: the largest overlap
  /// of a pair, over the sum of radii; how many spheres cross walls or are outside, and the most by which one
  /// does, over its radius.
  double overlap = 0;
  std::uint64_t protruding = 0;
  double protrusion = 0;
  /// For formats of solids, see OutputTable; `spheres` and `domain` are theirs.
  Solids solids{};

  std::size_t size() const { return spheres.size(); }
  int dimension() const { return spheres.dimension(); }
  /// 0 beyond the last axis.
  double coordinate(int axis, std::size_t i) const {
    const auto k = static_cast<std::size_t>(axis);
    return k < spheres.x.size() ? spheres.x[k][i] : 0.0;
  }
  Unit unit() const { return *output.unit; }
  double largest_radius() const;

  /// Whether each of three axes repeats itself.
  std::array<bool, 3> periods() const;
  /// "p p f": one letter an axis, of those that repeat themselves and of others.
  std::string periods_as(std::string_view yes, std::string_view no, std::string_view between = " ") const;
  /// What a simulator may take for its box: the domain's bounds, and a largest radius more wherever there is
  /// a wall, so that no sphere that yields a little leaves it; as much below and above a plane.
  Bounds<3> box() const;

  /// The file's name, fit for a comment; and as a word of a script, between quotation marks where it needs
  /// them.
  std::string name() const;
  std::string name_as_word() const;
  /// "spheres", or "spheres_3" where there are more types than one.
  std::string name_of_type(std::uint32_t type) const;
  /// "bernal 0.1.0: 1,000 spheres in a periodic box, packing fraction 0.64", in ASCII.
  std::string title() const;
};

/// Whether it needs no quotation marks in a script.
bool is_plain_word(const std::string&);
/// As a word of a script, between quotation marks where it needs them.
std::string as_word(const std::string&);
/// Three numbers as a row: "0 0 0.5".
std::string row_of(const Vector<3>&, std::string_view between = " ");
/// "True" or "False" of each axis, as Python has a tuple.
std::string periods_in_python(const Exported&);

/// What numbers of a format are kept in.
enum class Precision { as_double, as_float };

/// How an axis of a file's box ends: `wrapped` where the box is only as long as its centres reach, `unsaid`
/// where the format does not tell.
enum class AxisEnd : std::uint8_t { period, wall, wrapped, unsaid };

struct FileBox {
  std::vector<double> lower, upper;
  std::vector<AxisEnd> ends;

  static FileBox of_three(AxisEnd end) {
    return {std::vector<double>(3), std::vector<double>(3), std::vector<AxisEnd>(3, end)};
  }
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

  bool has_size() const { return options.diameter || options.radius; }
  [[noreturn]] void fail(const std::string& why, int line = 0) const {
    throw Error(ErrorCode::bad_packing, why, {file.string(), line});
  }
};

/// By what a format is recognised.
struct FileBeginning {
  const std::filesystem::path& file;
  std::string ending;  ///< ".data", in lower case
  std::string bytes;   ///< the first of them, at most some thousand
  bool has(std::string_view text) const { return bytes.find(text) != bytes.npos; }
  bool begins(std::string_view text) const { return bytes.starts_with(text); }
};

/// What other programs read, write, or both: all that is known of it.
struct Format {
  std::string_view name;

  // How it is written. `writes` is empty where it is not.
  std::string_view writes = {};             ///< for which program, and what of it
  std::vector<std::string_view> keys = {};  ///< what it can be told, besides what all can
  std::string_view file = {};               ///< this and the next seven are those of an OutputTable
  std::vector<std::string_view> endings = {};
  int least_dimension = 3, most_dimensions = 3;
  std::optional<Unit> unit = {};
  std::string_view sizes = "radius";
  bool solids = false, is_folder = false;
  std::vector<schema::Choice> choices = {};
  std::function<void(const void*, const schema::Section&)> rule = {};
  Precision precision = Precision::as_double;
  bool centred = false;  ///< the origin is in the middle of the domain
  bool wraps = true;     ///< centres of another hand outside the period are put into it
  /// Writes the file of the output's name, where that is text and the only one.
  void (*write_text)(const Exported&, TextFile&) = nullptr;
  /// Or that file and those beside it.
  void (*write)(const Exported&, StagedFolder&) = nullptr;
  /// What a file holds that has no numbers of spheres, in words.
  std::string (*note)(const Exported&) = nullptr;
  /// What its user has to know besides; nothing, or "; …".
  std::string (*remark)(const Exported&) = nullptr;
  /// Or them, and says what they hold, where only whoever writes them knows.
  std::string (*write_and_tell)(const Exported&, StagedFolder&) = nullptr;

  // How it is read. `reads` is empty where it is not; the next two are those of an ImportFormat.
  std::string_view reads = {}, unit_from = {};
  std::vector<std::string> options = {};
  bool (*recognises)(const FileBeginning&) = nullptr;
  FileContents (*read)(const Reading&) = nullptr;
};

/// Throws Error{bad_scene} where there is no such format.
const Format& format_of(const Output&);
/// That of the options, or of the file. Throws Error{bad_argument} for an unknown one and for options that it
/// has not.
const Format& format_of(const std::filesystem::path& file, const ImportOptions& options);

/// The packing as a file of that output has it. Precondition: the output is complete. Throws
/// Error{bad_argument} where contacts cannot be treated as asked, Cancelled.
Exported exported(const Packing&, const Output&, const Monitor& monitor = {});

/// Of lengths. To a larger unit they are divided: by a whole number where both are metric, so that nothing
/// but the result is rounded.
std::function<double(double)> unit_conversion(Unit from, Unit to);

/// What `coordinate(x, axis)` and `length(l)` make of spheres and domains.
struct Mapping {
  std::function<double(double, int)> coordinate;
  std::function<double(double)> length;

  Vector<3> point(Vector<3> p) const;
  void map(Spheres<dynamic>&) const;
  Domain of(const Domain&) const;
};

/// A text with what stands for each name between @ and @.
std::string filled(std::string_view text,
                   const std::vector<std::pair<std::string_view, std::string>>& values);

/// The clauses of a remark: what stands between its marks, semicolons and commas. What a remark says counts
/// where it is a clause of its own: of "bond lengths in nm" nothing follows.
std::vector<std::string_view> clauses_of(std::string_view remark);
/// "mm" of "lengths in mm" and "unit: mm"; "1000 mm" of "lengths in 1000 mm". None of other clauses.
std::optional<std::string_view> unit_in_clause(std::string_view clause);
/// `unit` becomes that one. Throws Error{bad_packing} where it is another already.
void take_unit(Unit said, std::optional<Unit>& unit, const Location& where);
/// The same of a word of a file, "mm", that stands in `what`. Throws also for one that is unknown.
void take_unit(std::string_view word, std::string_view what, std::optional<Unit>& unit,
               const Location& where);
/// `unit` becomes that of a clause "lengths in mm" or "unit: mm", as bernal's own files say it. Throws
/// Error{bad_packing} for one that is unknown and where `unit` is another already.
void take_unit_of_remark(std::string_view remark, std::optional<Unit>& unit, const Location& where);
/// Throws Error{bad_packing} for a box that is no cuboid.
[[noreturn]] void refuse_skewed(const Reading&, int line = 0);
/// Which of so many frames is meant, from 1. Throws Error{bad_argument} for one that there is not.
int frame_of(const Reading&, int frames);

/// Lengths that spheres may have, in any unit: what a scene may start from as well.
inline constexpr double smallest_length = 1e-30, farthest_place = 1e30;
inline bool is_size(double length) { return length >= smallest_length && length <= farthest_place; }
std::string complaint_of_size(double length, bool is_diameter);

}  // namespace bernal
