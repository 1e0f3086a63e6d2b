#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "bernal/core/boundary.hpp"
#include "bernal/core/error.hpp"
#include "bernal/core/random.hpp"
#include "bernal/measure/contacts.hpp"
#include "bernal/run/run.hpp"
#include "bernal/verify/certificate.hpp"
#include "near/point_grid.hpp"
#include "soft/neighbor_relaxation.hpp"
#include "support/packing_oracle.hpp"
#include "support/plans.hpp"
#include "support/tilted_cells.hpp"
#include "work/free_of_overlap.hpp"

// Tilted periodic boxes against all images, from the cell vectors by their definition.
namespace bernal {
namespace tilted_box_test {

using oracle::Rational;
using testing::tilted::Cell;
using testing::tilted::cells;
using testing::tilted::random_spheres;

double up(double x) { return std::nextafter(x, std::numeric_limits<double>::infinity()); }
double down(double x) { return std::nextafter(x, -std::numeric_limits<double>::infinity()); }

TEST(TiltedBoundary, WrapsIntoTheBrickByCellVectors) {
  Random random(1, stream(Stream::test));
  for (const Cell& cell : cells) {
    const TiltedBoundary<3> boundary = cell.boundary();
    for (int k = 0; k < 200; ++k) {
      const Vector<3> p = 5 * (uniform_point(random, Bounds<3>{-cell.edges, cell.edges}));
      const Vector<3> wrapped = boundary.wrap(p);
      EXPECT_TRUE((wrapped.array() >= 0).all() && (wrapped.array() < cell.edges.array()).all());
      const Vector<3> turns = boundary.in_cell_vectors(p) - boundary.in_cell_vectors(wrapped);
      EXPECT_LT((turns - turns.array().round().matrix()).norm(), 1e-12);
    }
    // Through the end of the last axis, by rounding.
    const Vector<3> below(0.1, 0.2, -1e-17);
    const Vector<3> same = boundary.wrap(below);
    EXPECT_EQ(same[2], 0);
    EXPECT_LT((same - Vector<3>(0.1, 0.2, 0)).norm(), 1e-15);
  }
}

TEST(TiltedBoundary, VisitsAllImagesWithinReach) {
  Random random(2, stream(Stream::test));
  for (const Cell& cell : cells) {
    const TiltedBoundary<3> boundary = cell.boundary();
    for (const double reach : {0.1, 0.5, 1.0}) {
      const Vector<3> d = uniform_point(random, Bounds<3>{-0.5 * cell.edges, 0.5 * cell.edges});
      std::multiset<long> found, expected;
      const auto key = [](const Vector<3>& image) { return std::lround(1e9 * image.norm()); };
      boundary.for_each_image(d, reach, [&](const Vector<3>& image) {
        if (image.norm() < reach) found.insert(key(image));
      });
      cell.for_each_image([&](int a, int b, int c) {
        if (const Vector<3> image = d + cell.at(a, b, c); image.norm() < reach) expected.insert(key(image));
      });
      EXPECT_EQ(found, expected);
    }
    double shortest = 1e9;
    cell.for_each_image([&](int a, int b, int c) {
      if (a != 0 || b != 0 || c != 0) shortest = std::min(shortest, cell.at(a, b, c).norm());
    });
    EXPECT_NEAR(boundary.shortest_period(), shortest, 1e-12);
    EXPECT_EQ(shortest_period(cell.box()), boundary.shortest_period());
  }
}

TEST(TiltedBoundary, PointGridVisitsEveryImageOnce) {
  for (const Cell& cell : cells) {
    const Spheres<3> points = random_spheres(cell, 60, 0.1, 0.1, 3);
    for (const double reach : {0.05, 0.3, 0.9}) {
      const PointGrid<3> grid(points, cell.boundary(), reach);
      for (const Vector<3>& share :
           {Vector<3>(0, 0, 0), Vector<3>(0.99, 0.5, 0.999), Vector<3>(0.3, 0.01, 0.6)}) {
        const Vector<3> c = share.cwiseProduct(cell.edges);
        std::multiset<std::pair<std::uint32_t, long>> found, expected;
        grid.for_each_near(c, reach, [&](std::uint32_t id, const Vector<3>& d) {
          if (d.norm() < reach) found.insert({id, std::lround(1e9 * d.norm())});
        });
        for (std::uint32_t i = 0; i < points.size(); ++i)
          cell.for_each_image([&](int x, int y, int z) {
            const double d = (points.center(i) - c + cell.at(x, y, z)).norm();
            if (d < reach) expected.insert({i, std::lround(1e9 * d)});
          });
        EXPECT_EQ(found, expected);
      }
    }
  }
}

/// Whether any two images overlap; in rational numbers where doubles do not tell.
bool overlaps(const Spheres<dynamic>& s, const Cell& cell) {
  constexpr double surely = 1e-9;
  const auto square_of = [](const Rational& x) { return Rational(x * x); };
  bool any = false;
  for (std::size_t i = 0; i < s.size(); ++i)
    for (std::size_t j = i; j < s.size(); ++j)
      cell.for_each_image([&](int a, int b, int c) {
        if (any || (i == j && a == 0 && b == 0 && c == 0)) return;
        const Vector<3> apart = Vector<3>(s.center(i)) - Vector<3>(s.center(j)) + cell.at(a, b, c);
        const double gap = apart.norm() - s.r[i] - s.r[j];
        if (std::abs(gap) > surely) {
          any = gap < 0;
          return;
        }
        const auto at = [&](std::size_t k) { return Rational(s.x[k][i]) - Rational(s.x[k][j]); };
        const auto& [xy, xz, yz] = cell.tilt;
        const Rational x = at(0) + a * Rational(cell.edges[0]) + b * Rational(xy) + c * Rational(xz);
        const Rational y = at(1) + b * Rational(cell.edges[1]) + c * Rational(yz);
        const Rational z = at(2) + c * Rational(cell.edges[2]);
        const Rational sum = Rational(s.r[i]) + Rational(s.r[j]);
        any = square_of(x) + square_of(y) + square_of(z) < square_of(sum);
      });
  return any;
}

/// The least (d - ri - rj) / (ri + rj) of all images.
double least_gap_ratio(const Spheres<dynamic>& s, const Cell& cell) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < s.size(); ++i)
    for (std::size_t j = i; j < s.size(); ++j)
      cell.for_each_image([&](int a, int b, int c) {
        if (i == j && a == 0 && b == 0 && c == 0) return;
        const Vector<3> apart = Vector<3>(s.center(i)) - Vector<3>(s.center(j)) + cell.at(a, b, c);
        least = std::min(least, apart.norm() / (s.r[i] + s.r[j]) - 1);
      });
  return least;
}

Certificate certificate(const Spheres<dynamic>& s, const Cell& cell) {
  const Certificate filtered = certify(s, cell.box());
  const Certificate exact = certify(s, cell.box(), {.arithmetic = Arithmetic::exact});
  EXPECT_EQ(filtered.certified, exact.certified);
  EXPECT_EQ(filtered.overlapping_pairs, exact.overlapping_pairs);
  EXPECT_EQ(filtered.max_overlap, exact.max_overlap);
  EXPECT_EQ(exact.decided_double, 0u);
  return filtered;
}

TEST(TiltedCertificate, SaysWhatAllImagesSay) {
  int certified = 0, refused = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed)
    for (const Cell& cell : cells)
      for (const double r : {0.0005, 0.02, 0.08, 0.2, 0.45}) {
        const std::size_t count = r > 0.3 ? 1 : r > 0.1 ? 3 : r > 0.01 ? 8 : 40;
        Spheres<dynamic> s(random_spheres(cell, count, 0.8 * r, r, seed));
        // Far from the box: centres are judged as they stand.
        const Spheres<dynamic> inside = s;
        s.set_center(0, s.center(0) + cell.at(3, -2, static_cast<int>(seed) - 4));
        const Certificate c = certificate(s, cell);
        EXPECT_EQ(c.certified, !overlaps(inside, cell)) << c.statement;
        const double ratio = least_gap_ratio(inside, cell);
        EXPECT_NEAR(-c.max_overlap, ratio, 1e-14 * (1 + ratio + 20 / r)) << c.statement;
        ++(c.certified ? certified : refused);
      }
  EXPECT_GT(certified, 20);
  EXPECT_GT(refused, 20);
}

TEST(TiltedCertificate, DecidesTouchesAcrossTiltedFacesByAnUlp) {
  // Across the upper face along z the offsets are 2, 3 and 6, the distance 7.
  const Cell cell{{16, 16, 16}, {4, -2, 6}, 2};
  Spheres<dynamic> pair(3);
  pair.push_back(Vector<3>(5, 4, 15), 3);
  // The image of (x, y, z) above is (x - 2, y + 6, z + 16).
  pair.push_back(Vector<3>(5 + 2 + 2, 4 + 3 - 6, 15 + 6 - 16), 4);
  EXPECT_TRUE(certificate(pair, cell).certified);
  EXPECT_EQ(certificate(pair, cell).max_overlap, 0);
  for (const std::size_t i : {0, 1}) {
    Spheres<dynamic> swollen = pair;
    swollen.r[i] = up(pair.r[i]);
    const Certificate c = certificate(swollen, cell);
    EXPECT_FALSE(c.certified);
    EXPECT_EQ(c.overlapping_pairs, 1u);
    EXPECT_EQ(c.worst_pair, (std::array<std::uint64_t, 2>{0, 1}));
    swollen.r[i] = down(pair.r[i]);
    EXPECT_TRUE(certificate(swollen, cell).certified);
  }
  Cell narrower = cell;
  narrower.tilt[1] = down(-2);  // moves the image by an ulp away from the other's side
  Cell wider = cell;
  wider.tilt[1] = up(-2);
  EXPECT_NE(certificate(pair, narrower).certified, certificate(pair, wider).certified);
}

TEST(TiltedCertificate, OfASphereAndItsOwnImages) {
  // b - a = (-3, 4, 0) is the shortest cell vector, 5.
  const Cell cell{{9, 4, 20}, {6, 0, 0}, 3};
  Spheres<dynamic> one(3);
  one.push_back(Vector<3>(1, 1, 1), 2.5);
  EXPECT_TRUE(certificate(one, cell).certified);
  one.r[0] = up(2.5);
  const Certificate c = certificate(one, cell);
  EXPECT_FALSE(c.certified);
  EXPECT_EQ(c.worst_pair, (std::array<std::uint64_t, 2>{0, 0}));
  one.r[0] = 1e6;  // larger than its box by far
  EXPECT_FALSE(certificate(one, cell).certified);
}

TEST(TiltedCertificate, FaceCentredCubicInItsPrimitiveCell) {
  const double edge = 2 * (1 + 1e-14);
  const Cell cell{{edge, edge * std::sqrt(0.75), edge * std::sqrt(2.0 / 3)},
                  {edge / 2, edge / 2, edge * std::sqrt(1.0 / 12)},
                  2};
  Spheres<dynamic> one(3);
  one.push_back(Vector<3>(0.3, 0.2, 0.1), 1);
  const Certificate c = certificate(one, cell);
  EXPECT_TRUE(c.certified) << c.statement;
  EXPECT_NEAR(packing_fraction(one, cell.box()), std::numbers::pi / std::sqrt(18.0), 1e-12);
  const Contacts contacts = measure_contacts(one, cell.box(), 1e-10);
  EXPECT_EQ(contacts.pairs, 6u);  // twelve neighbours
  one.r[0] = 1 + 1e-13;
  EXPECT_FALSE(certificate(one, cell).certified);
}

TEST(TiltedCertificate, RefusesWhatIsNoTiltedBox) {
  Spheres<dynamic> one(3);
  one.push_back(Vector<3>(0.3, 0.2, 0.1), 0.1);
  Box walled = periodic_box(Vector<3>(1, 1, 1), {false, false, true}, {0.5, 0, 0});
  EXPECT_THROW(certify(one, walled), Error);
  EXPECT_THROW(certify(one, periodic_box(Vector<3>(1e4, 1, 1), {}, {0.5, 0, 0})), Error);
  one.set_center(0, Vector<3>(1e9, 0, 0));
  EXPECT_THROW(certify(one, periodic_box(Vector<3>(1, 1, 1), {}, {0.5, 0, 0})), Error);
}

TEST(TiltedBox, OthersRefuseIt) {
  const Domain domain = cells[0].box();
  EXPECT_THROW(boundary_of<3>(domain), Error);
  EXPECT_THROW(boundary_in_space(domain), Error);
  EXPECT_EQ(name_of(domain), "tilted periodic box");
  EXPECT_EQ(volume_of(domain), 1);
}

TEST(TiltedBox, ContactFactorIsThatOfAllImages) {
  for (const Cell& cell : cells)
    for (const std::size_t count : {1, 2, 30}) {
      const Spheres<3> s = random_spheres(cell, count, 0.05, 0.2, 7);
      double factor = 0;
      for (std::size_t i = 0; i < count; ++i)
        for (std::size_t j = i; j < count; ++j)
          cell.for_each_image([&](int a, int b, int c) {
            if (i == j && a == 0 && b == 0 && c == 0) return;
            factor =
                std::max(factor, (s.r[i] + s.r[j]) / (s.center(i) - s.center(j) + cell.at(a, b, c)).norm());
          });
      EXPECT_NEAR(contact_factor<3>(s, cell.edges, cell.tilt), factor, 1e-12 * factor);
    }
}

/// The largest overlap ratio of all pairs of different spheres.
double largest_overlap(const Spheres<3>& s, const Cell& cell) {
  double largest = 0;
  for (std::size_t i = 0; i < s.size(); ++i)
    for (std::size_t j = i + 1; j < s.size(); ++j)
      cell.for_each_image([&](int a, int b, int c) {
        const double d = (s.center(i) - s.center(j) + cell.at(a, b, c)).norm();
        largest = std::max(largest, 1 - d / (s.r[i] + s.r[j]));
      });
  return largest;
}

TEST(TiltedRelaxation, MeetsTheOverlapsOfAllImages) {
  // In boxes of several diameters, and in those narrower than two.
  for (const Cell& cell : cells)
    for (const double r : {0.04, 0.1, 0.22}) {
      Spheres<3> s = random_spheres(cell, 12, 0.9 * r, r, 11);
      Vector<3> edges = cell.edges;
      NeighborRelaxation<3, true> engine(s, edges, cell.tilt);
      for (int sweep = 0; sweep < 10; ++sweep) {
        engine.write_to(s, edges);
        const double expected = largest_overlap(s, cell);
        // Spheres move while a sweep goes on: it meets about what was there, and nothing where nothing is.
        const double met = engine.sweep_and_measure(1e-3f);
        EXPECT_NEAR(met, expected, 0.01) << "radius " << r;
      }
    }
}

TEST(TiltedRelaxation, DilutePackingsPartAndStayApart) {
  for (const Cell& cell : cells) {
    const double r = 0.2 * std::cbrt(cell.edges.prod() / 12);
    Spheres<3> s = random_spheres(cell, 12, 0.5 * r, r, 5);
    if (2 * r > cell.boundary().shortest_period()) continue;
    Vector<3> edges = cell.edges;
    NeighborRelaxation<3, true> engine(s, edges, cell.tilt);
    for (int sweep = 0; sweep < 400; ++sweep) engine.sweep(1);
    engine.write_to(s, edges);
    EXPECT_LT(largest_overlap(s, cell), 1e-4);
    EXPECT_EQ(edges, cell.edges);
  }
}

Packing packed(std::size_t count, const std::string& tilt) {
  return run(testing::plan_of("[container]\nkind = \"periodic\"\nsize = [1, 1, 1]\nscalable = true\ntilt = " +
                              tilt + "\n[spheres]\ncount = " + std::to_string(count) + "\nradius = 1\n"));
}

TEST(TiltedBox, PacksAsDenselyAsTheCube) {
  // A cube of 1,000 reaches 0.6470 with a deviation of 0.0004.
  const Packing packing = packed(1000, "[0.5, -0.3, 0.4]");
  EXPECT_EQ(packing.outcome, Outcome::converged);
  EXPECT_NEAR(packing.packing_fraction(), 0.647, 0.003);
  const Box& box = std::get<Box>(packing.domain);
  const Cell cell{Vector<3>(box.size), box.tilt, 2};
  EXPECT_NEAR(box.tilt[0], 0.5 * box.size[0], 1e-12 * box.size[0]);
  EXPECT_NEAR(box.tilt[2], 0.4 * box.size[1], 1e-12 * box.size[1]);
  const Spheres<3> s = packing.spheres.in<3>();
  EXPECT_LE(largest_overlap(s, cell), 0);
  EXPECT_TRUE(certify(packing.spheres, packing.domain).certified);
  EXPECT_EQ(std::get<PeriodicBox>(packing.scene.container).tilt,
            std::vector<double>(box.tilt.begin(), box.tilt.end()));
}

TEST(TiltedBox, OfWholeCellVectorsIsTheUprightOne) {
  const Packing packing = packed(150, "[1, 0, 0]");
  Box box = std::get<Box>(packing.domain);
  EXPECT_EQ(box.tilt, (Tilt{box.size[0], 0, 0}));
  EXPECT_TRUE(certify(packing.spheres, box).certified);
  box.tilt = {};
  EXPECT_TRUE(certify(packing.spheres, box).certified);
  EXPECT_GT(packing.packing_fraction(), 0.62);
}

TEST(TiltedBox, OneSphereInTheRhombohedralCellIsFaceCentredCubic) {
  Scene scene;
  scene.container = PeriodicBox{.size = {1, std::sqrt(0.75), std::sqrt(2.0 / 3)},
                                .tilt = {0.5, 0.5, std::sqrt(1.0 / 12)},
                                .scalable = true};
  scene.target.count = 1;
  scene.sizes = Constant{1};
  const Packing packing = run(build(scene));
  EXPECT_TRUE(certify(packing.spheres, packing.domain).certified);
  EXPECT_NEAR(packing.packing_fraction(), std::numbers::pi / std::sqrt(18.0), 1e-11);
}

}  // namespace tilted_box_test
}  // namespace bernal
