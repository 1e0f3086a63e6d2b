#include <bernal/sizes/size_distribution.hpp>
#include <cmath>

int main() {
  const auto radii = bernal::make_uniform(1, 2, bernal::Basis::number);
  return std::abs(radii->moment(1) - 1.5) < 1e-12 ? 0 : 1;
}
