#include <bernal/verify/certificate.hpp>

int main() {
  using namespace bernal;
  const Cylinder column{.radius = 2, .height = 4, .periodic = true};
  Spheres<3> spheres;
  spheres.push_back({0, 0, 0.5}, 1);
  spheres.push_back({0, 0, 2.5}, 1);
  const bool touching = certify(spheres, column).certified;
  spheres.push_back({0.5, 0, 4.5}, 1);  // the image of the first one, moved
  const Certificate broken = certify(spheres, column, {.list = 10});
  return touching && broken.overlaps.size() == 1 && !broken.certified ? 0 : 1;
}
