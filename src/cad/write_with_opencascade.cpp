#include "bernal/core/error.hpp"
#include "cad/opencascade_module.hpp"
#include "cad/write_shapes.hpp"
#include "process/cage.hpp"

namespace bernal::cad {

WrittenShapes write_with_opencascade(const SolidShapes& shapes, SolidFormat format,
                                     const std::filesystem::path& file) {
  const std::uint64_t solids = shapes.balls.size() + shapes.necks.size() + shapes.faces.size();
  const CageLimits limits{.memory = (std::uint64_t{10} << 30) + (solids << 22),
                          .seconds = 60 + static_cast<double>(solids)};
  WrittenShapes made;
  const std::string befell = run_in_cage(
      "OpenCASCADE", limits,
      [&] {
        if (void* function = opencascade_function("bernal_write_shapes"))
          reinterpret_cast<decltype(&bernal_write_shapes)>(function)(shapes, format, file, made);
        else
          made.failure = "this bernal runs without OpenCASCADE, which writes STEP and BREP; " +
                         opencascade_remedy() + ", or export gmsh";
      },
      [&](Archive& a) { a(made.failure, made.solids, made.volume, made.has_container); });
  if (const std::string& failure = befell.empty() ? made.failure : befell; !failure.empty())
    throw Error(ErrorCode::cannot_write, failure, {file.filename().string()});
  return made;
}

}  // namespace bernal::cad
