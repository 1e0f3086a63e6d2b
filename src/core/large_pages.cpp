#include "core/large_pages.hpp"

#include <sys/mman.h>

#include <cstdint>

namespace bernal {
namespace {

constexpr std::uintptr_t page = large_page;

}  // namespace

void prefer_large_pages(void* begin, std::size_t bytes) {
  const auto first = (reinterpret_cast<std::uintptr_t>(begin) + page - 1) / page * page;
  const auto last = (reinterpret_cast<std::uintptr_t>(begin) + bytes) / page * page;
  if (first < last) madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE);
}

LargePages::LargePages(std::size_t bytes) : bytes_((bytes + page - 1) / page * page) {
  // The system aligns to small pages: what is too much at both ends goes back.
  void* const mapped =
      mmap(nullptr, bytes_ + page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (mapped == MAP_FAILED) throw std::bad_alloc();
  const auto at = reinterpret_cast<std::uintptr_t>(mapped);
  const std::uintptr_t before = (page - at % page) % page;
  if (before > 0) munmap(mapped, before);
  begin_ = reinterpret_cast<void*>(at + before);
  munmap(reinterpret_cast<void*>(at + before + bytes_), page - before);
  prefer_large_pages(begin_, bytes_);
}

LargePages::~LargePages() {
  if (begin_) munmap(begin_, bytes_);
}

}  // namespace bernal
