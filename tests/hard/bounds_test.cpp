// What looked for ever: containers that fill next to nothing of their bounds or are a million times as long
// as wide, solids without number, sizes far apart, spheres larger than their box. All end quickly, with a
// certified packing or with one line. No test here is timed: one that hangs meets ctest's limit.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "bernal/cad/mesh_container.hpp"
#include "bernal/cad/read_mesh.hpp"
#include "bernal/core/error.hpp"
#include "bernal/core/random.hpp"
#include "bernal/measure/measure.hpp"
#include "bernal/run/run.hpp"
#include "bernal/verify/certificate.hpp"
#include "core/parallel.hpp"
#include "domain/places.hpp"
#include "support/folder.hpp"
#include "support/meshes.hpp"
#include "support/plans.hpp"

namespace bernal {
namespace bounds_test {

using namespace test;
using testing::plan_of;

const std::string compressed =
    "[[stage]]\ndo = \"insert\"\n[[stage]]\ndo = \"compress\"\n"
    "[[stage]]\ndo = \"shake\"\n[[stage]]\ndo = \"refill\"\n";

Packing certified(const Plan& plan) {
  Packing packing = run(plan, {});
  const Certificate certificate = certify(packing.spheres, packing.domain);
  EXPECT_TRUE(certificate.certified) << certificate.statement;
  EXPECT_GT(packing.spheres.size(), 0u);
  return packing;
}

Packing packed(Domain container, const std::string& spheres, const std::string& stages = "") {
  const std::string scene =
      "[container]\nkind = \"sphere\"\nradius = 1.0\n[spheres]\n" + spheres + "\n" + stages;
  return certified(plan_of(scene, std::move(container)));
}

Mesh row_of_boxes(int count, const Vector<3>& step) {
  Mesh mesh;
  for (int i = 0; i < count; ++i) append(mesh, box_mesh(i * step, {1, 1, 1}));
  return mesh;
}

std::size_t beyond_the_middle(const Packing& packing) {
  const double middle = bounds_of(packing.domain).center()[0];
  return static_cast<std::size_t>(
      std::ranges::count_if(packing.spheres.x[0], [&](double x) { return x > middle; }));
}

TEST(HardBounds, TwoCubesAHundredEdgesApart) {
  for (const std::string& stages : {std::string(), compressed}) {
    for (const char* sizes :
         {"diameter = 0.2", "diameter = { distribution = \"lognormal\", median = 0.15, sigma = 0.3 }"}) {
      const Packing packing = packed(cubes_apart(100), sizes, stages);
      EXPECT_GT(packing.spheres.size(), 150u) << stages;
      EXPECT_GT(beyond_the_middle(packing), packing.spheres.size() / 3);
    }
  }
}

TEST(HardBounds, DiagonalPipeFiveHundredTimesAsLongAsWide) {
  const Packing packing = packed(turned(prism_mesh(8, 1, 1000), {1, 1, 1}), "diameter = 1.6");
  EXPECT_GT(packing.spheres.size(), 400u);
  EXPECT_GT(packed(Cylinder{.axis = {1, 1, 1}, .radius = 1, .height = 1000}, "count = 500\ndiameter = 0.5")
                .spheres.size(),
            499u);
}

TEST(HardBounds, PlacesInADiagonalPipe) {
  const Cylinder pipe{.axis = {1, 1, 1}, .radius = 1, .height = 1000};
  const Frame frame = frame_of(pipe);
  const auto container = make_local_container(pipe, frame, WallArithmetic::plain);
  ASSERT_FALSE(fills_its_bounds(*container));
  const Places places(*container);
  EXPECT_LT(places.volume(), 4 * container->volume());
  const std::vector<Vector<3>> inside = points_inside(*container, 3000, 1, {});
  ASSERT_EQ(inside.size(), 3000u);
  // Uniform: the mean along the axis and the mean square of the distance from it, half of that of the wall,
  // to five standard errors.
  double along = 0, squares = 0;
  const Vector<3> axis = Vector<3>::Ones().normalized();
  for (const Vector<3>& p : inside) {
    const Vector<3> q = frame.to_scene(p);
    EXPECT_TRUE(container->contains(p, 0));
    along += q.dot(axis) / 3000;
    squares += (q - q.dot(axis) * axis).squaredNorm() / 3000;
  }
  EXPECT_NEAR(along, 500, 5 * 1000 / std::sqrt(12 * 3000.));
  EXPECT_NEAR(squares, 0.5, 5 * std::sqrt(1 / (12 * 3000.)));
}

TEST(HardBounds, PlacesInAPlateTooThinAndOblique) {
  const Mesh plate = turned(box_mesh({0, 0, 0}, {1e8, 1e8, 1}), {1, 2, 3});
  const auto container = make_local_container(plate, frame_of(plate), WallArithmetic::plain);
  EXPECT_LT(points_inside(*container, 100, 1, {}).size(), 100u);
  EXPECT_THROW(plan_of("[container]\nkind = \"box\"\nsize = [9, 9, 9]\n[spheres]\ndiameter = 0.9\n", plate),
               Error);
}

TEST(HardBounds, RodsAndPlatesOfAnyKind) {
  const std::string spheres = "count = 20\ndiameter = 0.9";
  for (const double aspect : {1e6, 1e8}) {
    SCOPED_TRACE(aspect);
    for (const Vector<3>& size : {Vector<3>(1, 1, aspect), Vector<3>(aspect, aspect, 1)}) {
      EXPECT_EQ(packed(box_mesh({0, 0, 0}, size), spheres).spheres.size(), 20u);
      EXPECT_EQ(packed(Box{Vector<3>::Zero(), size}, spheres).spheres.size(), 20u);
    }
    EXPECT_EQ(packed(Cylinder{.radius = 0.5, .height = aspect}, spheres).spheres.size(), 20u);
    EXPECT_EQ(packed(Cylinder{.radius = aspect, .height = 1}, spheres).spheres.size(), 20u);
  }
}

TEST(HardBounds, WhatFillsAPlateIsRefusedBeforeItIsDrawn) {
  for (const char* container :
       {"kind = \"box\"\nsize = [1e8, 1e8, 1]\n", "kind = \"cylinder\"\nradius = 1e8\nheight = 1\n"})
    EXPECT_THROW(run(plan_of(std::string("[container]\n") + container + "[spheres]\ndiameter = 0.9\n")),
                 Error)
        << container;
}

TEST(HardBounds, ChambersOfNeedlesAndPlates) {
  const auto elongated = [](double arms, double height) {
    Mesh mesh = l_shape_mesh(height);
    for (Vector<3>& v : mesh.vertices) v = Vector<3>(arms * v[0], arms * v[1], v[2]);
    return mesh;
  };
  EXPECT_LE(chambers_for(elongated(1, 1e6), 0.4).chambers.size(), 1u);  // much thinner than the finest cell
  EXPECT_EQ(chambers_for(elongated(1e6, 1), 0.4).chambers.size(), 1u);
  EXPECT_EQ(chambers_for(box_mesh({0, 0, 0}, {1, 1, 1e6}), 0.4).chambers.size(), 1u);
  // In bounds of 10^6 times 10^6 both rods are thinner than the finest cell.
  EXPECT_LE(chambers_for(joined(elongated(1e6, 1), box_mesh({0, 0, 2}, {1, 1, 1e6})), 0.4).chambers.size(),
            2u);
  EXPECT_TRUE(chambers_for(elongated(1e6, 1), 0.6).chambers.empty());
}

class HardBoundsOfSolids : public ::testing::Test {
 protected:
  Mesh read(const Mesh& mesh) {
    const ImportedMesh imported = read_mesh({.file = folder.write("mesh.off", as_off(mesh))});
    EXPECT_TRUE(imported.report.usable());
    components = imported.report.components;
    return imported.mesh;
  }
  bernal::testing::Folder folder;
  std::uint64_t components = 0;
};

TEST_F(HardBoundsOfSolids, FiveThousandInARow) {
  // Seen along the row, each is in front of all others.
  for (const Vector<3>& step :
       {Vector<3>(2, 0, 0), Vector<3>(0, 2, 0), Vector<3>(0, 0, 2), Vector<3>(2, 2, 2)}) {
    const Mesh row = read(row_of_boxes(5000, step));
    EXPECT_EQ(components, 5000u);
    EXPECT_NEAR(volume_of(row), 5000, 1e-6);
  }
  EXPECT_EQ(packed(row_of_boxes(5000, {2, 0, 0}), "count = 1000\ndiameter = 0.5").spheres.size(), 1000u);
}

TEST(HardBounds, SizesOfOneToAHundred) {
  const std::string sizes =
      "diameter = { distribution = \"classes\", values = [1.0, 0.01], shares = [0.0002, 0.9998] }\n";
  for (const char* container :
       {"kind = \"box\"\nsize = [3, 3, 3]\n", "kind = \"periodic\"\nsize = [3, 3, 3]\n"})
    EXPECT_EQ(
        certified(plan_of(std::string("[container]\n") + container + "[spheres]\ncount = 30000\n" + sizes))
            .spheres.size(),
        30000u);
}

TEST(HardBounds, SpheresAMillionTimesAsLargeAsTheirBox) {
  Spheres<dynamic> spheres(3);
  spheres.push_back(Vector<3>(0.5, 0.5, 0.5), 1e6);
  spheres.push_back(Vector<3>(0.1, 0.5, 0.5), 0.1);
  const Domain box = periodic_box(Vector<3>::Ones());
  EXPECT_FALSE(certify(spheres, box).certified);
  EXPECT_THROW(measure(spheres, box), Error);
}

TEST(HardBounds, EdgesOfAHundredBillionthOfABillionth) {
  for (const char* size : {"[1e-20, 1e-20, 1e-20]", "[1e-20, 1, 1]"})
    for (const char* kind : {"box", "periodic"}) {
      const std::string scene = std::string("[container]\nkind = \"") + kind + "\"\nsize = " + size + "\n";
      EXPECT_THROW(run(plan_of(scene + "[spheres]\ncount = 10\nradius = 0.1\n")), Error) << scene;
    }
  for (const char* kind : {"box", "periodic"})
    EXPECT_EQ(certified(plan_of(std::string("[container]\nkind = \"") + kind +
                                "\"\nsize = [1e-20, 1e-20, 1e-20]\n[spheres]\ncount = 10\nradius = 1e-21\n"))
                  .spheres.size(),
              10u);
}

TEST(HardBounds, FewSpheresInAFineSphereAndAFinePrism) {
  EXPECT_GT(packed(icosphere_mesh(1, 6), "diameter = 0.3").spheres.size(), 150u);
  EXPECT_GT(packed(prism_mesh(2000, 1, 2), "diameter = 0.31").spheres.size(), 200u);
}

TEST(HardBounds, AFineMeshIsMadeReadyOnce) {
  const std::string sizes = "diameter = 0.3\n";
  const Plan plan =
      plan_of("[container]\nkind = \"sphere\"\nradius = 1.0\n[spheres]\n" + sizes, icosphere_mesh(1, 7));
  ASSERT_TRUE(plan.container);
  const Packing packing = certified(plan);
  EXPECT_EQ(packing.container, plan.container);
  EXPECT_GT(packing.spheres.size(), 150u);
  MeasureOptions options;
  options.walls.work = 1e4;
  options.container = packing.container;
  const Measurements shared = measure(packing.spheres, packing.domain, {}, options);
  EXPECT_TRUE(shared.walls && shared.chambers);
  EXPECT_EQ(shared.chambers->chambers.size(), 1u);
  EXPECT_GT(shared.contacts.walls, 20u);
}

/// n³ cubes of edge 1, a quarter of that apart.
Mesh lattice_of_cubes(int n) {
  Mesh mesh;
  for (int i = 0; i < n * n * n; ++i) {
    const Mesh box = box_mesh(1.25 * Vector<3>(i % n, i / n % n, i / (n * n)), {1, 1, 1});
    const std::uint32_t first = index(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), box.vertices.begin(), box.vertices.end());
    for (const auto& [a, b, c] : box.triangles) mesh.triangles.push_back({first + a, first + b, first + c});
  }
  return mesh;
}

TEST_F(HardBoundsOfSolids, TenThousandOnALattice) {
  constexpr int n = 22;
  const Mesh mesh = read(lattice_of_cubes(n));
  EXPECT_EQ(components, 10648u);
  const Packing packing = packed(mesh, "count = 300\ndiameter = 0.8");
  EXPECT_EQ(packing.spheres.size(), 300u);
  // Cubes so small that no cell of a coarse field is all inside or all outside of them.
  const auto container = make_container(mesh, WallArithmetic::plain, 0x1p-50);
  Random random(1, stream(Stream::test));
  const auto depth = [](double x) { return std::min(x - 1.25 * std::floor(x / 1.25), 1.0); };
  for (int k = 0; k < 20000; ++k) {
    const Vector<3> p = uniform_point<3>(random, container->bounds());
    bool inside = true;
    for (const double x : p) inside = inside && depth(x) < 1;
    EXPECT_EQ(container->contains(p, 0), inside) << p.transpose();
    EXPECT_EQ(container->clearance(p) > 0, inside) << p.transpose();
  }
}

/// Says stop at the n-th question.
Monitor stopping_at(int n) {
  return {{}, [n, asked = std::make_shared<int>(0)] { return ++*asked >= n; }};
}

TEST_F(HardBoundsOfSolids, DiagnosisHearsAnInterrupt) {
  const auto file = folder.write("row.off", as_off(row_of_boxes(3000, {2, 0, 0})));
  const Monitor monitor = stopping_at(100);
  const Interruptible listening(monitor);
  EXPECT_THROW(read_mesh({.file = file}), Cancelled);
}

TEST(HardBounds, AnInterruptBeforeTheFirstSphereIsAResult) {
  const Plan plan =
      plan_of("[container]\nkind = \"box\"\nsize = [9, 9, 9]\n[spheres]\ncount = 30000\nradius = 0.05\n");
  RunOptions options;
  options.monitor = stopping_at(1);
  const Packing packing = run(plan, options);
  EXPECT_EQ(packing.outcome, Outcome::cancelled);
  EXPECT_TRUE(packing.spheres.empty());
}

TEST(HardBounds, MeasuringLeavesOutWhatItWasStoppedIn) {
  const Packing packing = packed(l_shape_mesh(), "count = 50\ndiameter = 0.2");
  MeasureOptions options;
  options.monitor.cancelled = [] { return true; };
  const Measurements measured = measure(packing.spheres, packing.domain, {}, options);
  EXPECT_FALSE(measured.chambers || measured.walls || measured.order);
  EXPECT_GT(measured.packing_fraction, 0);
}

}  // namespace bounds_test
}  // namespace bernal
