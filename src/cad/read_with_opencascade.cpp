#include <dlfcn.h>

#include <algorithm>
#include <initializer_list>
#include <vector>

#include "cad/caged_reader.hpp"
#include "cad/known_formats.hpp"
#include "cad/opencascade/read_shapes.hpp"
#include "cad/opencascade_module.hpp"

namespace bernal::cad {
namespace {

/// Surfaces take more than triangles, and a deflection that somebody chose for small spheres may take the
/// mesher minutes; of its own choice it needs a second or two for the largest of our files, of 1.8 MB.
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

namespace {

/// Where the module may be: under its name alone where this was built, which the program's RUNPATH knows; beside
/// the program where both are installed; where packages put it. A folder that anybody may write to is not among
/// them.
std::vector<std::filesystem::path> places_of_module() {
  std::error_code unknown;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", unknown);
  std::vector<std::filesystem::path> places;
  for (const std::filesystem::path module : std::initializer_list<const char*>{BERNAL_OPENCASCADE_MODULES})
    places.push_back(module.has_parent_path() ? program.parent_path() / module : module);
  return places;
}

}  // namespace

void* opencascade_function(const char* name) {
  for (const std::filesystem::path& module : places_of_module())
    if (void* loaded = dlopen(module.c_str(), RTLD_LAZY | RTLD_LOCAL))
      if (void* symbol = dlsym(loaded, name)) return symbol;
  return nullptr;
}

std::string opencascade_remedy() {
  const auto places = places_of_module();
  if (places.empty()) return "install it and build again";
  std::error_code unknown;
  const bool is_there = std::ranges::any_of(places, [&](const std::filesystem::path& module) {
    return module.has_parent_path() && std::filesystem::exists(module, unknown);
  });
  return is_there ? "install its libraries, on Debian by apt install " BERNAL_OPENCASCADE_PACKAGE
                  : "install " + places.front().string() + ", which the Debian package bernal has";
}

bool opencascade_reads(const std::filesystem::path& file) { return shape_format(file).has_value(); }

ReadAttempt read_with_opencascade(const std::filesystem::path& file, double deflection) {
  return read_in_cage("OpenCASCADE", limits_for_shapes(std::filesystem::file_size(file), deflection > 0),
                      [&] {
                        ReadAttempt result;
                        if (void* function = opencascade_function("bernal_read_shapes")) {
                          const auto reader = reinterpret_cast<decltype(&bernal_read_shapes)>(function);
                          reader(file, shape_format(file).value(), deflection, result);
                        } else {
                          result.failure =
                              "this bernal runs without OpenCASCADE, which reads STEP, IGES and BREP; " +
                              opencascade_remedy() + ", or export STL";
                        }
                        return result;
                      });
}

}  // namespace bernal::cad
