#include "viewer/viewer_columns.hpp"

#include <algorithm>
#include <limits>

#include "bernal/scene/sphere_classes.hpp"
#include "measure/neighbourhoods.hpp"

namespace bernal {
namespace {

/// In single precision; NaN if out of range or NaN.
float single_or_none(double value) {
  constexpr double largest = std::numeric_limits<float>::max();
  return value >= -largest && value <= largest ? static_cast<float>(value)
                                               : std::numeric_limits<float>::quiet_NaN();
}

template <class Values>
std::vector<float> all_single(const Values& values) {
  std::vector<float> column;
  column.reserve(values.size());
  for (const auto value : values) column.push_back(single_or_none(static_cast<double>(value)));
  return column;
}

/// The requested entries of a column of all spheres.
template <class Values>
std::vector<float> those_single(const Values& values, std::span<const std::uint32_t> of) {
  std::vector<float> column;
  column.reserve(of.size());
  for (const std::uint32_t i : of) column.push_back(single_or_none(static_cast<double>(values[i])));
  return column;
}

}  // namespace

std::vector<ViewColumn> view_columns(const Packing& packing, const Measurements* measured,
                                     std::span<const std::uint32_t> of) {
  using Kind = ViewColumn::Kind;
  if (of.empty()) return {};
  const double contact_gap = measured ? measured->contacts.contact_gap : MeasureOptions().contact_gap;
  const Neighbourhoods around =
      neighbourhoods(packing.spheres, packing.domain, of, packing.scene.gap, contact_gap);
  std::vector<ViewColumn> columns = {
      {"contacts", "contacts", Kind::count, all_single(around.contacts)},
      {"gap", "gap to the nearest sphere", Kind::length, all_single(around.gaps)},
  };
  if (has_walls(packing.domain))
    columns.push_back({"wall", "distance from the wall", Kind::length,
                       all_single(wall_gaps(packing.spheres, packing.domain, of, packing.container))});
  if (!packing.classes.empty() && classes_of(packing.scene).size() > 1) {
    std::vector<float> number;  // from 1
    for (const std::uint32_t i : of) number.push_back(static_cast<float>(packing.classes[i] + 1));
    columns.push_back({"class", "class", Kind::category, std::move(number)});
  }
  if (measured && measured->chambers && measured->chambers->chambers.size() > 1) {
    std::vector<float> chamber;  // `none` becomes 0
    for (const std::uint32_t i : of)
      chamber.push_back(static_cast<float>(measured->chambers->of_sphere[i] + 1));
    columns.push_back({"chamber", "chamber", Kind::category, std::move(chamber)});
  }
  if (measured && measured->local && measured->local->ids.empty())
    columns.push_back({"local", "local packing fraction", Kind::number,
                       those_single(measured->local->packing_fraction, of)});
  return columns;
}

}  // namespace bernal
