#include <bernal/predict/predict.hpp>
#include <cmath>

int main() {
  const double phi = bernal::predict_packing_fraction(*bernal::make_constant(1)).phi;
  return std::abs(phi - 0.6435) < 1e-3 ? 0 : 1;
}
