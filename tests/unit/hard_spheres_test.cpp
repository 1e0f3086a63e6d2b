#include "hard/hard_spheres.hpp"

#include <gtest/gtest.h>

#include "support/flights.hpp"
#include "work/free_of_overlap.hpp"

namespace bernal {
namespace hard_spheres_test {

using testing::equal_radii;
using testing::Gas;
using testing::lognormal_radii;

Random velocities(std::uint64_t seed = 1) { return {seed, stream(Stream::test, 2)}; }

/// By how much the closest two overlap at the size that the spheres have now, as a ratio; negative: a gap.
template <int D>
double overlap(const HardSpheres<D>& flight, Gas<D> gas) {
  flight.write_to(gas.spheres);
  return 1 - 1 / (contact_factor<D>(gas.spheres, gas.edges) * flight.size());
}

TEST(HardSpheres, ConserveEnergyWhereNothingGrows) {
  for (const auto& radii : {equal_radii(500), lognormal_radii(500, 0.5)}) {
    for (const Masses masses : {Masses::equal, Masses::by_volume}) {
      const Gas<3> gas(radii, 0.3);
      HardSpheres<3> flight(gas.spheres, gas.edges, velocities(), {.masses = masses});
      const double energy = flight.kinetic_energy();
      EXPECT_NEAR(energy / (1.5 * 500), 1, 1e-12);
      std::uint64_t collisions = 0;
      for (int k = 0; k < 20; ++k) collisions += flight.fly(0).collisions;
      EXPECT_GT(collisions, 20000u);
      EXPECT_NEAR(flight.kinetic_energy() / energy, 1, 1e-12);
      EXPECT_LT(overlap(flight, gas), 1e-14);
    }
  }
}

template <int D>
double pressure(HardSpheres<D> flight) {
  for (int k = 0; k < 10; ++k) flight.fly(0);
  double sum = 0, time = 0;
  for (int k = 0; k < 40; ++k) {
    const FlightPeriod period = flight.fly(0);
    sum += period.compressibility_factor * period.time;
    time += period.time;
  }
  return sum / time;
}

/// The pressure of the equal-sphere fluid, Carnahan & Starling, J. Chem. Phys. 51, 635 (1969); in two
/// dimensions Henderson, Mol. Phys. 30, 971 (1975), which is 0.2 % off at most there. 10^5 collisions a point
/// and more: the pressure's own scatter is some 0.3 %.
TEST(HardSpheres, HaveThePressureOfAFluid) {
  const double eta = 0.3;
  const double three = (1 + eta + eta * eta - eta * eta * eta) / std::pow(1 - eta, 3);
  const double two = (1 + eta * eta / 8) / std::pow(1 - eta, 2);
  const Gas<3> gas(equal_radii(500), eta);
  EXPECT_NEAR(pressure(HardSpheres<3>(gas.spheres, gas.edges, velocities())) / three, 1, 0.012);
  const Gas<2> discs(equal_radii(500), eta);
  EXPECT_NEAR(pressure(HardSpheres<2>(discs.spheres, discs.edges, velocities())) / two, 1, 0.012);
}

/// What spheres weigh does not change the pressure of their fluid, only how fast they fly. Each of the two
/// scatters by some 0.4 %.
TEST(HardSpheres, HaveThePressureOfAFluidWhateverTheyWeigh) {
  std::vector<double> radii(500, 0.5);
  std::fill_n(radii.begin(), 20, 1.5);
  const Gas<3> gas(radii, 0.3);
  EXPECT_NEAR(pressure(HardSpheres<3>(gas.spheres, gas.edges, velocities(), {.masses = Masses::by_volume})) /
                  pressure(HardSpheres<3>(gas.spheres, gas.edges, velocities())),
              1, 0.02);
}

template <int D>
void grow_until_jammed(const std::vector<double>& radii, double phi, double growth,
                       Masses masses = Masses::equal) {
  SCOPED_TRACE(D);
  const Gas<D> gas(radii, phi);
  HardSpheres<D> flight(gas.spheres, gas.edges, velocities(), {.masses = masses});
  double most = -1;
  FlightPeriod period;
  for (int k = 0; k < 1000 && period.compressibility_factor < 1e8 && flight.has_room(); ++k) {
    period = flight.fly(growth);
    most = std::max(most, overlap(flight, gas));
  }
  EXPECT_GT(period.compressibility_factor, 1e8);
  EXPECT_LT(most, 1e-13) << "a lost collision shows as an overlap, even where energy looks perfect";
}

TEST(HardSpheres, NeverOverlapWhileTheyGrow) {
  grow_until_jammed<2>(lognormal_radii(200, 0.2), 0.25, 0.1);
  grow_until_jammed<3>(equal_radii(300), 0.2, 0.05);
  grow_until_jammed<3>(lognormal_radii(400, 0.3), 0.15, 0.1);
  grow_until_jammed<4>(equal_radii(400), 0.1, 0.1);
  grow_until_jammed<5>(equal_radii(600), 0.05, 0.2);
  grow_until_jammed<3>(lognormal_radii(400, 0.4), 0.15, 0.05, Masses::by_volume);
}

/// Surfaces that grow faster than the spheres fly: pairs part and are overtaken.
TEST(HardSpheres, NeverOverlapWhereTheyGrowFasterThanTheyFly) {
  grow_until_jammed<3>(lognormal_radii(300, 0.3), 0.1, 3.0);
}

/// It meets nobody, but has to get to the size, or to where the box has no more room.
TEST(HardSpheres, LetOneSphereGrowAlone) {
  const Gas<3> gas(equal_radii(1), 0.001);
  HardSpheres<3> flight(gas.spheres, gas.edges, velocities());
  for (int k = 0; k < 100 && flight.size() < 2; ++k) flight.fly(0.1, 2);
  EXPECT_EQ(flight.size(), 2);
}

/// The first period is short, as the spheres might be jammed; a collision in a moment in which none was to be
/// expected is no pressure. Of this gas it is 2.4, and the few collisions of a first period scatter.
TEST(HardSpheres, TakeNoSingleCollisionForPressure) {
  const Gas<3> gas(equal_radii(500), 0.2);
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    HardSpheres<3> flight(gas.spheres, gas.edges, velocities(seed));
    for (int k = 0; k < 5; ++k) EXPECT_LT(flight.fly(0.1).compressibility_factor, 10) << seed << ' ' << k;
  }
}

TEST(HardSpheres, StopAtTheSizeThatIsAskedFor) {
  const Gas<3> gas(equal_radii(300), 0.2);
  HardSpheres<3> flight(gas.spheres, gas.edges, velocities());
  while (flight.size() < 1.25) flight.fly(0.1, 1.25);
  EXPECT_EQ(flight.size(), 1.25);
  EXPECT_LT(overlap(flight, gas), 1e-14);
}

TEST(HardSpheres, DoTheSameInEveryInstructionSet) {
  const Gas<3> gas(lognormal_radii(300, 0.4), 0.2);
  const auto after = [&](const CollisionKernel<3>& kernel) {
    HardSpheres<3> flight(gas.spheres, gas.edges, velocities(), {.kernel = &kernel});
    for (int k = 0; k < 20; ++k) flight.fly(0.05);
    Spheres<3> spheres = gas.spheres;
    flight.write_to(spheres);
    return spheres;
  };
  for (const CollisionKernel<3>& kernel : collision_kernels<3>())
    EXPECT_EQ(after(kernel), after(collision_kernels<3>().back())) << kernel.name;
}

TEST(HardSpheres, EndAPeriodWhenToldTo) {
  const Gas<3> gas(equal_radii(3000), 0.3);
  HardSpheres<3> flight(gas.spheres, gas.edges, velocities());
  while (flight.fly(0).collisions < 7 * 3000) continue;  // periods find their length
  int asked = 0;
  const FlightPeriod period =
      flight.fly(0, 10, {.on_progress = {}, .cancelled = [&] { return ++asked > 3; }});
  EXPECT_EQ(asked, 4);
  EXPECT_TRUE(period.stopped);
  EXPECT_LT(period.collisions, 3 * 4096u);
  EXPECT_LT(overlap(flight, gas), 1e-14);
}

}  // namespace hard_spheres_test
}  // namespace bernal
