#include "files/input_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string>

namespace bernal {

bool open_to_read(std::filebuf& bytes, const std::filesystem::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (descriptor < 0) return false;
  struct stat facts {};
  const bool is_regular = ::fstat(descriptor, &facts) == 0 && S_ISREG(facts.st_mode);
  bytes.close();
  // What is open, whatever has its name by now; where /proc is not there, by name.
  const std::string as_open = "/proc/self/fd/" + std::to_string(descriptor);
  constexpr auto to_read = std::ios::in | std::ios::binary;
  const bool is_open = is_regular && (bytes.open(as_open, to_read) || bytes.open(file, to_read));
  const int why = is_regular ? errno : EINVAL;
  ::close(descriptor);
  errno = why;
  return is_open;
}

}  // namespace bernal
