#pragma once
#include <optional>

#include "bernal/scene/scene.hpp"
#include "run/last_pressed.hpp"
#include "work/checkpoints.hpp"
#include "work/reporter.hpp"
#include "work/spheres_in_box.hpp"

namespace bernal {

/// Lets the stages of a scene act one after the other, each on the spheres in a bed or in a box as it works,
/// and says how the last one ended. What a stage that is cut short leaves is what it found, if that was
/// denser. `pressed`: how the spheres were pressed last. A run that goes on begins in the stage it was in.
StageEnd run_stages(const Scene& scene, SpheresOfRun& spheres, Reporter& report, Checkpoints& checkpoints,
                    std::optional<Pressing>& pressed);

}  // namespace bernal
