#pragma once
#include <algorithm>
#include <cstddef>
#include <new>
#include <utility>
#include <vector>

namespace bernal {

inline constexpr std::size_t large_page = std::size_t{2} << 20;

/// Asks the system to back what lies in memory here with pages of 2 MiB: those that lie in it as a whole. To
/// be called before it is written to for the first time. What is read in no order, or along many ways at a
/// time, then needs few entries of the processor's table of pages: measured, a sweep over 10^6 spheres takes
/// a third less. A wish: nothing changes where the system does not grant it. Cost: a call of the system.
void prefer_large_pages(void* begin, std::size_t bytes);

/// Memory of its own in such pages, whole ones that nothing has been written to: what a heap hands out may
/// have been in small pages before, and stays in them. Throws std::bad_alloc. Cost: some calls of the system.
class LargePages {
 public:
  explicit LargePages(std::size_t bytes);
  ~LargePages();
  LargePages(LargePages&& other) noexcept
      : begin_(std::exchange(other.begin_, nullptr)), bytes_(std::exchange(other.bytes_, 0)) {}
  LargePages& operator=(LargePages&&) = delete;

  void* begin() const { return begin_; }
  std::size_t bytes() const { return bytes_; }

 private:
  void* begin_ = nullptr;
  std::size_t bytes_ = 0;
};

/// Allocates what is as long as such a page or longer aligned to them, and asks for them; what is shorter as
/// any other memory. So a vector that grows has them from the first item on, and no memory is lost: what does
/// not fill a page as a whole is in small ones.
template <class T>
struct LargePageAllocator {
  using value_type = T;

  LargePageAllocator() = default;
  template <class U>
  LargePageAllocator(const LargePageAllocator<U>&) {}

  T* allocate(std::size_t count) {
    const std::size_t bytes = count * sizeof(T);
    void* const memory = ::operator new(bytes, alignment(bytes));
    if (bytes >= large_page) prefer_large_pages(memory, bytes);
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t count) noexcept {
    ::operator delete(memory, alignment(count * sizeof(T)));
  }
  template <class U>
  bool operator==(const LargePageAllocator<U>&) const {
    return true;
  }

 private:
  static std::align_val_t alignment(std::size_t bytes) {
    return std::align_val_t{bytes >= large_page ? large_page
                                                : std::max(alignof(T), alignof(std::max_align_t))};
  }
};
/// For what is read in no order, and may be much.
template <class T>
using LargePageVector = std::vector<T, LargePageAllocator<T>>;

/// Makes these `size` items in such pages, to be overwritten: what they are is what happens to be there. Next
/// time there may be a few more of them without new memory. Cost: none but for new memory.
template <class T>
void resize_anew(std::vector<T>& items, std::size_t size) {
  if (items.capacity() < size) {
    std::vector<T>().swap(items);  // first: so there are never two of them
    items.reserve(size + size / 64);
    prefer_large_pages(items.data(), items.capacity() * sizeof(T));
  }
  items.resize(size);
}

}  // namespace bernal
