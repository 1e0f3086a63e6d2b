#pragma once
#include <cstdint>
#include <map>
#include <string>

namespace bernal {

/// A member of what is there for one effect and costs memory or time to make: counts by the name of the
/// effect how many have been made, copies among them, so that a test can tell that nothing is made which the
/// scene does not call for. What is never constructed allocates nothing and is never called. Any thread.
/// Cost: a lock, some 50 ns; so it belongs into what a stage makes a few times, not into a sphere.
class Made {
 public:
  explicit Made(const char* effect) : effect_(effect) { count(); }
  Made(const Made& other) : effect_(other.effect_) { count(); }
  Made(Made&& other) noexcept : effect_(other.effect_) {}
  Made& operator=(const Made&) = default;
  ~Made() = default;

 private:
  void count() const;
  const char* effect_;
};

/// By effect, since the process began.
std::map<std::string, std::uint64_t> made_so_far();

/// Of the innermost `EffectTimer` of this thread: what an allocation is made for. Null outside of all.
inline thread_local const char* effect_in_progress = nullptr;

}  // namespace bernal
