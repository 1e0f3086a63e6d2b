#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "bernal/core/monitor.hpp"
#include "bernal/run/packing.hpp"
#include "io/staged_folder.hpp"
#include "scene/output_table.hpp"
#include "solids/solids.hpp"

namespace bernal {

/// A packing as a file is to hold it: every number is the one that its reader will have.
struct Exported {
  const Packing& packing;
  const Output& output;  ///< complete
  /// Lengths in the output's unit, rounded to the precision of the format, and the origin where the format
  /// has it. In the order of the packing.
  Spheres<dynamic> spheres;
  Domain domain;
  Vector<3> middle = Vector<3>::Zero();  ///< of the domain, that became the origin; else zero
  std::vector<std::uint32_t> types;      ///< of each sphere, from 1
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
  /// "bernal 0.1.0: 1,000 spheres in a periodic box, packing fraction 0.64", in ASCII.
  std::string title() const;
};

/// As a word of a script, between quotation marks where it needs them.
std::string as_word(const std::string&);
/// Three axes as a row of numbers: "0 0 0.5".
std::string row_of(const Vector<3>&);

/// What numbers of a format are kept in.
enum class Precision { as_double, as_float };

/// A format: as a scene knows it, and what writes it.
struct Format {
  OutputTable table;
  Precision precision = Precision::as_double;
  bool centred = false;  ///< the origin is in the middle of the domain
  bool wraps = true;     ///< centres of another hand outside the period are put into it
  /// Writes the file of the output's name and those beside it.
  void (*write)(const Exported&, StagedFolder&) = nullptr;
  /// What a file holds that has no numbers of spheres, in words.
  std::string (*note)(const Exported&) = nullptr;
  /// What its user has to know besides; nothing, or "; …".
  std::string (*remark)(const Exported&) = nullptr;
  /// In place of `write` and `note`, where only whoever writes it knows.
  std::string (*write_and_tell)(const Exported&, StagedFolder&) = nullptr;
};

std::span<const Format* const> formats();
/// Throws Error{bad_scene} where there is no such format.
const Format& format_of(const Output&);

/// The packing as a file of that output has it. Precondition: the output is complete. Throws
/// Error{bad_argument} where contacts cannot be treated as asked, Cancelled.
Exported exported(const Packing&, const Output&, const Monitor& monitor = {});

/// The type of every radius, from 1, and how many there are: classes of equal width if `asked`; else one for
/// every radius where at most ten occur, or one for all.
std::uint32_t take_types(std::span<const double> radii, const std::optional<int>& asked,
                         std::vector<std::uint32_t>& types);

}  // namespace bernal
