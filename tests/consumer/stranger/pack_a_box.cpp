#include <bernal/io/write_packing.hpp>
#include <bernal/run/run.hpp>
#include <bernal/scene/read_scene.hpp>
#include <iostream>

int main(int, char** argv) {
  const bernal::Scene scene = bernal::parse_scene(R"(
    unit = "mm"
    [container]
    kind = "box"
    size = [10.0, 10.0, 10.0]
    [spheres]
    count = 200
    radius = { distribution = "uniform", min = 0.4, max = 0.6, basis = "number" }
  )",
                                                  "box");
  const bernal::Packing packing = bernal::run(bernal::build(scene));
  const bernal::WrittenPacking written = bernal::write_packing(packing, argv[1]);
  std::cout << written.certificate.statement << '\n';
  return packing.spheres.size() == 200 && written.certificate.certified ? 0 : 1;
}
