# The oldest compilers that know enough of C++20: those of Debian 12.
set(bernal_oldest_GNU 12)
set(bernal_oldest_Clang 16)
set(bernal_oldest ${bernal_oldest_${CMAKE_CXX_COMPILER_ID}})
if(bernal_oldest AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS bernal_oldest)
  message(FATAL_ERROR
    "bernal needs GCC ${bernal_oldest_GNU} or Clang ${bernal_oldest_Clang} or later, and ${CMAKE_CXX_COMPILER} is "
    "${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}: name another in CXX, for a new build folder")
endif()

# What every target of this project is compiled with. One seed gives one packing on every x86-64
# machine, so nothing here may let the compiler contract, reorder or approximate floating point.
add_library(bernal_compile_options INTERFACE)
target_compile_features(bernal_compile_options INTERFACE cxx_std_20)
target_compile_options(bernal_compile_options INTERFACE
  # Clang takes a name of one file for shadowed in another that is compiled together with it.
  -Wall -Wextra $<$<CXX_COMPILER_ID:GNU>:-Wshadow> -Wnon-virtual-dtor -Woverloaded-virtual
  $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>  # which takes a file compiled together with others for a header
  -ffp-contract=off -fno-fast-math -fno-math-errno -fno-trapping-math
  # Its garbage is collected once it is large, which it seldom is: a tenth less time.
  $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=524288>)

# What no loop runs long in is optimised lightly.
add_library(bernal_cold_options INTERFACE)
target_compile_options(bernal_cold_options INTERFACE $<$<CONFIG:Release>:-O1>
  $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)  # which it then holds for possible where it is not

set(BERNAL_SANITIZE "" CACHE STRING "Value of -fsanitize= for every target, empty for none")
if(BERNAL_SANITIZE)
  target_compile_options(bernal_compile_options INTERFACE
    -fsanitize=${BERNAL_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all
    # Two thirds more to compile. A null or too short object is AddressSanitizer's too; x86-64 reads unaligned.
    -fno-sanitize=null,alignment,object-size
    $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)  # which it holds for possible where it is not
  target_link_options(bernal_compile_options INTERFACE -fsanitize=${BERNAL_SANITIZE})
endif()

# Where CMAKE_UNITY_BUILD is on, the files of a folder are compiled many together: what the same headers and templates
# cost is paid once for all of them. Where eighteen take 2 GB, there are no more. Names in a folder are different anyway.
# Kernels stay alone: what they tell the compiler about instruction sets is theirs.
function(bernal_compile_together folder)
  set(most 40)
  if(folder MATCHES "^(cad|soft)")
    set(most 18)
  endif()
  string(REPLACE / _ group_name ${folder})
  set(sources ${ARGN})
  list(FILTER sources EXCLUDE REGEX "kernels[.]cpp$")
  list(LENGTH sources count)
  math(EXPR groups "(${count} + ${most} - 1) / ${most}")
  set(k 0)
  foreach(source IN LISTS sources)
    math(EXPR group "${k} * ${groups} / ${count}")
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${group_name}_${group})
    math(EXPR k "${k} + 1")
  endforeach()
endfunction()

# What nearly every file includes, read once instead of once a file. A file still includes what it uses:
# -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON must build too.
set(BERNAL_PRECOMPILED
  <algorithm> <array> <bit> <charconv> <chrono> <cmath> <cstdint> <cstring> <filesystem> <fstream> <functional>
  <iterator> <limits> <map> <memory> <numbers> <numeric> <optional> <ranges> <span> <string> <string_view>
  <utility> <variant> <vector>
  <Eigen/Core> <Eigen/Geometry> <fmt/format.h> <fmt/ranges.h>)
