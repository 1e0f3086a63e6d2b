#include <fmt/format.h>

#include "scene/scene_entries.hpp"

namespace bernal::schema {
namespace {

constexpr int most_ranks = 1'000'000, most_slabs = 4096;

std::vector<Key> keys_of_process() {
  return {
      integer(&EngineProcess::ranks, "ranks",
              "processes that share the spheres; a single one is started without a launcher",
              {1, most_ranks}),
      word(&EngineProcess::launcher, "launcher",
           "mpirun: started at once, and waited for; slurm: a script is written for sbatch, and the same "
           "call after that job goes on from its result",
           {"mpirun", "slurm"}),
      names(&EngineProcess::command, "command",
            "what starts the ranks, with options of its own; if absent mpirun, in a script for Slurm srun"),
      names(&EngineProcess::executable, "executable",
            "the engine, with options of its own; if absent as Debian calls it"),
      names(&EngineProcess::slurm, "slurm",
            "options for sbatch that the script begins with, such as \"--time=02:00:00\""),
      integer(&EngineProcess::steps, "steps",
              "of the motion that pushes spheres apart; more make a periodic box denser", {10, 1e9}),
      flag(&EngineProcess::keep, "keep",
           "true: what the engine read and wrote stays in the folder \"engine\" of the result, and the "
           "same scene takes it up again; its script and logs stay anyway"),
      integer(&EngineProcess::slabs, "slabs",
              "so many, across the longest axis of a periodic box whose size follows, are freed of overlap "
              "and certified one after the other, so that bernal holds only the spheres of one",
              {1, most_slabs})};
}

void engine_rule(const EngineProcess& process, const Section& section) {
  if (!process.slurm.empty() && process.launcher != EngineLauncher::slurm)
    section.refuse("slurm", "goes with launcher = \"slurm\"; leave it out");
  for (const auto& [key, words] : {std::pair{"command", &process.command},
                                   {"executable", &process.executable},
                                   {"slurm", &process.slurm}})
    for (const std::string& word : *words)
      if (word.empty() || word.find_first_of("\n\r") != std::string::npos)
        section.refuse(key, "must have no empty words and no line breaks");
}

std::vector<Key> keys_of_pouring() {
  return {flag(&Liggghts::pour, "pour",
               "true: the spheres fall from above the bed under gravity, rub and bounce, until all are at "
               "rest"),
          number(&Liggghts::friction, "friction",
                 "Coulomb's, of spheres that are poured, between them and with walls", {0, 10}),
          number(&Liggghts::restitution, "restitution",
                 "of spheres that are poured: their speed after an impact over that before", above(0, 1))};
}

/// What a result says of it explicitly is no matter.
void pouring_rule(const Liggghts& of, const Section& section) {
  const Liggghts usual;
  if (of.pour && of.process.steps != usual.process.steps)
    section.fail("steps", "spheres that are poured move until they rest; leave \"steps\" out");
  if (of.pour) return;
  const auto refuse = [&](std::string_view key) {
    section.fail(key,
                 fmt::format("\"{}\" is of spheres that are poured: say pour = true, or leave it out", key));
  };
  if (of.friction != usual.friction) refuse("friction");
  if (of.restitution != usual.restitution) refuse("restitution");
}

template <class Options>
Entry entry_of_engine(std::string_view name, std::string_view help, std::vector<Key> more = {}) {
  return entry<Options>({.name = name,
                         .help = help,
                         .keys = joined(inside(&Options::process, keys_of_process()), std::move(more)),
                         .rule = [](const void* options, const Section& section) {
                           const auto& engine = *static_cast<const Options*>(options);
                           engine_rule(engine.process, section);
                           if constexpr (std::is_same_v<Options, Liggghts>) pouring_rule(engine, section);
                         }});
}

}  // namespace

const std::vector<Entry>& engine_entries() {
  static const std::vector<Entry> all = {
      entry_of_engine<Lammps>(
          "lammps",
          "LAMMPS over MPI finds the places, as soft particles: in periodic boxes, boxes, "
          "cylinders and spheres"),
      entry_of_engine<Liggghts>("liggghts",
                                "LIGGGHTS over MPI finds the places, as soft particles: in parts of CAD, "
                                "boxes, cylinders along an axis and periodic boxes",
                                keys_of_pouring())};
  return all;
}

}  // namespace bernal::schema
