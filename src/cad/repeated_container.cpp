#include "cad/repeated_container.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "bernal/core/error.hpp"
#include "bernal/core/tolerance.hpp"
#include "geometry/measures.hpp"

namespace bernal::cad {
namespace {

class RepeatedContainer final : public Container {
 public:
  RepeatedContainer(std::unique_ptr<const Container> around, const Mesh& mesh,
                    const std::array<int, 3>& images, std::size_t walls)
      : Container(around->arithmetic(), around->resolution(), boundary_of<3>(mesh)),
        around_(std::move(around)),
        walls_(walls),
        cover_(std::numeric_limits<double>::infinity()) {
    for (int k = 0; k < 3; ++k) {
      if (!boundary().repeats(k)) continue;
      const double more = images[static_cast<std::size_t>(k)];
      cover_ = std::min(cover_, more * boundary().edges[k]);
      window_[k] = (2 * more + 1) * boundary().edges[k];
    }
    cover_ *= 1 - 8 * tolerance::roundoff;
  }

  std::string_view kind() const override { return around_->kind(); }
  Bounds<3> bounds() const override { return around_->bounds(); }
  double volume() const override { return around_->volume(); }

  double clearance(const Vector<3>& p) const override { return around_->clearance(home(p)); }
  double clearance_within(const Vector<3>& p, double reach) const override {
    return around_->clearance_within(home(p), reach);
  }
  bool contains(const Vector<3>& c, double r) const override { return around_->contains(home(c), r); }

  void facets_near(const Vector<3>& c, double reach, std::vector<NearFacet>& out) const override {
    few_facets_near(c, reach, std::numeric_limits<std::size_t>::max(), out);
  }

  bool few_facets_near(const Vector<3>& c, double reach, std::size_t most,
                       std::vector<NearFacet>& out) const override {
    const Vector<3> at = home(c);
    if (reach > cover_) return far_facets_near(at, c - at, reach, most, out);
    const std::size_t before = out.size();
    if (!around_->few_facets_near(at, reach, most, out)) return false;
    move(out, before, c - at, c);
    return true;
  }

  void contacts(const Vector<3>& c, double r, std::vector<WallContact>& out) const override {
    if (r > cover_)
      Container::contacts(c, r, out);
    else
      around_->contacts(home(c), r, out);
  }

  double first_contact(const Vector<3>& c, double r, const Vector<3>& direction,
                       double limit) const override {
    return walk(
        c, r + tolerance::skin(r, resolution()), direction, limit,
        [&](const Vector<3>& from, double way) { return around_->first_contact(from, r, direction, way); });
  }

  double free_path(const Vector<3>& c, double r, const Vector<3>& direction, double limit) const override {
    return walk(c, r + free_path_bound(c, r), direction, limit, [&](const Vector<3>& from, double way) {
      return around_->free_path(from, r, direction, way);
    });
  }

 private:
  Vector<3> home(const Vector<3>& p) const { return boundary().wrap(p); }

  /// Of facets that were found around c - by.
  static void move(std::vector<NearFacet>& facets, std::size_t from, const Vector<3>& by,
                   const Vector<3>& c) {
    if (by.isZero(0)) return;
    for (std::size_t k = from; k < facets.size(); ++k) {
      for (Vector<3>* corner : {&facets[k].facet.a, &facets[k].facet.b, &facets[k].facet.c}) *corner += by;
      facets[k].distance = distance(facets[k].facet, c);
    }
    sort(facets, from);
  }
  static void sort(std::vector<NearFacet>& facets, std::size_t from) {
    std::stable_sort(facets.begin() + static_cast<std::ptrdiff_t>(from), facets.end(),
                     [](const NearFacet& a, const NearFacet& b) { return a.distance < b.distance; });
  }

  /// Those around the images of a point that are whole windows apart, each of which has its own walls.
  bool far_facets_near(const Vector<3>& at, const Vector<3>& shift, double reach, std::size_t most,
                       std::vector<NearFacet>& out) const {
    const std::size_t first = out.size();
    std::array<int, 3> more{};
    for (std::size_t k = 0; k < 3; ++k)
      if (const double window = window_[static_cast<int>(k)]; window > 0)
        more[k] = std::isfinite(reach) ? static_cast<int>(std::ceil(reach / window)) : 1;
    std::vector<NearFacet> near;
    for (int x = -more[0]; x <= more[0]; ++x)
      for (int y = -more[1]; y <= more[1]; ++y)
        for (int z = -more[2]; z <= more[2]; ++z) {
          const Vector<3> by(x * window_[0], y * window_[1], z * window_[2]);
          near.clear();
          around_->facets_near(at - by, reach, near);
          std::erase_if(near, [&](const NearFacet& n) { return n.facet.id >= walls_; });
          move(near, 0, shift + by, at + shift);
          out.insert(out.end(), near.begin(), near.end());
          if (out.size() - first > most) return false;
        }
    sort(out, first);
    return true;
  }

  /// `ask(from, way)`: how far of a way that the images cover; all in lengths of `direction`.
  template <class Ask>
  double walk(const Vector<3>& c, double reach, const Vector<3>& direction, double limit,
              const Ask& ask) const {
    const double speed = direction.stableNorm();
    const double piece = std::max(0.0, cover_ - reach) / speed;
    if (!(speed > 0) || limit <= piece || !(piece > 0)) return ask(home(c), std::min(limit, piece));
    const double endless = period_along(direction) / speed;  // infinite, or a way after which all is the same
    double gone = 0;
    for (int k = 0; k < most_pieces && gone < limit; ++k) {
      const double way = std::min(piece, limit - gone);
      const double free = ask(home(c + gone * direction), way);
      gone += free;
      if (free < way) return gone;
      if (gone > endless) return limit;
    }
    return std::min(gone, limit);
  }

  /// The period of an axis that the direction lies along.
  double period_along(const Vector<3>& direction) const {
    for (int k = 0; k < 3; ++k)
      if (direction[k] != 0 && direction[(k + 1) % 3] == 0 && direction[(k + 2) % 3] == 0 &&
          boundary().repeats(k))
        return boundary().edges[k];
    return std::numeric_limits<double>::infinity();
  }

  std::unique_ptr<const Container> around_;
  std::size_t walls_;  // the first so many triangles; then those that close the ends
  double cover_;       // how far the images reach
  Vector<3> window_ = Vector<3>::Zero();
};

}  // namespace

std::array<int, 3> images_around(const Mesh& mesh) {
  const Vector<3> size = bounds_of(mesh).size();
  double farthest = std::numeric_limits<double>::infinity();
  bool everywhere = true;
  for (int k = 0; k < 3; ++k) {
    if (mesh.periodic[static_cast<std::size_t>(k)]) continue;
    everywhere = false;
    farthest = std::min(farthest, size[k]);
  }
  if (everywhere) farthest = 0.5 * size.norm();
  std::array<int, 3> images{};
  for (int k = 0; k < 3; ++k) {
    if (!mesh.periodic[static_cast<std::size_t>(k)]) continue;
    const double more = std::ceil(farthest / size[k] * (1 + 1e-9));
    if (!(more <= most_images))
      throw Error(ErrorCode::bad_argument,
                  "the period of the mesh is less than a thirtieth of its width; put several of its periods "
                  "into the file");
    images[static_cast<std::size_t>(k)] = std::max(1, static_cast<int>(more));
  }
  return images;
}

std::unique_ptr<Container> make_repeated_container(std::unique_ptr<const Container> around, const Mesh& mesh,
                                                   const std::array<int, 3>& images, std::size_t walls) {
  return std::make_unique<RepeatedContainer>(std::move(around), mesh, images, walls);
}

}  // namespace bernal::cad
