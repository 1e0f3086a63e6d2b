#include "core/archive.hpp"

#include "bernal/core/error.hpp"

namespace bernal {

void Archive::fail() {
  throw Error(ErrorCode::bad_packing,
              "a checkpoint does not hold what this program expects there; run without ‹resume› to start "
              "anew");
}

}  // namespace bernal
