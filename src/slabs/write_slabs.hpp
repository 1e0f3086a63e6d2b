#pragma once
#include <functional>

#include "bernal/slabs/pack_in_slabs.hpp"
#include "files/staged_folder.hpp"
#include "slabs/slab_store.hpp"

namespace bernal {

/// Writes what `pack_in_slabs` says and certifies the spheres as they are written. `edges` in a unit of the
/// scene's; the domain and how the run went are in `result`, which receives the rest; `conclude` is called
/// once the packing fraction is known. The store's slabs are given up one after the other.
void write_slabs(SlabStore& store, const Vector<3>& edges, double unit, const Plan& plan,
                 const std::filesystem::path& folder, StagedFolder& staged, const Monitor& monitor,
                 PackedInSlabs& result, const std::function<void()>& conclude);

}  // namespace bernal
