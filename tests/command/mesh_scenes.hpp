#pragma once
#include <filesystem>

// What tests of `bernal mesh` have in common.
namespace bernal::testing {

inline constexpr const char* layered_spheres = R"(unit = "mm"
[container]
kind = "periodic"
[spheres]
count = 12
packing_fraction = 0.35
radius = 1
gap = 0.1
layers = [{ name = "core" }, { name = "thin coat", thickness = 0.1 }]
)";

inline bool has_tetgen() { return std::filesystem::exists("/usr/bin/tetgen"); }

}  // namespace bernal::testing
