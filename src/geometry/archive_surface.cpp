#include "geometry/archive_surface.hpp"

namespace bernal {

void archive(Archive& a, TrueSurface::Bezier& patch) {
  a(patch.degree, patch.lower, patch.upper, patch.points);
}

void archive(Archive& a, TrueSurface::Patch& patch) {
  bool is_swept = std::holds_alternative<TrueSurface::Swept>(patch);
  a(is_swept);
  if (a.reads() && !is_swept) patch = TrueSurface::Bezier{};
  std::visit([&](auto& values) { a(values); }, patch);
}

void archive(Archive& a, TrueSurface::Face& face) {
  a(face.number, face.kind, face.tolerance, face.without_bound, face.apart, face.track, face.worst);
}

void archive(Archive& a, TrueSurface& surface) {
  a(surface.patches, surface.pieces, surface.flats, surface.faces);
}

}  // namespace bernal
