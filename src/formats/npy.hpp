#pragma once
#include <cstddef>
#include <filesystem>
#include <functional>

#include "formats/format.hpp"

namespace bernal {

/// An array of doubles as NumPy's .npy of version 1.0, little-endian and in C order, of shape (rows, columns)
/// or, where `columns` is 0, (rows,). `value(i, k)` is asked row by row.
/// Source: numpy.lib.format.
void write_npy(const std::filesystem::path& path, std::size_t rows, std::size_t columns,
               const std::function<double(std::size_t, std::size_t)>& value);

/// An array with a row x, y, z, r or x, y, z for each sphere, or as the options' columns say; without sizes
/// those of the options' or of the file `radii_beside` it.
FileContents read_npy(const Reading&);
bool is_npy(const FileBeginning&);
/// "centers_radii.npy" beside "centers.npy", as bernal and scripts for OpenMC call it.
std::filesystem::path radii_beside(const std::filesystem::path& file);
inline constexpr std::string_view radii_ending = "_radii.npy";

}  // namespace bernal
