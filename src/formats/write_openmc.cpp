#include <fmt/format.h>

#include "formats/format.hpp"
#include "formats/npy.hpp"
#include "io/seal.hpp"
#include "scene/toml_text.hpp"

namespace bernal {
namespace {

constexpr std::string_view radii_ending = "_radii.npy", script_ending_py = ".py";

/// A point or a direction as Python.
std::string tuple_of(const Vector<3>& v) { return fmt::format("({}, {}, {})", v[0], v[1], v[2]); }

/// The body of `region`, in Python: what bounds the domain.
struct RegionLines {
  const Exported& file;

  /// Along one axis: planes at its ends.
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
  std::string operator()(const Box& box) const {
    std::string lines;
    for (int k = 0; k < 3; ++k) lines += between(k, box.corner[k], box.corner[k] + box.size[k]);
    return lines + "    return +x_low & -x_high & +y_low & -y_high & +z_low & -z_high\n";
  }
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
    const Bounds<3> box = bounds_of(file.domain);
    std::string lines =
        "    # The walls are those of a CAD part, for which OpenMC has DAGMC; this is the box around it.\n";
    for (int k = 0; k < 3; ++k) lines += between(k, box.lower[k], box.upper[k]);
    return lines + "    return +x_low & -x_high & +y_low & -y_high & +z_low & -z_high\n";
  }
  std::string operator()(const Mesh&) const { return bounds(); }
  std::string operator()(const Polygon&) const { return bounds(); }
};

std::string script_text(const Exported& file, const std::string& radii) {
  const Bounds<3> bounds = bounds_of(file.domain);
  const auto periodic = file.periods();
  const auto word = [&](std::size_t k) { return periodic[k] ? "True" : "False"; };
  return fmt::format(
      R"("""{title}; for OpenMC, lengths in cm.

    particle = openmc.Universe(cells=[...])                    # what every sphere holds
    bed = openmc.Cell(region=region(), fill=lattice(particle, matrix, (10, 10, 10)))

or, for few spheres, openmc.Cell(fill=fuel, region=-s) for each s of spheres().
"""
from pathlib import Path

import numpy as np
import openmc
import openmc.model

here = Path(__file__).resolve().parent
centers = np.load(here / {centers})  # (N, 3)
radii = np.load(here / {radii})  # (N,)
lower = np.array({lower}, dtype=float)
upper = np.array({upper}, dtype=float)
periodic = ({p0}, {p1}, {p2})


def with_images():
    """Centres and radii, and those of all images that reach into the box where it repeats itself."""
    c, r = centers, radii
    for axis in range(3):
        if not periodic[axis]:
            continue
        edge = np.zeros(3)
        edge[axis] = upper[axis] - lower[axis]
        low = c[:, axis] - r < lower[axis]
        high = c[:, axis] + r > upper[axis]
        c = np.concatenate([c, c[low] + edge, c[high] - edge])
        r = np.concatenate([r, r[low], r[high]])
    # Beyond an edge or a corner of the box an image may be near two faces and not reach in.
    gap = np.maximum(np.maximum(lower - c, c - upper), 0)
    reach_in = np.square(gap).sum(axis=1) < r**2
    reach_in[: len(centers)] = True
    return c[reach_in], r[reach_in]


def region(wall="vacuum"):
    """What the spheres lie in; wall is the boundary_type of its surfaces."""
{region}

def spheres():
    """A surface for every sphere and image."""
    return [openmc.Sphere(*c, r) for c, r in zip(*with_images())]


def trisos(universe):
    return [openmc.model.TRISO(r, universe, c) for c, r in zip(*with_images())]


def lattice(universe, background, shape):
    """Finds spheres fast: of so many cells along each axis."""
    pitch = (upper - lower) / np.array(shape)
    return openmc.model.create_triso_lattice(trisos(universe), lower, pitch, shape, background)
)",
      fmt::arg("title", file.title()), fmt::arg("centers", toml_string(file.output.file.string())),
      fmt::arg("radii", toml_string(radii)), fmt::arg("lower", tuple_of(bounds.lower)),
      fmt::arg("upper", tuple_of(bounds.upper)), fmt::arg("p0", word(0)), fmt::arg("p1", word(1)),
      fmt::arg("p2", word(2)), fmt::arg("region", std::visit(RegionLines{file}, file.domain)));
}

void write_openmc(const Exported& file, StagedFolder& staged) {
  const std::string radii = file_beside(file.output.file, radii_ending);
  write_npy(staged.add(file.output.file.string()), file.size(), 3,
            [&](std::size_t i, std::size_t k) { return file.spheres.x[k][i]; });
  write_npy(staged.add(radii), file.size(), 0, [&](std::size_t i, std::size_t) { return file.spheres.r[i]; });
  staged.write(file_beside(file.output.file, script_ending_py),
               sealed_script(script_text(file, radii), {staged.written(radii)}));
}

}  // namespace

const Format& openmc_format() {
  static const Format format{
      .table = {.keys = output_entry(
                    "openmc", "OpenMC: centres (.npy), their radii and a Python module for TRISO particles",
                    {}),
                .file = "openmc.npy",
                .endings = {radii_ending, script_ending_py},
                .unit = Unit::cm},
      .write = write_openmc};
  return format;
}

}  // namespace bernal
