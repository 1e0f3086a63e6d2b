#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "bernal/scene/packing.hpp"
#include "bernal/verify/certificate.hpp"

namespace bernal {

/// What the tables of layers of a result say, held against its scene and its spheres.
struct LayersTable {
  std::uint64_t layers = 0;  ///< lines that say what the scene and the spheres do
  std::string fault = {};    ///< the first that says otherwise, in one line that names file and line
};

/// Holds layers.csv of a result, and those of what lies inside its spheres, against the layers that its
/// scene gives its spheres: the same lines in the same order, their radii within 1e-12 of themselves, for
/// which other mathematical libraries may round otherwise. A file that cannot be read, that ends early or
/// goes on, and one of a scene without layers is a fault; so are spheres that the layers do not fit, and a
/// table that is missing though the scene names layers and the spheres stand as text. Nothing where there is
/// no table to be. Precondition: the packing is that of the folder. Cost: O(N).
std::optional<LayersTable> layers_table_of(const Packing&, const std::filesystem::path& folder);

/// Certifies nothing where a table says otherwise, and says in the statement what was found.
void add_to(Certificate&, const LayersTable&);

}  // namespace bernal
