// Spheres within spheres that are copied from those around them, and the prisms between.
#include <unordered_map>
#include <utility>

#include "bernal/core/error.hpp"
#include "meshes/surface_draft.hpp"
#include "meshes/volume_mesh.hpp"

namespace bernal {
namespace {

class CopiedShells {
 public:
  explicit CopiedShells(SurfaceDraft& draft) : draft_(draft) {}

  void make() {
    std::vector<std::uint32_t> copied;
    for (std::uint32_t p = 0; p < draft_.pieces.size(); ++p)
      if (draft_.pieces[p].is_copied) copied.push_back(p);
    if (copied.empty()) return;
    find_tops(copied);
    for (const auto& pairs : draft_.made.periodic)
      for (const auto& [lower, upper] : pairs) lower_.try_emplace(upper, lower);
    for (const std::uint32_t p : copied) copy(p);
  }

 private:
  using Triangle = FaceCorners;

  /// The triangles on top of each layer: of the sphere around it and of the flat faces in that.
  void find_tops(const std::vector<std::uint32_t>& copied) {
    tops_.resize(draft_.pieces.size());
    std::vector<char> is_wanted(draft_.pieces.size(), 0);
    for (const std::uint32_t p : copied) is_wanted[draft_.pieces[p].around] = 1;
    for (std::size_t t = 0; t < draft_.made.triangles.size(); ++t) {
      const SurfacePatch& patch = draft_.made.patches[draft_.made.patch[t]];
      const std::int32_t piece = patch.regions[0] - 1;
      if (piece < 0 || piece >= static_cast<std::int32_t>(tops_.size()) ||
          !is_wanted[static_cast<std::size_t>(piece)] || patch.kind == draft_.kind_of_ends())
        continue;
      tops_[static_cast<std::size_t>(piece)].push_back(draft_.made.triangles[t]);
    }
  }

  /// The same for a vertex at an upper end and the one at the lower end that it belongs to: prisms are cut
  /// alike at both.
  std::uint32_t rank(std::uint32_t vertex) const {
    for (auto found = lower_.find(vertex); found != lower_.end(); found = lower_.find(vertex))
      vertex = found->second;
    return vertex;
  }

  void copy(std::uint32_t p) {
    const DraftPiece& piece = draft_.pieces[p];
    const std::vector<Triangle>& top = tops_[piece.around];
    below_.clear();
    for (const Circle& circle : piece.circles) join_chains(draft_.pieces[piece.around], circle);
    place_others(piece, top);
    const std::uint32_t patch = draft_.add_patch(patch_of(draft_, p));
    for (const Triangle& t : top) {
      const Triangle under = {below_.at(t[0]), below_.at(t[1]), below_.at(t[2])};
      draft_.add_triangle(patch, under[0], under[1], under[2]);
      if (piece.within != DraftPiece::none && draft_.pieces[piece.within].is_copied)
        tops_[p].push_back(under);
      add_prism(t, draft_.region_of_piece(piece.around));
    }
    for (const Circle& circle : piece.circles)
      if (!circle.chains.empty()) add_ring(draft_.pieces[piece.around], piece.around, circle);
  }

  const Circle& circle_like(const DraftPiece& piece, const Circle& wanted) const {
    for (const Circle& circle : piece.circles)
      if (circle.kind == Circle::Kind::end && circle.face == wanted.face) return circle;
    throw Error(ErrorCode::bad_argument, "a layer at an end of a period is not cut as its sphere is");
  }

  void join_chains(const DraftPiece& around, const Circle& circle) {
    const Circle& other = circle_like(around, circle);
    for (std::size_t k = 0; k < circle.chains.size(); ++k) {
      const auto &inner = circle.chains[k], &outer = other.chains.at(circle.chains_around.at(k));
      if (inner.size() != outer.size())
        throw Error(ErrorCode::bad_argument, "a layer at an end of a period is not cut as its sphere is");
      for (std::size_t i = 0; i < inner.size(); ++i) below_[outer[i]] = inner[i];
    }
  }

  /// Brings vertices inwards along the radius; near ends of periods, which move their vertices along
  /// themselves, they give way as springs do.
  void place_others(const DraftPiece& piece, const std::vector<Triangle>& top) {
    constexpr int rounds = 100;
    constexpr double stiffness = 0.05;
    const Vector<3> center = piece.piece.center;
    std::unordered_map<std::uint32_t, std::uint32_t> number;
    std::vector<std::uint32_t> ids;
    for (const Triangle& t : top)
      for (const std::uint32_t c : t)
        if (number.try_emplace(c, static_cast<std::uint32_t>(ids.size())).second) ids.push_back(c);
    const auto direction = [&](std::uint32_t id) {
      return Vector<3>((draft_.made.vertices[id] - center).normalized());
    };
    std::vector<Vector<3>> shift(ids.size(), Vector<3>::Zero());
    std::vector<char> is_given(ids.size(), 0);
    for (std::size_t k = 0; k < ids.size(); ++k)
      if (const auto given = below_.find(ids[k]); given != below_.end()) {
        shift[k] = direction(given->second) - direction(ids[k]);
        is_given[k] = 1;
      }
    if (!below_.empty()) {
      std::vector<std::vector<std::uint32_t>> beside(ids.size());
      for (const Triangle& t : top)
        for (std::size_t k = 0; k < 3; ++k) beside[number.at(t[k])].push_back(number.at(t[(k + 1) % 3]));
      for (int round = 0; round < rounds; ++round)
        for (std::size_t k = 0; k < ids.size(); ++k) {
          if (is_given[k] || beside[k].empty()) continue;
          Vector<3> sum = Vector<3>::Zero();
          for (const std::uint32_t other : beside[k]) sum += shift[other];
          shift[k] = sum / ((1 + stiffness) * static_cast<double>(beside[k].size()));
        }
    }
    // Facets that hold the volume stand off both spheres in proportion.
    const auto radius_below = [&](std::uint32_t id) {
      if (!draft_.options.hold_volumes) return piece.piece.radius;
      return piece.piece.radius * (draft_.made.vertices[id] - center).norm() /
             draft_.pieces[piece.around].piece.radius;
    };
    for (std::size_t k = 0; k < ids.size(); ++k)
      if (!is_given[k])
        below_[ids[k]] =
            draft_.add_vertex(center + radius_below(ids[k]) * (direction(ids[k]) + shift[k]).normalized(),
                              draft_.made.size[ids[k]]);
  }

  void add_prism(const Triangle& t, std::int32_t region) {
    const PrismCorners prism = {below_.at(t[0]), below_.at(t[1]), below_.at(t[2]), t[0], t[1], t[2]};
    for (const TetrahedronCorners& corners : tetrahedra_of(prism, {rank(t[0]), rank(t[1]), rank(t[2])})) {
      draft_.made.prisms.tetrahedra.push_back(corners);
      draft_.made.prisms.region.push_back(static_cast<std::uint32_t>(region));
    }
  }

  /// The sides of prisms at an end of a period.
  void add_ring(const DraftPiece& around, std::uint32_t number, const Circle& circle) {
    const Circle& other = circle_like(around, circle);
    const std::uint32_t patch =
        draft_.add_patch({.kind = draft_.kind_of_ends(),
                          .index = static_cast<std::uint32_t>(circle.face),
                          .regions = {draft_.region_of_piece(number), SurfacePatch::nothing}});
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      const auto& at = draft_.made.vertices;
      if ((at[b] - at[a]).cross(at[c] - at[a]).dot(circle.normal) < 0) std::swap(b, c);
      draft_.add_triangle(patch, a, b, c);
    };
    for (const std::size_t chain : circle.chains_around) {
      const auto& ids = other.chains[chain];
      for (std::size_t k = 0; k + (other.is_whole ? 0 : 1) < ids.size(); ++k) {
        std::uint32_t a = ids[k], b = ids[(k + 1) % ids.size()];
        if (rank(b) < rank(a)) std::swap(a, b);
        add(below_.at(a), below_.at(b), b);
        add(below_.at(a), b, a);
      }
    }
  }

  SurfaceDraft& draft_;
  std::vector<std::vector<Triangle>> tops_;                 ///< by piece
  std::unordered_map<std::uint32_t, std::uint32_t> lower_;  ///< by the vertex at the upper end
  std::unordered_map<std::uint32_t, std::uint32_t> below_;  ///< of the piece that is copied
};

}  // namespace

void mesh_copied_shells(SurfaceDraft& draft) { CopiedShells(draft).make(); }

}  // namespace bernal
