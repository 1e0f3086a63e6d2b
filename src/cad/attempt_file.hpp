#pragma once
#include <optional>

#include "cad/polygon_soup.hpp"

namespace bernal::cad {

/// What a reader made of a file, into an open file and out of it, in the form of this machine: from a child
/// process to its parent. Throws std::bad_alloc where the file takes no more.
void write_attempt(const ReadAttempt&, int file);

/// From the beginning of the file; nothing where what was written is not whole.
std::optional<ReadAttempt> read_attempt(int file);

}  // namespace bernal::cad
