#include <charconv>
#include <compare>
#include <map>
#include <unordered_map>

#include <fmt/format.h>

#include "files/file_kind.hpp"
#include "formats/level_layers.hpp"
#include "formats/level_marks.hpp"
#include "formats/openmc_model.hpp"

namespace bernal {
namespace openmc_contents {

using Id = std::uint64_t;

/// The value of an attribute in a line of XML, as bernal writes it; empty where there is none.
std::string_view attribute(std::string_view line, std::string_view name) {
  const std::string begins = fmt::format(" {}=\"", name);
  const std::size_t at = line.find(begins);
  if (at == line.npos) return {};
  line.remove_prefix(at + begins.size());
  return line.substr(0, line.find('"'));
}
Id id_in(std::string_view text) { return whole_number(text).value_or(0); }

/// A universe or a material that a cell is filled with.
struct Fill {
  bool is_universe = false;
  Id id = 0;
  auto operator<=>(const Fill&) const = default;
};

/// Cells and what they are filled with, as the lines say it.
class OpenmcContents {
 public:
  explicit OpenmcContents(const Reading& reading) {
    read(reading);
    const std::filesystem::path beside = reading.file.parent_path() / "materials.xml";
    if (kind_of_file(beside) == FileKind::regular) read({beside, reading.options, reading.monitor});
  }

  /// Of spheres by their surfaces: the shells of those that have the same share a place in `kinds`.
  std::vector<std::uint32_t> which(const std::vector<Id>& spheres) {
    std::map<Fill, std::uint32_t> known;
    std::vector<std::uint32_t> places;
    for (const Id sphere : spheres) {
      const auto within = within_.find(sphere);
      const Fill fill = within == within_.end() ? Fill() : within->second;
      const auto [place, is_new] = known.try_emplace(fill, static_cast<std::uint32_t>(kinds_.size()));
      if (is_new) kinds_.push_back(shells_of(fill));
      places.push_back(place->second);
    }
    return places;
  }
  const std::vector<ShellsInFile>& kinds() const { return kinds_; }
  const DensitiesInFile& densities() const { return densities_; }

 private:
  /// Of the space within one sphere and without another; 0 where there is none.
  struct ShellCell {
    Fill fill;
    Id outer = 0;
  };

  void read(const Reading& reading) {
    ForeignLines lines(reading);
    std::string material;
    while (lines.next()) {
      const std::string_view line = lines.line();
      if (line.find("<surface ") != line.npos) take_surface(line);
      if (line.find("<cell ") != line.npos) take_cell(line);
      if (line.find("<lattice ") != line.npos)  // its elements have the same between their spheres
        around_[id_in(attribute(line, "id"))] = around_[id_in(attribute(line, "outer"))];
      if (line.find("<material ") != line.npos) {
        material = attribute(line, "name");
        if (!material.empty()) materials_[id_in(attribute(line, "id"))] = material;
      }
      if (line.find("<density ") == line.npos || attribute(line, "units") != "g/cm3") continue;
      if (const std::string_view value = attribute(line, "value"); is_number(value))
        densities_[material] = 1000 * lines.number(value, "the density");
    }
  }
  void take_surface(std::string_view line) {
    std::vector<std::string_view> numbers;
    split_at(attribute(line, "coeffs"), " ", numbers);
    if (attribute(line, "type") != "sphere" || numbers.size() != 4) return;
    double& radius = radii_[id_in(attribute(line, "id"))];
    std::from_chars(numbers[3].data(), numbers[3].data() + numbers[3].size(), radius);
  }
  void take_cell(std::string_view line) {
    const std::string_view universe = attribute(line, "fill");
    const Fill fill{!universe.empty(), id_in(universe.empty() ? attribute(line, "material") : universe)};
    std::vector<std::string_view> sides;
    split_at(attribute(line, "region"), " ", sides);
    const bool has_end = !sides.empty() && sides.back().starts_with('-');
    const Id outer = has_end ? id_in(sides.back().substr(1)) : 0;
    if (sides.size() == 1 && has_end) within_[outer] = fill;
    if (sides.size() <= 2) cells_[id_in(attribute(line, "universe"))].push_back({fill, outer});
    // Around spheres, however many, is what they lie in.
    if (!has_end) around_[id_in(attribute(line, "universe"))] = fill.id;
  }

  std::string material_of(const Fill& fill) const {
    const auto name = materials_.find(fill.id);
    return name == materials_.end() ? fmt::format("material {}", fill.id) : name->second;
  }
  ShellsInFile shells_of(const Fill& fill) const {
    if (!fill.is_universe) return {.materials = {material_of(fill)}};
    ShellsInFile shells;
    const auto cells = cells_.find(fill.id);
    if (cells == cells_.end()) return shells;
    for (const ShellCell& cell : cells->second) {
      shells.is_filled = shells.is_filled || cell.fill.is_universe;
      const auto around = around_.find(cell.fill.id);
      shells.materials.push_back(!cell.fill.is_universe    ? material_of(cell.fill)
                                 : around == around_.end() ? std::string()
                                                           : material_of(Fill{false, around->second}));
      if (const auto end = radii_.find(cell.outer); end != radii_.end()) shells.ends.push_back(end->second);
    }
    return shells;
  }

  std::unordered_map<Id, double> radii_;
  std::unordered_map<Id, Fill> within_;  // one sphere alone
  std::unordered_map<Id, std::vector<ShellCell>> cells_;
  std::unordered_map<Id, Id> around_;  // the material of a universe without an end
  std::map<Id, std::string> materials_;
  std::vector<ShellsInFile> kinds_;
  DensitiesInFile densities_;
};

}  // namespace openmc_contents

FileContents read_openmc_model(const Reading& reading) {
  std::vector<std::uint64_t> spheres;
  FileContents contents =
      read_level(reading, [&](std::string_view line, std::vector<std::string_view>& parts) {
        if (openmc_contents::attribute(line, "type") != "sphere") return;
        split_at(openmc_contents::attribute(line, "coeffs"), " ", parts);
        spheres.push_back(openmc_contents::id_in(openmc_contents::attribute(line, "id")));
      });
  openmc_contents::OpenmcContents held(reading);
  const std::vector<std::uint32_t> which = held.which(spheres);
  take_layers(contents, held.kinds(), which, held.densities());
  return contents;
}

}  // namespace bernal
