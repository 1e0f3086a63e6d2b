#include "engine/run_engine.hpp"

#include <fcntl.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <system_error>
#include <thread>

#include <fmt/format.h>

#include "bernal/core/text.hpp"
#include "bernal/engine/engine_error.hpp"
#include "core/fnv.hpp"
#include "engine/engine_command.hpp"
#include "engine/engine_files.hpp"
#include "engine/engine_log.hpp"
#include "engine/script_parts.hpp"
#include "files/bytes_of_file.hpp"
#include "files/descriptor.hpp"
#include "files/folder_tree.hpp"
#include "files/lock.hpp"
#include "process/child.hpp"

namespace bernal::engine {
namespace {

/// Which input the files of the folder are of; what makes them bernal's.
constexpr const char* mark_name = "input.fnv";
constexpr const char* submit_name = "submit.sh";

[[noreturn]] void refuse(const std::string& why, const std::filesystem::path& folder) {
  throw EngineError(fmt::format("{} (its files are in {})", why, folder.string()));
}

/// The folder of one engine at work, which nobody else works in meanwhile.
class EngineFolder {
 public:
  explicit EngineFolder(const std::filesystem::path& folder) : folder_(std::filesystem::absolute(folder)) {
    std::error_code failed;
    for (auto at = folder_; !at.empty() && !std::filesystem::exists(at, failed) && !failed;
         at = at.parent_path())
      made_.push_back(at);
    std::filesystem::create_directories(folder_, failed);
    if (failed || !std::filesystem::is_directory(folder_, failed))
      throw Error(ErrorCode::cannot_write,
                  fmt::format("the engine's folder cannot be made{}{}", failed ? ": " : "",
                              failed ? failed.message() : ""),
                  {folder_.string()});
    lock_ = Lock(FolderTree(folder_).open_folder());
    if (!lock_.is_held())
      throw Error(ErrorCode::cannot_write,
                  lock_.is_elsewhere() ? "another run is at work in it; wait for that, or give another folder"
                                       : fmt::format("cannot be used: {}", strerror(lock_.why_not())),
                  {folder_.string()});
  }
  ~EngineFolder() {
    std::error_code is_used;
    for (const std::filesystem::path& folder : made_) std::filesystem::remove(folder, is_used);
  }
  EngineFolder(const EngineFolder&) = delete;
  EngineFolder& operator=(const EngineFolder&) = delete;

  const std::filesystem::path& path() const { return folder_; }
  std::filesystem::path file(std::string_view name) const { return folder_ / name; }
  bool has(std::string_view name) const {
    std::error_code unknown;
    return std::filesystem::exists(std::filesystem::symlink_status(file(name), unknown));
  }
  void remove(std::string_view name) const {
    std::error_code gone;
    std::filesystem::remove(file(name), gone);
  }

 private:
  std::filesystem::path folder_;
  std::vector<std::filesystem::path> made_;  // innermost first: those that nothing came into go again
  Lock lock_;
};

/// What decides the result: the script, the spheres and the walls, the engine and its ranks.
std::string mark_of(const SceneEngine& engine, const EngineTask& task, const std::string& script) {
  Fnv1a hash;
  for (const std::string& word : words_of(engine)) {
    hash.absorb(word);
    hash.absorb(std::string_view("\n"));
  }
  hash.absorb(script);
  task.spheres.for_each([&](const Vector<3>& c, double r) {
    for (const double x : {c[0], c[1], c[2], r}) hash.absorb(x);
  });
  if (const Mesh* mesh = std::get_if<Mesh>(&task.domain))
    for (const auto& triangle : mesh->triangles)
      for (const std::uint32_t corner : triangle)
        for (const double x : mesh->vertices[corner]) hash.absorb(x);
  return fmt::format("{:016x}\n", hash.hash());
}

Child started(const ChildCall& call) {
  try {
    return bernal::start(call);
  } catch (const std::system_error& failed) {
    throw EngineError(
        fmt::format("\"{}\" cannot be started: {}; \"executable\" and \"command\" in [engine] say what is",
                    call.words[0], failed.code().message()));
  }
}

using ReadDump = std::function<void(const std::filesystem::path& dump)>;

class EngineRun {
 public:
  EngineRun(const SceneEngine& engine, const EngineTask& task, const std::filesystem::path& folder,
            const Monitor& monitor, const ReadDump& read)
      : engine_(engine),
        dialect_(dialect_of(engine)),
        task_(task),
        folder_(folder),
        monitor_(monitor),
        read_(read),
        script_(dialect_.script_of(task)),
        mark_(mark_of(engine, task, script_)) {}

  void go() {
    const bool by_slurm = engine_.process().launcher == EngineLauncher::slurm;
    const bool is_there = bytes_of_file(folder_.file(mark_name)) == mark_ && folder_.has(places_name);
    if (by_slurm && !is_there) submit();
    if (by_slurm) return read();
    if (is_there) try {
        return read();
      } catch (const EngineError&) {  // of what is not whole it begins again
      }
    const std::vector<std::string> words = found_words(engine_);
    prepare();
    start(words);
    read();
  }

 private:
  void prepare() {
    for (const std::string_view name : {dialect_.script, std::string_view(data_name), dialect_.log,
                                        std::string_view(places_name), std::string_view(output_name)})
      if (folder_.has(name) && !is_ours())
        throw Error(ErrorCode::cannot_write,
                    "is in the way: an engine's files go there, and this is none that bernal wrote; move it",
                    {folder_.file(name).string()});
    for (const std::string_view name :
         {std::string_view(places_name), dialect_.log, std::string_view(output_name)})
      folder_.remove(name);
    if (monitor_.stop()) throw Cancelled();
    monitor_.report({dialect_.title, 0, "writes its input"});
    write_text(folder_.file(dialect_.script), script_);
    write_data(folder_.file(data_name), task_, dialect_);
    if (const Mesh* mesh = std::get_if<Mesh>(&task_.domain)) write_walls_stl(folder_.file(walls_name), *mesh);
    write_text(folder_.file(mark_name), mark_);
  }

  /// The first line of a script, of either engine, is one that only bernal writes.
  bool is_ours() const {
    const auto has_script_of = [&](const Dialect& dialect) {
      return bytes_of_file(folder_.file(dialect.script)).starts_with(script_mark);
    };
    return folder_.has(mark_name) || has_script_of(dialect_of(Lammps{})) ||
           has_script_of(dialect_of(Liggghts{}));
  }

  /// A job of this input that has begun is left alone.
  [[noreturn]] void submit() {
    const bool is_submitted = bytes_of_file(folder_.file(mark_name)) == mark_ && folder_.has(output_name);
    if (is_submitted)
      refuse(fmt::format("the job of {} has left no places yet: wait for its end, or see what it says in {}; "
                         "to begin again remove that file",
                         dialect_.title, output_name),
             folder_.path());
    prepare();
    write_text(folder_.file(submit_name), slurm_script(engine_, folder_.path()));
    throw EngineError(
        fmt::format("the places are still to be found: sbatch {}, and when that job has ended the same "
                    "call again, which goes on from them",
                    in_shell({folder_.file(submit_name).string()})));
  }

  void start(const std::vector<std::string>& words) {
    const Stopwatch watch;
    LogWatch log(folder_.file(dialect_.log));
    const std::string ranks =
        engine_.process().ranks == 1 ? "" : fmt::format(" on {} ranks", engine_.process().ranks);
    const auto look = [&] {
      if (monitor_.stop()) throw Cancelled();
      if (const auto step = log.new_step())
        monitor_.report({dialect_.title, static_cast<double>(*step) / std::max(1, task_.steps),
                         fmt::format("step {} of {}{}", *step, task_.steps, ranks)});
    };
    const ChildEnd end = run_child(words, look);
    const auto wrong = what_is_wrong(dialect_, end, tail_of(folder_.file(dialect_.log), longest_tail),
                                     tail_of(folder_.file(output_name), longest_tail));
    if (wrong) refuse(*wrong, folder_.path());
  }

  ChildEnd run_child(const std::vector<std::string>& words, const std::function<void()>& look) const {
    constexpr std::chrono::milliseconds between_looks(50);
    constexpr std::chrono::seconds patience(5);
    const std::filesystem::path said = folder_.file(output_name);
    const Descriptor output(::open(said.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
    if (!output.is_open())
      throw Error(ErrorCode::cannot_write, fmt::format("cannot be written: {}", strerror(errno)),
                  {said.string()});
    Child child = started({.words = words,
                           .environment = environment_of_mpi(),
                           .folder = folder_.path(),
                           .output = output.number(),
                           .errors = output.number(),
                           .apart = true});
    try {
      for (;; std::this_thread::sleep_for(between_looks)) {
        if (const auto end = child.ended()) return *end;
        look();
      }
    } catch (...) {
      child.stop(patience);  // its leader passes that on to ranks in groups of their own
      throw;
    }
  }

  void read() const {
    const std::string log = tail_of(folder_.file(dialect_.log), longest_tail);
    const auto wrong = what_is_wrong(dialect_, {}, log, tail_of(folder_.file(output_name), longest_tail));
    if (wrong) refuse(*wrong, folder_.path());
    if (engine_.process().ranks > 1 && says_it_is_alone(log))
      refuse(
          fmt::format("the {} ranks of {} did not find each other, each packed everything by itself: start "
                      "them by a \"command\" of its own MPI, such as [\"mpirun\"] or [\"srun\", "
                      "\"--mpi=pmix\"]",
                      engine_.process().ranks, dialect_.title),
          folder_.path());
    monitor_.report({dialect_.title, 1, "its places are read"});
    read_(folder_.file(places_name));
    if (!engine_.process().keep)
      for (const char* name : {data_name, places_name, walls_name, mark_name}) folder_.remove(name);
  }

  /// Of logs, which are long only where something has gone wrong.
  static constexpr std::uintmax_t longest_tail = 1 << 20;

  const SceneEngine& engine_;
  const Dialect& dialect_;
  const EngineTask& task_;
  const EngineFolder folder_;
  const Monitor& monitor_;
  const ReadDump& read_;
  const std::string script_, mark_;
};

}  // namespace

void run_engine(const SceneEngine& engine, const EngineTask& task, const std::filesystem::path& folder,
                const Monitor& monitor, const ReadDump& read) {
  EngineRun(engine, task, folder, monitor, read).go();
}

Places run_engine(const SceneEngine& engine, const EngineTask& task, const std::vector<double>& radii,
                  const std::filesystem::path& folder, const Monitor& monitor) {
  Places places;
  run_engine(engine, task, folder, monitor,
             [&](const std::filesystem::path& dump) { places = read_places(dump, radii); });
  return places;
}

}  // namespace bernal::engine
