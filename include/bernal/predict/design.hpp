#pragma once
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "bernal/core/monitor.hpp"
#include "bernal/predict/predict.hpp"
#include "bernal/sizes/size_distribution.hpp"

namespace bernal {

/// How a search for the densest composition goes about it.
struct SearchOptions {
  /// That the answer is for. Most of the search has a quarter of them, but no fewer than 1,000.
  int rods = 16000;
  /// Shares to begin at, in any scale, in place of the starts spread over all compositions: for a problem
  /// whose neighbour is solved. Empty for none.
  std::vector<double> from;
  Monitor monitor;
};

/// The densest composition that was found, and how sure it is.
struct Optimum {
  std::vector<double> shares;  ///< of the volume, one for each population; their sum is 1
  Prediction prediction;       ///< of the mixture
  int starts = 0;              ///< places that the search began at
  int agreeing = 0;            ///< that ended within 1e-5 of the best packing fraction
  double spread = 0;           ///< by how much the worst of the starts ended below the best
  int evaluations = 0;         ///< packing fractions computed
  bool cancelled = false;      ///< the monitor asked to stop: the best so far
};

/// The most populations whose composition is searched for.
inline constexpr int most_populations_to_mix = 6;

/// The mixture with these shares of the volume, which are not negative, some of them zero.
using MixtureOf = std::function<std::unique_ptr<SizeDistribution>(std::span<const double> shares)>;

/// The composition of 2 to 6 populations of spheres that packs densest by the rod model: the shares x_k of
/// the volume, x_k >= 0, Σ x_k = 1, that maximise phi.
///
/// The simplex of compositions is cut to a cube, x_k = u_k (1 - x_1 - … - x_(k-1)), and searched without
/// derivatives (Nelder and Mead, restarted along either cut until neither gains) from its centre and from 4
/// more places a population, spread evenly; the best three are refined with all rods. phi has kinks where
/// another rod begins to fit a gap, and local maxima between them, within 1e-4 of each other for two and
/// three sizes, 2e-3 for six. That is what many starts are for. Where rods are too few to stand for large
/// spheres (Prediction::error above 1e-4), that excess is taken off phi, else the search would find what the
/// model does not say. A maximum so found is no proof of the global one: `agreeing` and `spread` say how much
/// speaks for it.
///
/// Precondition: radii positive and finite, 2 to 6 of them, equal ones allowed (only the sum of their shares
/// is then determined), else Error{bad_argument}. Order and scale of the radii do not matter. Deterministic;
/// may be called from several threads at once. Cost: with 4,000 rods 30 ms for two sizes, 0.1 s for three, 2
/// s for six, and three times that with 16,000; with 2,000 rods and `from` given, 20 ms for three. Source:
/// Farr, Powder Technology 245, 28 (2013), section V. Nelder & Mead, Computer J. 7, 308 (1965), in S. G.
/// Johnson's NLopt. The starts: M. Roberts, The unreasonable effectiveness of quasirandom sequences (2018).
Optimum maximise_packing_fraction(std::span<const double> radii, const SearchOptions& options = {});

/// The same for populations of any kind. `mixture` is called once for each composition; what it throws passes
/// through.
Optimum maximise_packing_fraction(const MixtureOf& mixture, int populations,
                                  const SearchOptions& options = {});

/// A member of a family of size distributions with one parameter.
using FamilyOf = std::function<std::unique_ptr<SizeDistribution>(double parameter)>;

/// The member of a family that packs as densely as asked.
struct Match {
  bool found = false;
  double parameter = 0;
  Prediction prediction;             ///< of that member
  double least = 1, most = 0;        ///< packing fractions that the family reaches, where nothing was found
  double at_least = 0, at_most = 0;  ///< and the parameters where it does
};

/// The parameter nearest to `from`, on the way to `to`, where the family has the packing fraction `target` by
/// the rod model: the first bracket of 32 equal steps, closed by TOMS 748. Where no step brackets the target
/// the least and the most are refined by Brent's method and tried too. What is found is right to 1e-7.
///
/// Precondition: target in (0, 1), from and to finite, rods >= 2, else Error{bad_argument}; `family` is
/// continuous. What it throws passes through. Deterministic. Cost: 10 to 100 predictions.
/// Example: match_packing_fraction([](double sigma) { return make_lognormal(1, sigma, Basis::volume, 0, inf);
/// }, 1e-3, 3, 0.7) has sigma 0.4626. Source: Alefeld, Potra & Shi, ACM Trans. Math. Softw. 21, 327 (1995),
/// in Boost.Math.
Match match_packing_fraction(const FamilyOf& family, double from, double to, double target, int rods = 16000);

}  // namespace bernal
