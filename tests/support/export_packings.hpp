#pragma once
#include <array>
#include <map>
#include <string>

#include "bernal/formats/export.hpp"
#include "bernal/scene/read_scene.hpp"
#include "support/folder.hpp"
#include "support/packings.hpp"

// What the tests of export share: packings of some sixty spheres in domains of every kind, in mm.
namespace bernal::testing::exports {

/// Three sizes, or many, in a domain whose scene is in mm.
inline Packing packing_in(const Domain& domain, const std::string& container, bool three_sizes = true) {
  Packing packing;
  const Bounds<3> bounds = bounds_of(domain);
  const bool flat = dimension_of(domain) == 2;
  Bounds<3> middle = bounds;  // where balls fit whatever the shape
  for (int k = 0; k < 3; ++k) {
    const double margin = 0.2 * bounds.size()[k];
    middle.lower[k] += margin;
    middle.upper[k] -= margin;
  }
  if (flat) middle = {{bounds.lower[0], bounds.lower[1], -9}, {bounds.upper[0], bounds.upper[1], 9}};
  Spheres<3> spheres = scattered(60, 0.1, 0.4, middle, 7, true);
  for (std::size_t i = 0; i < spheres.size() && three_sizes; ++i)
    spheres.r[i] = std::array{0.1, 0.0625, 0.03}[i % 3];
  if (flat) {
    Spheres<2> discs;
    discs.x = {spheres.x[0], spheres.x[1]};
    discs.r = spheres.r;
    packing.spheres = discs;
  } else {
    packing.spheres = spheres;
  }
  packing.domain = domain;
  packing.volume = volume_of(domain);
  packing.scene =
      parse_scene("unit = \"mm\"\n[container]\n" + container + "\n[spheres]\ncount = 60\nradius = 0.1\n", "");
  return packing;
}

inline Packing periodic(bool three_sizes = true) {
  return packing_in(bernal::periodic_box(Vector<3>(3, 4, 5.3)), "kind = \"periodic\"\nsize = [3, 4, 5.3]",
                    three_sizes);
}
inline Packing between_walls() {
  return packing_in(bernal::periodic_box(Vector<3>(3, 4, 5.3), {false, false, true}),
                    "kind = \"periodic\"\nsize = [3, 4, 5.3]\nwalls = [2]");
}
inline Packing in_cylinder() {
  return packing_in(Cylinder{.base = {1, 2, -1}, .radius = 2, .height = 5},
                    "kind = \"cylinder\"\nradius = 2\nheight = 5\nbase = [1, 2, -1]");
}
inline Packing in_plane() {
  return packing_in(Box{Vector<2>(1, 2), Vector<2>(4, 5)}, "kind = \"box\"\nsize = [4, 5]");
}

/// Millimetres in metres or centimetres, rounded once.
inline double in_unit(double mm, const std::string& unit) {
  return unit == "m" ? mm / 1000 : unit == "cm" ? mm / 10 : mm;
}

/// The file of a format, in the folder.
inline std::filesystem::path exported_to(const Folder& folder, const Packing& packing,
                                         const std::string& format,
                                         const std::map<std::string, std::string>& words = {}) {
  return write_export(packing, output_of(format, words), folder / ("a." + format)).files.front();
}

}  // namespace bernal::testing::exports
