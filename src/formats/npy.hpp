#pragma once
#include <cstddef>
#include <filesystem>
#include <functional>

#include "formats/format.hpp"

namespace bernal {

/// Writes an array of doubles in NumPy's .npy version 1.0, little-endian and in C order, of shape (rows,
/// columns), or (rows,) if `columns` is 0. `value(i, k)` is called row by row. Source: numpy.lib.format.
void write_npy(const std::filesystem::path& path, std::size_t rows, std::size_t columns,
               const std::function<double(std::size_t, std::size_t)>& value);

/// Reads an array with a row x, y, z, r or x, y, z for each sphere, or the columns in the options; without
/// sizes, those of the options or of the file `radii_beside` it.
FileContents read_npy(const Reading&);
bool is_npy(const FileBeginning&);
/// "centers_radii.npy" beside "centers.npy", the name that bernal and scripts for OpenMC use.
std::filesystem::path radii_beside(const std::filesystem::path& file);
inline constexpr std::string_view radii_ending = "_radii.npy";

}  // namespace bernal
