#include "result/write_off.hpp"

#include <fmt/format.h>

#include <iterator>

#include "bernal/core/text.hpp"
#include "bernal/plan/plan.hpp"
#include "bernal/result/write_packing.hpp"

namespace bernal {

bool walls_are_made(const Scene& scene) {
  const auto* file = std::get_if<MeshFile>(&scene.container);
  if (!scene.container.obstacles.empty()) return true;
  return file && (!file->solids.empty() || !file->obstacles.empty() || !file->repair.empty() ||
                  file->repeats() || !file->cap.empty() || file->fill_level || file->deflection ||
                  file->interior != std::variant<Interior, Vector<3>>(Interior::solid));
}

std::string as_off_file(const Mesh& mesh) {
  std::string text = fmt::format("OFF\n{} {} 0\n", mesh.vertices.size(), mesh.triangles.size());
  const auto out = std::back_inserter(text);
  for (const Vector<3>& v : mesh.vertices) fmt::format_to(out, "{} {} {}\n", v[0], v[1], v[2]);
  for (const auto& [a, b, c] : mesh.triangles) fmt::format_to(out, "3 {} {} {}\n", a, b, c);
  return text;
}

std::string certified_walls(const Scene& scene, const Domain& domain) {
  std::string text;
  for (const std::filesystem::path& changed : changed_files(scene))
    text += fmt::format(" {} has changed since it was packed into; the walls are those that it holds now.",
                        plain_text(changed.string()));
  if (!scene.container.obstacles.empty())
    text +=
        " The walls are what obstacles leave of the container; where they are flat faces, those of "
        "container.off.";
  const auto* file = std::get_if<MeshFile>(&scene.container);
  if (!file) return text;
  const auto* mesh = std::get_if<Mesh>(&domain);
  const bool is_true = mesh && mesh->surface;  // which no repair has changed
  if (file->repeats())
    text += " The walls are those of the period in container.off, the ends of which match exactly.";
  if (!file->repair.empty() && !is_true)
    text += " The walls are those of the repaired surface, not of the file's.";
  if (is_true) {
    const double tolerance = mesh->surface->largest(&TrueSurface::Face::tolerance);
    text += fmt::format(
        " The walls are the surface of the CAD file itself, which is proven to lie within {:.2g} {} of its "
        "triangles; "
        "its edges are known to {:.2g} {}.",
        mesh->surface->worst_face().apart, name_of(scene.unit), tolerance, name_of(scene.unit));
  } else if (file->deflection)
    text += fmt::format(
        " The walls are triangles, tessellated from the CAD surface with a deflection of {:g} {}.",
        *file->deflection, name_of(scene.unit));
  return text;
}

}  // namespace bernal
