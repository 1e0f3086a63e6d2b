#include <bernal/bernal.hpp>

using namespace bernal;

int main(int, char** argv) {
  Scene scene;
  scene.unit = Unit::mm;
  scene.container = Box{.size = {10, 10, 10}};
  scene.sizes = Uniform{.min = 0.4, .max = 0.6};
  scene.target.count = 200;
  scene.stages = {Relax{.patience = 20}};
  const Packing packing = run(build(scene));
  return write_packing(packing, argv[1]).certificate.certified ? 0 : 1;
}
