#include <fmt/format.h>

#include "hard/table/hard_case.hpp"

// Sizes with tails, gaps and ratios, in containers and in periodic boxes.
namespace bernal::hard {

std::vector<Case> size_cases() {
  std::vector<Case> cases;
  const std::string group = "Size distributions";
  const std::string disc = "kind = \"cylinder\"\nradius = 5.0\nheight = 3.0",
                    cube = "kind = \"box\"\nsize = [10.0, 10.0, 10.0]",
                    ball = "kind = \"sphere\"\nradius = 5.0",
                    endless = "kind = \"periodic\"\nsize = [10.0, 10.0, 10.0]";
  const std::string settled = stages({"insert", "compress", "shake", "refill"});
  const auto add = [&](const std::string& name, const std::string& why, const std::string& container,
                       const std::string& spheres, Expected expected, const std::string& rest = "") {
    cases.push_back({group, name, why, scene(container, spheres, rest), std::move(expected)});
  };
  const auto lognormal = [](double median, double sigma, const char* rest = "") {
    return fmt::format("diameter = {{ distribution = \"lognormal\", median = {}, sigma = {}{} }}", median,
                       sigma, rest);
  };
  add("TailWithoutEndInADisc", "lognormal, sigma 0.5: the largest would fill the disc alone", disc,
      lognormal(1, 0.5), at_least(80));
  add("TailWithoutEndInADiscSettled", "the same from above", disc, lognormal(1, 0.5), at_least(80), settled);
  add("HeavyTailInADisc", "lognormal, sigma 1", disc, lognormal(0.5, 1), explained(50));
  add("HeavyTailInACube", "lognormal, sigma 1", cube, lognormal(0.4, 1), explained(50));
  add("HeavyTailCounted", "lognormal, sigma 1, a thousand of them", "kind = \"box\"\nsize = [1.0, 1.0, 1.0]",
      "count = 1000\n" + lognormal(0.04, 1), explained(100));
  add("HeavyTailInABall", "lognormal, sigma 0.8, no flat wall", ball, lognormal(0.6, 0.8), explained(50));
  add("HeavyTailInAPeriodicBox", "lognormal, sigma 0.8: the largest is a third of the box", endless,
      "count = 500\n" + lognormal(0.5, 0.8), explained(1));
  add("SieveLargerThanTheDisc", "a sieve line from 0.2 to 4 in a disc of height 3", disc,
      "diameter = { distribution = \"sieve\", sizes = [0.2, 0.5, 1.0, 2.0, 4.0], passing = [0, 20, 50, 80, "
      "100] }",
      refused("takes diameters up to 3 mm"));
  add("SieveInADisc", "a sieve line from 0.2 to 2.8 in a disc of height 3", disc,
      "diameter = { distribution = \"sieve\", sizes = [0.2, 0.5, 1.0, 2.0, 2.8], passing = [0, 20, 50, 80, "
      "100] }",
      explained(50));
  add("RosinRammlerCoarse", "a fifth of the volume fits nowhere", disc,
      "diameter = { distribution = \"rosin_rammler\", d63 = 1.5, n = 2.0, min = 0.3 }",
      refused("give the sizes a \"max\" of that"));
  add("Fuller", "from 0.3 to 3, most of the number at the small end", cube,
      "diameter = { distribution = \"fuller\", max = 3.0, min = 0.3 }", explained(500));
  add("NormalDownToNearlyNothing", "a mean of three standard deviations", cube,
      "diameter = { distribution = \"normal\", mean = 1.0, sd = 0.3, min = 0.05 }", at_least(400));
  add("UniformFromTiny", "from a hundredth on", cube,
      "count = 1500\ndiameter = { distribution = \"uniform\", min = 0.01, max = 1.0 }", exactly(1500));
  add("TableWithAGap", "two humps and nothing between", cube,
      "diameter = { distribution = \"table\", x = [0.5, 0.6, 0.7, 1.3, 1.4, 1.5], density = [0, 1, 0, 0, 1, "
      "0] }",
      at_least(300));
  add("MixtureOfPointAndTail", "equal spheres among a lognormal", cube,
      "diameter = { distribution = \"mixture\", of = [1.0, { distribution = \"lognormal\", median = 0.5, "
      "sigma = 0.3 }], shares = [1, 1] }",
      at_least(300));
  for (const int ratio : {10, 50}) {
    const std::string spheres = fmt::format(
        "count = {}\ndiameter = {{ distribution = \"classes\", values = [{}, {}], shares = [1, 99] }}",
        ratio == 10 ? 600 : 400, 2.0, 2.0 / ratio);
    add(fmt::format("TwoSizes1To{}InABox", ratio), "cells are as large as the largest", cube, spheres,
        exactly(ratio == 10 ? 600 : 400));
    add(fmt::format("TwoSizes1To{}Settled", ratio), "small ones fall between large ones", cube, spheres,
        exactly(ratio == 10 ? 600 : 400), settled);
    add(fmt::format("TwoSizes1To{}InAPeriodicBox", ratio), "images of large ones reach far", endless, spheres,
        exactly(ratio == 10 ? 600 : 400));
  }
  for (const char* container : {"box", "periodic"})
    add(fmt::format("SizesOfOneToAHundredIn{}", container[0] == 'b' ? "ABox" : "APeriodicBox"),
        "10,000 spheres 1 : 100", fmt::format("kind = \"{}\"\nsize = [3.0, 3.0, 3.0]", container),
        "count = 10000\ndiameter = { distribution = \"classes\", values = [1.0, 0.01], shares = [0.0006, "
        "0.9994] }",
        exactly(10000));
  add("OneLargeAmongSmall", "one sphere fills half the container", "kind = \"sphere\"\nradius = 1.0",
      "count = 301\nradius = { distribution = \"classes\", values = [0.79, 0.05], shares = [1, 300] }\ndraw "
      "= \"quantiles\"",
      explained(200));
  add("Dust", "spheres of a millionth of the container", "kind = \"box\"\nsize = [1.0, 1.0, 1.0]",
      "count = 300\nradius = 1e-6", exactly(300));
  add("DustSettled", "they fall a million radii", "kind = \"box\"\nsize = [1.0, 1.0, 1.0]",
      "count = 300\nradius = 1e-6", exactly(300), settled);
  add("DustOfATrillionth", "near the resolution of coordinates", "kind = \"box\"\nsize = [1.0, 1.0, 1.0]",
      "count = 100\nradius = 1e-12", refused("cannot be told apart"));
  add("TiersOfSieves", "three classes 9 : 3 : 1 by volume", cube,
      "diameter = { distribution = \"classes\", values = [4.5, 1.5, 0.5], shares = [1, 1, 1], basis = "
      "\"volume\" }",
      explained(1000));
  return cases;
}

}  // namespace bernal::hard
