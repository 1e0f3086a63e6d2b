#include "threads.hpp"

void add_threads(Command command, int& threads, const std::string& what) {
  command.add_option("--threads", threads, "As many as the machine has if absent; " + what + " is the same")
      .within(1, 1024)
      .type_name("N");
}
