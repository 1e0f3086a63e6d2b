#include "threads.hpp"

void add_threads(CLI::App& command, int& threads, const std::string& what) {
  command.add_option("--threads", threads, "As many as the machine has if absent; " + what + " is the same")
      ->check(CLI::Range(1, 1024))
      ->type_name("N");
}
