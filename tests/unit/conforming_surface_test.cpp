// The surfaces that beds are meshed from: closed about every region, of the volume that is stated, without
// triangles that cross, the same at opposite ends.
#include "meshes/conforming_surface.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <set>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "bernal/core/error.hpp"
#include "domain/revolved_surface.hpp"
#include "geometry/changes.hpp"
#include "meshes/flat_walls.hpp"
#include "meshes/tetgen.hpp"
#include "meshes/volume_mesh.hpp"

namespace bernal {
namespace conforming_surface_test {

constexpr double pi = std::numbers::pi;

Solids solids_in(const Spheres<dynamic>& spheres, const Domain& domain, ContactTreatment contact,
                 double gap = 0.01) {
  return solids_of(spheres, domain, {.contact = contact, .gap = gap, .bridge_radius = 0.2});
}

/// Balls at random places that overlap nothing, as many as some tries find.
Spheres<dynamic> scattered(const Domain& domain, double radius, int tries, unsigned seed) {
  std::mt19937 engine(seed);
  const Bounds<3> bounds = bounds_of(domain);
  const Boundary<3> boundary = boundary_of<3>(domain);
  const auto* cylinder = std::get_if<Cylinder>(&domain);
  Spheres<dynamic> spheres(3);
  for (int t = 0; t < tries; ++t) {
    Vector<3> p;
    for (int k = 0; k < 3; ++k) {
      const double inset = boundary.repeats(k) ? 0 : radius;
      p[k] = std::uniform_real_distribution(bounds.lower[k] + inset, bounds.upper[k] - inset)(engine);
    }
    if (cylinder != nullptr && std::hypot(p[0], p[1]) > cylinder->radius - radius) continue;
    bool is_free = true;
    for (std::size_t j = 0; j < spheres.size() && is_free; ++j)
      is_free = boundary.minimum_image(p - spheres.center(j)).norm() > 2 * radius;
    if (is_free) spheres.push_back(p, radius);
  }
  return spheres;
}

/// Four balls on a floor's corner: contacts with each other, the floor and two walls.
Spheres<dynamic> touching() {
  Spheres<dynamic> spheres(3);
  for (const Vector<3>& c : {Vector<3>(1, 1, 1), Vector<3>(3, 1, 1), Vector<3>(2, 1 + std::sqrt(3.0), 1),
                             Vector<3>(2, 1 + 1 / std::sqrt(3.0), 1 + 2 * std::sqrt(2.0 / 3))})
    spheres.push_back(c, 1);
  return spheres;
}

/// Edges that are not met once in each sense, over all regions.
std::size_t open_edges(const ConformingSurface& surface) {
  std::map<std::tuple<int, std::uint32_t, std::uint32_t>, std::array<int, 2>> seen;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    for (const std::size_t side : {0u, 1u}) {
      const int region = surface.patches[surface.patch[t]].regions[side];
      if (region == SurfacePatch::nothing) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = surface.triangles[t][k], b = surface.triangles[t][(k + 1) % 3];
        ++seen[{region, std::min(a, b), std::max(a, b)}][(a < b) == (side == 0)];
      }
    }
  return static_cast<std::size_t>(std::ranges::count_if(seen, [](const auto& edge) {
    return edge.second != std::array{1, 1};
  }));
}

/// V - E + F of all triangles around a region.
long euler_number(const ConformingSurface& surface, int region) {
  std::set<std::uint32_t> vertices;
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  long faces = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& regions = surface.patches[surface.patch[t]].regions;
    if (regions[0] != region && regions[1] != region) continue;
    ++faces;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = surface.triangles[t][k], b = surface.triangles[t][(k + 1) % 3];
      vertices.insert(a);
      edges.insert(std::minmax(a, b));
    }
  }
  return static_cast<long>(vertices.size()) - static_cast<long>(edges.size()) + faces;
}

/// Whether the open segment from a to b passes through the inside of a triangle, by more than rounding: flat
/// faces are in one plane to rounding only.
bool passes_through(const Vector<3>& a, const Vector<3>& b, const std::array<Vector<3>, 3>& t) {
  const auto volume = [](const Vector<3>& p, const Vector<3>& q, const Vector<3>& r, const Vector<3>& s) {
    return (q - p).cross(r - p).dot(s - p);
  };
  const double above = volume(t[0], t[1], t[2], a), below = volume(t[0], t[1], t[2], b);
  const double reach =
      std::max({(t[1] - t[0]).norm(), (t[2] - t[0]).norm(), (a - t[0]).norm(), (b - t[0]).norm()});
  const double rounding = 4e-15 * reach * reach;
  if (above * below >= 0 || std::min(std::abs(above), std::abs(below)) < rounding) return false;
  const double x = volume(a, b, t[0], t[1]), y = volume(a, b, t[1], t[2]), z = volume(a, b, t[2], t[0]);
  return (x > 0 && y > 0 && z > 0) || (x < 0 && y < 0 && z < 0);
}

/// Pairs of an edge and a triangle without a common corner that cross, by a search in cells of their own.
std::size_t crossings(const ConformingSurface& surface) {
  double cell = 0;
  const auto corner = [&](std::size_t t, std::size_t k) -> const Vector<3>& {
    return surface.vertices[surface.triangles[t][k]];
  };
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) cell = std::max(cell, (corner(t, k) - corner(t, (k + 1) % 3)).norm());
  cell *= 0.3;
  std::map<std::array<int, 3>, std::vector<std::size_t>> cells;
  const auto for_cells = [&](std::size_t t, const auto& visit) {
    const Vector<3> lower = corner(t, 0).cwiseMin(corner(t, 1)).cwiseMin(corner(t, 2)) / cell;
    const Vector<3> upper = corner(t, 0).cwiseMax(corner(t, 1)).cwiseMax(corner(t, 2)) / cell;
    for (int x = static_cast<int>(std::floor(lower[0])); x <= upper[0]; ++x)
      for (int y = static_cast<int>(std::floor(lower[1])); y <= upper[1]; ++y)
        for (int z = static_cast<int>(std::floor(lower[2])); z <= upper[2]; ++z) visit(std::array{x, y, z});
  };
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    for_cells(t, [&](const std::array<int, 3>& at) { cells[at].push_back(t); });
  std::size_t found = 0;
  for (const auto& [at, in] : cells)
    for (const std::size_t s : in)
      for (const std::size_t t : in) {
        if (s == t) continue;
        const auto &one = surface.triangles[s], &other = surface.triangles[t];
        for (std::size_t k = 0; k < 3; ++k) {
          const std::uint32_t a = one[k], b = one[(k + 1) % 3];
          if (std::ranges::find(other, a) != other.end() || std::ranges::find(other, b) != other.end())
            continue;
          found += passes_through(surface.vertices[a], surface.vertices[b],
                                  {corner(t, 0), corner(t, 1), corner(t, 2)});
        }
      }
  return found;
}

void expect_sound(const ConformingSurface& surface, double volume_error) {
  EXPECT_EQ(open_edges(surface), 0u);
  EXPECT_EQ(crossings(surface), 0u);
  EXPECT_NEAR(surface.statement.meshed_fluid_volume, surface.statement.fluid_volume,
              volume_error * surface.statement.fluid_volume);
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const auto& [lower, upper] : surface.periodic[axis])
      for (int k = 0; k < 3; ++k)
        if (k != static_cast<int>(axis)) {
          ASSERT_EQ(surface.vertices[lower][k], surface.vertices[upper][k]);
        }
}

TEST(ConformingSurface, OneBallInABox) {
  Spheres<dynamic> spheres(3);
  spheres.push_back(Vector<3>(1.5, 1.4, 1.6), 1);
  const Solids solids = solids_in(spheres, Box{.size = Vector<3>(3, 3, 3)}, ContactTreatment::gap);
  double error_before = 0;
  for (const double edge : {0.3, 0.15}) {
    const ConformingSurface surface = conforming_surface(solids, {.sphere_edge = edge, .solids = true});
    expect_sound(surface, 0.02);
    EXPECT_EQ(euler_number(surface, 0), 4);  // two closed surfaces
    EXPECT_EQ(euler_number(surface, 1), 2);
    EXPECT_NEAR(surface.statement.fluid_volume, 27 - 4 * pi / 3, 1e-12);
    EXPECT_GT(surface.statement.least_angle, 25);
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
      if (surface.patches[surface.patch[t]].kind != SurfacePatch::Kind::sphere) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vector<3>&a = surface.vertices[surface.triangles[t][k]],
              &b = surface.vertices[surface.triangles[t][(k + 1) % 3]];
        EXPECT_NEAR((a - Vector<3>(1.5, 1.4, 1.6)).norm(), 1, 1e-14);
        EXPECT_LT((a - b).norm(), 1.25 * edge);
      }
    }
    const double error = surface.statement.meshed_fluid_volume - surface.statement.fluid_volume;
    EXPECT_GT(error, 0);  // balls are inscribed
    if (error_before > 0) {
      EXPECT_NEAR(error_before / error, 4, 1);
    }
    error_before = error;
  }
}

TEST(ConformingSurface, NecksJoinBallsAndWalls) {
  const Domain box = Box{.size = Vector<3>(4, 4, 4)};
  for (const bool with_solids : {false, true}) {
    const ConformingSurface surface =
        conforming_surface(solids_in(touching(), box, ContactTreatment::bridge), {.solids = with_solids});
    expect_sound(surface, 0.02);
    // Six contacts, three with the floor, two with the wall y = 0, one with x = 0 and one with x = 4.
    ASSERT_EQ(surface.necks.size(), 13u);
    EXPECT_NEAR(surface.statement.contact_area, 13 * pi * 0.04, 1e-12);
    const double depth = std::sqrt(1 - 0.04), cap = cap_volume(1, 1 - depth);
    const double between = pi * 0.04 * (2 - 2 * depth) - 2 * cap, at_wall = pi * 0.04 * (1 - depth) - cap;
    EXPECT_NEAR(surface.statement.fluid_volume, 64 - 16 * pi / 3 - 6 * between - 7 * at_wall, 1e-9);
    EXPECT_GT(surface.statement.least_angle, 18);
    EXPECT_GT(surface.statement.least_angle_off_necks, 20);
    EXPECT_EQ(surface.statement.shrunk_necks, 0u);
    EXPECT_EQ(surface.regions.size(), with_solids ? 1u + 4 + 13 : 1u);
    // One closed surface with a handle for each neck but three, by which balls hang together with the walls.
    EXPECT_EQ(euler_number(surface, 0), 2 - 2 * (13 - 4));
    for (int region = 1; with_solids && region < 18; ++region) EXPECT_EQ(euler_number(surface, region), 2);
  }
}

TEST(ConformingSurface, CapsAndGapsLeaveRoom) {
  const Domain box = Box{.size = Vector<3>(4, 4, 4)};
  for (const ContactTreatment contact :
       {ContactTreatment::gap, ContactTreatment::shrink, ContactTreatment::cap}) {
    const ConformingSurface surface =
        conforming_surface(solids_in(touching(), box, contact, 0.03), {.solids = true});
    expect_sound(surface, 0.02);
    EXPECT_EQ(euler_number(surface, 0), 2 + 4 * 2);
    EXPECT_GT(surface.statement.least_angle, 20);
  }
}

TEST(ConformingSurface, OppositeEndsAreTheSame) {
  for (const std::vector<bool>& walls : {std::vector<bool>{}, {true, false, false}, {true, true, false}}) {
    const Domain box = periodic_box(Vector<3>(3, 3.5, 4), walls);
    const Spheres<dynamic> spheres = scattered(box, 0.5, 2000, 7);
    ASSERT_GT(spheres.size(), 15u);
    for (const bool with_solids : {false, true})
      for (const ContactTreatment contact : {ContactTreatment::gap, ContactTreatment::cap}) {
        const ConformingSurface surface =
            conforming_surface(solids_in(spheres, box, contact, 0.03), {.solids = with_solids});
        expect_sound(surface, 0.03);
        for (std::size_t axis = 0; axis < 3; ++axis)
          EXPECT_EQ(surface.periodic[axis].empty(), !std::get<Box>(box).repeats(static_cast<int>(axis)));
      }
  }
}

/// Balls each of which touches one that is there already, in a random direction, and overlaps none.
Spheres<dynamic> clustered(const Domain& domain, double radius, int tries, unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  const Boundary<3> boundary = boundary_of<3>(domain);
  Spheres<dynamic> spheres(3);
  spheres.push_back(Vector<3>(0.3, 0.4, 0.5), radius);
  for (int t = 0; t < tries; ++t) {
    const Vector<3> direction = Vector<3>(normal(engine), normal(engine), normal(engine)).normalized();
    const auto at = std::uniform_int_distribution<std::size_t>(0, spheres.size() - 1)(engine);
    const Vector<3> p = boundary.wrap(Vector<3>(spheres.center(at)) + 2.001 * radius * direction);
    bool is_free = true;
    for (std::size_t j = 0; j < spheres.size() && is_free; ++j)
      is_free = boundary.minimum_image(p - spheres.center(j)).norm() > 2.0005 * radius;
    if (is_free) spheres.push_back(p, radius);
  }
  return spheres;
}

TEST(ConformingSurface, EndsOfPeriodsCutBridges) {
  for (const std::vector<bool>& walls : {std::vector<bool>{}, {false, false, true}})
    for (const bool with_solids : {false, true}) {
      const Domain box = periodic_box(Vector<3>(3, 3.3, 3.6), walls);
      Spheres<dynamic> spheres = clustered(box, 0.5, 3000, with_solids ? 2 : 1);
      if (!walls.empty())  // none at the walls, and none through them
        spheres = [&] {
          Spheres<dynamic> inside(3);
          for (std::size_t i = 0; i < spheres.size(); ++i)
            if (spheres.x[2][i] > 0.55 && spheres.x[2][i] < 3.05)
              inside.push_back(Vector<3>(spheres.center(i)), 0.5);
          return inside;
        }();
      const Solids solids = solids_in(spheres, box, ContactTreatment::bridge);
      ASSERT_GT(solids.contacts.pairs, 10u);
      double error_before = 0;
      for (const double edge : {0.3, 0.15}) {
        const ConformingSurface surface = conforming_surface(
            solids, {.sphere_edge = edge, .neck_edge = 0.5 * edge, .per_gap = 4, .solids = with_solids});
        expect_sound(surface, 0.04);
        EXPECT_EQ(surface.necks.size(), solids.contacts.pairs);
        // Sides of necks reach ends of periods, and the same places of both.
        std::array<std::set<std::pair<double, double>>, 6> cut_at;
        const Boundary<3> boundary = boundary_of<3>(solids.domain);
        for (std::size_t t = 0; t < surface.triangles.size(); ++t)
          if (surface.patches[surface.patch[t]].kind == SurfacePatch::Kind::neck)
            for (const std::uint32_t c : surface.triangles[t])
              for (int k = 0; k < 3; ++k) {
                if (!boundary.repeats(k)) continue;
                const Vector<3>& p = surface.vertices[c];
                const std::pair at{p[(k + 1) % 3], p[(k + 2) % 3]};
                if (p[k] == boundary.origin[k]) cut_at[static_cast<std::size_t>(2 * k)].insert(at);
                if (p[k] == boundary.origin[k] + boundary.edges[k])
                  cut_at[static_cast<std::size_t>(2 * k + 1)].insert(at);
              }
        for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_EQ(cut_at[2 * axis], cut_at[2 * axis + 1]);
        EXPECT_GE(cut_at[0].size() + cut_at[2].size() + cut_at[4].size(), 4u);
        // Necks and balls have their volume, in closed form, within what chords cut off.
        double stated = 3 * 3.3 * 3.6;
        for (const double r : solids.spheres.r) stated -= 4 * pi / 3 * r * r * r;
        for (const MeshedNeck& neck : surface.necks) {
          const double a = neck.radius, depth = std::sqrt(0.25 - a * a);
          stated -= pi * a * a * (1.001 - 2 * depth) - 2 * cap_volume(0.5, 0.5 - depth);
        }
        EXPECT_NEAR(surface.statement.fluid_volume, stated, 0.002);
        const double error = surface.statement.meshed_fluid_volume - surface.statement.fluid_volume;
        EXPECT_GT(error, 0);
        if (error_before > 0) {
          EXPECT_NEAR(error_before / error, 4, 1);
        }
        error_before = error;
      }
    }
}

/// What caps have, by their flat faces: of each sphere those of different depth or direction.
double volume_of_caps(const ConformingSurface& surface, const Solids& solids) {
  const Boundary<3> boundary = boundary_of<3>(solids.domain);
  std::map<std::array<long, 5>, double> of_cap;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const SurfacePatch& patch = surface.patches[surface.patch[t]];
    if (patch.kind != SurfacePatch::Kind::cut_face) continue;
    const auto corner = [&](std::size_t k) { return surface.vertices[surface.triangles[t][k]]; };
    const Vector<3> normal = (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
    const double r = solids.spheres.r[patch.index];
    const double depth = normal.dot(boundary.minimum_image(corner(0) - solids.spheres.center(patch.index)));
    const auto rounded = [](double x) { return std::lround(x * 1e4); };
    of_cap[{patch.index, rounded(depth), rounded(normal[0]), rounded(normal[1]), rounded(normal[2])}] =
        cap_volume(r, r - depth);
  }
  double sum = 0;
  for (const auto& [cap, volume] : of_cap) sum += volume;
  return sum;
}

TEST(ConformingSurface, CapsAreDeeperWhereEndsWouldNearlyTouchThem) {
  const Domain box = periodic_box(Vector<3>(3, 3.3, 3.6));
  const Solids solids = solids_in(clustered(box, 0.5, 3000, 1), box, ContactTreatment::cap);
  for (const bool with_solids : {false, true}) {
    const ConformingSurface surface = conforming_surface(solids, {.per_gap = 4, .solids = with_solids});
    expect_sound(surface, 0.04);
    EXPECT_GT(surface.statement.deepened_caps, 0u);
    EXPECT_LT(surface.statement.deepened_caps, solids.contacts.pairs);
    EXPECT_GT(surface.statement.contact_area, solids.contacts.contact_area);
    EXPECT_NEAR(surface.statement.fluid_volume,
                3 * 3.3 * 3.6 - volume_of_balls(solids.spheres) + volume_of_caps(surface, solids), 1e-6);
  }
}

TEST(ConformingSurface, CylindersHaveRoundSides) {
  for (const bool is_periodic : {false, true}) {
    const Cylinder cylinder{.radius = 2, .height = 4, .periodic = is_periodic};
    Spheres<dynamic> spheres = scattered(cylinder, 0.5, 2000, 3);
    if (!is_periodic) {  // one that touches the side, one the floor
      spheres = Spheres<dynamic>(3);
      spheres.push_back(Vector<3>(1.5, 0, 2), 0.5);
      spheres.push_back(Vector<3>(0.1, 0.2, 0.5), 0.5);
    }
    const ConformingSurface surface = conforming_surface(
        solids_in(spheres, cylinder, is_periodic ? ContactTreatment::gap : ContactTreatment::bridge),
        {.solids = true});
    expect_sound(surface, 0.03);
    EXPECT_EQ(surface.necks.size(), is_periodic ? 0u : 2u);
  }
}

TEST(ConformingSurface, EndsOfPeriodsGoPastBridgesOnWalls) {
  const Cylinder cylinder{.radius = 2, .height = 4, .periodic = true};
  Spheres<dynamic> spheres(3);  // a spiral at the side, whose first ball is at the end of the period
  for (int k = 0; k < 8; ++k) {
    const double angle = 2 * pi * k / 8;
    spheres.push_back(Vector<3>(1.5 * std::cos(angle), 1.5 * std::sin(angle), 0.45 * k), 0.5);
  }
  const Solids solids = solids_in(spheres, cylinder, ContactTreatment::bridge);
  const Boundary<3> boundary = boundary_of<3>(solids.domain);
  for (const double z : solids.spheres.x[2]) {
    const double from = (z - boundary.origin[2]) / 4;
    EXPECT_GT(4 * std::abs(from - std::nearbyint(from)), 0.1);
  }
  const ConformingSurface surface = conforming_surface(solids, {.solids = true});
  expect_sound(surface, 0.03);
  EXPECT_EQ(std::ranges::count_if(surface.necks, [](const MeshedNeck& neck) { return !neck.other; }), 8);
}

TEST(ConformingSurface, BallsInABall) {
  const Sphere container{.radius = 2};
  Spheres<dynamic> spheres(3);
  for (const Vector<3>& c : {Vector<3>(1.5, 0, 0), Vector<3>(0.5, 0, 0), Vector<3>(0, 0.2, -1.2)})
    spheres.push_back(c, 0.5);
  for (const ContactTreatment contact : {ContactTreatment::gap, ContactTreatment::bridge}) {
    const ConformingSurface surface =
        conforming_surface(solids_in(spheres, container, contact), {.solids = true});
    expect_sound(surface, 0.02);
    EXPECT_EQ(surface.necks.size(), contact == ContactTreatment::bridge ? 2u : 0u);
    EXPECT_EQ(euler_number(surface, 0), contact == ContactTreatment::bridge ? 4 : 8);
    EXPECT_GT(surface.statement.least_angle, 18);
  }
}

/// Volumes of all regions: what walls enclose.
double volume_of_regions(const ConformingSurface& surface) {
  double sum = 0;
  for (const double volume : volumes_between(surface)) sum += volume;
  return sum;
}

TEST(ConformingSurface, ABoxOfTrianglesIsABox) {
  const Domain box = Box{.size = Vector<3>(4, 4, 4)};
  const Mesh mesh = mesh_of_box(bounds_of(box));
  for (const ContactTreatment contact :
       {ContactTreatment::bridge, ContactTreatment::gap, ContactTreatment::cap}) {
    const double gap = contact == ContactTreatment::bridge ? 0.01 : 0.03;
    const ConformingSurface wanted =
        conforming_surface(solids_in(touching(), box, contact, gap), {.solids = true});
    const ConformingSurface surface =
        conforming_surface(solids_in(touching(), mesh, contact, gap), {.solids = true});
    expect_sound(surface, 0.02);
    EXPECT_EQ(surface.necks.size(), wanted.necks.size());
    EXPECT_NEAR(surface.statement.fluid_volume, wanted.statement.fluid_volume, 1e-9);
    EXPECT_NEAR(surface.statement.contact_area, wanted.statement.contact_area, 1e-9);
    EXPECT_NEAR(volume_of_regions(surface), 64, 1e-11);
    EXPECT_GT(surface.statement.least_angle, 18);
    EXPECT_EQ(euler_number(surface, 0), euler_number(wanted, 0));
  }
}

TEST(ConformingSurface, CadPartsKeepTheirVolume) {
  // A drum of 24 flat sides with a bore, whose sides are narrow, and a block in it that touches nothing.
  const Revolved drum{.profile = {{0.4, 0}, {2.5, 0}, {2.5, 3}, {0.4, 3}}};
  Mesh part = surface_of(drum, 24);
  Mesh block = mesh_of_box({Vector<3>(1, -0.5, 0.2), Vector<3>(1.8, 0.4, 0.21)});
  turn_inside_out(block);
  append(part, block);
  Spheres<dynamic> spheres(3);
  spheres.push_back(Vector<3>(-1.2, 0.3, 0.5), 0.5);   // on the floor
  spheres.push_back(Vector<3>(-1.2, 0.3, 1.5), 0.5);   // on that
  spheres.push_back(Vector<3>(1.4, -0.1, 0.71), 0.5);  // on the block
  const double side = 2.5 * std::cos(pi / 24) - 0.5;   // at the middle of a side, and at an edge of the bore
  spheres.push_back(Vector<3>(side * std::cos(9 * pi / 24), side * std::sin(9 * pi / 24), 1.5), 0.5);
  spheres.push_back(Vector<3>(0, -0.9, 1.5), 0.5);
  for (const ContactTreatment contact : {ContactTreatment::bridge, ContactTreatment::gap}) {
    const SolidsInWalls made =
        solids_in_walls(spheres, part, {.contact = contact, .gap = 0.03, .bridge_radius = 0.2}, 0.15);
    const ConformingSurface surface = conforming_surface(made.solids, {.solids = true});
    expect_sound(surface, 0.02);
    EXPECT_NEAR(volume_of_regions(surface), volume_of(Domain(part)), 1e-11);
    EXPECT_GT(surface.statement.least_angle, 15);
    if (contact == ContactTreatment::bridge) {
      EXPECT_EQ(made.gaps_at_edges, 1u);
      EXPECT_EQ(surface.necks.size(), 4u);
    }
    // In the fluid alone, each ball and the block are holes.
    const ConformingSurface fluid = conforming_surface(made.solids, {});
    expect_sound(fluid, 0.02);
    const std::vector<Vector<3>> holes = points_of_holes(fluid);
    const auto in_block = [](const Vector<3>& p) {
      return p[0] > 1 && p[0] < 1.8 && p[1] > -0.5 && p[1] < 0.4 && p[2] > 0.2 && p[2] < 0.21;
    };
    EXPECT_TRUE(contact == ContactTreatment::bridge || std::ranges::any_of(holes, in_block));
  }
}

TEST(ConformingSurface, IsTheSameInAllThreads) {
  const Domain box = periodic_box(Vector<3>(3, 3, 3));
  const Solids solids = solids_in(scattered(box, 0.5, 500, 1), box, ContactTreatment::gap);
  const auto made_in = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return conforming_surface(solids, {});
  };
  const ConformingSurface one = made_in(1), other = made_in(3);
  EXPECT_EQ(one.triangles, other.triangles);
  EXPECT_EQ(one.vertices, other.vertices);
}

TEST(ConformingSurface, OtherDomainsAreRefused) {
  Spheres<dynamic> spheres(3);
  spheres.push_back(Vector<3>(0, 0, 0), 0.5);
  const Revolved drum{.profile = {{0, -2}, {2, -2}, {2, 2}, {0, 2}}};
  EXPECT_THROW(conforming_surface(solids_in(spheres, drum, ContactTreatment::none), {}), Error);
  const Solids solids = solids_in(spheres, Sphere{.radius = 2}, ContactTreatment::none);
  EXPECT_THROW(conforming_surface(solids, {.sphere_edge = 0}), Error);
}

}  // namespace conforming_surface_test
}  // namespace bernal
