#include "core/archive.hpp"

#include "bernal/core/error.hpp"

namespace bernal {

void Archive::fail() {
  throw Error(ErrorCode::bad_packing,
              "these bytes do not hold what this program expects there; they are of another one");
}

}  // namespace bernal
