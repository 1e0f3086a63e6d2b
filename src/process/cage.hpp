#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "core/archive.hpp"

namespace bernal {

/// What a child process may take.
struct CageLimits {
  std::uint64_t memory;  ///< bytes, beside what this process has already
  double seconds;        ///< of processor time
};

/// Lets `work` run in a child process, so that what crashes, loops or takes all memory costs no more than a
/// line, and brings back what it made: `values` archives that, keeping it in the child and setting it here.
/// Returns what befell the child, "assimp crashes on it (Aborted)" for instance, or the message of an
/// exception that `work` threw, or nothing. In the child standard streams are closed, and one thread runs.
/// Throws Cancelled where an Interruptible says so, and whatever keeps the child from starting as
/// Error{bad_mesh}. Cost beside `work`: a few milliseconds, and two copies of what is handed over.
std::string run_in_cage(std::string_view who, const CageLimits& limits, const std::function<void()>& work,
                        const std::function<void(Archive&)>& values);

}  // namespace bernal
