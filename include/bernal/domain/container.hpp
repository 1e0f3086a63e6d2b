#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "bernal/domain/domain.hpp"
#include "bernal/domain/facet.hpp"

namespace bernal {

/// How the question "does this sphere clear the wall?" is decided.
enum class WallArithmetic {
  plain,     ///< double; wrong answers only within a few roundoffs of the largest coordinate
  filtered,  ///< double with a certified bound, exact where the bound cannot decide
  exact,     ///< exact constructions throughout
};

/// A point of the wall as a sphere's centre sees it.
struct WallPoint {
  Vector<3> point;   ///< on the wall
  Vector<3> inward;  ///< unit normal at `point` towards the centre, or inward where the centre lies on it
  double clearance;  ///< signed distance from the centre, positive inside
};

/// What a ball meets of the wall: the unit normal from the wall's point to the ball's centre, and how far
/// that is.
struct WallContact {
  Vector<3> normal;
  double distance;
};

/// The walls of a domain of three dimensions: a region that is bounded, or bounded but for the axes along
/// which it repeats itself. Or of one of two dimensions, whose points are those with z = 0 and whose volume
/// is an area: a disc there is a sphere that stays in the plane, among walls upright on it, and all formulas
/// hold. Queries take points with z = 0 then and answer with such.
///
/// Lengths are in the unit of the shape it was made from. All queries are const and may be called from
/// several threads at once.
class Container {
 public:
  virtual ~Container() = default;

  virtual std::string_view kind() const = 0;
  int dimension() const { return dimension_; }
  /// Along an axis that repeats itself, one period.
  virtual Bounds<3> bounds() const = 0;
  virtual double volume() const = 0;

  /// Signed distance from `p` to the wall, positive inside; 1-Lipschitz. Error: a few roundoffs of the
  /// largest coordinate.
  virtual double clearance(const Vector<3>& p) const = 0;

  /// The smaller of `clearance(p)` and `reach`: the question "is a wall within reach?", which for a mesh
  /// costs the less the smaller `reach` is.
  virtual double clearance_within(const Vector<3>& p, double reach) const {
    return std::min(clearance(p), reach);
  }

  /// Whether the ball of radius r >= 0 around c lies inside, touching allowed; decided as the container's
  /// WallArithmetic promises.
  virtual bool contains(const Vector<3>& c, double r) const = 0;

  /// Appends every facet of the wall nearer than `reach` to `c`, nearest first; `c` is inside. A mesh may
  /// be asked for thousands of these, so keep the answer for as long as the sphere stays near.
  virtual void facets_near(const Vector<3>& c, double reach, std::vector<NearFacet>& out) const = 0;

  /// How far a sphere of radius r at c, inside, may move along the unit vector `direction` before its
  /// clearance falls to r + skin, at most `limit` >= 0. Never rounded towards the
  /// wall: the clearance stays at or above r + skin/2 on the whole way if it was so at the start. A sphere
  /// that rests on the wall can leave it; one that penetrates slightly can move out of the wall, never
  /// further in: then the answer is 0. A tangent of a round wall leads into it at once, so what slides there
  /// has to aim along a chord.
  virtual double first_contact(const Vector<3>& c, double r, const Vector<3>& direction, double limit) const;

  /// The same without a skin, decided as the container's WallArithmetic promises: how far a ball of radius
  /// r > 0 at c, inside, may move along `direction`, of whatever length, until it touches: the largest t in
  /// [0, limit] such that the ball about c + s·direction lies inside for all s in [0, t]. Taking doubles for
  /// the real numbers that they are, `exact` is the largest such double; `filtered` is not above that and a
  /// few roundoffs below it at most; `plain` reaches beyond the wall by less than 2 `free_path_bound`, and
  /// stops no farther before it. 0 for a ball that reaches beyond the wall at the start. `limit` may be
  /// infinite.
  ///
  /// A ball that rests on a wall and is to slide along it gets nowhere by this, since every rounding of a
  /// tangent leads into the wall or off it: what moves in steps asks for `first_contact`.
  virtual double free_path(const Vector<3>& c, double r, const Vector<3>& direction, double limit) const;

  /// See `free_path`: 64 roundoffs of the lengths and coordinates that occur.
  double free_path_bound(const Vector<3>& c, double r) const;

  /// `facets_near`, where these are not more than `most`; else false, and what is appended is of no use.
  virtual bool few_facets_near(const Vector<3>& c, double reach, std::size_t most,
                               std::vector<NearFacet>& out) const;

  /// Appends what pushes the ball of radius r around c, inside, away from the wall, nearest first: of every
  /// smooth patch that is nearer than r the nearest point, however finely it is cut into facets.
  virtual void contacts(const Vector<3>& c, double r, std::vector<WallContact>& out) const;

  /// Appends the wall points within `reach` of `c`, one a facet, edge or corner (each once), nearest first;
  /// where the wall has an inset the points of its facets, and their clearances from the wall.
  void walls_near(const Vector<3>& c, double reach, std::vector<WallPoint>& out) const;

  /// The periods. Queries take a point for what it is, not for its image in one period.
  const Boundary<3>& boundary() const { return boundary_; }

  /// Largest rounding error of a coordinate: `Frame::resolution` of the frame the container lives in.
  double resolution() const { return resolution_; }

  /// How far inside of its facets the wall stands, see `Mesh::inset`. Where that is negative, what is behind
  /// the facets is not inside for all that: `contains` says so, and a clearance of -inset at most.
  double inset() const { return inset_; }

  /// How `contains` and `free_path` are decided.
  WallArithmetic arithmetic() const { return arithmetic_; }

 protected:
  Container(WallArithmetic arithmetic, double resolution, const Boundary<3>& boundary = {}, int dimension = 3,
            double inset = 0)
      : arithmetic_(arithmetic),
        resolution_(resolution),
        inset_(inset),
        dimension_(dimension),
        boundary_(boundary) {}

 private:
  WallArithmetic arithmetic_;
  double resolution_;
  double inset_;
  int dimension_;
  Boundary<3> boundary_;
};

/// The container of a box of two or three dimensions, cylinder, sphere, polygon or solid of revolution.
/// Throws Error{bad_argument} for lengths that are not positive and finite, an axis without direction or a
/// periodic one that is oblique, and for a mesh.
std::unique_ptr<Container> make_analytic_container(const Domain&, WallArithmetic, double resolution);

}  // namespace bernal
