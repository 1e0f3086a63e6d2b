#include "engine/engine_command.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "bernal/engine/engine_error.hpp"
#include "process/find_program.hpp"

namespace bernal::engine {
namespace {

std::vector<std::string> launcher_of(const EngineProcess& process) {
  const bool by_slurm = process.launcher == EngineLauncher::slurm;
  std::vector<std::string> words = process.command;
  if (by_slurm) {
    if (words.empty()) words = {"srun"};
    return words;
  }
  if (process.ranks == 1 && words.empty()) return {};
  if (words.empty()) words = {"mpirun"};
  words.insert(words.end(), {"-np", fmt::format("{}", process.ranks)});
  return words;
}

std::vector<std::string> executable_of(const SceneEngine& engine) {
  const std::vector<std::string>& own = engine.process().executable;
  return own.empty() ? std::vector{std::string(dialect_of(engine).executable)} : own;
}

std::string at_or_refuse(const std::string& name, bool is_own, std::string_view package, std::string_view key,
                         const SceneEngine& engine) {
  const std::filesystem::path found = program_at(name);
  if (!found.empty()) return found.string();
  throw EngineError(
      is_own ? fmt::format("there is no program \"{}\", which \"{}\" in [engine] names", name, key)
             : fmt::format("{} needs the program \"{}\", which is not installed: apt-get install {}, or "
                           "name another by \"{}\" in [engine]",
                           dialect_of(engine).title, name, package, key),
      engine.locations.of(is_own ? key : "kind"));
}

}  // namespace

std::vector<std::string> words_of(const SceneEngine& engine) {
  std::vector<std::string> words = launcher_of(engine.process());
  const std::vector<std::string> executable = executable_of(engine);
  words.insert(words.end(), executable.begin(), executable.end());
  const Dialect& dialect = dialect_of(engine);
  words.insert(words.end(), {"-in", std::string(dialect.script), "-log", std::string(dialect.log)});
  return words;
}

std::vector<std::string> found_words(const SceneEngine& engine) {
  const EngineProcess& process = engine.process();
  std::vector<std::string> words = words_of(engine);
  const std::size_t place = launcher_of(process).size();
  words[place] = at_or_refuse(words[place], !process.executable.empty(), dialect_of(engine).package,
                              "executable", engine);
  if (place > 0)
    words[0] = at_or_refuse(words[0], !process.command.empty(), "openmpi-bin", "command", engine);
  return words;
}

std::string in_shell(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) {
    line += line.empty() ? "" : " ";
    const bool plain = !word.empty() && std::ranges::all_of(word, [](unsigned char c) {
      return std::isalnum(c) != 0 ||
             std::string_view("-_./=:,+@%").find(static_cast<char>(c)) != std::string_view::npos;
    });
    if (plain) {
      line += word;
      continue;
    }
    line += '\'';
    for (const char c : word) line += c == '\'' ? std::string("'\\''") : std::string(1, c);
    line += '\'';
  }
  return line;
}

std::vector<std::string> environment_of_mpi() {
  std::vector<std::string> all = {"OMPI_MCA_rmaps_base_oversubscribe=1",
                                  "OMPI_MCA_hwloc_base_binding_policy=none", "OMPI_MCA_mpi_yield_when_idle=1",
                                  "OMP_NUM_THREADS=1"};
  if (geteuid() == 0) all.insert(all.end(), {"OMPI_ALLOW_RUN_AS_ROOT=1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1"});
  return all;
}

std::string slurm_script(const SceneEngine& engine, const std::filesystem::path& folder) {
  const EngineProcess& process = engine.process();
  std::string text =
      fmt::format("#!/bin/bash\n#SBATCH --job-name=bernal\n#SBATCH --ntasks={}\n", process.ranks);
  for (const std::string& option : process.slurm) text += fmt::format("#SBATCH {}\n", option);
  text += fmt::format("# {} finds the places; the call of bernal that wrote this script goes on from them.\n",
                      dialect_of(engine).title);
  return text + fmt::format("cd {} || exit 1\nexport OMP_NUM_THREADS=1\nexec {} > {} 2>&1\n",
                            in_shell({folder.string()}), in_shell(words_of(engine)), output_name);
}

}  // namespace bernal::engine
