
#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include "bernal/core/error.hpp"
#include "bernal/core/random.hpp"
#include "kernels/first_contact.hpp"
#include "settle/mover.hpp"
#include "support/containers.hpp"

// Bed and Mover against brute force: every sphere, every facet and every image, no list, no grid, no box.
namespace bernal {
namespace mover_test {

using test::ContainerUnderTest;

constexpr double everywhere = 10;  // local containers have a diagonal below 2
const Vector<3> down = -Vector<3>::UnitZ();

/// Spheres at random places of a container.
class RandomBed {
 public:
  RandomBed(const ContainerUnderTest& tested, std::size_t n, double r_min, double r_max,
            std::uint64_t seed = 1)
      : shape_(tested.shape), container_(tested.container()), bed_(*container_, r_min, r_max, n, effects_) {
    Random random(seed, stream(Stream::test));
    const Bounds<3> bounds = container_->bounds();
    for (int failures = 0; bed_.size() < n && failures < 20'000; ++failures) {
      const Vector<3> c = uniform_point(random, bounds);
      const double r = r_min + (r_max - r_min) * random.uniform();
      if (!bed_.fits(c, r)) continue;
      bed_.insert(c, r, static_cast<std::uint32_t>(bed_.size()));
      failures = 0;
    }
  }

  Bed& operator*() { return bed_; }
  Bed* operator->() { return &bed_; }
  const Domain& shape() const { return shape_; }

  std::vector<NearFacet> all_facets(const Vector<3>& c) const {
    std::vector<NearFacet> facets;
    container_->facets_near(c, everywhere, facets);
    return facets;
  }

  /// All that matter of a sphere: two periods to every side.
  std::vector<Vector<3>> images(const Vector<3>& c) const {
    std::vector<Vector<3>> all{c};
    for (int k = 0; k < 3; ++k) {
      if (!container_->boundary().repeats(k)) continue;
      for (std::size_t n = 0, count = all.size(); n < count; ++n)
        for (const double periods : {-2.0, -1.0, 1.0, 2.0})
          all.push_back(all[n] + periods * container_->boundary().edges[k] * Vector<3>::Unit(k));
    }
    return all;
  }
  /// From p to the nearest image of sphere j's centre.
  long double nearest(const Vector<3>& p, Bed::Id j) const {
    long double least = everywhere;
    for (const Vector<3>& image : images(bed_[j].center))
      least = std::min(least, norm(test::Point<long double>(p) - test::Point<long double>(image)));
    return least;
  }

  /// The smallest gap of any two spheres, or of a sphere and the wall.
  double smallest_gap() const {
    long double gap = everywhere;
    for (Bed::Id i = 0; i < bed_.size(); ++i) {
      const auto& [c, r] = bed_[i];
      gap = std::min(gap, test::precise_clearance(shape_, c) - r);
      for (Bed::Id j = 0; j < i; ++j) gap = std::min(gap, nearest(c, j) - r - bed_[j].r);
    }
    return static_cast<double>(gap);
  }
  /// Contacts of spheres with others of which another image is in the period.
  int contacts_across_a_seam() const {
    int count = 0;
    const Spheres<3> spheres = bed_.spheres();
    for (Bed::Id i = 0; i < spheres.size(); ++i)
      for (Bed::Id j = 0; j < i; ++j) {
        const Vector<3> direct = spheres.center(j) - spheres.center(i);
        const Vector<3> way = container_->boundary().minimum_image(direct);
        count += way != direct && way.norm() < spheres.r[i] + spheres.r[j] + 2 * bed_.skin();
      }
    return count;
  }

 private:
  Domain shape_;
  std::unique_ptr<Container> container_;
  EffectLog effects_;
  Bed bed_;
};

class BedInContainer : public ::testing::TestWithParam<ContainerUnderTest> {};

INSTANTIATE_TEST_SUITE_P(
    , BedInContainer,
    ::testing::Values(test::localized("Box", Box{{0, 0, 0}, {1, 0.8, 0.9}}),
                      test::localized("ObliqueCylinder", Cylinder{{1, 2, 3}, {1, -2, 0.5}, 0.7, 1.9}),
                      test::localized("Sphere", Sphere{{0, 0, 0}, 1}),
                      test::localized("Column", Cylinder{{5, 2, 1}, {2, 0, 0}, 0.7, 1.9, true}),
                      test::localized("Slab", Box{{0, 0, 0}, {1, 0.8, 0.9}, {true, true, false}}),
                      test::localized("Channel", Box{{3, 0, -2}, {1, 0.8, 0.9}, {false, true, false}}),
                      test::localized("PrismMesh", test::prism_mesh(12, 1, 2)),
                      test::localized("LShapeMesh", test::l_shape_mesh())),
    [](const auto& tested) { return tested.param.name; });

/// The length that the sphere's bounding box leaves, whose half-width is `buffer` about `box_center`.
double way_out_of_box(const Vector<3>& box_center, double buffer, const Vector<3>& c, const Vector<3>& u) {
  double length = everywhere;
  for (int k = 0; k < 3; ++k) {
    const double room = buffer - (u[k] > 0 ? 1 : -1) * (c[k] - box_center[k]);
    if (u[k] != 0) length = std::min(length, std::max(0.0, room) / std::abs(u[k]));
  }
  return length;
}

/// The path is as long as box and limit allow where no obstacle, looked at alone, would stop the sphere on
/// it; else one obstacle stops it exactly there, and none before.
void expect_free_path(RandomBed& bed, Bed::Id i, const Vector<3>& u, double limit, double to_box,
                      const FreePath& path) {
  const auto& [c, r] = (*bed)[i];
  const double skin = bed->skin(), rounding = skin / 10;
  const double longest = std::min(limit, to_box);
  ASSERT_LE(path.length, longest + rounding);
  ASSERT_GE(path.length, 0);

  double alone = path.length, nearest = longest;
  Vector<3> towards_blocker = Vector<3>::Zero();
  const auto look_at = [&](double within_path, double within_longest, const Vector<3>& place) {
    alone = std::min(alone, within_path);
    if (within_longest < nearest) {
      nearest = within_longest;
      towards_blocker = place - (c + path.length * u);
    }
  };
  for (Bed::Id j = 0; j < bed->size(); ++j) {
    if (j == i) continue;
    for (const Vector<3>& image : bed.images((*bed)[j].center)) {
      const auto stop = [&](double most) {
        return first_contact<3>(c, u, most, image, (*bed)[j].r + r, skin);
      };
      look_at(stop(path.length), stop(longest), image);
    }
  }
  for (const NearFacet& near : bed.all_facets(c)) {
    const auto stop = [&](double most) { return first_contact(near.facet, c, r, u, most, skin); };
    look_at(stop(path.length), stop(longest), closest_point(near.facet, c + path.length * u));
  }
  EXPECT_GE(alone, path.length - rounding) << "an obstacle stands in the way";
  if (path.blocked()) {
    EXPECT_NEAR(nearest, path.length, rounding) << "no obstacle stands at its end";
    EXPECT_NEAR(path.normal.norm(), 1, 1e-12);
    EXPECT_LT(path.normal.dot(u), 0);
    EXPECT_NEAR(path.normal.dot(towards_blocker), -towards_blocker.norm(), 1e-6);
  } else {
    EXPECT_NEAR(path.length, longest, rounding);
    EXPECT_EQ(path.end == FreePath::End::box, to_box < limit);
  }
}

TEST_P(BedInContainer, FreePathIsTheLeastOfAllObstacles) {
  int ends[4] = {};
  for (const double most : {0.02, 0.3}) {
    RandomBed bed(GetParam(), 300, 0.03, 0.07);
    ASSERT_GT(bed->size(), 50u);
    const double buffer = bed->enclose(most);
    EXPECT_EQ(buffer, std::min(most, bed->longest_buffer()));
    Mover mover(*bed);
    Random random(2, stream(Stream::test));
    for (int step = 0; step < 400; ++step) {
      const auto i = static_cast<Bed::Id>(random.uniform() * static_cast<double>(bed->size()));
      const Vector<3> box_center = (*bed)[i].center;
      mover.pick(i);
      for (int leg = 0; leg < 4; ++leg) {
        const Vector<3> u = uniform_direction<3>(random);
        const double limit = random.uniform(0.0, 2 * buffer);
        const FreePath path = mover.free_path(u, limit);
        expect_free_path(bed, i, u, limit, way_out_of_box(box_center, buffer, (*bed)[i].center, u), path);
        if (HasFailure()) FAIL() << "step " << step << " leg " << leg << " buffer " << buffer;
        ++ends[static_cast<int>(path.end)];
        mover.advance(u, path.length);
      }
      mover.advance(box_center - (*bed)[i].center, 1);  // back, so that its box is still about it
    }
  }
  for (const int count : ends) EXPECT_GT(count, 20) << "one of the four ends hardly ever came";
}

TEST_P(BedInContainer, NoGapFallsBelowHalfTheSkinHoweverSpheresSlide) {
  RandomBed bed(GetParam(), 300, 0.03, 0.07);
  Random random(3, stream(Stream::test));
  Mover mover(*bed);
  double moved = 0;
  const double start = bed->potential(down);
  for (int sweep = 0; sweep < 40; ++sweep) {
    bed->sort_by_height(down);
    bed->enclose(0.03);
    for (Bed::Id i = 0; i < bed->size(); ++i) {
      const Vector<3> u = (sweep % 2 == 0 ? down : Vector<3>(down + 2 * uniform_direction<3>(random)));
      const Vector<3> before = (*bed)[i].center;
      const double way = mover.slide(i, u.normalized(), 0.1);
      EXPECT_NEAR(way, ((*bed)[i].center - before).norm(), 1e-14);
      EXPECT_LE(way, 0.1 * (1 + 1e-12));
      moved += way;
    }
  }
  EXPECT_LT(bed->potential(down), start - 0.05);  // they fell, so they touch
  EXPECT_GT(moved, 1);
  // Rounding may take some roundoffs of a coordinate from skin/2; the skin is at least a thousand of them.
  EXPECT_GE(bed.smallest_gap(), 0.49 * bed->skin());
  EXPECT_LE(bed.smallest_gap(), 2 * bed->skin());
  EXPECT_EQ(bed.contacts_across_a_seam() > 0, is_periodic(bed.shape()));
}

TEST_P(BedInContainer, BoxesEncloseWhatSpheresCanDo) {
  constexpr double buffer = 0.02;
  RandomBed bed(GetParam(), 300, 0.03, 0.07);
  bed->enclose(buffer);
  std::vector<Vector<3>> box_centers;
  for (Bed::Id i = 0; i < bed->size(); ++i) box_centers.push_back((*bed)[i].center);
  Mover mover(*bed);
  for (int sweep = 0; sweep < 10; ++sweep)
    for (Bed::Id i = 0; i < bed->size(); ++i) mover.slide(i, down, everywhere);
  for (Bed::Id i = 0; i < bed->size(); ++i)
    EXPECT_LE(((*bed)[i].center - box_centers[i]).cwiseAbs().maxCoeff(), buffer * (1 + 1e-12)) << i;
}

TEST_P(BedInContainer, ListsHoldAllThatASphereCanMeet) {
  constexpr double buffer = 0.03;
  RandomBed bed(GetParam(), 300, 0.03, 0.07);
  bed->enclose(buffer);
  for (Bed::Id i = 0; i < bed->size(); ++i) {
    const std::span<const Bed::Id> listed = bed->neighbors(i);
    for (Bed::Id j = 0; j < bed->size(); ++j) {
      double boxes_apart = everywhere;
      for (const Vector<3>& image : bed.images((*bed)[j].center)) {
        const Vector<3> apart = (image - (*bed)[i].center).cwiseAbs();
        boxes_apart = std::min(boxes_apart, (apart.array() - 2 * buffer).max(0).matrix().norm());
      }
      const auto times = std::ranges::count(listed, j);
      EXPECT_LE(times, i == j ? 0 : 1);
      if (i != j && boxes_apart < (*bed)[i].r + (*bed)[j].r) {
        EXPECT_EQ(times, 1) << i << ' ' << j;
      }
    }
  }
}

TEST_P(BedInContainer, FitsAgreesWithBruteForce) {
  RandomBed bed(GetParam(), 200, 0.03, 0.07);
  Random random(4, stream(Stream::test));
  const Bounds<3> bounds = bed->container().bounds();
  int fitting = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const Vector<3> c = uniform_point(random, bounds);
    const double r = random.uniform(0.03, 0.07);
    long double room = test::precise_clearance(bed.shape(), c);
    for (Bed::Id j = 0; j < bed->size(); ++j) room = std::min(room, bed.nearest(c, j) - (*bed)[j].r);
    const long double spare = room - r - bed->skin();
    if (std::abs(spare) < 1e-14L) continue;
    EXPECT_EQ(bed->fits(c, r), spare > 0) << "spare room " << static_cast<double>(spare);
    fitting += spare > 0;
  }
  EXPECT_GT(fitting, 10);
}

TEST_P(BedInContainer, FitsKnowsWhereSpheresHaveMovedTo) {
  RandomBed bed(GetParam(), 100, 0.03, 0.07);
  bed->enclose(0.3);
  Mover mover(*bed);
  for (Bed::Id i = 0; i < bed->size(); ++i) mover.slide(i, down, everywhere);
  bed->update_grid();
  for (Bed::Id i = 0; i < bed->size(); ++i) EXPECT_FALSE(bed->fits((*bed)[i].center, 0.03)) << i;
}

TEST_P(BedInContainer, SortingKeepsEverySphereAndPutsLowerLayersFirst) {
  RandomBed bed(GetParam(), 300, 0.03, 0.07);
  const Spheres<3> before = bed->spheres();
  const double fraction = bed->packing_fraction();
  const Vector<3> direction = Vector<3>(1, -2, -2) / 3;
  bed->sort_by_height(direction);
  EXPECT_TRUE(bed->spheres() == before);
  EXPECT_NEAR(bed->packing_fraction(), fraction, 1e-12);
  const double layer = 2 * bed->mean_radius();
  for (Bed::Id i = 1; i < bed->size(); ++i) {
    const double rise = -direction.dot((*bed)[i].center - (*bed)[i - 1].center);
    EXPECT_GT(rise, -layer * (1 + 1e-12)) << i;
  }
}

TEST_P(BedInContainer, TagsThatAreRemovedLeaveRoomForOthers) {
  RandomBed bed(GetParam(), 200, 0.03, 0.07);
  const Spheres<3> all = bed->spheres();
  const std::size_t kept = all.size() / 2;
  bed->sort_by_height(down);
  bed->remove_tags_from(static_cast<std::uint32_t>(kept));
  const Spheres<3> rest = bed->spheres();
  ASSERT_EQ(rest.size(), kept);
  double volume = 0, sum_of_radii = 0;
  for (std::size_t i = 0; i < kept; ++i) {
    EXPECT_EQ(rest.center(i), all.center(i));
    EXPECT_EQ(rest.r[i], all.r[i]);
    volume += 4.0 / 3.0 * std::numbers::pi * std::pow(rest.r[i], 3);
    sum_of_radii += rest.r[i];
  }
  EXPECT_NEAR(bed->packing_fraction(), volume / bed->container().volume(), 1e-12);
  EXPECT_NEAR(bed->mean_radius(), sum_of_radii / static_cast<double>(kept), 1e-12);
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(bed->fits(all.center(i), all.r[i]), i >= kept) << i;
}

TEST(Bed, PotentialIsTheMeanHeightByVolume) {
  const ContainerUnderTest cube = test::localized("", Box{{-0.5, -0.5, -0.5}, {1, 1, 1}});
  const auto container = cube.container();
  EffectLog effects;
  Bed bed(*container, 0.1, 0.2, 2, effects);
  EXPECT_EQ(bed.potential(down), 0);
  bed.insert({0, 0, -0.3}, 0.2, 0);
  bed.insert({0, 0, 0.2}, 0.1, 1);
  EXPECT_NEAR(bed.potential(down), (8 * -0.3 + 1 * 0.2) / 9, 1e-15);
}

/// Longer boxes than that would let a sphere meet two images of another.
TEST(Bed, KeepsBoxesShorterThanItsPeriodsAllow) {
  const ContainerUnderTest slab =
      test::localized("", Box{{-0.5, -0.5, -0.5}, {1, 1, 1}, {true, false, false}});
  const auto container = slab.container();
  EffectLog effects;
  const double r = 1.0 / 6;
  Bed bed(*container, 0.01, r, 2, effects);
  EXPECT_NEAR(bed.longest_buffer(), (0.5 - 2 * r) / 4, 1e-8);
  EXPECT_GT(bed.longest_buffer(), 0);
  EXPECT_THROW(Bed(*container, 0.01, 1.001 * r, 2, effects), Error);
}

TEST(Bed, ListsDoNotDependOnTheNumberOfThreads) {
  const ContainerUnderTest cube = test::localized("", Box{{0, 0, 0}, {1, 1, 1}});
  std::vector<std::vector<Bed::Id>> lists[2];
  std::vector<double> paths[2];
  for (const std::size_t threads : {std::size_t{1}, std::size_t{2}}) {
    const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, threads);
    RandomBed bed(cube, 5000, 0.015, 0.025);
    ASSERT_EQ(bed->size(), 5000u);  // several of the blocks that threads share
    bed->enclose(0.02);
    Mover mover(*bed);
    for (Bed::Id i = 0; i < bed->size(); ++i) {
      const std::span<const Bed::Id> listed = bed->neighbors(i);
      lists[threads - 1].emplace_back(listed.begin(), listed.end());
      paths[threads - 1].push_back(mover.slide(i, down, everywhere));  // asks the walls, too
    }
  }
  EXPECT_EQ(lists[0], lists[1]);
  EXPECT_EQ(paths[0], paths[1]);
}

}  // namespace mover_test
}  // namespace bernal
