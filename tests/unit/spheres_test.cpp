#include "bernal/core/spheres.hpp"

#include <gtest/gtest.h>

namespace bernal {
namespace spheres_test {

template <int D>
void expect_columns_of_equal_length() {
  Spheres<D> spheres;
  EXPECT_TRUE(spheres.empty());
  spheres.reserve(3);
  for (int i = 0; i < 3; ++i) spheres.push_back(Vector<D>::Constant(i + 0.5), i + 1.0);
  EXPECT_EQ(spheres.size(), 3u);
  for (const auto& column : spheres.x) EXPECT_EQ(column.size(), 3u);

  spheres.set_center(1, Vector<D>::LinSpaced(7, 8));
  EXPECT_EQ(spheres.center(1), (Vector<D>::LinSpaced(7, 8)));
  EXPECT_EQ(spheres.center(0), (Vector<D>::Constant(0.5)));
  EXPECT_EQ(spheres.r[2], 3.0);
}

TEST(Spheres, AnyDimension) {
  expect_columns_of_equal_length<2>();
  expect_columns_of_equal_length<3>();
  expect_columns_of_equal_length<6>();
}

TEST(Spheres, TheOrderIsPartOfTheValue) {
  Spheres<3> a, b;
  a.push_back({0, 0, 0}, 1), a.push_back({3, 0, 0}, 1);
  b.push_back({3, 0, 0}, 1), b.push_back({0, 0, 0}, 1);
  EXPECT_NE(a, b);
  b = a;
  EXPECT_EQ(a, b);
}

TEST(Bounds, SizeCenterVolume) {
  const Bounds<3> bounds{{-1, 0, 2}, {1, 3, 8}};
  EXPECT_EQ(bounds.size(), Vector<3>(2, 3, 6));
  EXPECT_EQ(bounds.center(), Vector<3>(0, 1.5, 5));
  EXPECT_EQ(bounds.volume(), 36);
  EXPECT_EQ(bounds.diagonal(), 7);
}

}  // namespace spheres_test
}  // namespace bernal
