#include "formats/surface_file.hpp"
#include "formats/text_file.hpp"

namespace bernal {
namespace {

std::string write_obj_file(const Exported& file, StagedFolder& staged) {
  const Surfaces surfaces = surfaces_of(file);
  TextFile out(staged.add(file.output.file.string()));
  out.add("# ", file.title(), "; lengths in ", name_of(file.unit()), '\n');
  std::optional<std::uint32_t> last;
  bool any = false;
  surfaces.visit([&](const SurfacePart& part) {
    if (!any || part.sphere != last) {  // pieces of one sphere form one object
      if (part.sphere)
        out.add("o sphere_", *part.sphere, '\n');
      else
        out.add("o container\n");
    }
    any = true;
    last = part.sphere;
    for (const FloatPoint& p : part.vertices) out.add("v ", p[0], ' ', p[1], ' ', p[2], '\n');
    for (const auto& [a, b, c] : part.triangles) out.add("f ", a + 1, ' ', b + 1, ' ', c + 1, '\n');
  });
  out.close();
  return surfaces.note();
}

}  // namespace

Format obj_format() {
  return surface_format("obj", "triangles for modellers, an object a sphere", "spheres.obj", write_obj_file);
}

}  // namespace bernal
