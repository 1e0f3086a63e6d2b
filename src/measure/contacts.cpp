#include <algorithm>
#include <vector>

#include "bernal/cad/mesh_container.hpp"
#include "bernal/domain/container.hpp"
#include "bernal/measure/measure.hpp"
#include "neighbors/cell_grid.hpp"

namespace bernal {
namespace {

constexpr int contacts_that_hold = 4;

struct Touching {
  std::uint32_t first, second;
};

/// Spheres and wall in the container's own frame, where rounding errors are as small as they can be: far from
/// the origin the scene's coordinates would lose the digits that tell a contact from a gap.
struct Local {
  Spheres<3> spheres;
  std::unique_ptr<Container> container;
};

Local localised(const Packing& packing) {
  const Frame frame = frame_of(std::get<Shape>(packing.domain));
  const Shape shape = to_local(std::get<Shape>(packing.domain), frame);
  Local local;
  local.spheres.reserve(packing.spheres.size());
  for (std::size_t i = 0; i < packing.spheres.size(); ++i) {
    local.spheres.push_back(frame.to_local(packing.spheres.center(i)), packing.spheres.r[i] / frame.scale);
  }
  const Mesh* mesh = std::get_if<Mesh>(&shape);
  local.container = mesh ? make_mesh_container(*mesh, WallArithmetic::plain, frame.resolution)
                         : make_analytic_container(shape, WallArithmetic::plain, frame.resolution);
  return local;
}

std::vector<Touching> touching_pairs(const Spheres<3>& spheres, const Bounds<3>& bounds, double contact_gap) {
  const auto [least, most] = std::ranges::minmax(spheres.r);
  CellGrid<3> grid(bounds, least, most, spheres.size());
  std::vector<Touching> pairs;
  // Each pair is met when its second sphere, the smaller one, comes: it need not reach far for the larger.
  std::vector<std::uint32_t> order(spheres.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::stable_sort(order,
                           [&](std::uint32_t i, std::uint32_t j) { return spheres.r[i] > spheres.r[j]; });
  for (const std::uint32_t i : order) {
    const Vector<3> c = spheres.center(i);
    const double r = spheres.r[i];
    // d < (1 + gap)(r + r_j) with r_j up to the largest.
    const double reach = r + contact_gap * (r + most);
    grid.for_each_near(c, reach, [&](std::uint32_t j) {
      if ((spheres.center(j) - c).norm() - (r + spheres.r[j]) < contact_gap * (r + spheres.r[j])) {
        pairs.push_back({i, j});
      }
    });
    grid.insert(i, c, r);
  }
  return pairs;
}

std::vector<int> wall_contacts(const Local& local, double contact_gap) {
  std::vector<int> counts;
  std::vector<WallPoint> points;
  for (std::size_t i = 0; i < local.spheres.size(); ++i) {
    const double reach = (1 + contact_gap) * local.spheres.r[i];
    points.clear();
    local.container->walls_near(local.spheres.center(i), reach, points);
    counts.push_back(static_cast<int>(
        std::ranges::count_if(points, [&](const WallPoint& p) { return p.clearance < reach; })));
  }
  return counts;
}

/// Takes out spheres that too few contacts hold, until every one that is left is held; returns how many.
std::uint64_t count_rattlers(std::vector<int> held, const std::vector<Touching>& pairs) {
  std::vector<std::size_t> start(held.size() + 1, 0);  // of each sphere's neighbours in one flat list
  for (const auto& [i, j] : pairs) {
    ++start[i];
    ++start[j];
  }
  for (std::size_t k = 1; k < start.size(); ++k) start[k] += start[k - 1];
  std::vector<std::uint32_t> neighbours(2 * pairs.size());
  for (const auto& [i, j] : pairs) {
    neighbours[--start[i]] = j;
    neighbours[--start[j]] = i;
  }
  std::vector<std::uint32_t> loose;
  for (std::uint32_t i = 0; i < held.size(); ++i) {
    held[i] += static_cast<int>(start[i + 1] - start[i]);
    if (held[i] < contacts_that_hold) loose.push_back(i);
  }
  for (std::size_t k = 0; k < loose.size(); ++k) {
    for (std::size_t n = start[loose[k]]; n < start[loose[k] + 1]; ++n) {
      if (held[neighbours[n]]-- == contacts_that_hold) loose.push_back(neighbours[n]);
    }
  }
  return loose.size();
}

}  // namespace

Contacts measure_contacts(const Packing& packing, double contact_gap) {
  Contacts contacts{.contact_gap = contact_gap};
  if (packing.spheres.empty()) return contacts;
  const Local local = localised(packing);
  const std::vector<Touching> pairs = touching_pairs(local.spheres, local.container->bounds(), contact_gap);
  const std::vector<int> walls = wall_contacts(local, contact_gap);

  contacts.pairs = pairs.size();
  for (const int count : walls) contacts.walls += static_cast<std::uint64_t>(count);
  contacts.coordination =
      2.0 * static_cast<double>(pairs.size()) / static_cast<double>(packing.spheres.size());
  contacts.rattlers = count_rattlers(walls, pairs);
  return contacts;
}

}  // namespace bernal
