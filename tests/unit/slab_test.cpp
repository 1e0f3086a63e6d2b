#include "bernal/measure/slab.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "bernal/core/error.hpp"
#include "bernal/measure/measure.hpp"
#include "domain/volume_below.hpp"
#include "support/containers.hpp"
#include "support/packings.hpp"
#include "support/periodic.hpp"

// What lies between two planes, and the contacts of some spheres only: of a slab, of the core.
namespace bernal {
namespace slab_test {

using testing::ideal_gas;
using testing::periodic_packing;

void expect_slab(const std::string& text, const Vector<3>& up, double from, double to) {
  const LowerPart slab = slab_in(text, Unit::mm);
  EXPECT_NEAR((slab.direction + up).norm(), 0, 1e-15) << text;
  EXPECT_DOUBLE_EQ(slab.from, from) << text;
  EXPECT_DOUBLE_EQ(slab.height, to) << text;
}

TEST(SlabIn, ReadsWhatPeopleWrite) {
  constexpr double far = std::numeric_limits<double>::infinity();
  expect_slab("z = 10..40", {0, 0, 1}, 10, 40);
  expect_slab("x=-5..5mm", {1, 0, 0}, -5, 5);
  expect_slab(" y = 1 cm .. 2.5 cm ", {0, 1, 0}, 10, 25);
  expect_slab("z = 1 cm..40 mm", {0, 0, 1}, 10, 40);
  expect_slab("z = 0.1..1 in", {0, 0, 1}, 2.54, 25.4);
  expect_slab("3 x + 4 z = 5..10", {0.6, 0, 0.8}, 1, 2);
  expect_slab("z < 20", {0, 0, 1}, -far, 20);
  expect_slab("z <= 2 cm", {0, 0, 1}, -far, 20);
  expect_slab("z > 20", {0, 0, 1}, 20, far);
  for (const char* text : {"", "z", "z = 10", "10..40", "z = 40..10", "z = 10..10", "z = 10..", "z = ..40",
                           "z < 1..2", "w = 1..2", "z = 1..2 kg", "z = 1 furlong..2", "z = 1..2..3",
                           "z = 1..2 = 3", "0 z = 1..2", "z = 1,5..2"})
    try {
      slab_in(text, Unit::mm);
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("is no slab; write \"z = 10..40\""), std::string::npos);
    }
}

/// Mean contacts of the marked spheres, by all pairs in all images of up to two periods.
template <int D>
double by_brute_force(const Spheres<D>& spheres, const Vector<D>& edges, const std::vector<bool>& marked,
                      double ratio) {
  std::vector<Vector<D>> shifts = {Vector<D>::Zero()};
  for (int k = 0; k < D; ++k)
    for (std::size_t s = shifts.size(); s-- > 0;)
      for (const int turn : {-2, -1, 1, 2}) {
        shifts.push_back(shifts[s]);
        shifts.back()[k] += turn * edges[k];
      }
  double contacts = 0, n = 0;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    if (!marked[i]) continue;
    ++n;
    for (std::size_t j = 0; j < spheres.size(); ++j)
      for (const Vector<D>& shift : shifts) {
        const double distance = (spheres.center(j) + shift - spheres.center(i)).norm();
        if (i == j && !(distance > 0)) continue;
        contacts += distance < (1 + ratio) * (spheres.r[i] + spheres.r[j]);
      }
  }
  return contacts / n;
}

TEST(ContactsOfSome, AreThoseOfAllPairsInAllImages) {
  const std::vector<double> ratios = {0.05, -0.2, 0.3, 0.05};
  const Vector<3> edges(5, 4, 3);
  const Spheres<3> spheres = ideal_gas<3>(80, 0.05, 0.9, edges, 3);
  const Packing packing = periodic_packing<3>(spheres, edges);
  std::vector<bool> marked(spheres.size());
  for (std::size_t i = 0; i < marked.size(); ++i) marked[i] = i % 3 == 1;
  const ContactsOfSome some = contacts_of_some(marked, 0, packing.spheres, packing.domain, ratios);
  EXPECT_EQ(some.spheres, 27u);
  ASSERT_EQ(some.by_gap.size(), ratios.size());
  for (std::size_t k = 0; k < ratios.size(); ++k) {
    EXPECT_EQ(some.by_gap[k].contact_gap, ratios[k]);
    EXPECT_DOUBLE_EQ(some.by_gap[k].coordination, by_brute_force<3>(spheres, edges, marked, ratios[k]));
  }
  const std::vector<bool> all(spheres.size(), true), none(spheres.size(), false);
  const std::vector<Contacts> whole = measure_contacts(packing.spheres, packing.domain, ratios);
  const ContactsOfSome of_all = contacts_of_some(all, 0, packing.spheres, packing.domain, ratios);
  for (std::size_t k = 0; k < ratios.size(); ++k)
    EXPECT_DOUBLE_EQ(of_all.by_gap[k].coordination, whole[k].coordination);
  EXPECT_EQ(contacts_of_some(none, 0, packing.spheres, packing.domain, ratios).by_gap[0].coordination, 0);
  EXPECT_THROW(contacts_of_some(all, 0, packing.spheres, packing.domain, std::vector{2.0}), Error);
}

/// Three slabs across any direction hold together what the container holds.
TEST(Slab, OfEveryContainerAddUpToTheWhole) {
  const std::vector<double> gaps = {0.05};
  int held = 0;
  for (const auto& tested : test::containers_under_test()) {
    SCOPED_TRACE(tested.name);
    const Domain& domain = tested.shape;
    const Bounds<3> bounds = bounds_of(domain);
    const auto container = tested.container();
    Spheres<3> spheres;
    const Spheres<3> all =
        testing::scattered(300, 0.005 * bounds.diagonal(), 0.05 * bounds.diagonal(), bounds, 7, true);
    for (std::size_t i = 0; i < all.size(); ++i)
      if (container->contains(all.center(i), all.r[i])) spheres.push_back(all.center(i), all.r[i]);
    if (spheres.size() < 3) continue;  // thin ones hold none of these
    ++held;
    Vector<3> up(0.48, -0.6, 0.64);
    for (int k = 0; k < 3; ++k)
      if (boundary_of<3>(domain).edges[k] > 0) up[k] = 0;
    up.normalize();
    double lowest = 1e9, highest = -1e9;
    for (std::size_t i = 0; i < spheres.size(); ++i) {
      lowest = std::min(lowest, up.dot(spheres.center(i)));
      highest = std::max(highest, up.dot(spheres.center(i)));
    }
    constexpr double far = 1e3;  // beyond the container
    double spheres_there = 0, contacts = 0, filled = 0, volume = 0;
    const VolumeBelow below(domain, -up);
    const double cuts[] = {-far, lowest + 0.3 * (highest - lowest), lowest + 0.6 * (highest - lowest), far};
    for (int k = 0; k < 3; ++k) {
      const Slab slab = measure_slab({-up, cuts[k + 1], cuts[k]}, spheres, domain, gaps);
      EXPECT_LE(slab.part.height, below.highest() + 1e-12);
      EXPECT_GE(slab.part.from, below.lowest() - 1e-12);
      const double room = below(cuts[k + 1]) - below(cuts[k]);
      volume += room;
      filled += slab.packing_fraction * room;
      spheres_there += static_cast<double>(slab.contacts.spheres);
      contacts += static_cast<double>(slab.contacts.spheres) * slab.contacts.by_gap[0].coordination;
    }
    const double solid = packing_fraction(spheres, domain) * volume_of(domain);
    EXPECT_NEAR(volume, volume_of(domain), 1e-4 * volume);  // leaning round walls are prisms there
    EXPECT_NEAR(filled, solid, 1e-7 * solid);
    EXPECT_EQ(spheres_there, static_cast<double>(spheres.size()));
    EXPECT_NEAR(contacts, 2 * static_cast<double>(measure_contacts(spheres, domain, 0.05).pairs), 1e-9);
  }
  EXPECT_GE(held, 8);
}

TEST(Slab, OfOneSphereIsItsSlice) {
  Spheres<3> spheres;
  spheres.push_back({2, 2, 5}, 1);
  const Box box{Vector<3>::Zero(), Vector<3>(4, 4, 9)};
  const std::vector<double> gaps = {0.002};
  const Slab slab = measure_slab(slab_in("z = 4.5..5.5", Unit::mm), spheres, box, gaps);
  const double slice = std::numbers::pi * (1 - 1.0 / 12);
  EXPECT_NEAR(slab.packing_fraction, slice / 16, 1e-12);
  EXPECT_EQ(slab.contacts.spheres, 1u);
  EXPECT_EQ(measure_slab(slab_in("z > 5.5", Unit::mm), spheres, box, gaps).contacts.spheres, 0u);
  EXPECT_DOUBLE_EQ(measure_slab(slab_in("z > 5.5", Unit::mm), spheres, box, gaps).part.height, 9);
  Spheres<dynamic> discs(2);
  discs.push_back(Vector<2>(2, 3), 1);
  const Box plane{Vector<2>(0, 0), Vector<2>(4, 6)};
  EXPECT_NEAR(measure_slab(slab_in("y < 3", Unit::mm), discs, plane, gaps).packing_fraction,
              std::numbers::pi / 24, 1e-12);
}

TEST(Slab, ThatIsNoneIsRefusedInOneLine) {
  Spheres<3> spheres;
  spheres.push_back({1, 1, 1}, 0.5);
  const auto refusal = [&](const std::string& text, const Domain& domain) {
    try {
      measure_slab(slab_in(text, Unit::mm), spheres, domain, std::vector{0.002});
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  const Box box{Vector<3>::Zero(), Vector<3>(4, 4, 9)},
      open{Vector<3>::Zero(), Vector<3>(4, 4, 9), {false, true, true}};
  EXPECT_NE(refusal("z = 10..12", box).find("reaches from 0 to 9 across it"), std::string::npos);
  EXPECT_NE(refusal("z = 1..2", open).find("needs walls on either side"), std::string::npos);
  EXPECT_EQ(refusal("x = 1..2", open), "none");
  EXPECT_NE(refusal("z = 1..2", periodic_box(Vector<3>(4, 4, 9))).find("needs walls"), std::string::npos);
}

/// A cubic crystal in a box: every sphere in the core has six neighbours, fewer at the walls.
TEST(Measurements, CountContactsInTheCoreWhereWallsDoNotLowerThem) {
  Spheres<3> spheres;
  constexpr int n = 9;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k) spheres.push_back({i + 0.5, j + 0.5, k + 0.5}, 0.5);
  const Box box{Vector<3>::Zero(), Vector<3>::Constant(n)};
  MeasureOptions options;
  options.slab = slab_in("x = 2..5", Unit::mm);
  options.radial.places = 1e5;
  options.pores.points = 1000;
  const Measurements measured = measure(spheres, box, {}, options);
  ASSERT_TRUE(measured.core_contacts && measured.slab && measured.walls && measured.column);
  EXPECT_EQ(measured.core_contacts->spheres, 27u);  // three diameters or more from the walls
  EXPECT_NEAR(measured.core_contacts->by_gap.back().coordination, 6, 1e-12);
  ASSERT_EQ(measured.core_contacts->by_gap.size(), measured.by_gap.size() + 1);
  EXPECT_EQ(measured.core_contacts->by_gap.back().contact_gap, options.contact_gap);
  EXPECT_NEAR(measured.contacts.coordination, 2.0 * 3 * n * n * (n - 1) / (n * n * n), 1e-12);
  // Three whole layers, of which each sphere touches one on either side.
  EXPECT_EQ(measured.slab->contacts.spheres, 3u * n * n);
  EXPECT_NEAR(measured.slab->contacts.by_gap.back().coordination, 2 + 4.0 * (n - 1) / n, 1e-12);
  EXPECT_NEAR(measured.slab->packing_fraction, std::numbers::pi / 6, 1e-12);
  EXPECT_NEAR(measured.walls->mean_porosity, 1 - std::numbers::pi / 6, 1e-12);
  // Across the slab, whose first slice is as that of any layer.
  EXPECT_EQ(measured.column->axis, Vector<3>(1, 0, 0));
  ASSERT_EQ(measured.column->along.size(), 30u);
  EXPECT_DOUBLE_EQ(measured.column->along.front().from, 2);
  EXPECT_DOUBLE_EQ(measured.column->along.back().to, 5);
  EXPECT_NEAR(measured.column->along.front().porosity, 1 - std::numbers::pi * 0.1 * (0.5 - 0.1 / 3), 1e-9);
  EXPECT_FALSE(measured.column->floor_minimum || measured.column->lid_minimum);
  ASSERT_TRUE(measured.column->side);
  EXPECT_NEAR(measured.column->side->profile.mean_porosity, 1 - std::numbers::pi / 6, 1e-12);
}

}  // namespace slab_test
}  // namespace bernal
