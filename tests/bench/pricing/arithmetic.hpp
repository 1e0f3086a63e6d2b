#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bernal/core/monitor.hpp"
#include "bernal/core/random.hpp"
#include "bernal/domain/container.hpp"

namespace bernal::pricing {

/// The three levels, in their order: plain, filtered, exact.
inline constexpr std::size_t level_count = 3;
std::string_view name_of_level(std::size_t level);

/// One container, made once a level.
struct PricedContainer {
  std::string name;  ///< "box", "mesh 1e4"
  Domain shape;
  std::uint64_t triangles = 0;
  std::unique_ptr<Container> at[level_count];
  double ulp = 0;  ///< spacing of doubles at the largest coordinate

  bool is_mesh() const { return triangles > 0; }
  const Container& exact() const { return *at[level_count - 1]; }
};

/// A box, an oblique cylinder, a sphere, and about the axis of that cylinder a frustum, a tube and a hopper,
/// all of size 1 to 2, of coordinates that are no round numbers but for what makes exact ties possible; then
/// meshes of about 10^2, 10^3, … triangles, up to `largest`: a cube
/// with five flat faces and a wavy sixth.
std::vector<PricedContainer> containers_to_price(std::uint64_t largest);

/// A ball and, of move limits, its way.
struct Query {
  Vector<3> c = Vector<3>::Zero();
  double r = 0;
  Vector<3> direction = Vector<3>::Zero();
  double limit = 0;
};

/// From where queries are drawn, in equal parts and in this order: `anywhere` near a wall; within 1e-12 of a
/// tie; within two doubles of it; and exactly at it, where doubles can be: balls that touch, ways that end in
/// contact, centres on the wall.
enum class Population { anywhere, near, nearest, tie };
inline constexpr std::uint64_t population_count = 4;

Query query_of_place(const PricedContainer& container, Population population, Random& random);
Query query_of_centre(const PricedContainer& container, Population population, Random& random);
Query query_of_way(const PricedContainer& container, Population population, Random& random);

/// What the levels said of the same queries, and what it cost.
struct Priced {
  std::uint64_t decisions = 0;
  double nanoseconds = 0;                  ///< each
  double exact_share = 0;                  ///< of the decisions that needed exact arithmetic
  std::uint64_t differ = 0;                ///< from exact
  std::optional<double> worst_error = {};  ///< a length: see the page
  std::optional<double> bound = {};        ///< that is promised for it
};

/// A row of the table.
struct PricedRow {
  std::string decision = {}, container = {};
  std::uint64_t triangles = 0;
  double ulp = 0;
  std::optional<Priced> level[level_count] = {};
};

/// Stopped by the monitor they throw Cancelled.
PricedRow price_places(const PricedContainer&, std::uint64_t count, const Monitor&);
PricedRow price_centres(const PricedContainer&, std::uint64_t count, const Monitor&);
PricedRow price_distances(const PricedContainer&, std::uint64_t count, const Monitor&);
PricedRow price_ways(const PricedContainer&, std::uint64_t count, const Monitor&);
PricedRow price_pairs(std::uint64_t count, const Monitor&);
PricedRow price_certificate(const PricedContainer&, std::uint64_t count, const Monitor&);

}  // namespace bernal::pricing
