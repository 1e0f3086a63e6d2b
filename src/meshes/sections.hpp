#pragma once
#include <cstddef>
#include <vector>

#include "bernal/core/monitor.hpp"
#include "meshes/conforming_surface.hpp"
#include "meshes/tetgen.hpp"
#include "meshes/volume_mesh.hpp"

namespace bernal {

/// Where a surface is cut into sections along one of its axes.
struct SectionCuts {
  int axis = 0;
  std::vector<double> at = {};  ///< between sections, ascending; none: the surface is one section
  std::size_t count() const { return at.size() + 1; }
};

/// Sections of about equally many triangles, no more than `most_triangles` and of an odd count, unless they
/// would be thinner than the extent of two spheres. Cost: some ns a triangle.
SectionCuts section_cuts(const ConformingSurface&, std::size_t most_triangles);

/// Fills a surface section by section, so that the mesher never holds the whole. The first, third, … are
/// filled with all surface that reaches into them or is near; tetrahedra with all their corners in the
/// section are kept. No surface that was left out passes through
/// these. Their free faces close what is left, which is the second, fourth, …. The result is as of
/// `run_tetgen`, with the regions of the surface; up to four meshers run at once, and the mesh is the same
/// for any number.
///
/// `peak_bytes`: the largest sum for as many meshers as ran at once. Throws as `run_tetgen`.
VolumeMesh fill_in_sections(const ConformingSurface&, const SectionCuts&, const TetgenOptions&,
                            double& peak_bytes, const Monitor& monitor = {});

}  // namespace bernal
