#pragma once
#include <string>
#include <string_view>

#include "bernal/scene/packing.hpp"

namespace bernal {

/// A packing as bytes, for another process of a bernal with the same packings number: the spheres and the
/// domain to the bit, the scene with all that it holds, and how the run went. Files that the scene names stay
/// where they are. Cost: that of copying. Precondition: the scene is complete, as that of a run, a result or
/// an import.
std::string bytes_of(const Packing&);

/// And back, but for `container`, which whoever needs it makes again. Throws Error{bad_packing} where a
/// bernal wrote the bytes that packs otherwise or keeps other things of a packing. Precondition: `bytes_of`
/// made them.
Packing packing_of_bytes(std::string_view bytes);

}  // namespace bernal
