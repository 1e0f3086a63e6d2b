#pragma once

namespace bernal {

/// Asks the memory for the line of the cache at `address`, without waiting. The empty statement is there
/// because GCC (12) takes a function that does nothing but `__builtin_prefetch` for one without effect and
/// drops the calls of it.
[[gnu::always_inline]] inline void prefetch(const void* address) {
  __builtin_prefetch(address);
  asm volatile("");
}

}  // namespace bernal
