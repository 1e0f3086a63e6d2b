#include "cad/opencascade/read_shapes.hpp"
#include "cad/opencascade_module.hpp"
#include "cad/read/caged_reader.hpp"
#include "cad/read/known_formats.hpp"

namespace bernal::cad {
namespace {

/// Surfaces take more memory than triangles, and a deflection chosen for small spheres may take the mesher
/// minutes; with its default it takes a second or two for the largest test file, of 1.8 MB.
CageLimits limits_for_shapes(std::uint64_t file_size, bool deflection_chosen) {
  CageLimits limits = cage_limits(file_size);
  limits.memory = 10 * limits.memory;
  limits.seconds = (deflection_chosen ? 60 : 2) * limits.seconds;
  return limits;
}

std::optional<ShapeFormat> shape_format(const std::filesystem::path& file) {
  const std::string extension = extension_of(file);
  if (extension == ".step" || extension == ".stp") return ShapeFormat::step;
  if (extension == ".iges" || extension == ".igs") return ShapeFormat::iges;
  if (extension == ".brep" || extension == ".brp") return ShapeFormat::brep;
  return std::nullopt;
}

}  // namespace

bool opencascade_reads(const std::filesystem::path& file) { return shape_format(file).has_value(); }

ReadAttempt read_with_opencascade(const std::filesystem::path& file, double deflection,
                                  const std::optional<SpheresInside>& inside) {
  const CageLimits limits = limits_for_shapes(std::filesystem::file_size(file), deflection > 0);
  ReadAttempt read = read_in_cage("OpenCASCADE", limits, [&] {
    ReadAttempt result;
    if (void* function = opencascade_function("bernal_read_shapes")) {
      const auto reader = reinterpret_cast<decltype(&bernal_read_shapes)>(function);
      reader(file, shape_format(file).value(), deflection, inside, result);
    } else {
      result.failure = "this bernal runs without OpenCASCADE, which reads STEP, IGES and BREP; " +
                       opencascade_remedy() + ", or export STL";
    }
    return result;
  });
  read.reader = "OpenCASCADE, tessellated";
  return read;
}

}  // namespace bernal::cad
