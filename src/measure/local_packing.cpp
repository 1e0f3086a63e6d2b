#include "bernal/measure/local_packing.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bernal/cad/mesh_container.hpp"
#include "bernal/core/dimension.hpp"
#include "bernal/core/error.hpp"
#include "measure/cell_in_container.hpp"
#include "measure/localised.hpp"
#include "measure/power_cells.hpp"

namespace bernal {
namespace {

constexpr double least_face = 1e-6;  ///< of the surface of a cell

/// Whether bounds and periods are the only walls.
bool is_box(const Domain& domain) { return std::holds_alternative<Box>(domain); }

/// Drops the spheres that were not evaluated.
void keep(const std::vector<std::uint8_t>& looked_at, LocalPacking& local) {
  const auto keep_of = [&](auto& all) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < looked_at.size(); ++i)
      if (looked_at[i]) all[kept++] = all[i];
    all.resize(kept);
  };
  local.ids.resize(looked_at.size());
  std::iota(local.ids.begin(), local.ids.end(), 0u);
  keep_of(local.ids);
  keep_of(local.packing_fraction);
  keep_of(local.cell_volume);
  keep_of(local.neighbours);
}

void summarise(LocalPacking& local, std::size_t spheres) {
  std::vector<double> fractions;
  double sum = 0, neighbours = 0;
  for (std::size_t i = 0; i < local.cell_volume.size(); ++i) {
    sum += local.cell_volume[i];
    if (!(local.cell_volume[i] > 0)) {
      ++local.empty;
      continue;
    }
    fractions.push_back(local.packing_fraction[i]);
    neighbours += local.neighbours[i];
  }
  local.volume_error = local.ids.empty() ? std::abs(sum - local.volume) / local.volume
                                         : std::numeric_limits<double>::quiet_NaN();
  if (fractions.empty()) return;
  const auto n = static_cast<double>(fractions.size());
  local.mean = std::accumulate(fractions.begin(), fractions.end(), 0.0) / n;
  double squares = 0;
  for (const double phi : fractions) squares += (phi - local.mean) * (phi - local.mean);
  local.deviation = std::sqrt(squares / n);
  const double left_out = 1 - static_cast<double>(local.cell_volume.size()) / static_cast<double>(spheres);
  local.mean_error = local.deviation * std::sqrt(left_out / n);
  local.mean_neighbours = neighbours / n;
  std::ranges::sort(fractions);
  for (const double share : {0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99}) {
    const auto k = static_cast<std::size_t>(std::ceil(share * n));
    local.quantiles.push_back({share, fractions[std::max<std::size_t>(k, 1) - 1]});
  }
}

}  // namespace

std::optional<LocalPacking> local_packing(const Spheres<dynamic>& packed, const Domain& domain,
                                          const LocalPackingOptions& options,
                                          const std::shared_ptr<const Container>& made) {
  const int dimension = dimension_of(domain);
  if (packed.empty() || packed.size() > options.most_spheres || (dimension != 2 && dimension != 3)) return {};
  const Frame frame = frame_of(domain);
  const Domain local_domain = to_local(domain, frame);
  const Spheres<3> spheres = localised(packed, frame);
  CellBox box{dimension, bounds_of(local_domain), localised(boundary_in_space(domain), frame)};
  const std::shared_ptr<const Container> container = is_box(domain) ? nullptr : local_container(domain, made);
  std::optional<CellInContainer> within;
  if (container) {
    if (container->inset() != 0)
      throw Error(ErrorCode::bad_argument, "the domain has an inset; cells are those between its facets");
    within.emplace(local_domain, *container);
    box.bounds = within->bounds();
    box.trim = [&](const Vector<3>& center, ConvexCell& cell) { within->trim(cell, center); };
  }

  const double unit = std::pow(frame.scale, dimension);
  LocalPacking local;
  local.volume = unit * volume_of(local_domain);
  local.packing_fraction.resize(spheres.size(), 0);
  local.cell_volume.resize(spheres.size(), 0);
  local.neighbours.resize(spheres.size(), 0);
  const bool some = spheres.size() > options.all_of;
  std::vector<std::uint8_t> was_looked_at(spheres.size(), !some);
  const std::size_t most = some ? options.looked_at : spheres.size();
  for_each_power_cell(spheres, box, most,
                      [&](std::uint32_t i, const Vector<3>& center, const ConvexCell& cell) {
                        was_looked_at[i] = true;
                        if (cell.empty()) return;
                        const double volume = within ? within->volume(cell, center) : cell.volume();
                        if (!(volume > 0)) return;
                        local.cell_volume[i] = unit * volume;
                        local.packing_fraction[i] = ball_volume(dimension, spheres.r[i]) / volume;
                        local.neighbours[i] = cell.faces(least_face);
                      });
  if (some) keep(was_looked_at, local);
  summarise(local, spheres.size());
  return local;
}

}  // namespace bernal
