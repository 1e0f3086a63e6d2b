#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "bernal/scene/scene.hpp"
#include "engine/engine_files.hpp"

namespace bernal::engine {

/// The words that start an engine on its script, programs by their own names: "mpirun -np 2 lmp -in
/// in.lammps -log log.lammps".
std::vector<std::string> words_of(const SceneEngine& engine);
/// The same in one line, as a shell would have it.
std::string in_shell(const std::vector<std::string>& words);

/// The words with the programs where they are: the first, and after it the engine. Throws EngineError
/// with the package that has what is missing.
std::vector<std::string> found_words(const SceneEngine& engine);

/// What Open MPI is told, where nobody has told it otherwise: to let root start it, to start more ranks than
/// there are cores, not to bind them to cores, for others may be at work there, and to give way while they
/// wait for each other: on a machine with other work that is 20 times as fast. Others take no notice.
std::vector<std::string> environment_of_mpi();

/// For sbatch. `folder` is the engine's.
std::string slurm_script(const SceneEngine& engine, const std::filesystem::path& folder);

}  // namespace bernal::engine
