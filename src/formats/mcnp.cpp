#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "formats/level_marks.hpp"
#include "formats/level_walls.hpp"
#include "formats/text_file.hpp"

namespace bernal {
namespace {

using Kind = LevelSurface::Kind;
using Id = std::uint64_t;

constexpr std::size_t most_columns = 80;

/// A card, continued below wherever a line would be longer than MCNP reads.
class McnpCard {
 public:
  void add(std::string_view word) {
    if (!line_.empty() && line_.size() + 1 + word.size() > most_columns) {
      text_ += line_ + "\n";
      line_ = "    ";  // with the blank before the word, five: it goes on
    }
    if (!line_.empty()) line_ += ' ';
    line_ += word;
  }
  template <class... T>
  void add(fmt::format_string<T...> form, T&&... values) {
    const std::string words = fmt::format(form, std::forward<T>(values)...);
    std::string_view rest = words;
    while (!rest.empty()) {
      const std::size_t end = std::min(rest.find(' '), rest.size());
      add(rest.substr(0, end));
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
  }
  void end(TextFile& out) {
    out.add(text_, line_, '\n');
    text_.clear();
    line_.clear();
  }

 private:
  std::string text_, line_;
};

/// 0 for -0.
Vector<3> without_signs_of_zero(const Vector<3>& v) {
  return v.unaryExpr([](double x) { return x == 0 ? 0.0 : x; });
}

class McnpInput {
 public:
  McnpInput(const Exported& file, const LevelModel& model, TextFile& out)
      : file_(file), model_(model), level_(model.outermost()), out_(out), walls_(walls_of(file.domain)) {
    // Of a sphere the last surface is its own, those before it are between its layers.
    Id next = level_.size() + 1;
    for (const std::uint32_t content : level_.contents) {
      first_shell_.push_back(next);
      next += model_.contents[content].outer.size() - 1;
    }
    first_wall_ = next;
  }

  void write() {
    write_title(file_.title());
    out_.add("c lengths in cm; the last digits of a material are those of its m card\n");
    write_cells();
    out_.add('\n');
    write_surfaces();
    out_.add("\nmode n\n");
    for (std::size_t k = 0; k < model_.materials.size(); ++k)
      out_.add("c m", k + 1, " is ", model_.materials[k].name, ": give its nuclides, as in\nc m", k + 1,
               " 6000 1\n");
  }

 private:
  /// A cell of matter has a density on its card, by mass where it is negative.
  void begin_cell(std::uint32_t material) {
    card_.add("{} {} -{}", next_cell_++, material + 1, model_.materials[material].density.value_or(1));
  }
  void end_cell() {
    if (repeats_) card_.add("u={}", universe_of_box);
    card_.add("imp:n=1");
    card_.end(out_);
  }

  /// In one line, and what is longer in comments.
  void write_title(std::string_view rest) {
    for (std::string_view mark = ""; !rest.empty(); mark = "c ") {
      const std::size_t most = most_columns - mark.size();
      std::size_t end = rest.size() <= most ? rest.size() : rest.rfind(' ', most);
      if (end == rest.npos || end == 0) end = most;
      out_.add(mark, rest.substr(0, end), '\n');
      rest.remove_prefix(std::min(rest.size(), end + 1));
    }
  }

  void write_cells() {
    for (const LevelMaterial& material : model_.materials)
      if (!material.density)
        out_.add("c no density is known of ", material.name, ": 1 g/cm3 stands in its place\n");
    for (std::size_t i = 0; i < level_.size(); ++i) {
      const SphereContent& content = model_.contents[level_.contents[i]];
      for (std::size_t k = 0; k < content.outer.size(); ++k) {
        begin_cell(content.materials[k]);
        card_.add("-{}", k + 1 == content.outer.size() ? Id{i + 1} : first_shell_[i] + k);
        if (k > 0) card_.add("{}", first_shell_[i] + k - 1);
        end_cell();
      }
    }
    if (repeats_) return write_repeated();
    for (std::size_t k = 0; k < walls_.inside.size(); ++k) {
      begin_cell(level_.background);
      for (const SurfaceSide& half : sides_of(walls_.inside[k]))
        card_.add("{}{}", half.inner ? "-" : "", first_wall_ + half.surface);
      for (std::size_t i = 0; i < level_.size(); ++i) card_.add("{}", i + 1);
      end_cell();
    }
    write_outside();
  }

  /// A box that repeats itself is an element of a lattice, which has no end of its own: it fills so many
  /// boxes that none of the outermost matters.
  void write_repeated() {
    begin_cell(level_.background);
    for (std::size_t i = 0; i < level_.size(); ++i) card_.add("{}", i + 1);
    end_cell();
    body_ = macrobody();
    out_.add(next_cell_++, " 0 -", first_wall_, " lat=1 u=", universe_of_lattice, " fill=", universe_of_box,
             " imp:n=1\n");
    out_.add(next_cell_++, " 0 -", first_wall_ + 1, " fill=", universe_of_lattice, " imp:n=1\n");
    out_.add(next_cell_++, " 0 ", first_wall_ + 1, " imp:n=0\n");
  }
  std::string many_boxes() const {
    constexpr double boxes = 1e5;
    std::string body = "RPP";
    for (int k = 0; k < 3; ++k) {
      const bool repeats = file_.periods()[static_cast<std::size_t>(k)];
      const double more = repeats ? boxes * level_.bounds.size()[k] : 0;
      body += fmt::format(" {} {}", level_.bounds.lower[k] - more, level_.bounds.upper[k] + more);
    }
    return body;
  }

  void write_outside() {
    const bool is_body = !body_.empty();
    const auto write_part = [&](const CommonPart& part) {
      card_.add("{} 0", next_cell_++);
      for (const SurfaceSide& half : part)
        card_.add("{}{}", half.inner ? "-" : "", first_wall_ + half.surface);
      card_.add("imp:n=0");
      card_.end(out_);
    };
    if (is_body) return write_part({{0, false}});
    for (const CommonPart& part : walls_.outside) write_part(part);
  }

  /// One macrobody stands for all walls of a box, a cylinder, a sphere or a frustum.
  CommonPart sides_of(const CommonPart& part) {
    if (body_.empty()) body_ = macrobody();
    return body_.empty() ? part : CommonPart{{0, true}};
  }
  std::string macrobody() const {
    if (const auto* box = std::get_if<Box>(&file_.domain)) {
      const Bounds<3> b = bounds_of(Domain(*box));
      return fmt::format("RPP {} {} {} {} {} {}", b.lower[0], b.upper[0], b.lower[1], b.upper[1], b.lower[2],
                         b.upper[2]);
    }
    if (const auto* sphere = std::get_if<Sphere>(&file_.domain))
      return fmt::format("SPH {} {}", row_of(sphere->center), sphere->radius);
    if (const auto* cylinder = std::get_if<Cylinder>(&file_.domain))
      return fmt::format("RCC {} {} {}", row_of(cylinder->base),
                         row_of(without_signs_of_zero(cylinder->height * cylinder->axis.normalized())),
                         cylinder->radius);
    if (const auto* revolved = std::get_if<Revolved>(&file_.domain)) return frustum(*revolved);
    return {};
  }
  /// Of a trapezium beside the axis whose ends are level and no points; else empty.
  std::string frustum(const Revolved& revolved) const {
    const auto& p = revolved.profile;
    if (p.size() != 4) return {};
    double low = p[0][1], high = low;
    for (const Vector<2>& corner : p) {
      low = std::min(low, corner[1]);
      high = std::max(high, corner[1]);
    }
    double radius_low = 0, radius_high = 0;
    int on_axis = 0, level = 0;
    for (const Vector<2>& corner : p) {
      on_axis += corner[0] == 0;
      level += corner[1] == low || corner[1] == high;
      double& radius = corner[1] == low ? radius_low : radius_high;
      radius = std::max(radius, corner[0]);
    }
    if (on_axis != 2 || level != 4 || !(radius_low > 0) || !(radius_high > 0) || radius_low == radius_high)
      return {};
    const Vector<3> axis = revolved.axis.normalized();
    const bool grows = radius_high > radius_low;  // MCNP's first end is the wider one
    const Vector<3> from = revolved.base + (grows ? high : low) * axis,
                    along = (grows ? low - high : high - low) * axis;
    return fmt::format("TRC {} {} {} {}", row_of(from), row_of(without_signs_of_zero(along)),
                       std::max(radius_low, radius_high), std::min(radius_low, radius_high));
  }

  void write_surfaces() {
    out_.add(level_comments(level_, file_, "c ", "\n"));
    for (std::size_t i = 0; i < level_.size(); ++i) write_sphere(i + 1, i, level_.spheres.r[i]);
    for (std::size_t i = 0; i < level_.size(); ++i) {
      const SphereContent& content = model_.contents[level_.contents[i]];
      for (std::size_t k = 0; k + 1 < content.outer.size(); ++k)
        write_sphere(first_shell_[i] + k, i, content.outer[k]);
    }
    out_.add("c the ", walls_.words, '\n');
    if (!body_.empty()) {
      card_.add("{} {}", first_wall_, body_);
      card_.end(out_);
      if (!repeats_) return;
      card_.add("{} {}", first_wall_ + 1, many_boxes());
      return card_.end(out_);
    }
    for (std::size_t k = 0; k < walls_.surfaces.size(); ++k) {
      card_.add("{} {}", first_wall_ + k, typed(walls_.surfaces[k]));
      card_.end(out_);
    }
  }
  void write_sphere(Id id, std::size_t i, double r) {
    card_.add("{} SPH {} {}", id, row_of(level_.center(i)), r);
    card_.end(out_);
  }

  static std::string typed(const LevelSurface& surface) {
    const int k = surface.coordinate_axis();
    if (surface.kind == Kind::plane) {
      if (k >= 0 && surface.axis[k] > 0) return fmt::format("P{} {}", "XYZ"[k], surface.size);
      return fmt::format("P {} {}", row_of(surface.axis), surface.size);
    }
    return fmt::format("GQ {}", fmt::join(surface.quadric(), " "));
  }

  const Exported& file_;
  const LevelModel& model_;
  const Level& level_;
  TextFile& out_;
  LevelWalls walls_;
  bool repeats_ = is_periodic(file_.domain);
  static constexpr int universe_of_lattice = 1, universe_of_box = 2;
  std::vector<Id> first_shell_;
  Id first_wall_ = 1, next_cell_ = 1;
  std::string body_;
  McnpCard card_;
};

std::string write_mcnp(const Exported& file, StagedFolder& staged) {
  const LevelModel model = levels_of(file);
  require_one_level(model, file);
  require_boxes_repeat(file);
  TextFile out(staged.add(file.output.file.string()));
  McnpInput(file, model, out).write();
  out.close();
  return model.in_words();
}

/// Numbers may stand on two lines.
FileContents read_mcnp(const Reading& reading) {
  std::string card;
  return read_level(reading, [&card](std::string_view line, std::vector<std::string_view>& parts) {
    if (line.starts_with("c ")) return;
    card = line.starts_with("     ") ? card + std::string(line) : std::string(line);
    constexpr std::string_view type = " SPH ";
    const std::size_t at = card.find(type);
    if (at == card.npos) return;
    split_at(std::string_view(card).substr(at + type.size()), " ", parts);
    if (parts.size() < 4) parts.clear();
  });
}

constexpr LevelFormat of_mcnp = {
    .name = "mcnp",
    .file = "mcnp.inp",
    .writes = "MCNP: cells and macrobodies (SPH, RPP, RCC, TRC) of one level with its layers",
    .reads = "MCNP inputs that bernal wrote",
    .begins = "bernal ",
    .says = "\nc lengths in cm;",
    .write = write_mcnp,
    .read = read_mcnp};

}  // namespace

Format mcnp_format() { return format_of_levels<of_mcnp>(); }

}  // namespace bernal
