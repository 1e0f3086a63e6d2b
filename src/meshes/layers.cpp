// The spheres within spheres in which layers begin, and prisms in layers that are thin.
#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "meshes/surface_draft.hpp"

namespace bernal {
namespace {

/// From this thickness on, in edges of the sphere around, layers are filled as any other region.
constexpr double thin = 0.8;
/// Prisms are not higher than that many of the shortest edges of their sphere.
constexpr double highest_prism = 4;
/// A plane that cuts a sphere, and lines and points in which several do, lie within this share of the radius
/// of the sphere within, or beyond the sphere around: else what is cut of both is not alike.
constexpr double well_within = 0.87;
/// What a neck or cap leaves of a layer at least, of its thickness.
constexpr double least_left = 0.2;

class ShellsOfPieces {
 public:
  explicit ShellsOfPieces(SurfaceDraft& draft) : draft_(draft), shells_(draft.solids.shells) {}

  void add() {
    const auto outer = static_cast<std::uint32_t>(draft_.pieces.size());
    std::map<std::uint32_t, Plan> plans;
    for (std::uint32_t p = 0; p < outer; ++p) {
      const std::uint32_t sphere = draft_.pieces[p].piece.sphere;
      const std::span<const double> radii = shells_.of(sphere);
      if (radii.empty()) continue;
      require_room(draft_.pieces[p], radii.back());
      look_at(draft_.pieces[p], radii, plans.try_emplace(sphere, radii.size()).first->second);
    }
    for (auto& [sphere, plan] : plans) limit_edges(sphere, plan);
    for (std::uint32_t p = 0; p < outer; ++p) {
      DraftPiece& piece = draft_.pieces[p];
      const std::size_t count = shells_.of(piece.piece.sphere).size();
      if (count == 0) continue;
      piece.layer = static_cast<std::uint32_t>(count);
      piece.largest_edge = plans.at(piece.piece.sphere).edge.back();
    }
    for (std::uint32_t below = 1;; ++below)
      if (!add_level(below, plans)) return;
  }

 private:
  /// Of a sphere: of each layer but the innermost whether prisms fill it, and edges at each radius.
  struct Plan {
    explicit Plan(std::size_t count) : is_copied(count, 1), edge(count + 1, infinite) {}
    static constexpr double infinite = std::numeric_limits<double>::infinity();
    std::vector<char> is_copied;
    std::vector<double> edge;
  };

  double radius_at(std::uint32_t sphere, std::size_t level) const {
    const std::span<const double> radii = shells_.of(sphere);
    return level < radii.size() ? radii[level] : draft_.solids.spheres.r[sphere];
  }

  void require_room(const DraftPiece& piece, double inner) const {
    const double room = inner + least_left * (piece.piece.radius - inner);
    const auto require = [&](double depth, const char* what, const char* remedy) {
      if (depth > room) return;
      throw Error(ErrorCode::bad_argument,
                  fmt::format("a {} of sphere {} reaches through its outer layer, which is {:.4g} thick; {}",
                              what, piece.piece.sphere, piece.piece.radius - inner, remedy));
    };
    for (const Circle& circle : piece.circles)
      if (circle.kind == Circle::Kind::neck)
        require(circle.depth, "bridge", "narrower bridges or contact gap leave it whole");
    for (const Cut& cut : piece.piece.cuts)
      if (cut.face == Cut::contact)
        require(cut.keeps.offset - cut.keeps.normal.dot(piece.piece.center), "cap",
                "a smaller gap or contact gap leaves it whole");
  }

  /// Where ends of periods cut the spheres of a layer in other ways, no prisms fit between.
  void look_at(const DraftPiece& piece, std::span<const double> radii, Plan& plan) const {
    for (const Circle& circle : piece.circles)
      if (circle.kind == Circle::Kind::neck && draft_.necks[circle.neck].is_cut) plan.is_copied.back() = 0;
    const std::vector<double> squares = squares_of(piece.piece);
    for (std::size_t k = 0; k < radii.size(); ++k) {
      const double inner = well_within * radii[k], outer = radius_at(piece.piece.sphere, k + 1);
      for (const double square : squares)
        if (square > inner * inner && square < outer * outer) plan.is_copied[k] = 0;
    }
  }

  /// Of the distances of planes, lines and corners that cut a piece from its centre.
  std::vector<double> squares_of(const Piece& piece) const {
    std::vector<double> squares = {0};
    std::vector<char> is_cut;  // by face
    for (const Cut& cut : piece.cuts) {
      if (cut.face == Cut::contact) continue;
      const double depth = cut.keeps.offset - cut.keeps.normal.dot(piece.center);
      if (!draft_.solids.part || draft_.solids.part->is_box) {  // planes at right angles
        for (std::size_t k = squares.size(); k-- > 0;) squares.push_back(squares[k] + depth * depth);
        continue;
      }
      squares.push_back(depth * depth);
      is_cut.resize(draft_.solids.part->faces.size(), 0);
      is_cut[static_cast<std::size_t>(cut.face)] = 1;
    }
    if (is_cut.empty()) return squares;
    const ConvexPart& part = *draft_.solids.part;
    const auto are_cut = [&](std::span<const std::uint32_t> faces) {
      return std::ranges::all_of(faces, [&](std::uint32_t face) { return is_cut[face]; });
    };
    const auto from = [&](std::uint32_t corner) {
      return Vector<3>(part.corners[corner].point - piece.center);
    };
    for (const ConvexPart::Edge& edge : part.edges)
      if (const Vector<3> d = from(edge.corners[0]); are_cut(edge.faces))
        squares.push_back((d - d.dot(edge.along) * edge.along).squaredNorm());
    for (std::uint32_t corner = 0; corner < part.corners.size(); ++corner)
      if (are_cut(part.corners[corner].faces)) squares.push_back(from(corner).squaredNorm());
    return squares;
  }

  double least_edge_on(std::uint32_t sphere) const {
    const Vector<3> center(draft_.solids.spheres.center(sphere));
    const double r = draft_.solids.spheres.r[sphere];
    double least = draft_.options.sphere_edge * r;
    const std::vector<NearBall> near = draft_.sizes.near(center, sphere);
    for (const NearBall& ball : near)
      least = std::min(least, draft_.sizes.on_sphere(center + r * (ball.center - center).normalized(), center,
                                                     r, true, near));
    return least;
  }

  void limit_edges(std::uint32_t sphere, Plan& plan) const {
    const double shortest = least_edge_on(sphere);
    for (std::size_t k = 0; k < plan.is_copied.size(); ++k) {
      const double outer = radius_at(sphere, k + 1), thickness = outer - radius_at(sphere, k);
      if (thickness >= thin * draft_.options.sphere_edge * outer) {
        plan.is_copied[k] = 0;
        continue;
      }
      if (thickness > highest_prism * shortest) plan.is_copied[k] = 0;
      const double edge = (plan.is_copied[k] ? 1 : 0.5) * draft_.options.per_layer * thickness;
      for (const std::size_t at : {k, k + 1}) plan.edge[at] = std::min(plan.edge[at], edge);
    }
    for (std::size_t k = 0; k < plan.is_copied.size(); ++k)
      if (plan.is_copied[k]) plan.edge[k + 1] = std::min(plan.edge[k + 1], plan.edge[k]);
  }

  /// The pieces of balls in the domain.
  std::vector<Piece> pieces_within(const Spheres<dynamic>& balls) const {
    if (!draft_.solids.part) return pieces_of(balls, draft_.solids.domain);
    std::vector<Piece> pieces;
    for (std::uint32_t i = 0; i < balls.size(); ++i)
      if (auto piece = piece_in(*draft_.solids.part, balls.center(i), balls.r[i])) {
        piece->sphere = i;
        pieces.push_back(std::move(*piece));
      }
    return pieces;
  }

  /// Adds the spheres that are so many layers below the surface; false if there are none.
  bool add_level(std::uint32_t below, const std::map<std::uint32_t, Plan>& plans) {
    Spheres<dynamic> balls(3);
    std::vector<std::uint32_t> number;
    for (const auto& [sphere, plan] : plans) {
      const std::span<const double> radii = shells_.of(sphere);
      if (below > radii.size()) continue;
      balls.push_back(draft_.solids.spheres.center(sphere), radii[radii.size() - below]);
      number.push_back(sphere);
    }
    if (number.empty()) return false;
    for (Piece& piece : pieces_within(balls)) {
      piece.sphere = number[piece.sphere];
      const Plan& plan = plans.at(piece.sphere);
      DraftPiece made{.piece = std::move(piece)};
      made.layer = static_cast<std::uint32_t>(plan.is_copied.size() - below);
      made.below = below;
      made.around = draft_.piece_at(made.piece.sphere, made.piece.image, below - 1);
      made.is_copied = plan.is_copied[made.layer];
      made.largest_edge = plan.edge[made.layer];
      draft_.pieces[made.around].within = static_cast<std::uint32_t>(draft_.pieces.size());
      draft_.add_piece(std::move(made));
    }
    return true;
  }

  SurfaceDraft& draft_;
  const InnerSpheres& shells_;
};

}  // namespace

void add_shells(SurfaceDraft& draft) { ShellsOfPieces(draft).add(); }

}  // namespace bernal
