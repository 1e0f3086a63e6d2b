#pragma once
#include <cstdint>

#include "bernal/scene/scene.hpp"
#include "work/checkpoint_folder.hpp"

namespace bernal {

/// Of a run of this scene, complete and with the files pinned as `build` leaves it. Where the files stand,
/// and what is written of the result, makes no difference.
CheckpointOwner checkpoint_owner(const Scene& scene, std::uint64_t seed);

}  // namespace bernal
