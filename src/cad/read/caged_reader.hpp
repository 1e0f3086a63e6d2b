#pragma once
#include <cstdint>
#include <functional>
#include <string_view>

#include "cad/read/polygon_soup.hpp"
#include "process/cage.hpp"

namespace bernal::cad {

/// For a file of so many bytes: 1 GiB and a hundred times its size; 5 s and one more for every megabyte.
CageLimits cage_limits(std::uint64_t file_size);

/// Lets `read` run in a child process: `failure` says which reader it was and what befell it.
ReadAttempt read_in_cage(std::string_view reader, const CageLimits& limits,
                         const std::function<ReadAttempt()>& read);

}  // namespace bernal::cad
