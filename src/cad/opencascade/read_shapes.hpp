#pragma once
#include <cstdint>
#include <filesystem>

#include "cad/read/polygon_soup.hpp"

namespace bernal::cad {

enum class ShapeFormat : std::uint8_t { step, iges, brep };

}  // namespace bernal::cad

/// What the module of OpenCASCADE answers: see `read_with_opencascade`, which loads it.
extern "C" void bernal_read_shapes(const std::filesystem::path& file, bernal::cad::ShapeFormat format,
                                   double deflection, const std::optional<bernal::cad::SpheresInside>& inside,
                                   bernal::cad::ReadAttempt& result);
