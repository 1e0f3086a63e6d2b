#include "cad/read/placed_meshes.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <string_view>

#include "bernal/core/error.hpp"
#include "cad/diagnose/counted.hpp"

namespace bernal::cad {
namespace {

constexpr int most_nested = 1000;
constexpr double most_faces = 1e9, most_pieces = 1e7;

[[noreturn]] void refuse(const char* why) { throw Error(ErrorCode::bad_mesh, why); }

/// Counts before anything is built, each object once.
class Counter {
 public:
  struct Count {
    double faces = 0, pieces = 0;
    void operator+=(const Count& more) { faces += more.faces, pieces += more.pieces; }
  };

  /// Checks all objects, placed or not, for containing themselves.
  explicit Counter(const PlacedMeshes& meshes) : meshes_(meshes) {
    for (const auto& [key, object] : meshes.objects) of(key, 0);
  }

  Count of(const std::vector<PlacedMeshes::Component>& components, int level = 0) {
    Count all;
    for (const auto& component : components) all += of(component.object, level);
    return all;
  }

 private:
  Count of(const std::string& key, int level) {
    State& state = states_[key];
    if (state.open) refuse("one of its objects is a part of itself");
    if (level == most_nested) refuse("its objects are nested more than a thousand deep");
    if (!state.counted) {
      state.open = true;
      const PlacedMeshes::Object& object = meshes_.objects.at(key);
      Count count = of(object.components, level + 1);
      count += {0, 1};  // empty objects take time, too
      for (const auto& piece : object.pieces) count += {double(piece.triangles.size()), 1};
      state = {count, false, true};
    }
    return state.count;
  }

  struct State {
    Count count = {};
    bool open = false, counted = false;
  };
  const PlacedMeshes& meshes_;
  std::map<std::string, State> states_;  // a map, because references to its values stay valid
};

class Placer {
 public:
  Placer(const PlacedMeshes& meshes, PolygonSoup& soup) : meshes_(meshes), soup_(soup) {}

  void place(const PlacedMeshes::Component& component, const Eigen::Affine3d& above, std::string_view name) {
    const PlacedMeshes::Object& object = meshes_.objects.at(component.object);
    const Eigen::Affine3d placement = above * component.placement;
    if (!object.name.empty()) name = object.name;
    if (!object.pieces.empty()) {
      const double volume = placement.linear().determinant();
      if (volume == 0)
        ++flattened;
      else
        append(object, placement, volume < 0, name);
    }
    for (const auto& inner : object.components) place(inner, placement, name);
  }

  std::size_t flattened = 0;

 private:
  void append(const PlacedMeshes::Object& object, const Eigen::Affine3d& placement, bool mirrored,
              std::string_view name) {
    const auto first = static_cast<std::uint32_t>(soup_.points.size());
    for (const Vector<3>& p : object.points) soup_.points.emplace_back(placement * p);
    for (const PlacedMeshes::Piece& piece : object.pieces) {
      if (piece.triangles.empty()) continue;
      soup_.solids.push_back({piece.name.empty() ? std::string(name) : piece.name, soup_.polygons.size()});
      for (const auto& [a, b, c] : piece.triangles)
        soup_.polygons.push_back(mirrored ? std::vector{first + a, first + c, first + b}
                                          : std::vector{first + a, first + b, first + c});
    }
  }

  const PlacedMeshes& meshes_;
  PolygonSoup& soup_;
};

}  // namespace

void append_placed(const PlacedMeshes& meshes, ReadAttempt& attempt) {
  const Counter::Count count = Counter(meshes).of(meshes.items);
  if (count.faces > most_faces) refuse("its objects repeat each other up to more than 1e9 faces");
  if (count.pieces > most_pieces) refuse("its objects repeat each other up to more than 1e7 pieces");
  Placer placer(meshes, attempt.soup);
  for (const auto& item : meshes.items) placer.place(item, Eigen::Affine3d::Identity(), {});
  for (const Vector<3>& p : attempt.soup.points)
    if (!p.allFinite()) refuse("a coordinate is not finite where it is placed");
  if (placer.flattened > 0)
    attempt.facts.notes.push_back(fmt::format("{} left out, flattened by the file's transforms",
                                              counted(placer.flattened, "object is", "objects are")));
  std::vector<Solid>& solids = attempt.soup.solids;
  if (solids.size() == 1 && solids.front().name.empty()) solids.clear();
}

}  // namespace bernal::cad
