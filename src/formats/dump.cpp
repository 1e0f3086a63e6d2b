#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "formats/lammps.hpp"

namespace bernal {
namespace {

constexpr std::string_view item = "ITEM: ", step_item = "ITEM: TIMESTEP", atoms_item = "ITEM: ATOMS",
                           box_item = "ITEM: BOX BOUNDS", count_item = "ITEM: NUMBER OF ATOMS",
                           units_item = "ITEM: UNITS", time_item = "ITEM: TIME";

/// The number below "ITEM: NUMBER OF ATOMS".
std::uint64_t read_claimed(ForeignLines& lines) {
  lines.require_next("the number of atoms");
  const auto words = lines.words();
  return lines.whole(words.empty() ? std::string_view() : words[0], "the number of atoms");
}

/// The number of rows below an item. Throws for items that dumps of atoms do not have.
std::uint64_t rows_below(std::string_view line, std::uint64_t atoms, const ForeignLines& lines) {
  if (line.starts_with(atoms_item)) return atoms;
  if (line.starts_with(box_item)) return 3;
  for (const std::string_view one : {step_item, count_item, units_item, time_item})
    if (line.starts_with(one)) return 1;
  lines.fail(fmt::format("{} is no item of a dump of atoms; take it and the rows below it out",
                         bernal::quoted(line)));
}

/// Throws for surplus rows of an item, whichever frame is requested: rows of two frames may have been mixed.
int count_frames(const Reading& reading) {
  ForeignLines lines(reading);
  int frames = 0;
  constexpr std::uint64_t any_number = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t claimed = any_number, left = 0;
  bool in_atoms = false;
  while (lines.next()) {
    const std::string_view line = lines.line();
    if (line.starts_with(item)) {
      left = rows_below(line, claimed, lines);
      in_atoms = line.starts_with(atoms_item);
      frames += line.starts_with(step_item);
      if (line.starts_with(step_item)) claimed = any_number;
      if (line.starts_with(count_item)) {
        claimed = read_claimed(lines);
        left = 0;
      }
    } else if (!lines.words().empty() && left-- == 0) {
      if (!in_atoms) lines.fail("a row that belongs to no item; take it out");
      lines.refuse_more(fmt::format("frame {}", frames), claimed, fmt::format("below \"{}\"", count_item));
    }
  }
  if (frames == 0) lines.fail(fmt::format("there is no line \"{}\"", step_item));
  return frames;
}

/// From the bounds of the cell to the cell (LAMMPS's Howto_triclinic): what its tilts add to both ends.
void take_tilt(const Tilt& tilt, FileBox& box) {
  const auto [xy, xz, yz] = tilt;
  box.tilt = tilt;
  box.lower[0] -= std::min({0.0, xy, xz, xy + xz});
  box.upper[0] -= std::max({0.0, xy, xz, xy + xz});
  box.lower[1] -= std::min(0.0, yz);
  box.upper[1] -= std::max(0.0, yz);
}

[[noreturn]] void fail_of_tilts(const ForeignLines& lines) {
  lines.fail(
      fmt::format("the tilts of a box are xy xz yz, all three and in this order, as in "
                  "\"{} xy xz yz pp pp pp\"",
                  box_item));
}

/// The three lines after "ITEM: BOX BOUNDS pp pp ff", or "… xy xz yz pp pp pp" with a tilt in each.
FileBox read_bounds(const Reading& reading, ForeignLines& lines) {
  FileBox box = FileBox::of_three(AxisEnd::unsaid);
  const auto words = lines.words();
  std::size_t axis = 0, tilts = 0;
  for (std::size_t k = 3; k < words.size(); ++k) {
    if (words[k] == "abc" || words[k] == "origin") refuse_skewed(reading, lines.number());
    if (words[k] == "xy" || words[k] == "xz" || words[k] == "yz") {
      if (tilts == 3 || words[k] != tilt_names[tilts]) fail_of_tilts(lines);
      ++tilts;
      continue;
    }
    const bool is_period = words[k] == "pp";
    if (axis == 3 || words[k].size() != 2 ||
        (!is_period && words[k].find_first_not_of("fsm") != words[k].npos))
      lines.fail(
          fmt::format("{} is no end of an axis, of which there are three; pp, ff, fs and such are known",
                      bernal::quoted(words[k])));
    box.ends[axis++] = is_period ? AxisEnd::period : words[k] == "ff" ? AxisEnd::wall : AxisEnd::wrapped;
  }
  if (axis != 0 && axis != 3) lines.fail("the ends of three axes are expected, such as pp pp ff");
  if (tilts != 0 && tilts != 3) fail_of_tilts(lines);
  Tilt tilt{};
  for (std::size_t k = 0; k < 3; ++k) {
    lines.require_next("the box");
    const auto bounds = lines.words();
    if (tilts == 3 && bounds.size() != 3)
      lines.fail(
          fmt::format("two bounds of the box and the tilt {} are expected, as \"{} xy xz yz\" says, and here "
                      "stand {} words; was the line cut off?",
                      tilt_names[k], box_item, bounds.size()));
    if (tilts == 0 && bounds.size() != 2)
      lines.fail(
          fmt::format("two bounds of the box are expected, and here stand {} words; a third is a tilt where "
                      "\"{} xy xz yz\" announces it",
                      bounds.size(), box_item));
    box.lower[k] = lines.number(bounds[0], "lower bound");
    box.upper[k] = lines.number(bounds[1], "upper bound");
    if (tilts == 3) tilt[k] = lines.number(bounds[2], "tilt");
  }
  if (tilt != Tilt{}) take_tilt(tilt, box);
  return box;
}

/// Finds which of x, xs, xu, xsu the columns have. Wrapped ones take precedence, scaled ones come last.
std::vector<std::string> with_plain_axes(std::vector<std::string> names, bool& is_scaled) {
  for (const std::string_view kind : {"", "u", "s", "su"}) {
    std::vector<std::string*> found;
    for (const char axis : {'x', 'y', 'z'})
      for (std::string& name : names)
        if (name == fmt::format("{}{}", axis, kind)) {
          found.push_back(&name);
          break;
        }
    if (found.size() != 3) continue;
    is_scaled = kind.starts_with('s');
    for (std::string* name : found) name->resize(1);
    return names;
  }
  return names;
}

void unscale(FileContents& contents) {
  const FileBox& box = *contents.box;
  auto& x = contents.spheres.x;
  const auto [xy, xz, yz] = box.tilt;
  for (std::size_t i = 0; i < x[0].size(); ++i) {
    const double b = x[1][i], c = x[2][i];
    for (std::size_t k = 0; k < 3; ++k) x[k][i] = box.lower[k] + x[k][i] * (box.upper[k] - box.lower[k]);
    if (box.tilt == Tilt{}) continue;
    x[0][i] += b * xy + c * xz;
    x[1][i] += c * yz;
  }
}

/// The remedy for a frame that was cut off.
std::string or_before(int frame) {
  return frame > 1 ? fmt::format("; ‹frame={}› is the one before", frame - 1) : "";
}

void read_frame_atoms(int frame, std::uint64_t claimed, const Reading& reading, ForeignLines& lines,
                      FileContents& contents) {
  const auto words = lines.words();
  std::vector<std::string> names(words.begin() + 2, words.end());
  bool is_scaled = false;
  if (reading.options.columns.empty()) names = with_plain_axes(std::move(names), is_scaled);
  const SphereColumns columns = sphere_columns(reading.options.columns, names, lines);
  if (columns.x.size() != 3) lines.fail("a dump has three coordinates; ‹columns› has to name x, y and z");
  const auto id = std::ranges::find(names, "id");
  const auto id_place = static_cast<std::size_t>(id - names.begin());
  Identities identities;
  std::size_t found = 0;
  for (; found < claimed && lines.next(); ++found) {
    if (lines.line().starts_with(item)) break;
    const auto row = lines.words();
    if (row.size() != names.size())
      lines.fail(fmt::format("{} columns, but {} are named; was the line cut off?{}", row.size(),
                             names.size(), or_before(frame)));
    add_row(lines, columns, row, contents.spheres);
    if (id == names.end()) continue;
    identities.id.push_back(lines.whole(row[id_place], "id"));
    identities.line.push_back(lines.number());
  }
  if (found != claimed)
    lines.fail(fmt::format("frame {} says that it has {} spheres, and here end {} of them; was it cut off?{}",
                           frame, claimed, found, or_before(frame)));
  if (is_scaled && !contents.box) lines.fail("scaled coordinates xs, ys, zs need the box, and there is none");
  if (is_scaled) unscale(contents);
  if (id != names.end()) identities.sort(contents.spheres, reading);
  contents.note += ", " + columns.in_words() + (is_scaled ? ", scaled by the box" : "");
}

FileContents read_dump(const Reading& reading) {
  const int frames = count_frames(reading), wanted = frame_of(reading, frames);
  ForeignLines lines(reading);
  FileContents contents;
  std::optional<std::uint64_t> claimed;
  for (int frame = 0;;) {
    lines.require_next(fmt::format("the atoms of frame {}{}", wanted, or_before(wanted)));
    const bool here = frame == wanted;
    if (lines.line().starts_with(step_item)) {
      if (here) lines.fail(fmt::format("the frame before this line has no \"{}\"", atoms_item));
      ++frame;
      lines.require_next("the number of the step");
      contents.note = fmt::format("frame {} of {}, step {}", frame, frames, bernal::quoted(lines.line()));
    } else if (lines.line().starts_with(units_item)) {
      lines.require_next("the units");
      const auto words = lines.words();
      const std::optional<Unit> before = contents.unit;
      if (!words.empty()) contents.unit = unit_of_style(words[0], lines);
      if (before && contents.unit != before)
        lines.fail(fmt::format("\"{}\" says another unit than the one before it", units_item));
    } else if (here && lines.line().starts_with(count_item)) {
      if (claimed) lines.fail(fmt::format("a second \"{}\" in frame {}", count_item, frame));
      claimed = read_claimed(lines);
    } else if (here && lines.line().starts_with(box_item)) {
      if (contents.box) lines.fail(fmt::format("a second \"{}\" in frame {}", box_item, frame));
      contents.box = read_bounds(reading, lines);
    } else if (here && lines.line().starts_with(atoms_item)) {
      if (!claimed) lines.fail(fmt::format("\"{}\" does not stand before the atoms", count_item));
      read_frame_atoms(wanted, *claimed, reading, lines, contents);
      while (lines.next() && !lines.line().starts_with(step_item))
        if (lines.line().starts_with(atoms_item))
          lines.fail(fmt::format("a second \"{}\" in frame {}", atoms_item, frame));
      return contents;
    }
  }
}

}  // namespace

Format dump_format() {
  return {
      .name = "dump",
      .reads =
          "LAMMPS and LIGGGHTS dumps, text: x y z, xu yu zu or xs ys zs, radius or diameter, sorted by id; "
          "the last frame",
      .unit_from = "ITEM: UNITS, or ‹unit›",
      .options = {"columns", "frame"},
      .recognises = [](const FileBeginning& file) { return file.begins(item); },
      .read = read_dump};
}

}  // namespace bernal
