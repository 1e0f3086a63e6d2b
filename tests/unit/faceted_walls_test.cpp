#include "hard/faceted_walls.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "bernal/core/random.hpp"
#include "bernal/domain/domain.hpp"
#include "bernal/run/run.hpp"
#include "hard/hard_spheres.hpp"
#include "support/meshes.hpp"
#include "support/plans.hpp"
#include "support/polygons.hpp"
#include "support/precise_distance.hpp"

// Walls of containers that are not convex, as spheres meet them that fly and grow: faces, edges that stand
// into the container, corners of these.
namespace bernal {
namespace faceted_walls_test {

using Real = long double;
using Point = test::Point<Real>;

struct Facets {
  std::vector<Facet> all;

  explicit Facets(const Mesh& mesh) {
    for (const auto& [i, j, k] : mesh.triangles)
      all.push_back({Facet::Kind::triangle, 0, mesh.vertices[i], mesh.vertices[j], mesh.vertices[k]});
  }
  explicit Facets(const Polygon& polygon) {
    for (const auto& loop : polygon.loops)
      for (std::size_t k = 0; k < loop.size(); ++k) {
        Facet edge{.kind = Facet::Kind::triangle};
        edge.a.head<2>() = loop[k];
        edge.b.head<2>() = edge.c.head<2>() = loop[(k + 1) % loop.size()];
        all.push_back(edge);
      }
  }
  Real distance(const Point& p) const {
    Real least = std::numeric_limits<Real>::infinity();
    for (const Facet& facet : all) least = std::min(least, test::precise_distance<Real>(facet, p));
    return least;
  }
  /// The first time at which a sphere on its way touches a facet: of each by bisection, from its least room
  /// on back to the start, as its room is a convex function of time.
  Real first_touch(const Vector<3>& p, const Vector<3>& v, double r, double growth, Real end) const {
    Real first = std::numeric_limits<Real>::infinity();
    for (const Facet& facet : all) {
      const auto room = [&](Real t) {
        return test::precise_distance<Real>(facet, Point(p) + t * Point(v)) - r - t * growth;
      };
      Real low = 0, high = end;
      for (int k = 0; k < 200; ++k) {  // by thirds, to where there is the least
        const Real a = low + (high - low) / 3, b = high - (high - low) / 3;
        (room(a) < room(b) ? high : low) = room(a) < room(b) ? b : a;
      }
      Real last = 0, next = low;
      if (room(next) > 0) continue;
      for (int k = 0; k < 100; ++k) {
        const Real middle = (last + next) / 2;
        (room(middle) > 0 ? last : next) = middle;
      }
      first = std::min(first, next);
    }
    return first;
  }
};

Mesh hollow_ball() {
  return test::joined(test::icosphere_mesh(1, 2), test::inverted(test::icosphere_mesh(0.4, 1)));
}

TEST(FacetedWalls, AreTouchedWhereBisectionSays) {
  Random random(1, stream(Stream::test));
  for (const Mesh& mesh : {test::l_shape_mesh(), hollow_ball(), test::torus_mesh(1, 0.4, 12, 6)}) {
    const Facets oracle(mesh);
    const FacetedWalls walls(mesh, 1e-6, Vector<3>::Zero());
    const Bounds<3> bounds = bounds_of(Domain(mesh));
    std::vector<FacetedWalls::Near> near;
    int met = 0;
    for (int k = 0; k < 300; ++k) {
      const Vector<3> p = uniform_point(random, bounds);
      const auto room = static_cast<double>(oracle.distance(p));
      const double r = 0.9 * random.uniform() * room,
                   growth = k % 3 == 0 ? 0 : std::exp(random.uniform(-4, 0));
      const Vector<3> v = std::exp(random.uniform(-2, 1)) * uniform_direction<3>(random);
      walls.find_near(p, 10, near);
      EXPECT_EQ(near.size(), mesh.triangles.size());
      EXPECT_NEAR(near.front().clearance, room, 1e-15);
      double first = 1;
      for (const auto& [normal, clearance, facet] : near)
        first = std::min(first, walls.time_to_touch(facet, p, v, r, growth, first));
      const Real wanted = oracle.first_touch(p, v, r, growth, 1);
      if (wanted >= 1) {
        EXPECT_EQ(first, 1);
        continue;
      }
      ++met;
      // A sphere that only just grazes an edge meets it any time within the rounding of its distance.
      const Real left = oracle.distance(Point(p) + Real(first) * Point(v)) - r - first * growth;
      EXPECT_NEAR(static_cast<double>(left), 0, 1e-14);
      EXPECT_LT(first, static_cast<double>(wanted) + 1e-7);
    }
    EXPECT_GT(met, 100);
  }
}

TEST(FacetedWalls, FindWhatIsNear) {
  const Mesh mesh = test::divided(test::l_shape_mesh(), 4);
  const Facets oracle(mesh);
  const FacetedWalls walls(mesh, 1e-6, Vector<3>::Zero());
  Random random(2, stream(Stream::test));
  std::vector<FacetedWalls::Near> near;
  for (int k = 0; k < 200; ++k) {
    const Vector<3> p = uniform_point(random, Bounds<3>{{0, 0, 0}, {2, 2, 1}});
    const double reach = 0.3 * random.uniform();
    walls.find_near(p, reach, near);
    std::size_t wanted = 0;
    for (const Facet& facet : oracle.all) wanted += test::precise_distance<Real>(facet, Point(p)) < reach;
    EXPECT_EQ(near.size(), wanted);
    EXPECT_TRUE(std::ranges::is_sorted(near, {}, &FacetedWalls::Near::clearance));
  }
}

/// A wall inside of its facets is met earlier; one behind them is not met later than they are.
TEST(FacetedWalls, StandWhereTheInsetSays) {
  Mesh mesh = test::l_shape_mesh();
  const Vector<3> p(0.5, 0.5, 0.5), v(1, 0, 0);
  std::vector<FacetedWalls::Near> near;
  for (const double inset : {0.0, 0.1, -0.1}) {
    mesh.inset = inset;
    const FacetedWalls walls(mesh, 1e-6, Vector<3>::Zero());
    walls.find_near(p, 10, near);
    double first = 10;
    for (const auto& [normal, clearance, facet] : near)
      first = std::min(first, walls.time_to_touch(facet, p, v, 0.2, 0, first));
    EXPECT_NEAR(first, 1.3 - std::max(0.0, inset), 1e-14);
  }
}

/// Spheres of radius r in a container, in a periodic box around it.
template <int D>
struct Flight {
  Facets oracle;
  Spheres<D> spheres;
  Vector<D> edges;
  std::shared_ptr<const FacetedWalls> walls;
  Vector<3> shift = Vector<3>::Zero();

  template <class Shape, class Inside>
  Flight(const Shape& shape, std::size_t n, double r, double most_size, Inside&& inside) : oracle(shape) {
    const Bounds<3> bounds = bounds_of(Domain(shape));
    edges = bounds.size().head<D>().array() + 6 * r * most_size;
    shift.head<D>() = 0.5 * edges - bounds.center().head<D>();
    walls = std::make_shared<FacetedWalls>(shape, 1e-9, shift);
    Random random(3, stream(Stream::test));
    while (spheres.size() < n) {
      const Vector<3> c = uniform_point(random, bounds);
      const Vector<D> place = (c + shift).template head<D>();
      bool free = inside(c) && static_cast<double>(oracle.distance(c)) >= r;
      for (std::size_t j = 0; j < spheres.size() && free; ++j)
        free = (spheres.center(j) - place).norm() > 2 * r;
      if (free) spheres.push_back(place, r);
    }
  }
  HardSpheres<D> start(double room_at_walls = 0) const {
    return {spheres,
            edges,
            Random(1, stream(Stream::test, 2)),
            {.walls = {}, .facets = walls.get(), .room_at_walls = room_at_walls}};
  }
  /// How far the worst sphere is across a wall, in radii; or how much nearer than so many radii.
  double protrusion(const HardSpheres<D>& flight, double room_at_walls = 0) const {
    Spheres<D> now = spheres;
    flight.write_to(now);
    double worst = -1e300;
    for (std::size_t i = 0; i < now.size(); ++i) {
      Vector<3> c = -shift;
      c.head<D>() += now.center(i);
      worst = std::max(
          worst, std::max(room_at_walls, flight.size()) - static_cast<double>(oracle.distance(c)) / now.r[i]);
    }
    return worst;
  }
};

bool in_l_shape(const Vector<3>& c) { return c[0] < 1 || c[1] < 1; }
bool in_hollow(const Vector<3>& c) { return c.norm() < 0.95 && c.norm() > 0.45; }

TEST(HardSpheresInFacets, ConserveEnergyAndStayInside) {
  const auto fly = [](const auto& gas) {
    auto flight = gas.start();
    const double energy = flight.kinetic_energy();
    std::uint64_t reflections = 0;
    for (int k = 0; k < 20; ++k) {
      reflections += flight.fly(0).reflections;
      ASSERT_LT(gas.protrusion(flight), 1e-12);
    }
    EXPECT_GT(reflections, 2000u);
    EXPECT_NEAR(flight.kinetic_energy() / energy, 1, 1e-10);
  };
  fly(Flight<3>(test::l_shape_mesh(), 150, 0.05, 1, in_l_shape));
  fly(Flight<3>(hollow_ball(), 150, 0.05, 1, in_hollow));
  fly(Flight<2>(test::l_shape(), 100, 0.2, 1, [](const Vector<3>& c) { return c[0] < 4 || c[1] < 4; }));
}

/// The momentum that the walls receive is the pressure which the virial of pairs and of radii at walls says:
/// no reflection is missing, and none is there twice, at faces, edges and corners.
TEST(HardSpheresInFacets, PressTheWallsAsTheirVirialSays) {
  const double volume = 3, area = 2 * 3 + 8;
  const Flight<3> gas(test::divided(test::l_shape_mesh(), 2), 250, 0.085, 1, in_l_shape);
  HardSpheres<3> flight = gas.start();
  for (int k = 0; k < 10; ++k) flight.fly(0);
  double virial = 0, momentum = 0, time = 0;
  for (int k = 0; k < 100; ++k) {
    const FlightPeriod period = flight.fly(0);
    virial += period.compressibility_factor * period.time;
    momentum += period.wall_momentum;
    time += period.time;
  }
  const auto n = static_cast<double>(gas.spheres.size());
  const double temperature = 2 * flight.kinetic_energy() / (3 * n);
  EXPECT_GT(virial / time, 2);
  // The wall is an area that spheres see from their own radius inside; at the edge that stands in, from
  // outside.
  EXPECT_NEAR(momentum / time / area * volume / (n * temperature) / (virial / time), 1, 0.05);
}

TEST(HardSpheresInFacets, NeverCrossThemWhileTheyGrow) {
  const auto grow = [](const auto& gas) {
    auto flight = gas.start();
    FlightPeriod period;
    for (int k = 0; k < 1000 && period.compressibility_factor < 1e8; ++k) {
      period = flight.fly(0.05);
      ASSERT_LT(gas.protrusion(flight), 1e-12);
    }
    EXPECT_GT(period.compressibility_factor, 1e8);
  };
  grow(Flight<3>(test::l_shape_mesh(), 100, 0.06, 2.5, in_l_shape));
  grow(Flight<3>(hollow_ball(), 100, 0.06, 2.5, in_hollow));
  grow(Flight<2>(test::l_shape(), 60, 0.3, 2.5, [](const Vector<3>& c) { return c[0] < 4 || c[1] < 4; }));
}

TEST(HardSpheresInFacets, KeepTheRoomThatTheyWillNeed) {
  Flight<3> gas(test::l_shape_mesh(), 100, 0.06, 2.5, in_l_shape);
  for (double& r : gas.spheres.r) r /= 2;
  HardSpheres<3> flight = gas.start(2);
  FlightPeriod period;
  for (int k = 0; k < 1000 && flight.size() < 2; ++k) {
    period = flight.fly(0.05, 2);
    ASSERT_LT(gas.protrusion(flight, 2), 1e-12);
  }
  EXPECT_EQ(flight.size(), 2);
}

/// Small spheres would get into the groove and the neck, in which there is no room for them in the end, and
/// jam there: the containers would be filled to 0.13.
TEST(GrowInContainer, LeavesGroovesEmptyInWhichSpheresHaveNoRoom) {
  for (const std::string polygon :
       {"[[0,0],[8,0],[8,6],[5,6],[5,8],[4.05,8],[4.05,6],[0,6]]",
        "[[0,0],[5,0],[5,2.5],[6,2.5],[6,0],[11,0],[11,6],[6,6],[6,3.45],[5,3.45],[5,6],[0,6]]"}) {
    SCOPED_TRACE(polygon);
    const auto filled_by = [&](const std::string& stage) {
      return run(testing::plan_of("[container]\nkind = \"extruded\"\npolygon = " + polygon +
                                  "\nheight = 5\n[spheres]\nfill = true\nradius = 0.5\n[[stage]]\ndo = \"" +
                                  stage + "\"\n"));
    };
    const Packing grown = filled_by("grow"), relaxed = filled_by("relax");
    EXPECT_EQ(grown.outcome, Outcome::converged) << grown.reason;
    EXPECT_GT(grown.packing_fraction(), relaxed.packing_fraction() - 0.02);
  }
}

}  // namespace faceted_walls_test
}  // namespace bernal
