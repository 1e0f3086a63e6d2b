#pragma once

/// Calls a macro of one argument for each dimension of `EveryDimension`: for explicit instantiations, which
/// no template can write.
#define BERNAL_IN_EVERY_DIMENSION(F) F(1) F(2) F(3) F(4) F(5) F(6) F(7) F(8)
