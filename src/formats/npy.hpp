#pragma once
#include <cstddef>
#include <filesystem>
#include <functional>

namespace bernal {

/// An array of doubles as NumPy's .npy of version 1.0, little-endian and in C order, of shape (rows, columns)
/// or, where `columns` is 0, (rows,). `value(i, k)` is asked row by row.
/// Source: numpy.lib.format.
void write_npy(const std::filesystem::path& path, std::size_t rows, std::size_t columns,
               const std::function<double(std::size_t, std::size_t)>& value);

}  // namespace bernal
