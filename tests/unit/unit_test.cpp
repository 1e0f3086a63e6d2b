#include "bernal/core/unit.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "bernal/core/error.hpp"

namespace bernal {
namespace {

TEST(Units, MetresAreTheDecimalFractionsPeopleWrite) {
  EXPECT_EQ(metres_per("nm"), 1e-9);
  EXPECT_EQ(metres_per("um"), 1e-6);
  EXPECT_EQ(metres_per("mm"), 1e-3);
  EXPECT_EQ(metres_per("cm"), 1e-2);
  EXPECT_EQ(metres_per("m"), 1.0);
  EXPECT_EQ(metres_per("in"), 0.0254);
  EXPECT_EQ(metres_per("ft"), 0.3048);
}

TEST(Units, FactorsBetweenMetricUnitsAreCorrectlyRoundedPowersOfTen) {
  EXPECT_EQ(conversion_factor("mm", "m"), 1e-3);
  EXPECT_EQ(conversion_factor("m", "mm"), 1e3);
  EXPECT_EQ(conversion_factor("um", "mm"), 1e-3);
  EXPECT_EQ(conversion_factor("mm", "um"), 1e3);
  EXPECT_EQ(conversion_factor("cm", "mm"), 10.0);
  EXPECT_EQ(conversion_factor("mm", "cm"), 0.1);
  EXPECT_EQ(conversion_factor("nm", "cm"), 1e-7);
  EXPECT_EQ(conversion_factor("nm", "m"), 1e-9);
  EXPECT_EQ(conversion_factor("m", "nm"), 1e9);
}

TEST(Units, InchesAndFeet) {
  EXPECT_EQ(conversion_factor("in", "mm"), 25.4);
  EXPECT_EQ(conversion_factor("ft", "in"), 12.0);
  EXPECT_EQ(conversion_factor("ft", "mm"), 304.8);
  EXPECT_EQ(conversion_factor("mm", "in"), 10.0 / 254.0);
}

TEST(Units, ToItselfIsExactlyOneAndThereAndBackIsOneToRounding) {
  for (const Unit& a : units())
    for (const Unit& b : units()) {
      const double there = conversion_factor(a.name, b.name), back = conversion_factor(b.name, a.name);
      if (a.name == b.name) {
        EXPECT_EQ(there, 1.0);
      }
      EXPECT_NEAR(there * back, 1, 2 * std::numeric_limits<double>::epsilon()) << a.name << " to " << b.name;
    }
}

TEST(Units, AnUnknownNameIsRefusedWithTheListOfNames) {
  for (const char* name : {"mmm", "", "MM", "metre"}) {
    try {
      metres_per(name);
      FAIL() << name;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_argument);
      EXPECT_STREQ(
          error.what(),
          ("unknown unit \"" + std::string(name) + "\": use one of nm, um, mm, cm, m, in, ft").c_str());
    }
  }
  EXPECT_THROW(conversion_factor("mm", "parsec"), Error);
}

}  // namespace
}  // namespace bernal
