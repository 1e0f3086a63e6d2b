#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "bernal/scene/packing.hpp"

namespace bernal {

/// Writes a file that does not exist yet: as text, see `write_csv`, or as an array of doubles, a row of
/// coordinates and the radius for each sphere. Cost on two cores: about 0.2 µs a sphere as text, 70 bytes
/// each; as an array 32 bytes each, what the disk costs. Memory: some megabytes.
void write_spheres(const std::filesystem::path& file, const Packing& packing, bool as_array);

/// Reads such a file back. Throws Error{cannot_write} unless it holds these spheres, to the bit, and as
/// text their classes. Cost: as
/// writing. Memory: that of the spheres for text; some megabytes for an array.
void require_written(const std::filesystem::path& file, const Packing& packing, bool as_array);

/// The bytes of a list of NumPy's, of doubles.
std::string as_npy(const std::vector<double>& values);
std::string as_npy(const std::vector<std::uint32_t>& classes);

}  // namespace bernal
