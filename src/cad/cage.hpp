#pragma once
#include <cstdint>
#include <functional>
#include <string_view>

#include "cad/polygon_soup.hpp"

namespace bernal::cad {

/// What a reader may take.
struct CageLimits {
  std::uint64_t memory;  ///< bytes, beside what this process has already
  double seconds;        ///< of processor time
};

/// For a file of so many bytes: 1 GiB and a hundred times its size; 5 s and one more for every megabyte.
CageLimits cage_limits(std::uint64_t file_size);

/// Lets `read` run in a child process, so that a reader that crashes, loops or takes all memory on a file
/// costs no more than a line: `failure` then says which reader it was and what befell it. In the child
/// standard streams are closed, and one thread runs. Throws Cancelled where an Interruptible says so, and
/// whatever keeps the child from starting as Error{bad_mesh}. Cost beside `read`: a few milliseconds, and a
/// copy of the soup.
ReadAttempt read_in_cage(std::string_view reader, const CageLimits& limits,
                         const std::function<ReadAttempt()>& read);

}  // namespace bernal::cad
