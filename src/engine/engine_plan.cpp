#include "engine/engine_plan.hpp"

#include <string>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "bernal/soft/relax.hpp"
#include "engine/engine_command.hpp"
#include "engine/engine_files.hpp"
#include "scene/stage_table.hpp"

namespace bernal::engine {
namespace {

/// Of a sphere, a step on one rank; and what a rank holds of it. Measured with 10,000 and 100,000 equal
/// spheres.
constexpr double seconds_a_step = 0.3e-6, bytes_a_sphere_of_engine = 1200;

struct Refusal {
  const Scene& scene;

  [[noreturn]] void at(const Location& where, const std::string& why) const {
    throw Error(ErrorCode::bad_scene, why, where);
  }
  [[noreturn]] void of_kind(const std::string& why) const { at(scene.engine->locations.of("kind"), why); }
};

/// Why the engine cannot have such walls, or empty.
std::string lack_of_walls(const SceneEngine& engine, const Domain& domain) {
  const bool is_lammps = std::holds_alternative<Lammps>(engine);
  if (std::holds_alternative<Polygon>(domain)) return "engines pack spheres, no discs; leave [engine] out";
  if (std::holds_alternative<Revolved>(domain))
    return "engines have no walls of a solid of revolution: leave [engine] out, or give the container to "
           "kind = \"liggghts\" as a mesh";
  if (is_lammps && std::holds_alternative<Mesh>(domain))
    return "LAMMPS has no walls of triangles; kind = \"liggghts\" has";
  if (is_lammps) return {};
  if (std::holds_alternative<Sphere>(domain))
    return "LIGGGHTS has no wall around a sphere; kind = \"lammps\" has";
  if (const auto* cylinder = std::get_if<Cylinder>(&domain); cylinder && cylinder->coordinate_axis() < 0)
    return "LIGGGHTS has cylinders along x, y and z only; kind = \"lammps\" has others";
  return {};
}

void require_stages(const Scene& scene, const Refusal& refuse) {
  const Stage& first = scene.stages.front();
  const StageTraits& traits = table_of(first).traits;
  if (!(traits.stands_in_bed(scene) ? traits.frees_bed : traits.frees_box))
    refuse.at(first.locations.whole,
              fmt::format("\"{}\" cannot begin with what an engine leaves, for soft particles overlap: begin "
                          "with \"relax\"",
                          first.name()));
  if (const Relax* relax = first.as<Relax>(); relax && relax->phi0)
    refuse.at(first.locations.of("phi0"),
              "with an [engine] relax begins where that ends; leave \"phi0\" out");
}

/// What is done slab by slab is a relaxation in a box that follows, and no more.
void require_slabs_fit(const Scene& scene, const Refusal& refuse) {
  const Location where = scene.engine->locations.of("slabs");
  const auto* box = std::get_if<PeriodicBox>(&scene.container);
  if (!box || !box->walls.empty() || !box->scalable)
    refuse.at(where,
              "\"slabs\" are those of a box that repeats itself along all axes and whose size is the result: "
              "leave \"slabs\" out, or make the container such a box");
  if (!scene.target.has_count() || scene.target.has_packing_fraction())
    refuse.at(where,
              "\"slabs\" need a \"count\" in [spheres], and no packing fraction; give that, or leave "
              "\"slabs\" out");
  if (scene.asks_for_gaps()) refuse.at(where, "\"slabs\" know no gaps; leave the gap out, or \"slabs\"");
  for (const Output& output : scene.outputs)
    refuse.at(output.locations.whole,
              "an [[output]] needs all spheres at once, and the engine's \"slabs\" are there so that nobody "
              "holds them; leave it out, for bernal export");
  const Relax* relax = scene.stages.size() == 1 ? scene.stages.front().as<Relax>() : nullptr;
  if (!relax)
    refuse.at(
        scene.stages.back().locations.whole,
        "with the engine's \"slabs\" there is one stage, \"relax\"; leave the others out, or \"slabs\"");
  for (const auto& [key, is_asked] : {std::pair{"exchange", relax->exchange},
                                      {"polish", relax->polish > 0},
                                      {"settle", relax->settle},
                                      {"method", relax->method != RelaxMethod::fast},
                                      {"device", relax->device != RelaxDevice::processor}})
    if (is_asked)
      refuse.at(
          scene.stages.front().locations.of(key),
          fmt::format("\"{}\" needs all spheres at once; leave it out, or the engine's \"slabs\"", key));
}

/// Spheres that are poured are so many, and fall onto something.
void require_pouring_fits(const Scene& scene, const Domain& domain, const Refusal& refuse) {
  const Location where = scene.engine->locations.of("pour");
  if (scene.engine->process().slabs > 1)
    refuse.at(where, "\"pour\" and \"slabs\" exclude each other; give one");
  if (!has_walls(domain) || !table_of(scene.stages.front()).traits.stands_in_bed(scene))
    refuse.at(where,
              "spheres are poured onto a floor, which this periodic box has not: take another container");
  if (!scene.target.has_count())
    refuse.at(where, "\"pour\" needs a \"count\" in [spheres]: how many spheres are poured");
}

}  // namespace

void require_engine_fits(const Scene& scene, const Domain& domain) {
  const Refusal refuse{scene};
  if (scene.dimension() != 3)
    refuse.of_kind(
        fmt::format("engines pack in three dimensions, not in {}; leave [engine] out", scene.dimension()));
  if (const std::string lack = lack_of_walls(*scene.engine, domain); !lack.empty()) refuse.of_kind(lack);
  if (scene.start.file)
    refuse.at(
        scene.locations.of("start"),
        "\"start\" and [engine] exclude each other: both say where the spheres begin; give one of them");
  require_stages(scene, refuse);
  if (scene.engine->process().slabs > 1) require_slabs_fit(scene, refuse);
  if (const auto* liggghts = std::get_if<Liggghts>(&*scene.engine); liggghts && liggghts->pour)
    require_pouring_fits(scene, domain, refuse);
  if (const auto* box = std::get_if<PeriodicBox>(&scene.container)) {
    if (box->scalable && !box->walls.empty())
      refuse.of_kind("engines know no box between walls whose size follows; give it \"size\" or \"edge\"");
    if (!box->scalable && box->walls.empty() && scene.target.is_open())
      refuse.at(
          scene.target.where,
          "with an [engine] a periodic box of given size needs a \"count\" or a \"packing_fraction\" in "
          "[spheres]");
  }
  for (const Output& output : scene.outputs)
    if (output.file == "engine")
      refuse.at(output.locations.of("file"),
                "\"engine\" is the folder of the [engine]; give it another \"file\"");
}

PlanItem planned_engine(const Scene& scene, double spheres) {
  const SceneEngine& engine = *scene.engine;
  const EngineProcess& process = engine.process();
  const Dialect& dialect = dialect_of(engine);
  const std::vector<std::string> words = words_of(engine);
  std::string what =
      fmt::format("soft particles in {}, {} steps, in the folder \"engine\" of the result: {}", dialect.title,
                  grouped(static_cast<std::uint64_t>(process.steps)), in_shell(words));
  if (process.launcher == EngineLauncher::slurm)
    what += "; in a script for sbatch, after whose job the same call goes on";
  else
    try {
      found_words(engine);
    } catch (const Error& error) {
      std::string why = error.what();
      if (const std::string place = error.location().text(); !place.empty()) why.erase(0, place.size() + 2);
      what += "; it would fail here: " + why;
    }
  if (process.slabs > 1)
    what += fmt::format(
        "; what it leaves is freed of overlap and certified in {} slabs on the disk, of which "
        "one at a time is in memory",
        process.slabs);
  return {.name = engine_effect,
          .what = what,
          .cost = "O(N) a step",
          .seconds = seconds_a_step * spheres * process.steps / process.ranks,
          .bytes = bytes_a_sphere_of_engine * spheres};
}

}  // namespace bernal::engine
