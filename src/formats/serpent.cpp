#include <algorithm>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "files/file_kind.hpp"
#include "files/seal.hpp"
#include "formats/level_layers.hpp"
#include "formats/level_marks.hpp"
#include "formats/level_walls.hpp"
#include "formats/text_file.hpp"

namespace bernal {
namespace {

using Kind = LevelSurface::Kind;

/// The universe of a level, and the file beside the input that has its spheres.
std::string universe_of(const Level& level) { return "u_" + level.name; }
std::string level_file(const std::filesystem::path& input, std::string_view level) {
  return file_beside(input, fmt::format("_{}.pbed", level));
}
std::string content_universe(std::size_t content) { return fmt::format("s{}", content + 1); }

std::string serpent_surface(const LevelSurface& surface) {
  const int k = surface.coordinate_axis();
  const Vector<3>& at = surface.at;
  switch (surface.kind) {
    case Kind::plane:
      if (k >= 0 && surface.axis[k] > 0) return fmt::format("p{} {}", "xyz"[k], surface.size);
      return fmt::format("plane {} {}", row_of(surface.axis), surface.size);
    case Kind::sphere:
      return fmt::format("sph {} {}", row_of(at), surface.size);
    case Kind::cylinder:
      if (k < 0) break;
      return fmt::format("cyl{} {} {} {}", "xyz"[k], at[k == 0 ? 1 : 0], at[k == 2 ? 1 : 2], surface.size);
    case Kind::cone:
      break;
  }
  return fmt::format("quadratic {}", fmt::join(surface.quadric(), " "));
}

class SerpentInput {
 public:
  SerpentInput(const Exported& file, const LevelModel& model) : file_(file), model_(model) {}

  std::string text() {
    add("% {}; for Serpent 2, lengths in cm\n", file_.title());
    add_materials();
    add("\n% all of space\nsurf everywhere inf\n");
    add_contents();
    for (const Level& level : model_.levels) add_level(level);
    add_walls();
    return std::move(text_);
  }

  /// The universes of a level's spheres, as its file names them: those that hold a level are wrapped, as rows
  /// of such a file turn nothing.
  std::string universe_of_sphere(const Level& level, std::size_t i) const {
    const std::uint32_t content = level.contents[i];
    if (!model_.contents[content].level) return content_universe(content);
    return fmt::format("w_{}_{}", level.name, i + 1);
  }

 private:
  template <class... T>
  void add(fmt::format_string<T...> form, T&&... values) {
    fmt::format_to(std::back_inserter(text_), form, std::forward<T>(values)...);
  }
  const std::string& material(std::uint32_t number) const { return model_.materials[number].name; }

  void add_materials() {
    add("\n% give each material its nuclides below its line, and a density where none is known\n");
    for (const LevelMaterial& of : model_.materials)
      if (of.density)
        add("mat {} -{}\n", of.name, *of.density);
      else
        add("mat {} sum\n", of.name);
  }

  /// What spheres hold, as universes about their centres; the outermost shell has no end of its own.
  void add_contents() {
    add("\n% what spheres hold\n");
    for (std::size_t c = 0; c < model_.contents.size(); ++c) {
      const SphereContent& content = model_.contents[c];
      const std::string universe = content_universe(c);
      const std::size_t last = content.outer.size() - 1;
      for (std::size_t k = 0; k < last; ++k)
        add("surf {}_{} sph 0 0 0 {}\n", universe, k + 1, content.outer[k]);
      for (std::size_t k = 0; k <= last; ++k) {
        add("cell {0}_{1} {0} ", universe, k + 1);
        if (k == 0 && content.level)
          add("fill {}", universe_of(model_.levels[*content.level]));
        else
          add("{}", material(content.materials[k]));
        if (k > 0) add(" {}_{}", universe, k);
        if (k < last) add(" -{}_{}", universe, k + 1);
        if (last == 0) add(" -everywhere");
        add("\n");
      }
    }
  }

  void add_level(const Level& level) {
    const std::string universe = universe_of(level);
    add("\n% the spheres of {}\n", level.name);
    if (!level.turns.empty())
      add("% turned ones: coordinates that enter a universe are multiplied by its matrix\n");
    add("cell around_{0} around_{0} {1} -everywhere\n", universe, material(level.background));
    add("pbed {0} around_{0} {1}\n", universe, as_word(level_file(file_.output.file, level.name)));
    for (std::size_t i = 0; i < level.size(); ++i) {
      const SphereContent& content = model_.contents[level.contents[i]];
      if (!content.level) continue;
      const std::string name = universe_of_sphere(level, i);
      add("cell {0} {0} fill {1} -everywhere\ntrans U {0} 0 0 0 {2} 1\n", name,
          content_universe(level.contents[i]), fmt::join(transposed(*level.turn_of(i)), " "));
    }
  }

  void add_walls() {
    const LevelWalls walls = walls_of(file_.domain);
    add("\n% the {}\n", walls.words);
    for (std::size_t k = 0; k < walls.surfaces.size(); ++k)
      add("surf wall_{} {}\n", k + 1, serpent_surface(walls.surfaces[k]));
    const auto add_parts = [&](const std::vector<CommonPart>& parts, std::string_view name,
                               const std::string& fill) {
      for (std::size_t k = 0; k < parts.size(); ++k) {
        add("cell {}_{} 0 {}", name, k + 1, fill);
        for (const SurfaceSide& half : parts[k]) add(" {}wall_{}", half.inner ? "-" : "", half.surface + 1);
        add("\n");
      }
    };
    add_parts(walls.inside, "inside", "fill " + universe_of(model_.outermost()));
    add_parts(walls.outside, "outside", "outside");
    const auto condition = [&](std::size_t k) { return file_.periods()[k] ? 3 : 1; };
    add("\n% 1 lets particles leave, 3 repeats\nset bc {} {} {}\n", condition(0), condition(1), condition(2));
  }

  const Exported& file_;
  const LevelModel& model_;
  std::string text_;
};

std::string write_serpent(const Exported& file, StagedFolder& staged) {
  require_boxes_repeat(file);
  const LevelModel model = levels_of(file);
  SerpentInput input(file, model);
  const std::filesystem::path to = staged.add(file.output.file.string());  // the first of the files
  std::vector<std::filesystem::path> beside;
  std::string marks;
  for (const Level& level : model.levels) {
    const std::string name = level_file(file.output.file, level.name);
    {
      TextFile rows(staged.add(name));
      for (std::size_t i = 0; i < level.size(); ++i) {
        const Vector<3> at = level.center(i);
        rows.add(at[0], ' ', at[1], ' ', at[2], ' ', level.spheres.r[i], ' ',
                 input.universe_of_sphere(level, i), '\n');
      }
      rows.close();
    }
    beside.push_back(staged.written(name));
    marks += level_comments(level, file, "% ", "\n");
  }
  TextFile out(to);
  out.add(sealed_script(input.text() + "\n" + marks, beside, "% "));
  out.close();
  return model.in_words();
}

std::vector<std::string> level_files(const Packing& packing, const Output& output) {
  std::vector<std::string> files;
  for (const std::string& level : level_names(packing)) files.push_back(level_file(output.file, level));
  return files;
}

/// What universes of spheres hold, as the input says it.
class SerpentContents {
 public:
  explicit SerpentContents(const Reading& reading) {
    ForeignLines lines(reading);
    while (lines.next()) take(lines);
    for (ShellsInFile& of : kinds_)  // of what is filled, what stands around the spheres in it
      if (of.is_filled) of.materials.front() = around_["around_" + of.materials.front()];
  }

  /// Of the universe of a sphere, its place in `kinds`; that of one that holds nothing where it is unknown.
  std::uint32_t kind_of(std::string_view universe) {
    if (const auto wrapped = wrapped_.find(universe); wrapped != wrapped_.end()) universe = wrapped->second;
    const auto found = places_.find(universe);
    return found == places_.end() ? 0 : found->second;
  }
  const std::vector<ShellsInFile>& kinds() const { return kinds_; }
  const DensitiesInFile& densities() const { return densities_; }

 private:
  void take(ForeignLines& lines) {
    const auto words = lines.words();
    if (words.size() == 3 && words[0] == "mat" && words[2].starts_with('-') && is_number(words[2]))
      densities_[std::string(words[1])] = -1000 * lines.number(words[2], "the density");
    if (words.size() == 7 && words[0] == "surf" && words[2] == "sph" && is_number(words[6]))
      ends_[std::string(words[1])] = lines.number(words[6], "the radius");
    if (words.size() < 4 || words[0] != "cell") return;
    const bool is_fill = words[3] == "fill" && words.size() > 4;
    const std::string universe(words[2]), held(words[is_fill ? 4 : 3]);
    if (universe.starts_with("w_") && is_fill) wrapped_[universe] = held;
    if (universe.starts_with("around_")) around_[universe] = held;
    if (!universe.starts_with('s')) return;
    const auto [known, is_new] = places_.try_emplace(universe, static_cast<std::uint32_t>(kinds_.size()));
    if (is_new) kinds_.emplace_back();
    ShellsInFile& shells = kinds_[known->second];
    shells.is_filled = shells.is_filled || is_fill;
    shells.materials.push_back(held);
    if (words.back().starts_with('-'))
      if (const auto end = ends_.find(words.back().substr(1)); end != ends_.end())
        shells.ends.push_back(end->second);
  }

  std::map<std::string, double, std::less<>> ends_;
  std::map<std::string, std::uint32_t, std::less<>> places_;
  std::map<std::string, std::string, std::less<>> wrapped_, around_;
  std::vector<ShellsInFile> kinds_ = {{}};
  DensitiesInFile densities_;
};

/// The level is found in the input, its spheres in the file beside it.
FileContents read_serpent(const Reading& reading) {
  ForeignLines input(reading);
  FileContents contents;
  const std::uint64_t spheres = find_level(input, reading, contents);
  const std::string_view level = std::string_view(contents.note).substr(level_mark.size());
  const std::filesystem::path file = reading.file.parent_path() / level_file(reading.file, level);
  if (kind_of_file(file) != FileKind::regular)
    throw Error(ErrorCode::bad_packing, "is named by the input, and is not there", {file.string()});
  ForeignLines rows(Reading{file, reading.options, reading.monitor});
  SerpentContents held(reading);
  std::vector<std::uint32_t> which;
  read_spheres(
      rows, spheres,
      [&](std::string_view line, std::vector<std::string_view>& parts) {
        split_at(line, " ", parts);
        if (parts.size() > 4) which.push_back(held.kind_of(parts[4]));
      },
      contents);
  if (which.size() == contents.size()) take_layers(contents, held.kinds(), which, held.densities());
  return contents;
}

constexpr LevelFormat of_serpent = {
    .name = "serpent",
    .file = "serpent.inp",
    .writes = "Serpent 2: an input with universes and walls, and the spheres of each level (.pbed)",
    .reads = "Serpent inputs that bernal wrote, with the .pbed files beside them",
    .begins = "% bernal ",
    .says = "; for Serpent 2, ",
    .write = write_serpent,
    .beside = level_files,
    .read = read_serpent};

}  // namespace

Format serpent_format() { return format_of_levels<of_serpent>(); }

}  // namespace bernal
