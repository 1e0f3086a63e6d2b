#include "bernal/core/unit.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "bernal/core/error.hpp"

namespace bernal {
namespace unit_test {

TEST(Units, MetresAreTheDecimalFractionsPeopleWrite) {
  EXPECT_EQ(metres_per(Unit::nm), 1e-9);
  EXPECT_EQ(metres_per(Unit::um), 1e-6);
  EXPECT_EQ(metres_per(Unit::mm), 1e-3);
  EXPECT_EQ(metres_per(Unit::cm), 1e-2);
  EXPECT_EQ(metres_per(Unit::m), 1.0);
  EXPECT_EQ(metres_per(Unit::in), 0.0254);
  EXPECT_EQ(metres_per(Unit::ft), 0.3048);
}

TEST(Units, FactorsBetweenMetricUnitsAreCorrectlyRoundedPowersOfTen) {
  EXPECT_EQ(conversion_factor(Unit::mm, Unit::m), 1e-3);
  EXPECT_EQ(conversion_factor(Unit::m, Unit::mm), 1e3);
  EXPECT_EQ(conversion_factor(Unit::um, Unit::mm), 1e-3);
  EXPECT_EQ(conversion_factor(Unit::mm, Unit::um), 1e3);
  EXPECT_EQ(conversion_factor(Unit::cm, Unit::mm), 10.0);
  EXPECT_EQ(conversion_factor(Unit::mm, Unit::cm), 0.1);
  EXPECT_EQ(conversion_factor(Unit::nm, Unit::cm), 1e-7);
  EXPECT_EQ(conversion_factor(Unit::nm, Unit::m), 1e-9);
  EXPECT_EQ(conversion_factor(Unit::m, Unit::nm), 1e9);
}

TEST(Units, InchesAndFeet) {
  EXPECT_EQ(conversion_factor(Unit::in, Unit::mm), 25.4);
  EXPECT_EQ(conversion_factor(Unit::ft, Unit::in), 12.0);
  EXPECT_EQ(conversion_factor(Unit::ft, Unit::mm), 304.8);
  EXPECT_EQ(conversion_factor(Unit::mm, Unit::in), 10.0 / 254.0);
}

TEST(Units, RatiosAreOfIntegersWithoutACommonFactor) {
  const auto expect = [](Unit from, Unit to, double numerator, double denominator) {
    const Ratio ratio = conversion_ratio(from, to);
    EXPECT_EQ(ratio.numerator, numerator);
    EXPECT_EQ(ratio.denominator, denominator);
  };
  expect(Unit::in, Unit::mm, 127, 5);
  expect(Unit::mm, Unit::in, 5, 127);
  expect(Unit::ft, Unit::in, 12, 1);
  expect(Unit::mm, Unit::m, 1, 1000);
  expect(Unit::m, Unit::nm, 1e9, 1);
  expect(Unit::nm, Unit::ft, 1, 304'800'000);
  expect(Unit::cm, Unit::cm, 1, 1);
}

TEST(Units, ToItselfIsExactlyOneAndThereAndBackIsOneToRounding) {
  for (const std::string_view from : unit_names())
    for (const std::string_view to : unit_names()) {
      const Unit a = unit_named(from), b = unit_named(to);
      const double there = conversion_factor(a, b), back = conversion_factor(b, a);
      if (a == b) {
        EXPECT_EQ(there, 1.0);
      }
      EXPECT_EQ(name_of(a), from);
      EXPECT_NEAR(there * back, 1, 2 * std::numeric_limits<double>::epsilon()) << from << " to " << to;
    }
}

TEST(Units, AnUnknownNameIsRefusedWithTheListOfNames) {
  for (const char* name : {"mmm", "", "MM", "metre"}) {
    try {
      unit_named(name);
      FAIL() << name;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_argument);
      EXPECT_STREQ(
          error.what(),
          ("unknown unit \"" + std::string(name) + "\": use one of nm, um, mm, cm, m, in, ft").c_str());
    }
  }
}

}  // namespace unit_test
}  // namespace bernal
