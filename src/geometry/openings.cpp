#include "geometry/openings.hpp"

#include "geometry/measures.hpp"

namespace bernal {
namespace {

/// Where a triangle of an end plane lies.
struct End {
  int axis = -1;  ///< -1: in none
  bool upper = false;
};

class Ends {
 public:
  explicit Ends(const Mesh& mesh) : mesh_(mesh), bounds_(bounds_of(mesh)) {}

  const Bounds<3>& bounds() const { return bounds_; }

  End of(const FaceCorners& t) const {
    for (int k = 0; k < 3; ++k) {
      if (!mesh_.periodic[static_cast<std::size_t>(k)]) continue;
      for (const bool upper : {false, true})
        if (lies_in_plane(mesh_, t, k, (upper ? bounds_.upper : bounds_.lower)[k])) return {k, upper};
    }
    return {};
  }

 private:
  const Mesh& mesh_;
  Bounds<3> bounds_;
};

/// Appends the triangles of one image that `takes(end)`.
template <class Takes>
void append_image(Mesh& to, const Mesh& mesh, std::uint32_t first, const Ends& ends, const Takes& takes) {
  for (const FaceCorners& t : mesh.triangles)
    if (takes(ends.of(t))) to.triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

}  // namespace

std::vector<FaceCorners> triangles_of_walls(const Mesh& mesh) {
  const Ends ends(mesh);
  std::vector<FaceCorners> walls;
  for (const FaceCorners& t : mesh.triangles)
    if (ends.of(t).axis < 0) walls.push_back(t);
  return walls;
}

RepeatedMesh repeated(const Mesh& mesh, const std::array<int, 3>& more) {
  const Ends ends(mesh);
  const Vector<3> period = ends.bounds().size();
  RepeatedMesh made;
  made.mesh.inset = mesh.inset;
  std::vector<std::array<int, 3>> images;
  for (int x = -more[0]; x <= more[0]; ++x)
    for (int y = -more[1]; y <= more[1]; ++y)
      for (int z = -more[2]; z <= more[2]; ++z) images.push_back({x, y, z});
  const auto first = [&](std::size_t image) {
    return static_cast<std::uint32_t>(image * mesh.vertices.size());
  };
  for (std::size_t i = 0; i < images.size(); ++i) {
    const Vector<3> shift(images[i][0] * period[0], images[i][1] * period[1], images[i][2] * period[2]);
    for (const Vector<3>& v : mesh.vertices) made.mesh.vertices.push_back(v + shift);
    append_image(made.mesh, mesh, first(i), ends, [](const End& end) { return end.axis < 0; });
  }
  const std::size_t walls = made.mesh.triangles.size();
  for (std::size_t i = 0; i < images.size(); ++i)
    append_image(made.mesh, mesh, first(i), ends, [&](const End& end) {
      if (end.axis < 0) return false;
      const auto axis = static_cast<std::size_t>(end.axis);
      return images[i][axis] == (end.upper ? more[axis] : -more[axis]);
    });
  made.closures = made.mesh.triangles.size() - walls;
  return made;
}

}  // namespace bernal
