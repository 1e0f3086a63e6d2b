#include "bernal/voxels/voxels.hpp"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <string>

#include "bernal/core/dimension.hpp"
#include "bernal/core/error.hpp"
#include "bernal/core/random.hpp"
#include "support/containers.hpp"
#include "support/packings.hpp"
#include "support/polygons.hpp"

namespace bernal {
namespace voxels_test {

template <class T>
std::vector<T> image_of(const Spheres<dynamic>& spheres, const Domain& domain, const VoxelGrid& grid,
                        VoxelValues values) {
  std::string bytes;
  voxelise(spheres, domain, grid, values, [&](std::string_view layers) { bytes += layers; });
  std::vector<T> voxels(bytes.size() / sizeof(T));
  EXPECT_EQ(bytes.size(), sizeof(T) * static_cast<std::size_t>(grid.voxels()));
  std::memcpy(voxels.data(), bytes.data(), sizeof(T) * voxels.size());
  return voxels;
}

Vector<3> center_of(const VoxelGrid& grid, std::int64_t i, std::int64_t j, std::int64_t k) {
  return {grid.center(0, i), grid.center(1, j), grid.center(2, k)};
}

/// Spheres that overlap, with centres in the bounds.
Spheres<dynamic> thrown(const Domain& domain, int n, double r_min, double r_max, std::uint64_t seed) {
  const int dimension = dimension_of(domain);
  const Bounds<3> bounds = bounds_of(domain);
  Random random(seed, stream(Stream::test));
  Spheres<dynamic> spheres(dimension);
  for (int i = 0; i < n; ++i) {
    Vector<dynamic> c(dimension);
    for (int k = 0; k < dimension; ++k) c[k] = random.uniform(bounds.lower[k], bounds.upper[k]);
    spheres.push_back(c, random.uniform(r_min, r_max));
  }
  return spheres;
}

/// The first sphere, counted from 1, one of whose images within two periods has the point, or 0.
std::uint32_t first_around(const Vector<3>& p, const Spheres<dynamic>& spheres, const Vector<3>& periods) {
  std::vector<double> shifts[3];
  for (int k = 0; k < 3; ++k)
    shifts[k] = periods[k] > 0 ? std::vector{-2 * periods[k], -periods[k], 0.0, periods[k], 2 * periods[k]}
                               : std::vector{0.0};
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const auto coordinate = [&](std::size_t k) { return k < spheres.x.size() ? spheres.x[k][i] : 0.0; };
    for (const double z : shifts[2]) {
      const double dz = p[2] - (coordinate(2) + z);
      for (const double y : shifts[1]) {
        const double dy = p[1] - (coordinate(1) + y);
        for (const double x : shifts[0]) {
          const double dx = p[0] - (coordinate(0) + x);
          if (dx * dx + (dy * dy + dz * dz) <= spheres.r[i] * spheres.r[i])
            return static_cast<std::uint32_t>(i + 1);
        }
      }
    }
  }
  return 0;
}

long double precise_clearance_of(const Domain& domain, const Vector<3>& p) {
  return dimension_of(domain) == 2 ? test::precise_clearance_flat(domain, p.head<2>())
                                   : test::precise_clearance(domain, p);
}

/// Every voxel by its rule, over all spheres, images and walls.
void expect_every_voxel(const std::string& name, const Spheres<dynamic>& spheres, const Domain& domain,
                        const VoxelGrid& grid) {
  const auto labels = image_of<std::uint32_t>(spheres, domain, grid, VoxelValues::labels);
  const auto phases = image_of<std::uint8_t>(spheres, domain, grid, VoxelValues::binary);
  Vector<3> periods = Vector<3>::Zero();
  if (dimension_of(domain) == 3) {
    periods = boundary_of<3>(domain).edges;
  } else {
    periods.head<2>() = boundary_of<2>(domain).edges;
  }
  const double resolution =
      1e-12 * bounds_of(domain).diagonal() + 1e-14 * std::max(bounds_of(domain).lower.cwiseAbs().maxCoeff(),
                                                              bounds_of(domain).upper.cwiseAbs().maxCoeff());
  std::size_t v = 0, wrong = 0, too_near = 0;
  for (std::int64_t k = 0; k < grid.count[2]; ++k) {
    for (std::int64_t j = 0; j < grid.count[1]; ++j) {
      for (std::int64_t i = 0; i < grid.count[0]; ++i, ++v) {
        const Vector<3> p = center_of(grid, i, j, k);
        std::uint32_t expected = first_around(p, spheres, periods);
        if (expected == 0 && has_walls(domain)) {
          const long double clearance = precise_clearance_of(domain, p);
          if (std::abs(clearance) < resolution) {
            ++too_near;
            continue;
          }
          if (clearance < 0) expected = 0xFFFFFFFF;
        }
        const std::uint8_t phase = expected == 0 ? 0 : expected == 0xFFFFFFFF ? 2 : 1;
        wrong += labels[v] != expected || phases[v] != phase;
      }
    }
  }
  EXPECT_EQ(wrong, 0u) << name << ": of " << v;
  EXPECT_LE(too_near, v / 4) << name;
}

TEST(Voxels, AreThoseWhoseCentresLieInASphereOfAnyImage) {
  const std::pair<const char*, Box> boxes[] = {
      {"cube", periodic_box(Vector<3>(1, 1, 1))},
      {"long", periodic_box(Vector<3>(0.31, 2, 0.7))},
      {"between walls", periodic_box(Vector<3>(1, 1.3, 0.8), {false, true, false})},
      {"far away", Box{{1e4, -3e4, 5e4}, {1, 1.4, 0.8}, {true, false, true}}},
      {"plane", periodic_box(Vector<2>(1, 1.7))},
      {"strip", periodic_box(Vector<2>(1, 1.7), {true, false})},
  };
  std::uint64_t seed = 1;
  for (const auto& [name, box] : boxes) {
    // Small spheres, some that hold no centre, and such as are their own neighbours.
    expect_every_voxel(name, thrown(box, 40, 0.01, 0.12, ++seed), box, voxel_grid_of(box, 23));
    expect_every_voxel(name, thrown(box, 3, 0.3, 0.5, ++seed), box, voxel_grid(box, 0.061));
  }
}

TEST(Voxels, OfEveryContainerAreOutsideWhereItsClearanceIsNegative) {
  for (const test::ContainerUnderTest& tested : test::containers_under_test())
    expect_every_voxel(tested.name, thrown(tested.shape, 5, 0.02, 0.1, 3), tested.shape,
                       voxel_grid_of(tested.shape, 17));
  for (const auto& [name, domain] : test::flat_domains())
    expect_every_voxel(name, thrown(domain, 3, 0.02, 0.1, 3), domain, voxel_grid_of(domain, 40));
}

TEST(Voxels, CentresOnTheSphereAreIn) {
  // Lengths are halves and the radius is three voxels: i² + j² + k² <= 9 has 123 solutions, 30 on the sphere.
  Spheres<dynamic> ball(3);
  ball.push_back(Vector<3>(4.25, 4.25, 4.25), 1.5);
  const Domain box = periodic_box(Vector<3>(8, 8, 8));
  const auto image = image_of<std::uint8_t>(ball, box, voxel_grid(box, 0.5), VoxelValues::binary);
  EXPECT_EQ(std::count(image.begin(), image.end(), 1), 123);
  ball.r[0] = std::nextafter(1.5, 0.0);
  const auto smaller = image_of<std::uint8_t>(ball, box, voxel_grid(box, 0.5), VoxelValues::binary);
  EXPECT_EQ(std::count(smaller.begin(), smaller.end(), 1), 93);
}

TEST(Voxels, RowsBesideEdgesAndThroughCornersOfAMeshStayInside) {
  // Rows meet the corners of an octahedron, its edges and the diagonals of its sections.
  const Mesh octahedron{
      {{4, 0, 0}, {-4, 0, 0}, {0, 4, 0}, {0, -4, 0}, {0, 0, 4}, {0, 0, -4}},
      {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
  const VoxelGrid grid{
      .count = {17, 17, 17}, .corner = Vector<3>::Constant(-4.25), .spacing = Vector<3>::Constant(0.5)};
  const auto image = image_of<std::uint8_t>(Spheres<dynamic>(3), octahedron, grid, VoxelValues::binary);
  std::size_t v = 0;
  for (std::int64_t k = 0; k < 17; ++k) {
    for (std::int64_t j = 0; j < 17; ++j) {
      for (std::int64_t i = 0; i < 17; ++i, ++v) {
        const double depth = 4 - center_of(grid, i, j, k).cwiseAbs().sum();  // exact
        if (depth > 0) {
          EXPECT_EQ(image[v], 0) << i << ' ' << j << ' ' << k;
        } else if (depth < 0) {
          EXPECT_EQ(image[v], 2) << i << ' ' << j << ' ' << k;
        }
      }
    }
  }
}

double sum_of(const std::vector<float>& fractions) {
  double sum = 0;
  for (const float f : fractions) sum += static_cast<double>(f);
  return sum;
}

TEST(Voxels, FractionsSumUpToTheVolumeOfTheSpheres) {
  // Floats are rounded by up to 2^-25, at random: n voxels that a surface cuts, whose mean is about 1/2, give
  // the sum a relative error of 2^-25 / sqrt(3) * 2 / sqrt(n), 2e-10 for the 3e4 here.
  const Box cube = periodic_box(Vector<3>(1, 1.2, 0.9));
  Spheres<dynamic> spheres = testing::scattered(60, 0.03, 0.2, bounds_of(cube), 5);
  ASSERT_GT(spheres.size(), 40u);
  for (std::size_t i = 0; i < spheres.size(); ++i) {  // until they cross every face
    spheres.x[0][i] += 0.37;
    spheres.x[1][i] += 0.51;
    spheres.x[2][i] += 0.23;
  }
  wrap(spheres, cube);
  double volume = 0;
  for (const double r : spheres.r) volume += ball_volume(3, r);
  for (const double edge : {0.02, 0.013, 0.3}) {
    const VoxelGrid grid = voxel_grid(cube, edge);
    const auto image = image_of<float>(spheres, cube, grid, VoxelValues::fraction);
    EXPECT_NEAR(sum_of(image) * grid.measure() / volume, 1, edge > 0.1 ? 1e-7 : 1e-9) << edge;
    if (edge > 0.1) continue;
    EXPECT_EQ(*std::min_element(image.begin(), image.end()),
              0);  // what no surface cuts is not left to rounding
    EXPECT_EQ(*std::max_element(image.begin(), image.end()), 1);
  }
  // A wall changes nothing.
  Spheres<dynamic> one(3);
  one.push_back(Vector<3>(0.4, 0.5, 0.6), 0.4);
  const Domain ball = Sphere{{0.4, 0.5, 0.6}, 0.4};
  const VoxelGrid grid = voxel_grid_of(ball, 40);
  EXPECT_NEAR(sum_of(image_of<float>(one, ball, grid, VoxelValues::fraction)) * grid.measure(),
              volume_of(ball), 1e-9 * volume_of(ball));
}

TEST(Voxels, FractionsOfDiscsAreAreas) {
  const Box square = periodic_box(Vector<2>(1, 1.5));
  Spheres<dynamic> discs(2);
  discs.push_back(Vector<2>(0.1, 0.2), 0.3);
  discs.push_back(Vector<2>(0.6, 0.9), 0.25);
  const VoxelGrid grid = voxel_grid(square, 0.01);
  EXPECT_EQ(grid.count[2], 1);
  const auto image = image_of<float>(discs, square, grid, VoxelValues::fraction);
  const double area = ball_volume(2, 0.3) + ball_volume(2, 0.25);
  EXPECT_NEAR(sum_of(image) * grid.measure() / area, 1, 1e-8);  // some 500 voxels are cut
}

TEST(Voxels, AreTheSameForAnyNumberOfThreadsAndSlabs) {
  const Box cube = periodic_box(Vector<3>(1, 1, 1));
  const Spheres<dynamic> spheres = thrown(cube, 300, 0.01, 0.15, 9);
  const VoxelGrid grid = voxel_grid_of(cube, 70);
  for (const VoxelValues values : {VoxelValues::binary, VoxelValues::labels, VoxelValues::fraction}) {
    std::string bytes[2];
    for (const std::size_t threads : {std::size_t{1}, std::size_t{4}}) {
      const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, threads);
      voxelise(spheres, cube, grid, values,
               [&](std::string_view layers) { bytes[threads == 1 ? 0 : 1] += layers; });
    }
    EXPECT_EQ(bytes[0], bytes[1]);
  }
  // Layers of 16 MiB each, of which four make a slab: those of the second slab are what they are alone.
  Spheres<dynamic> few(3);
  few.push_back(Vector<3>(1, 1, 2.5e-3), 0.4);
  const Box plate = periodic_box(Vector<3>(4, 4, 5e-3));
  const VoxelGrid thin = voxel_grid(plate, 1e-3);
  std::vector<std::size_t> sizes;
  std::vector<std::int64_t> solid;
  voxelise(few, plate, thin, VoxelValues::binary, [&](std::string_view layers) {
    sizes.push_back(layers.size());
    solid.push_back(std::count(layers.begin(), layers.end(), 1));
  });
  EXPECT_EQ(sizes, (std::vector<std::size_t>{64000000, 16000000}));
  std::int64_t expected = 0;  // of the disc that every layer has to within a voxel
  for (std::int64_t j = 0; j < 4000; ++j)
    for (std::int64_t i = 0; i < 4000; ++i)
      expected += std::hypot(thin.center(0, i) - 1, thin.center(1, j) - 1) <= 0.4;
  EXPECT_NEAR(static_cast<double>(solid[1]), static_cast<double>(expected), 10);
}

TEST(Voxels, GridsDivideThePeriodsAndCoverTheRest) {
  const VoxelGrid cube = voxel_grid(periodic_box(Vector<3>(1, 1, 1)), 0.3);
  EXPECT_EQ(cube.count, (std::array<std::int64_t, 3>{3, 3, 3}));
  EXPECT_TRUE(cube.has_cubes());
  EXPECT_DOUBLE_EQ(cube.spacing[0], 1.0 / 3);

  const VoxelGrid uneven = voxel_grid(periodic_box(Vector<3>(1, 0.75, 2)), 0.1);
  EXPECT_EQ(uneven.count, (std::array<std::int64_t, 3>{10, 8, 20}));
  EXPECT_FALSE(uneven.has_cubes());

  const VoxelGrid slab = voxel_grid(periodic_box(Vector<3>(1, 0.75, 2), {true, false, true}), 0.1);
  EXPECT_EQ(slab.count, (std::array<std::int64_t, 3>{11, 8, 22}));  // of edge 0.75 / 8
  EXPECT_TRUE(slab.has_cubes());

  const VoxelGrid walls = voxel_grid(Box{{-1, 0, 5}, {1, 0.3, 0.25}}, 0.1);
  EXPECT_EQ(walls.count, (std::array<std::int64_t, 3>{10, 3, 3}));
  EXPECT_EQ(walls.corner, Vector<3>(-1, 0, 5));
  EXPECT_EQ(walls.spacing, Vector<3>(0.1, 0.1, 0.1));

  for (const std::int64_t n : {1, 7, 512})
    EXPECT_EQ(voxel_grid_of(Cylinder{{3, 2, 1}, {0, 0, 1}, 1, 7}, n).count[2], n);
  const VoxelGrid flat = voxel_grid(Domain(test::triangle()), 0.5);
  EXPECT_EQ(flat.count, (std::array<std::int64_t, 3>{20, 18, 1}));
  EXPECT_EQ(flat.center(2, 0), 0);
}

TEST(Voxels, ImagesBeyondAllMeasureAreRefused) {
  const Domain box = periodic_box(Vector<3>(1, 1, 1));
  for (const double edge : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity(), 1e-300, 1e-5})
    EXPECT_THROW(voxel_grid(box, edge), Error) << edge;
  EXPECT_THROW(voxel_grid_of(box, 0), Error);
  EXPECT_THROW(voxel_grid(periodic_box(Coordinates{1, 1, 1, 1}), 0.1), Error);
  EXPECT_NO_THROW(voxel_grid_of(box, 10000));
}

TEST(Voxels, EndWhenTheMonitorSaysStop) {
  const Box cube = periodic_box(Vector<3>(1, 1, 1));
  std::atomic<int> asked = 0;
  const Monitor monitor{.on_progress = {}, .cancelled = [&] { return ++asked > 0; }};
  EXPECT_THROW(voxelise(
                   thrown(cube, 10, 0.1, 0.2, 1), cube, voxel_grid_of(cube, 20), VoxelValues::labels,
                   [](std::string_view) { ADD_FAILURE() << "took what is not there"; }, monitor),
               Cancelled);
}

TEST(Voxels, ASphereOfManyPeriodsIsRefused) {
  Spheres<3> spheres;
  spheres.push_back({1, 1, 1}, 0.1);
  spheres.push_back({1, 1, 1}, 1e300);
  const Domain box = periodic_box(Vector<3>(2, 2, 2));
  const auto draw = [&](const Domain& domain) {
    voxelise(spheres, domain, voxel_grid(domain, 0.5), VoxelValues::binary, [](std::string_view) {});
  };
  try {
    draw(box);
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("sphere 1 has the radius 1e+300"), std::string::npos)
        << error.what();
  }
  EXPECT_NO_THROW(draw(Box{Vector<3>::Zero(), Vector<3>(2, 2, 2)}));  // which repeats nothing
}

}  // namespace voxels_test
}  // namespace bernal
