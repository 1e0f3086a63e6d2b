#include "soft/device_spheres.hpp"

#include "bernal/core/error.hpp"

namespace bernal {

#if !BERNAL_CUDA
void require_gpu() {
  throw Error(
      ErrorCode::bad_scene,
      "this bernal was built without CUDA and packs on no GPU; leave \"device\" out, and the processor "
      "packs, or build bernal with -DBERNAL_CUDA=ON");
}

std::unique_ptr<DeviceSpheres> spheres_on_gpu() {
  require_gpu();
  return nullptr;
}
#endif

}  // namespace bernal
