#include "cad/exact_corners.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include "bernal/core/error.hpp"
#include "core/rounding.hpp"

namespace bernal::cad {
namespace {

/// A coordinate times the scale of its part.
struct Wide {
  double high, low;
};

Wide product(double factor, double x) { return {factor * x, rounding_of_product(x, factor)}; }

struct Corner {
  std::array<Wide, 3> at;
  double scale;
};

/// The product is rounded if it is no sum of two doubles: for an obstacle in a unit whose denominator is
/// unrelated to the container's.
Wide times(const Wide& x, double factor) {
  const Wide high = product(factor, x.high), low = product(factor, x.low);
  const double rest = high.low + low.high;
  return {high.high + rest, rounding_of_sum(high.high, rest)};
}

Corner converted(const Vector<3>& v, const Ratio& ratio) {
  Corner corner{{}, ratio.denominator};
  for (int k = 0; k < 3; ++k) corner.at[static_cast<std::size_t>(k)] = product(ratio.numerator, v[k]);
  return corner;
}

/// Positions in double, each with its exact corner; equal positions are adjacent, in an order that depends on
/// the exact corners alone.
class Places {
 public:
  void add(const Vector<3>& place, const Corner& corner) { all_.push_back({place, corner}); }
  void sort() { std::ranges::sort(all_, before); }

  const Corner* find(const Vector<3>& place) const {
    const auto found = std::ranges::lower_bound(all_, place, before_place, &Entry::first);
    return found != all_.end() && found->first == place ? &found->second : nullptr;
  }

 private:
  using Entry = std::pair<Vector<3>, Corner>;

  static bool before_place(const Vector<3>& a, const Vector<3>& b) {
    return std::tie(a[0], a[1], a[2]) < std::tie(b[0], b[1], b[2]);
  }
  static bool before(const Entry& a, const Entry& b) {
    if (a.first != b.first) return before_place(a.first, b.first);
    const auto key = [](const Corner& c) {
      const auto& [x, y, z] = c.at;
      return std::tuple(c.scale, x.high, x.low, y.high, y.low, z.high, z.low);
    };
    return key(a.second) < key(b.second);
  }

  std::vector<Entry> all_;
};

/// The least common multiple of the scales, if it is an exact double.
std::optional<double> common_scale(double first, std::span<const Mesh> others) {
  constexpr double largest = 0x1p50;
  double scale = first;
  for (const Mesh& other : others) {
    if (!other.exact) continue;
    const auto a = static_cast<std::int64_t>(scale), b = static_cast<std::int64_t>(other.exact->scale);
    const double common = scale * static_cast<double>(b / std::gcd(a, b));
    if (!(common <= largest)) return std::nullopt;
    scale = common;
  }
  return scale;
}

}  // namespace

void state_exactly(Mesh& mesh, std::span<const Vector<3>> as_written, const Ratio& ratio,
                   std::span<const Mesh> taken_out) {
  const std::optional<double> common = common_scale(ratio.denominator, taken_out);
  const double scale = common.value_or(ratio.denominator), factor = ratio.nearest();
  const auto place_of = [&](const Vector<3>& v) { return Vector<3>(factor * v); };
  bool in_order = mesh.vertices.size() == as_written.size();
  for (std::size_t v = 0; in_order && v < as_written.size(); ++v)
    in_order = mesh.vertices[v] == place_of(as_written[v]);
  Places places;
  if (!in_order) {
    for (const Vector<3>& v : as_written) places.add(place_of(v), converted(v, ratio));
    for (const Mesh& part : taken_out) {
      if (!part.exact || !common) continue;
      for (std::size_t v = 0; v < part.vertices.size(); ++v) {
        Corner corner{{}, part.exact->scale};
        for (int k = 0; k < 3; ++k)
          corner.at[static_cast<std::size_t>(k)] = {part.exact->high[v][k], part.exact->low[v][k]};
        places.add(part.vertices[v], corner);
      }
    }
    places.sort();
  }

  auto exact = std::make_shared<ExactCorners>();
  exact->scale = scale;
  bool all_doubles = true;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Vector<3>& place = mesh.vertices[v];
    const Corner own = in_order ? converted(as_written[v], ratio) : Corner{};
    const Corner* known = in_order ? &own : places.find(place);
    Vector<3>&high = exact->high.emplace_back(), &low = exact->low.emplace_back();
    for (int k = 0; k < 3; ++k) {
      const Wide as_double = product(scale, place[k]);
      const Wide meant =
          known ? times(known->at[static_cast<std::size_t>(k)], scale / known->scale) : as_double;
      high[k] = meant.high;
      low[k] = meant.low;
      all_doubles = all_doubles && meant.high == as_double.high && meant.low == as_double.low;
      if (!std::isfinite(meant.high) || !std::isfinite(meant.low))
        throw Error(ErrorCode::bad_mesh, "has coordinates too large to be converted to the scene's unit");
    }
  }
  if (!all_doubles) mesh.exact = std::move(exact);
}

}  // namespace bernal::cad
