#pragma once
#include <filesystem>
#include <functional>
#include <vector>

#include "bernal/core/monitor.hpp"
#include "bernal/scene/scene.hpp"
#include "engine/engine_task.hpp"
#include "engine/read_places.hpp"

namespace bernal::engine {

/// Lets an engine do a task, in a folder that is made where it does not exist. It writes there what the
/// engine reads, starts it and waits, or for Slurm writes the script for sbatch, and reads the result. A
/// result that stands there whole, of the same input, is taken as it is, and nothing is started.
///
/// The script and the logs stay; the spheres' file and the result go once it has been read, unless `keep`
/// says otherwise. Where anything goes wrong all stays, and the error names the folder.
///
/// Throws EngineError where the engine is missing, crashes, loses spheres or leaves no whole result, and
/// for Slurm where there is none yet; Cancelled once the monitor says stop, when the engine has ended.
///
/// The same task, ranks and engine on the same machine give the same places; with another number of ranks
/// sums are made in another order, and soft spheres come to lie elsewhere.
///
/// `read` is given the dump, and throws EngineError where it is not whole; then, of a result that stood
/// there, it is given that of another run.
void run_engine(const SceneEngine& engine, const EngineTask& task, const std::filesystem::path& folder,
                const Monitor& monitor, const std::function<void(const std::filesystem::path& dump)>& read);
/// The places, of spheres with these radii.
Places run_engine(const SceneEngine& engine, const EngineTask& task, const std::vector<double>& radii,
                  const std::filesystem::path& folder, const Monitor& monitor);

}  // namespace bernal::engine
