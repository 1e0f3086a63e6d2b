#include <algorithm>
#include <array>
#include <cmath>
#include <variant>

#include <fmt/format.h>

#include "bernal/core/text.hpp"
#include "bernal/scene/nest.hpp"
#include "formats/format.hpp"
#include "formats/text_file.hpp"

namespace bernal {
namespace {

using Quaternion = std::array<double, 4>;

/// The rotation by `first`, and then by `second`.
Quaternion after(const Quaternion& second, const Quaternion& first) {
  const auto [a, b, c, d] = second;
  const auto [w, x, y, z] = first;
  return {a * w - b * x - c * y - d * z, a * x + b * w + c * z - d * y, a * y - b * z + c * w + d * x,
          a * z + b * y - c * x + d * w};
}

/// Which packing lies in a sphere, and how it is turned there.
struct Held {
  const Packing* packing = nullptr;
  Quaternion rotation = {1, 0, 0, 0};
};
Held held_in(const Packing& packing, std::size_t sphere) {
  for (const PackingsInside& inside : packing.inside) {
    const auto found = std::ranges::lower_bound(inside.spheres, static_cast<std::uint32_t>(sphere));
    if (found == inside.spheres.end() || *found != sphere) continue;
    const auto k = static_cast<std::size_t>(found - inside.spheres.begin());
    return {inside.templates[inside.which[k]].get(), inside.rotations[k]};
  }
  return {};
}

/// A line for every sphere that holds no others, those of a packing inside as often as it stands. What lies
/// inside of a sphere is turned, and moved to its centre.
class Lines {
 public:
  Lines(const Exported& file, TextFile& out) : file_(file), out_(out) {}

  void add_all() {
    for (outermost_ = 0; outermost_ < file_.size(); ++outermost_) {
      const Vector<3> center = file_.spheres.center(outermost_);
      const Held held = held_in(file_.packing, outermost_);
      if (held.packing)
        add_inside(*held.packing, held.rotation, center);
      else
        add(center, file_.spheres.r[outermost_]);
    }
  }

 private:
  void add_inside(const Packing& packing, const Quaternion& rotation, const Vector<3>& center) {
    const auto convert = unit_conversion(packing.scene.unit, file_.unit());
    const auto& x = packing.spheres.x;
    for (std::size_t i = 0; i < packing.spheres.size(); ++i) {
      const Vector<3> own(convert(x[0][i]), convert(x[1][i]), convert(x[2][i]));
      const Vector<3> at = center + turned(own, rotation);
      const Held held = held_in(packing, i);
      if (held.packing)
        add_inside(*held.packing, after(rotation, held.rotation), at);
      else
        add(at, convert(packing.spheres.r[i]));
    }
  }

  void add(const Vector<3>& at, double radius) {
    out_.add(at[0], ',', at[1], ',', at[2], ',', radius, ',', outermost_, '\n');
  }

  const Exported& file_;
  TextFile& out_;
  std::size_t outermost_ = 0;
};

void write_flat(const Exported& file, TextFile& out) {
  out.add("# unit: ", name_of(file.unit()), "\nx,y,z,r,sphere\n");
  Lines(file, out).add_all();
}

/// How far turning and moving may be off: see `turned`, and half a unit in the last place of each sum.
std::string rounding_in_words(const Exported& file) {
  if (file.packing.inside.empty()) return "radii; nothing lies inside of its spheres";
  double largest = 0, ball = 0;
  for (const auto& column : file.spheres.x)
    for (const double x : column) largest = std::max(largest, std::abs(x));
  std::uint64_t spheres = 0;
  int depth = 0;
  for (const NestLevel& level : levels_of(file.packing)) {
    spheres += level.spheres;
    if (level.depth > 0) spheres -= std::min(spheres, level.filled);  // which hold others
    depth = std::max(depth, level.depth);
    ball = std::max(ball, level.ball * conversion_factor(level.unit, file.unit()));
  }
  const double off = depth * (4e-15 * ball + 0x1p-53 * (largest + ball));
  return fmt::format(
      "radii; {} spheres that hold no others, with the number of the outermost that each lies in; turning "
      "and moving them rounds each coordinate, by less than {:.1g} {}, so that they may overlap by as much",
      grouped(spheres), off, name_of(file.unit()));
}

}  // namespace

Format flat_format() {
  return {
      .name = "flat",
      .writes =
          "a table of what lies inside of spheres, each where it stands: x, y, z, r and the sphere that it "
          "lies in, written one after the other",
      .file = "flat.csv",
      .least_dimension = 3,
      .write_text = write_flat,
      .note = rounding_in_words,
      .holds_levels = [](const Output&) { return true; }};
}

}  // namespace bernal
