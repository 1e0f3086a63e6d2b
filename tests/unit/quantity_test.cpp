#include "bernal/core/quantity.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <boost/multiprecision/cpp_int.hpp>

namespace bernal {
namespace quantity_test {

using Rational = boost::multiprecision::cpp_rational;
using Integer = boost::multiprecision::cpp_int;

double value_of(std::string_view text, Quantity of = Quantity::length, Unit unit = Unit::mm) {
  std::string complaint;
  const auto value = number_with_unit(text, of, unit, complaint);
  EXPECT_TRUE(value) << text << ": " << complaint;
  return value.value_or(std::nan(""));
}

std::string complaint_of(std::string_view text, Quantity of = Quantity::length, Unit unit = Unit::mm) {
  std::string complaint;
  EXPECT_FALSE(number_with_unit(text, of, unit, complaint)) << text;
  return complaint;
}

TEST(NumberWithUnit, IsInTheUnitThatIsWanted) {
  EXPECT_EQ(value_of("25.4 mm", Quantity::length, Unit::in), 1);
  EXPECT_EQ(value_of("1 in"), 25.4);
  EXPECT_EQ(value_of("1in"), 25.4);
  EXPECT_EQ(value_of(" 1\tft "), 304.8);
  EXPECT_EQ(value_of("0.5 um"), 0.0005);
  EXPECT_EQ(value_of("0.5 µm"), 0.0005);
  EXPECT_EQ(value_of("0.5 μm"), 0.0005);
  EXPECT_EQ(value_of("1e-3 m"), 1);
  EXPECT_EQ(value_of(".1 cm", Quantity::length, Unit::m), 0.001);
  EXPECT_EQ(value_of("-3. cm"), -30);
  EXPECT_EQ(value_of("+1.0E+1 mm"), 10);
  EXPECT_FALSE(std::signbit(value_of("-0 mm")));
  EXPECT_EQ(value_of("2 kg", Quantity::mass), 2);
  EXPECT_EQ(value_of("250 g", Quantity::mass), 0.25);
  EXPECT_EQ(value_of("3 mg", Quantity::mass), 3e-6);
  EXPECT_EQ(value_of("0.1 t", Quantity::mass), 100);
  EXPECT_EQ(value_of("1 lb", Quantity::mass), 0.45359237);
  EXPECT_EQ(value_of("2.65 g/cm3", Quantity::density), 2650);
  EXPECT_EQ(value_of("1550 kg/m³", Quantity::density), 1550);
}

TEST(NumberWithUnit, OfThePhiScaleIsADiameterOrASpread) {
  EXPECT_EQ(value_of("1.5 phi", Quantity::diameter), std::exp2(-1.5));
  EXPECT_EQ(value_of("-1 phi", Quantity::diameter), 2);
  EXPECT_EQ(value_of("3 phi", Quantity::diameter, Unit::um), 125);
  EXPECT_EQ(value_of("2 mm", Quantity::diameter), 2);
  EXPECT_EQ(value_of("0.6 phi", Quantity::spread), 0.6 * std::numbers::ln2);
  EXPECT_NE(complaint_of("1.5 phi").find("diameters of grains"), std::string::npos);
  EXPECT_NE(complaint_of("1.5 phi", Quantity::mass).find("diameters of grains"), std::string::npos);
  EXPECT_NE(complaint_of("0.6 mm", Quantity::spread).find("use one of phi"), std::string::npos);
  complaint_of("-9999 phi", Quantity::diameter);
  complaint_of("9999 phi", Quantity::diameter);
}

/// No double is nearer to the decimal number times the ratio of the units, in exact arithmetic.
TEST(NumberWithUnit, IsRoundedOnce) {
  std::mt19937_64 random(7);
  int halfway = 0;
  for (int k = 0; k < 4000; ++k) {
    const std::uint64_t digits = random() >> (random() % 60);
    const int shift = static_cast<int>(random() % 24);
    const auto from = static_cast<Unit>(random() % unit_names().size());
    const auto to = static_cast<Unit>(random() % unit_names().size());
    const std::string text = fmt::format("{}e-{} {}", digits, shift, name_of(from));
    const Ratio ratio = conversion_ratio(from, to);
    const Rational exact = Rational(Integer(digits), boost::multiprecision::pow(Integer(10), shift)) *
                           Rational(ratio.numerator) / Rational(ratio.denominator);
    const double value = value_of(text, Quantity::length, to);
    const Rational error = abs(Rational(value) - exact);
    for (const double other : {std::nextafter(value, -1.0), std::nextafter(value, 1e300)})
      EXPECT_LE(error, abs(Rational(other) - exact)) << text << " in " << name_of(to);
    // What multiplication by a rounded factor would make of it, often another double.
    halfway += value != static_cast<double>(digits) * std::pow(10, -shift) * conversion_factor(from, to);
  }
  EXPECT_GT(halfway, 100);
  // A tie, and a remainder far behind it.
  EXPECT_EQ(value_of("9007199254740993 mm"), 9007199254740992);
  EXPECT_EQ(value_of("9007199254740993.0000000000000000000000000000000000000000000000001 mm"),
            9007199254740994);
}

TEST(NumberWithUnit, ComplainsWithTheRemedy) {
  const auto says = [](const std::string& complaint, std::string_view what) {
    EXPECT_NE(complaint.find(what), std::string::npos) << complaint;
  };
  says(complaint_of("25,4 mm"), "decimal comma; write a point, \"25.4 mm\"");
  says(complaint_of("25,4"), "\"25.4\"");
  says(complaint_of("1,550 kg/m3", Quantity::density), "\"1550 kg/m3\" or \"1.550 kg/m3\"");
  says(complaint_of("25.4"), "names no unit; write \"25.4 mm\", or 25.4 without quotes");
  says(complaint_of("2", Quantity::mass), "\"2 kg\"");
  says(complaint_of("2 miles"), "\"miles\" is unknown; use one of nm, um, mm");
  says(complaint_of("2 kg"), "use one of nm");
  says(complaint_of("2 m", Quantity::mass), "use one of mg, g, kg, t, lb");
  says(complaint_of("wide"), "no number with a unit");
  says(complaint_of(""), "no number with a unit");
  says(complaint_of("-"), "no number with a unit");
  says(complaint_of(". mm"), "no number with a unit");
  says(complaint_of("1e999 mm"), "beyond");
  says(complaint_of("1e99999999999999999999 mm"), "beyond");
  says(complaint_of("1 2 mm"), "unknown");
  EXPECT_EQ(without_decimal_comma("1,2"), "1.2");
  for (const char* none : {"", ",", "1,", ",1", "1, 2", "1,2,3", "a,1", "1.2,3"})
    EXPECT_FALSE(without_decimal_comma(none)) << none;
}

}  // namespace quantity_test
}  // namespace bernal
