#pragma once

namespace bernal {

/// Prefetches the cache line at `address`. The empty statement is needed because GCC 12 considers a function
/// with nothing but `__builtin_prefetch` as without effect and drops calls of it.
[[gnu::always_inline]] inline void prefetch(const void* address) {
  __builtin_prefetch(address);
  asm volatile("");
}

}  // namespace bernal
