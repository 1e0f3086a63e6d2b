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

/// A packing prepared for a file: every number is the one that a reader will get.
struct Exported {
  const Packing& packing;
  const Output& output;  ///< complete
  /// Lengths in the output's unit, rounded to the precision of the format, with the format's origin. In the
  /// order of the packing.
  Spheres<dynamic> spheres;
  Domain domain;
  std::vector<std::uint32_t> types;  ///< of each sphere, from 1
  std::uint32_t type_count = 1;
  std::vector<double> type_densities = {};  ///< in kg/m³, where types are zones of several materials
  bool wrapped = false;  ///< some centres were outside the period and have been replaced by their images
  Monitor monitor = {};  ///< for slow writers
  /// The treatment of contacts; `spheres` are those after it.
  ContactReport contacts = {};
  /// Faults of the packing itself, for writers of solids, triangles or images: the largest overlap of a pair,
  /// over the sum of radii; the number of spheres across or outside walls, and the largest protrusion over
  /// the radius.
  double overlap = 0;
  std::uint64_t protruding = 0;
  double protrusion = 0;
  /// For formats of solids; made from `spheres` and `domain`.
  Solids solids{};

  std::size_t size() const { return spheres.size(); }
  int dimension() const { return spheres.dimension(); }
  /// 0 beyond the last axis.
  double coordinate(int axis, std::size_t i) const {
    const auto k = static_cast<std::size_t>(axis);
    return k < spheres.x.size() ? spheres.x[k][i] : 0.0;
  }
  Unit unit() const { return *output.unit; }
  /// Of the spheres, in kg/m³. Precondition: the format takes a density.
  double density() const { return *output.material_density; }
  double density_of(std::uint32_t type) const {
    return type_densities.empty() ? density() : type_densities[type - 1];
  }
  /// "2500", or of several types "2500, 7850".
  std::string densities_in_words() const;
  double largest_radius() const;

  /// Whether each of three axes is periodic.
  std::array<bool, 3> periods() const;
  /// "p p f": one letter an axis, for periodic and other axes.
  std::string periods_as(std::string_view yes, std::string_view no, std::string_view between = " ") const;
  /// Of the periodic box; all 0 where it is upright.
  Tilt tilt() const;
  /// A simulation box: the domain's bounds, wider by the largest radius at walls (and on both sides of a
  /// plane of discs), so that spheres that yield slightly stay inside.
  Bounds<3> box() const;

  /// The file's name for a comment; and as a word of a script, quoted if necessary.
  std::string name() const;
  std::string name_as_word() const;
  /// "spheres", or "spheres_3" if there are several types.
  std::string name_of_type(std::uint32_t type) const;
  /// "bernal 0.2.0 (packings 25, commit 0123456789ab): 1,000 spheres in a periodic box, packing fraction
  /// 0.64", in ASCII.
  std::string title() const;
};

/// Whether the word needs no quotation marks in a script.
bool is_plain_word(const std::string&);
/// A word of a script, quoted if necessary.
std::string as_word(const std::string&);
/// Three numbers as a row: "0 0 0.5".
std::string row_of(const Vector<3>&, std::string_view between = " ");
/// The periods as a Python tuple of True and False.
std::string periods_in_python(const Exported&);

/// The precision of a format's numbers.
enum class Precision { as_double, as_float };

/// The end of an axis of a file's box: `wrapped` if the box is only as long as its centres extend, `unsaid`
/// if the format does not say.
enum class AxisEnd : std::uint8_t { period, wall, wrapped, unsaid };

struct FileBox {
  std::vector<double> lower, upper;  ///< of a tilted one its lowest corner, and that plus the edges
  std::vector<AxisEnd> ends;
  Tilt tilt = {};

  static FileBox of_three(AxisEnd end) {
    return {std::vector<double>(3), std::vector<double>(3), std::vector<AxisEnd>(3, end)};
  }
};

/// The contents of a file, in its own unit and frame.
struct FileContents {
  Spheres<dynamic> spheres;  ///< `r` is empty if the file has no sizes
  std::optional<Unit> unit = {};
  std::optional<FileBox> box = {};
  std::optional<Scene> container = {};  ///< with the container, where the file says it
  bool is_flat = false;                 ///< the file states two dimensions; the third coordinate is ignored
  std::string note = {};
  std::vector<Layer> layers = {};      ///< of all spheres, in the file's unit
  std::vector<ImportNote> notes = {};  ///< what else the reader has to say

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

/// The data by which a format is recognised.
struct FileBeginning {
  const std::filesystem::path& file;
  std::string ending;  ///< ".data", in lower case
  std::string bytes;   ///< the first few thousand
  bool has(std::string_view text) const { return bytes.find(text) != bytes.npos; }
  bool begins(std::string_view text) const { return bytes.starts_with(text); }
};

/// A format that other programs read, write, or both.
struct Format {
  std::string_view name;

  // Writing; `writes` is empty if the format is not written.
  std::string_view writes = {};             ///< the program, and what the file holds for it
  std::vector<std::string_view> keys = {};  ///< its options besides those of all formats
  std::string_view file = {};               ///< this and the next eight are as in an OutputTable
  std::vector<std::string_view> endings = {};
  std::string_view alone = {};
  int least_dimension = 3, most_dimensions = 3;
  std::optional<Unit> unit = {};
  std::string_view sizes = "radius";
  bool is_folder = false;
  bool tilted = false;  ///< its files state tilted periodic boxes
  bool repeated_mesh = false;
  bool solids = false;  ///< whether it is given `Exported::solids`
  std::vector<schema::Choice> choices = {};
  std::function<void(const void*, const schema::Section&)> rule = {};
  Precision precision = Precision::as_double;
  bool centred = false;  ///< the origin is in the middle of the domain
  bool wraps = true;     ///< centres outside the period are moved into it
  /// Writes the file of the output's name, if that is text and the only file.
  void (*write_text)(const Exported&, TextFile&) = nullptr;
  /// Writes that file and those beside it.
  void (*write)(const Exported&, StagedFolder&) = nullptr;
  /// What the file holds, if it has no numbers of spheres.
  std::string (*note)(const Exported&) = nullptr;
  /// Further information for the user: empty, or "; …".
  std::string (*remark)(const Exported&) = nullptr;
  /// Writes the files and returns what they hold, for formats that know it only then.
  std::string (*write_with_note)(const Exported&, StagedFolder&) = nullptr;

  /// Whether the output holds layers of spheres, and what lies inside of them; null where none does.
  bool (*holds_levels)(const Output&) = nullptr;

  /// Files beside the file whose number the packing decides; the file answers for them, see `sealed_script`.
  std::vector<std::string> (*beside)(const Packing&, const Output&) = nullptr;

  // Reading; `reads` is empty if the format is not read. The next two are as in an ImportFormat.
  std::string_view reads = {}, unit_from = {};
  std::vector<std::string> options = {};
  bool (*recognises)(const FileBeginning&) = nullptr;
  FileContents (*read)(const Reading&) = nullptr;
};

/// Throws Error{bad_scene} for an unknown format.
const Format& format_of(const Output&);
/// The format in the options, else the one recognised from the file. Throws Error{bad_argument} for an
/// unknown format and for options that it does not take.
const Format& format_of(const std::filesystem::path& file, const ImportOptions& options);

/// The packing as the output's file will hold it. Precondition: the output is complete. Throws
/// Error{bad_argument} if contacts cannot be treated as requested, Cancelled.
Exported exported(const Packing&, const Output&, const Monitor& monitor = {});

/// Converts lengths. For a larger unit they are divided, by a whole number if both units are metric, so that
/// only the result is rounded.
std::function<double(double)> unit_conversion(Unit from, Unit to);

/// Applies `coordinate(x, axis)` and `length(l)` to spheres and domains.
struct Mapping {
  std::function<double(double, int)> coordinate;
  std::function<double(double)> length;

  Vector<3> point(Vector<3> p) const;
  void map(Spheres<dynamic>&) const;
  Domain of(const Domain&) const;
};

/// Replaces each @NAME@ in a text by its value.
std::string filled(std::string_view text,
                   const std::vector<std::pair<std::string_view, std::string>>& values);

/// The clauses of a remark, separated by its marks, semicolons and commas. Only whole clauses are
/// interpreted: "bond lengths in nm" is not.
std::vector<std::string_view> clauses_of(std::string_view remark);
/// "mm" of "lengths in mm" and "unit: mm"; "1000 mm" of "lengths in 1000 mm". Absent for other clauses.
std::optional<std::string_view> unit_in_clause(std::string_view clause);
/// Sets `unit`. Throws Error{bad_packing} if another one is set already.
void take_unit(Unit said, std::optional<Unit>& unit, const Location& where);
/// The same for a word of a file, "mm", in `what`. Throws also for an unknown one.
void take_unit(std::string_view word, std::string_view what, std::optional<Unit>& unit,
               const Location& where);
/// Sets `unit` from a clause "lengths in mm" or "unit: mm", as in bernal's own files. Throws
/// Error{bad_packing} for an unknown unit and if another one is set already.
void take_unit_of_remark(std::string_view remark, std::optional<Unit>& unit, const Location& where);
/// The error for a box whose cell vectors are not those of a tilted one, (lx, 0, 0), (xy, ly, 0) and
/// (xz, yz, lz).
[[noreturn]] void refuse_skewed(const Reading&, int line = 0);
/// The requested frame, from 1. Throws Error{bad_argument} if there is no such frame.
int frame_of(const Reading&, int frames);

/// Limits of lengths of spheres, in any unit; the same as for the start of a scene.
inline constexpr double smallest_length = 1e-30, farthest_place = 1e30;
inline bool is_size(double length) { return length >= smallest_length && length <= farthest_place; }
std::string size_error(double length, bool is_diameter);

}  // namespace bernal
