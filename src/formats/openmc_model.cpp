#include "formats/openmc_model.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/text.hpp"
#include "formats/level_lattice.hpp"
#include "formats/level_marks.hpp"
#include "formats/level_walls.hpp"
#include "formats/templates.hpp"
#include "formats/text_file.hpp"

namespace bernal {
namespace {

using Kind = LevelSurface::Kind;
using Id = std::uint64_t;

/// A universe or a material that a cell is filled with.
struct CellFill {
  bool is_universe = false;
  Id id = 0;
};

/// The type of a surface and its coefficients; a sphere of the packing has more digits to fear than these.
std::string openmc_surface(const LevelSurface& surface) {
  const int k = surface.coordinate_axis();
  const char letter = "xyz"[std::max(k, 0)];
  const Vector<3>& at = surface.at;
  const Vector<2> across(at[k == 0 ? 1 : 0], at[k == 2 ? 1 : 2]);
  const auto typed = [](const std::string& type, const std::string& coefficients) {
    return fmt::format("type=\"{}\" coeffs=\"{}\"", type, coefficients);
  };
  switch (surface.kind) {
    case Kind::plane:
      if (k >= 0 && surface.axis[k] > 0)
        return typed(fmt::format("{}-plane", letter), fmt::format("{}", surface.size));
      return typed("plane", fmt::format("{} {}", row_of(surface.axis), surface.size));
    case Kind::sphere:
      return typed("sphere", fmt::format("{} {}", row_of(at), surface.size));
    case Kind::cylinder:
      if (k < 0) break;
      return typed(fmt::format("{}-cylinder", letter),
                   fmt::format("{} {} {}", across[0], across[1], surface.size));
    case Kind::cone:
      if (k < 0) break;
      return typed(fmt::format("{}-cone", letter),
                   fmt::format("{} {}", row_of(at), surface.size * surface.size));
  }
  return typed("quadric", fmt::format("{}", fmt::join(surface.quadric(), " ")));
}

class OpenmcGeometry {
 public:
  OpenmcGeometry(const Exported& file, const LevelModel& model, TextFile& out)
      : file_(file), model_(model), out_(out) {}

  void write() {
    out_.add("<geometry>\n");
    number_universes();
    for (const Level& level : model_.levels) write_spheres(level);
    for (std::size_t c = 0; c < model_.contents.size(); ++c) write_content(c);
    for (std::size_t k = 0; k < model_.levels.size(); ++k) write_level(k);
    write_walls();
    out_.add("</geometry>\n");
  }

 private:
  static Id material(std::uint32_t number) { return number + 1; }

  void number_universes() {
    for (std::size_t c = 0; c < model_.contents.size(); ++c) content_universes_.push_back(next_universe_++);
    for (std::size_t k = 0; k < model_.levels.size(); ++k) level_universes_.push_back(next_universe_++);
  }

  void write_spheres(const Level& level) {
    first_surface_.push_back(next_surface_);
    out_.add(level_comments(level, file_, "  <!-- ", " -->\n"));
    for (std::size_t i = 0; i < level.size(); ++i) write_sphere(level.center(i), level.spheres.r[i]);
  }
  Id write_sphere(const Vector<3>& at, double r) {
    out_.add("  <surface id=\"", next_surface_, "\" type=\"sphere\" coeffs=\"", at[0], ' ', at[1], ' ', at[2],
             ' ', r, "\"/>\n");
    return next_surface_++;
  }

  /// The beginning of a cell up to its region or transformation.
  void begin_cell(Id universe, const CellFill& fill) {
    out_.add("  <cell id=\"", next_cell_++, "\" universe=\"", universe,
             fill.is_universe ? "\" fill=\"" : "\" material=\"", fill.id, '"');
  }
  void end_cell() { out_.add("/>\n"); }

  /// Cells between concentric spheres; the outermost has no end but that of the cell which it fills.
  void write_content(std::size_t c) {
    const SphereContent& content = model_.contents[c];
    if (content.is_plain()) return;
    Id within = 0;
    for (std::size_t k = 0; k < content.outer.size(); ++k) {
      const bool is_last = k + 1 == content.outer.size();
      const Id sphere = is_last ? 0 : write_sphere(Vector<3>::Zero(), content.outer[k]);
      begin_cell(content_universes_[c], k == 0 && content.level
                                            ? CellFill{true, level_universes_[*content.level]}
                                            : CellFill{false, material(content.materials[k])});
      if (within || sphere) out_.add(" region=\"");
      if (within) out_.add(within);
      if (within && sphere) out_.add(' ');
      if (sphere) out_.add('-', sphere);
      if (within || sphere) out_.add('"');
      end_cell();
      within = sphere;
    }
  }

  CellFill fill_of(std::uint32_t content) const {
    const SphereContent& of = model_.contents[content];
    if (of.is_plain()) return {false, material(of.materials.front())};
    return {true, content_universes_[content]};
  }

  /// Cells of these spheres in a universe, and what is around them.
  void write_spheres_in(Id universe, const Level& level, Id first, std::span<const std::uint32_t> spheres) {
    for (const std::uint32_t i : spheres) {
      const CellFill fill = fill_of(level.contents[i]);
      begin_cell(universe, fill);
      out_.add(" region=\"-", first + i, '"');
      if (fill.is_universe) {
        const Vector<3> at = level.center(i);
        out_.add(" translation=\"", at[0], ' ', at[1], ' ', at[2], '"');
        // OpenMC multiplies what it takes into the cell by this, after it has moved it.
        if (const TurnMatrix* turn = level.turn_of(i); turn && model_.contents[level.contents[i]].level)
          write_rotation(transposed(*turn));
      }
      end_cell();
    }
    begin_cell(universe, {false, material(level.background)});
    if (!spheres.empty()) out_.add(" region=\"");
    for (std::size_t k = 0; k < spheres.size(); ++k) {
      if (k) out_.add(' ');
      out_.add(first + spheres[k]);
    }
    if (!spheres.empty()) out_.add('"');
    end_cell();
  }
  void write_rotation(const TurnMatrix& m) {
    out_.add(" rotation=\"", m[0]);
    for (std::size_t k = 1; k < m.size(); ++k) out_.add(' ', m[k]);
    out_.add('"');
  }

  void write_level(std::size_t k) {
    const Level& level = model_.levels[k];
    const Id universe = level_universes_[k], first = first_surface_[k];
    if (!needs_lattice(level)) {
      std::vector<std::uint32_t> all(level.size());
      for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
      return write_spheres_in(universe, level, first, all);
    }
    // An element has its own origin in its middle. A cell without an end moves back to that of the level, so
    // that a sphere is one surface, with the packing's own numbers, in every element.
    const LevelLattice lattice = lattice_of(level);
    const Id around = next_universe_++;
    write_spheres_in(around, level, first, {});
    std::vector<Id> elements(lattice.size(), around);
    for (std::size_t e = 0; e < lattice.size(); ++e) {
      const auto spheres = lattice.of(e);
      if (spheres.empty()) continue;
      const Id held = next_universe_++;
      write_spheres_in(held, level, first, spheres);
      elements[e] = next_universe_++;
      begin_cell(elements[e], {true, held});
      const Vector<3> back = -lattice.center(e);
      out_.add(" translation=\"", back[0], ' ', back[1], ' ', back[2], '"');
      end_cell();
    }
    write_lattice(universe, lattice, around, elements);
  }

  void write_lattice(Id id, const LevelLattice& lattice, Id around, const std::vector<Id>& elements) {
    const auto [nx, ny, nz] = lattice.shape;
    out_.add("  <lattice id=\"", id, "\" dimension=\"", nx, ' ', ny, ' ', nz, "\" outer=\"", around,
             "\">\n    <lower_left>", row_of(lattice.lower), "</lower_left>\n    <pitch>",
             row_of(lattice.pitch), "</pitch>\n    <universes>\n");
    for (std::size_t z = 0; z < nz; ++z)
      for (std::size_t y = ny; y-- > 0;) {  // OpenMC's rows fall in y
        for (std::size_t x = 0; x < nx; ++x) out_.add(x ? " " : "      ", elements[x + nx * (y + ny * z)]);
        out_.add('\n');
      }
    out_.add("    </universes>\n  </lattice>\n");
  }

  /// The root universe. A container that is cut into parts has a sphere around it, at which particles end.
  void write_walls() {
    const LevelWalls walls = walls_of(file_.domain);
    const bool is_whole = walls.inside.size() == 1;
    const Id first = next_surface_;
    for (std::size_t k = 0; k < walls.surfaces.size(); ++k) {
      const std::string_view boundary = walls.periodic[k] ? "periodic" : is_whole ? "vacuum" : "transmission";
      out_.add("  <surface id=\"", next_surface_, "\" name=\"wall\" ", openmc_surface(walls.surfaces[k]),
               " boundary=\"", boundary, '"');
      // Both ends of a period stand one after the other.
      if (walls.periodic[k]) out_.add(" periodic_surface_id=\"", next_surface_ + ((k % 2) ? -1 : 1), '"');
      out_.add("/>\n");
      ++next_surface_;
    }
    const auto write_parts = [&](const std::vector<CommonPart>& parts, const CellFill& fill, Id end) {
      for (const CommonPart& part : parts) {
        if (fill.id == 0)
          out_.add("  <cell id=\"", next_cell_++, "\" universe=\"0\" material=\"void\"");
        else
          begin_cell(0, fill);
        out_.add(" region=\"");
        for (std::size_t k = 0; k < part.size(); ++k)
          out_.add(k ? " " : "", part[k].inner ? "-" : "", first + part[k].surface);
        if (end) out_.add(" -", end);
        out_.add("\"/>\n");
      }
    };
    write_parts(walls.inside, {true, level_universes_.front()}, 0);
    if (is_whole) return;
    const Bounds<3> bounds = bounds_of(file_.domain);
    const Id end = next_surface_++;
    out_.add("  <surface id=\"", end, "\" name=\"end\" type=\"sphere\" coeffs=\"", row_of(bounds.center()),
             ' ', 0.6 * bounds.diagonal(), "\" boundary=\"vacuum\"/>\n");
    write_parts(walls.outside, {}, end);
  }

  const Exported& file_;
  const LevelModel& model_;
  TextFile& out_;
  Id next_surface_ = 1, next_cell_ = 1, next_universe_ = 1;  // universe 0 is the root
  std::vector<Id> content_universes_, level_universes_, first_surface_;
};

constexpr std::string_view xml_head = "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n";

std::string comment_of(const Exported& file) {
  return fmt::format("<!-- {}; lengths in cm -->\n", file.title());
}

/// Names and densities; what they are made of, a packing does not know.
std::string materials_text(const LevelModel& model) {
  std::string text =
      "<materials>\n  <!-- give each its nuclides; where no density is known it is the sum of theirs -->\n";
  for (std::size_t k = 0; k < model.materials.size(); ++k) {
    const LevelMaterial& material = model.materials[k];
    text += fmt::format(
        "  <material id=\"{}\" name=\"{}\">\n    <density {}/>\n  </material>\n", k + 1, material.name,
        material.density ? fmt::format("value=\"{}\" units=\"g/cm3\"", *material.density) : "units=\"sum\"");
  }
  return text + "</materials>\n";
}

std::string settings_text(const Exported& file) {
  const Bounds<3> bounds = bounds_of(file.domain);
  return fmt::format(
      "<settings>\n  <run_mode>eigenvalue</run_mode>\n  <particles>10000</particles>\n"
      "  <batches>100</batches>\n  <inactive>20</inactive>\n  <source type=\"independent\" "
      "strength=\"1.0\">\n    <space type=\"box\">\n      <parameters>{} {}</parameters>\n    </space>\n"
      "  </source>\n</settings>\n",
      row_of(bounds.lower), row_of(bounds.upper));
}

std::string build_script(const Exported& file, const LevelModel& model) {
  std::vector<std::string_view> names;
  for (const LevelMaterial& material : model.materials) names.push_back(material.name);
  return filled(openmc_build_py,
                {{"TITLE", file.title()},
                 {"LEVELS", fmt::format("{} spheres, {}", grouped(file.size()), model.in_words())},
                 {"MATERIALS", fmt::format("{}", fmt::join(names, ", "))}});
}

}  // namespace

std::string write_openmc_model(const Exported& file, StagedFolder& staged) {
  const LevelModel model = levels_of(file);
  const std::string name = file.output.file.string();
  const std::string head = std::string(xml_head) + comment_of(file);
  const bool is_one_file = file.output.file.has_extension();
  const auto write_to = [&](const std::string& to, const auto& write) {
    TextFile out(staged.add(to));
    out.add(head);
    write(out);
    out.close();
  };
  const auto geometry = [&](TextFile& out) { OpenmcGeometry(file, model, out).write(); };
  if (is_one_file) {
    write_to(name, [&](TextFile& out) {
      out.add("<model>\n", materials_text(model));
      geometry(out);
      out.add(settings_text(file), "</model>\n");
    });
  } else {
    write_to(name + "/geometry.xml", geometry);
    write_to(name + "/materials.xml", [&](TextFile& out) { out.add(materials_text(model)); });
    write_to(name + "/settings.xml", [&](TextFile& out) { out.add(settings_text(file)); });
    staged.write(name + "/build.py", build_script(file, model));
  }
  return model.in_words();
}

bool is_openmc_model(const FileBeginning& file) {
  return file.begins("<?xml") && file.has("<!-- bernal ") && file.has("<geometry>");
}

}  // namespace bernal
