# What every target of this project is compiled with. One seed gives one packing on every x86-64
# machine, so nothing here may let the compiler contract, reorder or approximate floating point.
add_library(bernal_compile_options INTERFACE)
target_compile_features(bernal_compile_options INTERFACE cxx_std_20)
target_compile_options(bernal_compile_options INTERFACE
  -Wall -Wextra -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual
  -ffp-contract=off -fno-fast-math -fno-math-errno -fno-trapping-math)

set(BERNAL_SANITIZE "" CACHE STRING "Value of -fsanitize= for every target, empty for none")
if(BERNAL_SANITIZE)
  target_compile_options(bernal_compile_options INTERFACE
    -fsanitize=${BERNAL_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(bernal_compile_options INTERFACE -fsanitize=${BERNAL_SANITIZE})
endif()

# What nearly every file includes, read once instead of once a file. A file still includes what it uses:
# -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON must build too.
set(BERNAL_PRECOMPILED
  <algorithm> <array> <bit> <charconv> <chrono> <cmath> <cstdint> <cstring> <filesystem> <fstream> <functional>
  <iterator> <limits> <map> <memory> <numbers> <numeric> <optional> <ranges> <span> <string> <string_view>
  <utility> <variant> <vector>
  <Eigen/Core> <Eigen/Geometry> <fmt/format.h> <fmt/ranges.h>)
