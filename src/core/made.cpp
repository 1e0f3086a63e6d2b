#include "core/made.hpp"

#include <mutex>

namespace bernal {
namespace {

struct MadeByEffect {
  std::mutex lock;
  std::map<std::string, std::uint64_t> counts;
};
MadeByEffect& made_by_effect() {
  static MadeByEffect all;
  return all;
}

}  // namespace

void Made::count() const {
  MadeByEffect& all = made_by_effect();
  const std::lock_guard held(all.lock);
  ++all.counts[effect_];
}

std::map<std::string, std::uint64_t> made_so_far() {
  MadeByEffect& all = made_by_effect();
  const std::lock_guard held(all.lock);
  return all.counts;
}

}  // namespace bernal
