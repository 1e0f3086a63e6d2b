#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "bernal/core/random.hpp"
#include "hard/table/hard_case.hpp"

// Random closed surfaces, most of them nastier than parts: whatever the seed, what is packed into them is
// certified.
namespace bernal::hard {

struct Family {
  std::string name, what;
  Mesh (*make)(Random&);
};
const std::vector<Family>& families_of_polyhedra();

/// Some thirty spheres, or as many as there is room for, in the polyhedron of this seed, by a protocol that
/// the seed chooses. The case is what a failure is to be looked at with: scene and mesh as files.
Case case_of(const Family&, std::uint64_t seed);

/// Packs the cases of so many seeds, each at one of the levels of arithmetic, and says what is wrong with how
/// they end, a line each.
std::string objections(const Family&, std::uint64_t first_seed, std::uint64_t seeds);

}  // namespace bernal::hard
