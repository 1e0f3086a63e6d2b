#pragma once

namespace bernal {

/// The packing fraction at which equal spheres jam at random, in dimension k + 1.
///
/// | dimension | source |
/// |-----------|--------|
/// | 1         | rods in line leave nothing free |
/// | 2         | O'Hern, Silbert, Liu & Nagel, Phys. Rev. E 68 (2003) 011306 (two sizes, as equal discs crystallise) |
/// | 3         | the same; Scott & Kilgour, J. Phys. D 2 (1969) 863, poured 0.637 |
/// | 4, 5, 6   | Skoge, Donev, Stillinger & Torquato, Phys. Rev. E 74 (2006) 041127 |
/// | 7, 8      | none: extrapolated from those before |
inline constexpr double random_close_packing[] = {1, 0.84, 0.64, 0.46, 0.31, 0.20, 0.119, 0.069};

}  // namespace bernal
