#include "work/work.hpp"

#include <algorithm>
#include <cmath>

namespace bernal {
namespace {

/// Which of the drawn sequence the radii are, which come in its order but for some that are left out.
std::vector<std::uint32_t> tags_of(const std::vector<double>& radii, const Supply& supply) {
  std::vector<std::uint32_t> tags;
  std::uint32_t tag = 0;
  for (const double r : radii) {
    while (supply.radius(tag) != r) ++tag;
    tags.push_back(tag++);
  }
  return tags;
}

}  // namespace

double Work::volume_of_spheres() const {
  double sum = 0;
  for (const double r : spheres.r) sum += ball_volume(dimension(), r);
  return sum;
}

void Work::stand_in_bed() {
  if (bed_) return;
  bed_ = std::make_shared<Bed>(*container, supply->smallest(), supply->largest(), supply->wanted(), effects);
  if (!placed) return;
  const std::vector<std::uint32_t> tags = tags_of(spheres.r, *supply);
  std::vector<bool> has_place(tags.empty() ? 0 : tags.back() + std::size_t{1}, false);
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    bed_->insert(spheres.center(i), spheres.r[i], tags[i]);
    has_place[tags[i]] = true;
  }
  supply->set_placed(has_place);
  placed = false;
  spheres = Spheres<dynamic>(dimension());
}

void Work::stand_in_box() {
  if (!bed_) return;
  spheres = bed_->spheres();
  placed = target.is_open() ? !spheres.empty() : spheres.size() == supply->wanted();
  if (!placed) {  // what is to come has to find its place among the others: all start anew
    spheres = Spheres<dynamic>(dimension());
    spheres.resize(target.is_open() ? supply->count_filling(attainable * volume_of(domain))
                                    : supply->wanted());
    for (std::size_t i = 0; i < spheres.size(); ++i)
      spheres.r[i] = supply->radius(static_cast<std::uint32_t>(i));
  }
  edges = bounds_of<dynamic>(domain).size();
  target_edges = edges;
  bed_ = nullptr;
}

void Work::milestone(std::string_view stage) const {
  if (!on_course) return;
  on_course({.stage = stage,
             .spheres = bed().size(),
             .packing_fraction = bed().packing_fraction(),
             .potential = bed().potential(-Vector<3>::UnitZ())});
}

void Work::milestone(std::string_view stage, double done, double max_overlap) const {
  if (!on_course) return;
  on_course({.stage = stage,
             .spheres = placed_share < 1 ? placed_count : spheres.size(),
             .packing_fraction = placed_share * volume_of_spheres() / edges.prod(),
             .max_overlap = max_overlap,
             .done = done});
}

void Work::crowd_milestone(std::string_view stage, std::size_t count, double volume, double max_overlap,
                           double done) const {
  if (!on_course) return;
  on_course({.stage = stage,
             .spheres = count,
             .packing_fraction = volume / container->volume(),
             .max_overlap = max_overlap,
             .done = std::clamp(done, 0.0, 0.99)});
}

}  // namespace bernal
