#include "bernal/report/picture.hpp"

#include "report/write_svg.hpp"

namespace bernal {

std::string picture_of(const Packing& packing) {
  return svg_of(packing.spheres, packing.domain, name_of(packing.scene.unit));
}

}  // namespace bernal
