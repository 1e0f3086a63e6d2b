#include "bernal/sizes/size_distribution.hpp"
#include "sizes/check.hpp"
#include "sizes/mixture.hpp"
#include "sizes/power_law.hpp"

namespace bernal {

std::unique_ptr<SizeDistribution> make_sieve(std::vector<double> radii, std::vector<double> passing) {
  if (radii.size() < 2 || radii.size() != passing.size())
    throw Error(ErrorCode::bad_argument,
                fmt::format("a sieve analysis needs two sieves or more and what passes each of them; got {} "
                            "and {}",
                            radii.size(), passing.size()));
  require_ascending("the sieves", radii);
  if (passing.front() != 0)
    throw Error(ErrorCode::bad_argument,
                fmt::format("nothing may pass the finest sieve, but {} does", passing.front()));
  std::vector<std::unique_ptr<SizeDistribution>> fractions;
  std::vector<double> volumes;
  for (std::size_t i = 1; i < radii.size(); ++i) {
    if (!(passing[i] >= passing[i - 1] && std::isfinite(passing[i])))
      throw Error(ErrorCode::bad_argument,
                  fmt::format("less passes the sieve {} than a finer one", radii[i]));
    if (passing[i] == passing[i - 1]) continue;
    constexpr double even_over_the_logarithm = -3;
    fractions.push_back(make_power_law("sieve", radii[i - 1], radii[i], even_over_the_logarithm));
    volumes.push_back(passing[i] - passing[i - 1]);
  }
  return make_mixture("sieve", std::move(fractions), std::move(volumes), Basis::volume);
}

}  // namespace bernal
