#include "hard/table/hard_case.hpp"

// What no packing can come of is refused before anything is drawn, with the number and the likely reason.
namespace bernal::hard {

std::vector<Case> refusal_cases() {
  std::vector<Case> cases;
  const std::string group = "Refused before anything is drawn";
  const auto add = [&](const char* name, const char* why, const std::string& container,
                       const std::string& spheres, const char* words, const std::string& rest = "") {
    cases.push_back({group, name, why, scene(container, spheres, rest), refused(words)});
  };
  const std::string cube = "kind = \"box\"\nsize = [1.0, 1.0, 1.0]",
                    metre = "kind = \"box\"\nsize = [1000.0, 1000.0, 1000.0]",
                    endless = "kind = \"periodic\"\nsize = [1.0, 1.0, 1.0]";
  add("MoreThanTwoToThe31", "micrometres meant, millimetres said", metre, "radius = 0.001", "2^31");
  add("MoreThanMemory", "hundreds of gigabytes", metre, "radius = 0.5", "check the units");
  add("ACountBeyondMemory", "two billion spheres by count", metre, "count = 2000000000\nradius = 0.01", "");
  add("ABillionInASmallBox", "a thousand of them fit", "kind = \"box\"\nsize = [10.0, 10.0, 10.0]",
      "count = 1000000000\ndiameter = 1.0", "check the units");
  add("StagesThatPlaceNothing", "they only move spheres", cube, "radius = 0.1", "none places any",
      stages({"compress", "shake"}));
  add("MoreThanMemoryInAPeriodicBox", "without walls", "kind = \"periodic\"\nsize = [1000.0, 1000.0, 1000.0]",
      "packing_fraction = 0.6\nradius = 0.3", "");
  add("SizesWithoutLowerLimit", "lognormal, sigma 3: fines without end", cube,
      "diameter = { distribution = \"lognormal\", median = 1e-3, sigma = 3.0 }", "without limit");
  add("LargerThanTheBox", "a sphere wider than its box", cube, "count = 1\nradius = 0.51", "");
  add("LargerThanTheCylinder", "a sphere wider than its cylinder",
      "kind = \"cylinder\"\nradius = 1.0\nheight = 9.0", "count = 1\nradius = 1.01", "");
  add("HigherThanTheDisc", "a sphere higher than its disc", "kind = \"cylinder\"\nradius = 9.0\nheight = 1.0",
      "count = 1\nradius = 0.51", "");
  add("LargerThanTheSphere", "a sphere larger than its container", "kind = \"sphere\"\nradius = 1.0",
      "count = 1\nradius = 1.0000001", "");
  add("LargerThanItsPeriod", "a sphere that meets its own image", endless, "count = 1\nradius = 0.51", "");
  add("AllSizesTooLarge", "every size fits nowhere", cube,
      "diameter = { distribution = \"lognormal\", median = 2.0, sigma = 0.1 }", "does not fit");
  add("CountOfNone", "zero spheres", cube, "count = 0\nradius = 0.1", "");
  add("CountBelowNone", "minus one", cube, "count = -1\nradius = 0.1", "");
  add("RadiusOfNone", "a radius of zero", cube, "radius = 0.0", "");
  add("RadiusNotANumber", "nan", cube, "radius = nan", "");
  add("RadiusWithoutEnd", "inf", cube, "radius = inf", "");
  add("BoxWithoutVolume", "an edge of zero", "kind = \"box\"\nsize = [1.0, 0.0, 1.0]", "radius = 0.1", "");
  add("BoxOfNegativeEdge", "a negative edge", "kind = \"box\"\nsize = [1.0, -1.0, 1.0]", "radius = 0.1", "");
  add("AxisOfNoDirection", "a cylinder along nothing",
      "kind = \"cylinder\"\nradius = 1.0\nheight = 1.0\naxis = [0.0, 0.0, 0.0]", "radius = 0.1", "");
  add("PackingFractionOfOne", "nothing but spheres", endless, "packing_fraction = 1.0\nradius = 0.05", "");
  add("FallingForEver", "compression along an axis without walls",
      "kind = \"periodic\"\nsize = [2.0, 2.0, 2.0]\nwalls = [2]", "radius = 0.2", "fall for ever",
      stages({"insert"}) + "[[stage]]\ndo = \"compress\"\ndirection = [1.0, 0.0, 0.0]\n");
  add("FlightInACylinder", "a method that has no walls like these",
      "kind = \"cylinder\"\nradius = 1.0\nheight = 2.0", "radius = 0.2", "", stages({"fly"}));
  add("GrowthInALShapeThatIsABox", "seven dimensions are too many to grow in",
      "kind = \"periodic\"\ndimension = 7", "count = 50\nradius = 0.5", "", stages({"grow"}));
  add("NineDimensions", "one more than there are", "kind = \"periodic\"\ndimension = 9",
      "count = 50\nradius = 0.5", "");
  add("OverlapOfAll", "an overlap ratio of one", cube, "radius = 0.1", "", "[accuracy]\noverlap = 1.0\n");
  add("UnknownStage", "a word that is none", cube, "radius = 0.1", "", stages({"sediment"}));
  add("UnknownKey", "a misspelt key", cube, "radius = 0.1\ndiametre = 0.2", "");
  add("BothRadiusAndDiameter", "two sizes at once", cube, "radius = 0.1\ndiameter = 0.2", "");
  add("MedianBelowNone", "a negative median", cube,
      "diameter = { distribution = \"lognormal\", median = -1.0, sigma = 0.3 }", "");
  add("MinAboveMax", "limits the wrong way round", cube,
      "diameter = { distribution = \"uniform\", min = 0.2, max = 0.1 }", "");
  add("SharesOfNothing", "as many shares as sizes, less one", cube,
      "diameter = { distribution = \"classes\", values = [0.1, 0.2], shares = [1] }", "");
  add("PlateFullOfSpheres", "1e16 spheres in a plate", "kind = \"box\"\nsize = [1e8, 1e8, 1.0]",
      "diameter = 0.9", "");
  add("EdgeOfNearlyNothing", "1e-20 beside 1", "kind = \"box\"\nsize = [1e-20, 1.0, 1.0]",
      "count = 10\nradius = 0.1", "");
  return cases;
}

}  // namespace bernal::hard
