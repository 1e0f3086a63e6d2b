#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/scene/sphere_layers.hpp"
#include "files/csv_lines.hpp"
#include "files/file_kind.hpp"
#include "files/seal.hpp"
#include "formats/npy.hpp"
#include "formats/openmc_model.hpp"
#include "formats/templates.hpp"
#include "scene/toml_text.hpp"

namespace bernal {
namespace {

constexpr std::string_view script_ending_py = ".py", xml_ending = ".xml", array_ending = ".npy";

/// A point or a direction in Python.
std::string tuple_of(const Vector<3>& v) { return fmt::format("({})", row_of(v, ", ")); }

/// The body of the Python function `region`: the surfaces that bound the domain.
struct RegionLines {
  const Exported& file;

  /// Planes at both ends of an axis.
  std::string between(int axis, double lower, double upper) const {
    const bool repeats = file.periods()[static_cast<std::size_t>(axis)];
    const char letter = "xyz"[axis], plane = "XYZ"[axis];
    std::string lines = fmt::format(
        "    {0}_low = openmc.{1}Plane({2}, boundary_type={4})\n"
        "    {0}_high = openmc.{1}Plane({3}, boundary_type={4})\n",
        letter, plane, lower, upper, repeats ? "'periodic'" : "wall");
    if (repeats) lines += fmt::format("    {0}_low.periodic_surface = {0}_high\n", letter);
    return lines;
  }
  std::string faces() const {
    const Bounds<3> box = bounds_of(file.domain);
    std::string lines;
    for (int k = 0; k < 3; ++k) lines += between(k, box.lower[k], box.upper[k]);
    return lines + "    return +x_low & -x_high & +y_low & -y_high & +z_low & -z_high\n";
  }
  std::string operator()(const Box&) const { return faces(); }
  std::string operator()(const Cylinder& cylinder) const {
    const Vector<3> axis = cylinder.axis.normalized(), top = cylinder.base + cylinder.height * axis;
    std::string lines = fmt::format(
        "    side = openmc.Cylinder({}, {}, {}, {}, {}, {}, {}, boundary_type=wall)\n", cylinder.base[0],
        cylinder.base[1], cylinder.base[2], cylinder.radius, axis[0], axis[1], axis[2]);
    if (const int k = cylinder.coordinate_axis(); cylinder.periodic) {
      lines += between(k, cylinder.base[k], cylinder.base[k] + cylinder.height);
      return lines + fmt::format("    return -side & +{0}_low & -{0}_high\n", "xyz"[k]);
    }
    const auto lid = [&](std::string_view name, const Vector<3>& at) {
      return fmt::format("    {} = openmc.Plane({}, {}, {}, {}, boundary_type=wall)\n", name, axis[0],
                         axis[1], axis[2], axis.dot(at));
    };
    return lines + lid("base", cylinder.base) + lid("top", top) + "    return -side & +base & -top\n";
  }
  std::string operator()(const Sphere& sphere) const {
    return fmt::format("    return -openmc.Sphere({}, {}, {}, {}, boundary_type=wall)\n", sphere.center[0],
                       sphere.center[1], sphere.center[2], sphere.radius);
  }
  std::string bounds() const {
    return "    # The walls are those of a CAD part, for which OpenMC has DAGMC; this is the box around "
           "it.\n" +
           faces();
  }
  std::string operator()(const Mesh&) const { return bounds(); }
  std::string operator()(const Polygon&) const { return bounds(); }
  std::string operator()(const Revolved&) const { return bounds(); }
};

std::string script_text(const Exported& file, const std::string& radii) {
  const Bounds<3> bounds = bounds_of(file.domain);
  return filled(openmc_py, {{"TITLE", file.title()},
                            {"CENTERS", toml_string(file.output.file.string())},
                            {"RADII", toml_string(radii)},
                            {"LOWER", tuple_of(bounds.lower)},
                            {"UPPER", tuple_of(bounds.upper)},
                            {"PERIODIC", periods_in_python(file)},
                            {"REGION", std::visit(RegionLines{file}, file.domain)}});
}

/// Centres, radii and a module where the name is that of an array; else the levels of the packing.
std::string write_openmc(const Exported& file, StagedFolder& staged) {
  const std::string ending = file.output.file.extension().string();
  if (ending.empty() || ending == xml_ending) return write_openmc_model(file, staged);
  const bool has_more = has_layers(file.packing.scene) || !file.packing.inside.empty();
  if (ending != array_ending && has_more)
    throw Error(
        ErrorCode::bad_scene,
        fmt::format("the format openmc writes spheres alone into a file that ends in .npy, and layers and "
                    "levels into one that ends in .xml or a folder; give {} one of these endings, or none",
                    bernal::quoted(std::string_view(file.output.file.string()))),
        file.output.locations.whole);
  const std::string radii = file_beside(file.output.file, radii_ending);
  write_npy(staged.add(file.output.file.string()), file.size(), 3,
            [&](std::size_t i, std::size_t k) { return file.spheres.x[k][i]; });
  write_npy(staged.add(radii), file.size(), 0, [&](std::size_t i, std::size_t) { return file.spheres.r[i]; });
  staged.write(file_beside(file.output.file, script_ending_py),
               sealed_script(script_text(file, radii), {staged.written(radii)}));
  return {};
}

FileContents read_openmc(const Reading& reading) {
  if (reading.file.extension() == xml_ending) return read_openmc_model(reading);
  FileContents contents = read_npy(reading);
  contents.unit = reading.options.unit.value_or(Unit::cm);
  return contents;
}

}  // namespace

Format openmc_format() {
  return {.name = "openmc",
          .writes =
              "OpenMC: centres (.npy), their radii and a Python module for TRISO particles; or CSG of all "
              "levels, in a folder, or in one file where the name ends in .xml",
          .file = "openmc.npy",
          .endings = {radii_ending, script_ending_py},
          .alone = xml_ending,
          .unit = Unit::cm,
          .is_folder = true,
          .write_with_note = write_openmc,
          .holds_levels = [](const Output& output) { return output.file.extension() != array_ending; },
          .reads =
              "OpenMC centres, .npy of N x 3, with FILE_radii.npy beside them, ‹radii› or ‹radius›; "
              "geometry.xml that bernal wrote",
          .unit_from = "cm",
          .options = {"columns", "radii", "level"},
          .recognises =
              [](const FileBeginning& file) {
                return is_openmc_model(file) ||
                       (is_npy(file) && kind_of_file(radii_beside(file.file)) == FileKind::regular);
              },
          .read = read_openmc};
}

}  // namespace bernal
