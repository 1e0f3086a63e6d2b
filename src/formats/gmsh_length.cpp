#include <cmath>

#include "formats/gmsh_model.hpp"

namespace bernal {
namespace {

/// Into lengths of ten to the power of `exponent`. Ten to a negative power is no double: by whole numbers
/// nothing but the result is rounded.
struct IntoLength {
  double times, by;

  explicit IntoLength(int exponent)
      : times(exponent < 0 ? std::pow(10, -exponent) : 1), by(exponent > 0 ? std::pow(10, exponent) : 1) {}

  double operator()(double length) const { return length * times / by; }
  Vector<3> operator()(const Vector<3>& p) const { return p * times / by; }
  Domain operator()(Box box) const {
    box.corner = (box.corner * times / by).eval();
    box.size = (box.size * times / by).eval();
    return box;
  }
  Domain operator()(Cylinder cylinder) const {
    cylinder.base = (*this)(Vector<3>(cylinder.base));
    cylinder.radius = (*this)(cylinder.radius);
    cylinder.height = (*this)(cylinder.height);
    return cylinder;
  }
  Domain operator()(Sphere sphere) const {
    sphere.center = (*this)(Vector<3>(sphere.center));
    sphere.radius = (*this)(sphere.radius);
    return sphere;
  }
  Domain operator()(Mesh mesh) const {
    for (Vector<3>& vertex : mesh.vertices) vertex = (*this)(Vector<3>(vertex));
    return mesh;
  }
  Domain operator()(const Polygon& polygon) const { return polygon; }

  void convert(Spheres<dynamic>& spheres) const {
    for (auto& axis : spheres.x)
      for (double& x : axis) x = (*this)(x);
    for (double& r : spheres.r) r = (*this)(r);
  }
  void convert(std::vector<Cut>& cuts) const {
    for (Cut& cut : cuts) cut.keeps.offset = (*this)(cut.keeps.offset);
  }
  void convert(Solids& solids) const {
    convert(solids.spheres);
    solids.domain = std::visit(*this, solids.domain);
    for (Piece& piece : solids.pieces) {
      piece.center = (*this)(piece.center);
      piece.radius = (*this)(piece.radius);
      convert(piece.cuts);
    }
    for (Bridge& bridge : solids.bridges) {
      for (Vector<3>& rim : bridge.rims) rim = (*this)(rim);
      bridge.radius = (*this)(bridge.radius);
      convert(bridge.cuts);
    }
    convert(solids.contacts);
  }
  void convert(ContactReport& report) const {
    for (double* volume : {&report.volume_before, &report.volume_after, &report.domain_volume})
      for (int k = 0; k < 3; ++k) *volume = (*this)(*volume);
    for (int k = 0; k < 2; ++k) report.contact_area = (*this)(report.contact_area);
  }
};

}  // namespace

int exponent_of_model(const Domain& domain) {
  constexpr double smallest = 1, largest = 1e3;
  const double diagonal = bounds_of(domain).diagonal();
  if (!(diagonal > 0 && std::isfinite(diagonal)) || (diagonal >= smallest && diagonal <= largest)) return 0;
  return static_cast<int>(std::floor(std::log10(diagonal))) - 1;
}

Exported in_length_of_model(const Exported& file, int exponent) {
  const IntoLength into(exponent);
  Exported made = file;
  into.convert(made.spheres);
  made.domain = std::visit(into, made.domain);
  into.convert(made.contacts);
  into.convert(made.solids);
  return made;
}

}  // namespace bernal
