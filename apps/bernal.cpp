// The command: one subcommand a file; this one only turns what they throw into a line and an exit code.
#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <system_error>

#include "bernal/core/text.hpp"
#include "bernal/engine/engine_error.hpp"
#include "bernal/version.hpp"
#include "commands.hpp"
#include "say.hpp"

namespace {

constexpr const char* description =
    "bernal packs spheres into real shapes and proves that nothing overlaps.\n"
    "A scene, a short TOML file, says which container, which sizes and how many.";

Explanation explanation() {
  return {
      .text =
          "Messages go to standard error, results to files or standard output. Ctrl-C ends a run at the next "
          "safe point, with a valid result of what is there.",
      .lists =
          {{.title = "Files",
            .text = {},
            .entries =
                {{"/usr/share/doc/bernal",
                  "the guide (site/index.html), and in data scenes and CAD parts to begin with, where the "
                  "Debian package is installed"}}}},
      .examples = {{"bernal pack data/scenes/cylinder_han.toml -o out", "fill a cylinder; results in out/"},
                   {"bernal pack bracket.stl --unit mm --diameter 2",
                    "fill a CAD part, without a scene; results in bracket/"},
                   {"bernal verify out", "certify what stands in the files, from scratch"},
                   {"bernal measure out", "contacts, rattlers, g(r), sizes against those asked for"},
                   {"bernal cells out --to neper -o grains.tess", "the cells around spheres, for Neper"},
                   {"bernal mesh out --to openfoam -o case/bed.foam", "tetrahedra between the spheres"},
                   {"bernal export out --to lammps -o out.data",
                    "for LAMMPS, YADE, OVITO, OpenMC, POV-Ray, …"},
                   {"bernal import dump.lammpstrj --unit mm -o out",
                    "another program's packing, to be certified and packed on"},
                   {"bernal inspect part.stl --unit mm", "can this CAD file be a container?"},
                   {"bernal explain data/scenes/hopper.toml", "what would run, and what it would cost"},
                   {"bernal cost data/scenes/relax_equal.toml -o out",
                    "what accuracy costs in time there, and what to take"},
                   {"bernal sweep data/sweeps/exchange.toml -o out",
                    "many scenes at once: a grid over any keys, resumable, one table"},
                   {"bernal keys relax", "what a scene may say of a stage"},
                   {"bernal keys roundness of the top", "which key was it?"},
                   {"bernal help pack", "the options of a command"},
                   {"bernal predict --lognormal 0.5", "how densely spheres of these sizes pack"},
                   {"bernal design maximise --diameters 1,3,9", "how much of each size packs densest"},
                   {"bernal map 0.3 0.6 -o out", "how densely all their mixtures do"}},
      .exit_codes = {{"0", "done"},
                     {"1", "not certified, or not usable"},
                     {"2", "bad input"},
                     {"3", "ended without reaching what the scene asks"}}};
}

/// Prints a message as one line, whatever characters the input had.
int complain(std::string_view what) {
  say(stderr, "bernal: {}\n", bernal::plain_text(what, 1000));
  return exit_code::bad_input;
}

/// Opens /dev/null for each standard stream that the caller has closed. Otherwise the next file that is
/// opened would get the stream's number, and what is printed.
void open_closed_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) == -1 && errno == EBADF) [[maybe_unused]]
      const int lowest_free = open("/dev/null", O_RDWR);
}

/// Whether standard output is a pipe whose reader has read enough and ended, as in `| head -1`.
bool reader_has_left() {
  pollfd output{STDOUT_FILENO, POLLOUT, 0};
  return poll(&output, 1, 0) == 1 && (output.revents & POLLERR) != 0;
}

}  // namespace

int main(int argc, char** argv) {
  open_closed_streams();
  std::signal(SIGXFSZ, SIG_IGN);  // a file over the size limit is an error to report, not a reason to die
  std::signal(SIGPIPE, SIG_IGN);  // a run is not lost because nobody reads what it says
  int status = exit_code::done;
  try {
    Command command = {
        "bernal",
        description,
        {},
        explanation(),
        {},
        {pack_command(), verify_command(), inspect_command(), explain_command(), cost_command(),
         sweep_command(), measure_command(), cells_command(), mesh_command(), export_command(),
         import_command(), predict_command(), design_command(), map_command()}};
    command.commands.insert(command.commands.begin() + 4, keys_command(command));
    command.commands.push_back(help_command(command));
    command.commands.push_back(completion_command(command));
    command.commands.push_back(manual_command(command));
    status = run_command_line(argc, argv, command, "bernal " + bernal::text_of(bernal::this_program()));
  } catch (const std::system_error& error) {
    if (error.code() == std::errc::broken_pipe && reader_has_left()) return status;
    return complain(std::ferror(stdout) != 0 ? "standard output cannot be written" : error.what());
  } catch (const bernal::EngineError& error) {
    complain(error.what());
    return exit_code::not_reached;
  } catch (const std::bad_alloc&) {
    return complain("out of memory");
  } catch (const std::exception& error) {
    return complain(error.what());
  }
  // CLI11 flushes what it prints and does not report an error.
  if ((std::fflush(stdout) != 0 || std::ferror(stdout) != 0) && !reader_has_left())
    return complain("standard output cannot be written");
  return status;
}
