#pragma once
#include <optional>
#include <string>

#include "bernal/scene/scene.hpp"
#include "core/archive.hpp"
#include "work/pressing.hpp"
#include "work/reporter.hpp"
#include "work/spheres_in_bed.hpp"

namespace bernal {

/// How the spheres were pressed last, as long as they are as that left them: a stage that only places, and
/// finds no place, changes nothing; one that moves spheres in another way, or puts more among them, makes
/// something else of what was a settled bed.
class LastPressed {
 public:
  explicit LastPressed(const Scene& scene);

  /// The bed that the stage works in, or null where it works in a box.
  void before_stage(const Bed*);
  void after_stage(std::size_t stage, const Bed*);
  /// Nothing: by none.
  std::optional<Pressing> by() const;

  /// Of a scene without a stage that settles: nothing.
  void archive(Archive& a) {
    if (any_settles_) a(by_, spheres_before_);
  }

 private:
  const Scene& scene_;
  bool any_settles_;
  std::optional<std::size_t> by_;  // the stage
  std::string spheres_before_;     // their hash, before the present stage
};

/// Takes the few spheres out again that stand beyond one which found no place, where that makes the drawn
/// sequence whole, less its tail. What they supported rolls to rest anew. Returns how the
/// stages end with that.
StageEnd leave_out_tail(SpheresInBed& in_bed, Reporter& report, StageEnd end,
                        const std::optional<Pressing>& pressed);

}  // namespace bernal
