#pragma once
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "bernal/core/error.hpp"
#include "files/output_file.hpp"
#include "support/folder.hpp"
#include "support/packings.hpp"

// What the tests of the files that bernal writes share.
namespace bernal::testing {

/// The box of `example`.
inline const Box example_box{Vector<3>::Zero(), Vector<3>::Constant(10)};

/// A packing of up to n spheres, a different one for each seed.
inline Packing example(std::uint64_t seed = 1, std::size_t n = 300) {
  return packing_of(scattered(n, 0.1, 0.8, bounds_of(example_box), seed), example_box);
}

/// Spheres in a unit, of which nothing else is known.
inline Packing spheres_in(const Spheres<dynamic>& spheres, Unit unit = Unit::mm) {
  Packing packing;
  packing.spheres = spheres;
  packing.scene.unit = unit;
  return packing;
}

/// Some spheres of any dimension.
inline Spheres<dynamic> example_in(int dimension, std::size_t n = 50) {
  Random random(1, stream(Stream::test));
  Spheres<dynamic> spheres(dimension);
  for (std::size_t i = 0; i < n; ++i) {
    Vector<dynamic> c(dimension);
    for (double& x : c) x = random.uniform(-1, 1);
    spheres.push_back(c, random.uniform(0.1, 1));
  }
  return spheres;
}

/// The error that `call` throws, or a failed test.
template <class Call>
Error error_of(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << "no error";
  return {ErrorCode::bad_argument, "none"};
}

/// The file of this name in the folder, as `write` fills it.
template <class Write>
std::filesystem::path written(const Folder& folder, const std::string& name, const Write& write) {
  OutputFile file(folder / name);
  write(file);
  file.close();
  return folder / name;
}

}  // namespace bernal::testing
