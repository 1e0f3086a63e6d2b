// Packings of which only a slab is in memory, against the same looked at as a whole.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "bernal/core/boundary.hpp"
#include "bernal/core/random.hpp"
#include "slabs/drawn_spheres.hpp"
#include "slabs/slab_relaxation.hpp"
#include "support/folder.hpp"
#include "work/free_of_overlap.hpp"

namespace bernal {
namespace slab_packing_test {

using testing::Folder;

struct Whole {
  Spheres<3> spheres;
  Vector<3> edges;
};

/// At random places in a box that they fill, overlaps counted twice, to 0.6.
Whole at_random(std::size_t n, const Vector<3>& proportions, double r_min, double r_max) {
  Random random(5, stream(Stream::test));
  Whole whole{{}, proportions};
  double volume = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double r = r_min + (r_max - r_min) * random.uniform();
    whole.spheres.push_back(Vector<3>::Zero(), r);
    volume += 4.18879 * r * r * r;
  }
  whole.edges *= std::cbrt(volume / 0.6 / whole.edges.prod());
  for (std::size_t i = 0; i < n; ++i)
    whole.spheres.set_center(i, uniform_point<3>(random, {Vector<3>::Zero(), whole.edges}));
  return whole;
}

void put(const Whole& whole, SlabStore& store) {
  for (std::size_t i = 0; i < whole.spheres.size(); ++i) {
    SlabSphere sphere{{}, whole.spheres.r[i]};
    for (int k = 0; k < 3; ++k)
      sphere.at[static_cast<std::size_t>(k)] = whole.spheres.center(i)[k] / whole.edges[k];
    store.add(sphere);
  }
  store.close();
}

Whole taken(const SlabStore& store, const Vector<3>& edges) {
  Whole whole{{}, edges};
  for (int s = 0; s < store.size(); ++s)
    store.for_each(s, [&](const SlabSphere& sphere) {
      whole.spheres.push_back(Vector<3>(sphere.at[0], sphere.at[1], sphere.at[2]).cwiseProduct(edges),
                              sphere.r);
    });
  return whole;
}

/// Distances and radii of all that are near a sphere, itself left out.
std::vector<std::pair<double, double>> near(const Spheres<3>& spheres, const Vector<3>& edges, std::size_t i,
                                            double width) {
  const Boundary<3> boundary{edges};
  std::vector<std::pair<double, double>> found;
  for (std::size_t j = 0; j < spheres.size(); ++j) {
    const double d = boundary.minimum_image(spheres.center(i) - spheres.center(j)).norm();
    if (j != i && d < width) found.emplace_back(d, spheres.r[j]);
  }
  std::ranges::sort(found);
  return found;
}

/// Of every slab's own spheres all that are within `width`, as by brute force. Returns how many spheres
/// are held at most.
std::size_t expect_all_around(const SlabStore& store, const Vector<3>& edges, double width) {
  const Whole whole = taken(store, edges);
  std::size_t i = 0, held = 0;  // as they are taken
  for (int s = 0; s < store.size(); ++s) {
    const SlabSurroundings here = surroundings(store, s, edges, width);
    EXPECT_EQ(here.own, store.spheres(s));
    held = std::max(held, here.spheres.size());
    for (std::size_t own = 0; own < here.own; ++own, ++i) {
      const auto expected = near(whole.spheres, edges, i, width);
      const auto found = near(here.spheres, here.edges, own, width);
      EXPECT_EQ(found.size(), expected.size()) << store.size() << " slabs, width " << width;
      for (std::size_t k = 0; k < std::min(found.size(), expected.size()); ++k) {
        EXPECT_NEAR(found[k].first, expected[k].first, 1e-9);
        EXPECT_EQ(found[k].second, expected[k].second);
      }
    }
  }
  EXPECT_EQ(i, whole.spheres.size());
  return held;
}

TEST(SlabStore, KnowsWhoIsAroundASlab) {
  const Whole whole = at_random(700, {1, 2, 1}, 0.7, 1.3);
  const Folder folder;
  for (const int slabs : {2, 3, 5})
    for (const double width : {2.0, 4.0, 6.0}) {
      SlabStore store(folder / "slabs", slabs, 1);
      put(whole, store);
      const std::size_t held = expect_all_around(store, whole.edges, width);
      if (slabs == 5 && width == 2) {
        EXPECT_LT(held, whole.spheres.size() / 2) << "the others stay on the disk";
      }
      // And when they have gone where they were not put, all down, or all up by most of half a slab.
      for (const double most : {-0.4, 0.8}) {
        for (int s = 0; s < slabs; ++s)
          store.rewrite(s, [&](std::uint64_t k, SlabSphere& sphere) {
            sphere.at[1] += most / slabs * std::abs(std::sin(static_cast<double>(k)));
          });
        expect_all_around(store, whole.edges, width);
      }
    }
}

TEST(SlabStore, KeepsWhatIsPutElsewhere) {
  const Whole whole = at_random(300, {3, 1, 1}, 1, 1);
  const Folder folder;
  SlabStore store(folder / "slabs", 3, 0);
  put(whole, store);
  const Whole before = taken(store, whole.edges);
  for (int s = 0; s < 3; ++s)  // beyond both ends of the period, too
    store.rewrite(s, [](std::uint64_t k, SlabSphere& sphere) { sphere.at[0] += k % 2 == 0 ? 0.1 : -0.1; });
  const Whole after = taken(store, whole.edges);
  const Boundary<3> boundary{whole.edges};
  ASSERT_EQ(after.spheres.size(), before.spheres.size());
  std::size_t i = 0;
  for (int s = 0; s < 3; ++s)
    for (std::uint64_t k = 0; k < store.spheres(s); ++k, ++i) {
      EXPECT_GE(after.spheres.center(i)[0], 0);
      EXPECT_LT(after.spheres.center(i)[0], whole.edges[0]);
      const Vector<3> moved = boundary.minimum_image(after.spheres.center(i) - before.spheres.center(i));
      EXPECT_NEAR(moved[0], (k % 2 == 0 ? 0.1 : -0.1) * whole.edges[0], 1e-9);
    }
  EXPECT_LT(store.extent(0).lower, -1.0 / 6 - 0.05);
}

TEST(SlabPacking, LeavesSpheresWhereNothingPushesThem) {
  const Whole whole = at_random(1200, {1, 1, 3}, 1, 1);
  const Folder folder;
  SlabStore store(folder / "slabs", 3, 2);
  put(whole, store);
  const Whole before = taken(store, whole.edges);
  SlabPacking packing(store, whole.edges, 1, 1, [] {});
  for (int sweep = 0; sweep < 100; ++sweep) packing.sweep(0);
  // By steps of nothing it measures what there is.
  const double overlap = packing.sweep_to_overlap(0);
  EXPECT_NEAR(1 / (1 - overlap), contact_factor<3>(whole.spheres, whole.edges), 1e-3);
  const Whole after = taken(store, whole.edges);
  const Boundary<3> boundary{whole.edges};
  for (std::size_t i = 0; i < before.spheres.size(); ++i)
    EXPECT_LT(boundary.minimum_image(after.spheres.center(i) - before.spheres.center(i)).norm(), 1e-6);
}

TEST(SlabPacking, PushesSpheresApartUntilNoneOverlaps) {
  const Folder folder;
  for (const double least : {1.0, 0.5}) {
    const Whole whole = at_random(1500, {3, 1, 1}, least, 1);
    const double mean = (1 + least) / 2;
    for (const int slabs : {2, 3, 4}) {
      SlabStore store(folder / "slabs", slabs, 0);
      put(whole, store);
      SlabPacking packing(store, whole.edges, 1, mean, [] {});
      double first = 0, last = 1;
      for (int k = 0; k < 300 && last > 1e-4; ++k) {
        for (int sweep = 0; sweep < 30; ++sweep) packing.sweep(4);
        last = packing.sweep_to_overlap(4);
        if (k == 0) first = last;
        packing.grow(1 + last / 30);
      }
      EXPECT_GT(first, 0.01);
      EXPECT_LE(last, 1e-4);
      // What was measured is so, and the box grows by just that.
      const Whole relaxed = taken(store, packing.edges());
      const double of_all = contact_factor<3>(relaxed.spheres, relaxed.edges);
      EXPECT_NEAR(contact_factor_of(store, packing.edges(), 1, [] {}), of_all, 1e-12);
      EXPECT_LT(of_all, 1 + 3e-4);
    }
  }
}

TEST(SlabPacking, IsTheSameForAnyNumberOfThreads) {
  const Whole whole = at_random(60'000, {2, 1, 1}, 0.8, 1.2);  // so many that a slab is swept in threads
  const auto with_threads = [&](std::size_t n) {
    tbb::global_control limit(tbb::global_control::max_allowed_parallelism, n);
    const Folder folder;
    SlabStore store(folder / "slabs", 2, 0);
    put(whole, store);
    SlabPacking packing(store, whole.edges, 1.2, 1, [] {});
    for (int sweep = 0; sweep < 20; ++sweep) packing.sweep(5);
    packing.sweep_to_overlap(5);
    return taken(store, whole.edges).spheres;
  };
  EXPECT_EQ(with_threads(1), with_threads(2));
}

TEST(SlabPacking, AsksBeforeEachVisit) {
  const Whole whole = at_random(700, {3, 1, 1}, 1, 1);
  const Folder folder;
  SlabStore store(folder / "slabs", 3, 0);
  put(whole, store);
  int asked = 0;
  SlabPacking packing(store, whole.edges, 1, 1, [&] {
    if (++asked == 3) throw Cancelled();
  });
  EXPECT_THROW(packing.sweep_to_overlap(1), Cancelled);
  EXPECT_EQ(asked, 3);
}

TEST(RadiiByNumber, AreToldApartInAnyOrder) {
  RadiiByNumber a, b, swapped, other;
  a.add(0, 1.5);
  a.add(1, 2);
  b.add(1, 2);
  b.add(0, 1.5);
  swapped.add(0, 2);
  swapped.add(1, 1.5);
  other.add(0, 1.5);
  other.add(1, std::nextafter(2, 3));
  EXPECT_EQ(a, b);
  EXPECT_NE(a, swapped);
  EXPECT_NE(a, other);
}

}  // namespace slab_packing_test
}  // namespace bernal
