#include "work/spheres_in_box.hpp"

#include <numeric>
#include <utility>

namespace bernal {
namespace {

/// Of what is likely to fit: where it is left open how many spheres there are, and a bed holds less than
/// this, a stage that works in a box starts anew with all.
constexpr double nearly_all = 0.7;

}  // namespace

void SpheresInBox::begin_with(std::size_t count) {
  spheres = Spheres<dynamic>(dimension());
  spheres.resize(count);
  tags.resize(count);
  std::iota(tags.begin(), tags.end(), 0u);
  for (std::size_t i = 0; i < count; ++i) spheres.r[i] = supply->radius(tags[i]);
}

void SpheresInBox::leave(const std::vector<std::uint32_t>& numbers) {
  Spheres<dynamic> left(dimension());
  left.reserve(numbers.size());
  std::vector<std::uint32_t> left_tags;
  for (const std::uint32_t i : numbers) {
    left.push_back(spheres.center(i), spheres.r[i]);
    left_tags.push_back(tags[i]);
  }
  spheres = std::move(left);
  tags = std::move(left_tags);
}

void stand_in_bed(SpheresOfRun& spheres, EffectLog& effects) {
  const auto* in_box = std::get_if<SpheresInBox>(&spheres);
  if (!in_box) return;
  const Task& task = in_box->task;
  SpheresInBed in_bed(task, in_box->supply, effects);
  if (in_box->placed) {
    // In a box whose edges are not larger they overlap nothing; its walls were kept clear by a bound.
    const bool too_large = (in_box->edges.array() > task.target_edges->array()).any();
    std::vector<bool> has_place(in_box->tags.empty() ? 0 : in_box->tags.back() + std::size_t{1}, false);
    for (std::size_t i = 0; i < in_box->spheres.size(); ++i) {
      const Vector<3> place = place_in_bed(in_box->spheres.center(i));
      const double r = in_box->spheres.r[i];
      if (!(too_large ? in_bed.fits_in_bed(place, r) : task.container->contains(place, r))) continue;
      in_bed.bed().insert(place, r, in_box->tags[i]);
      has_place[in_box->tags[i]] = true;
    }
    in_bed.supply->set_placed(has_place);
  }
  spheres.emplace<SpheresInBed>(std::move(in_bed));
}

void stand_in_box(SpheresOfRun& spheres) {
  const auto* in_bed = std::get_if<SpheresInBed>(&spheres);
  if (!in_bed) return;
  const Task& task = in_bed->task;
  SpheresInBox in_box{.task = task,
                      .supply = in_bed->supply,
                      .spheres = in_bed->bed().spheres_as_packed(),
                      .tags = in_bed->bed().tags(),
                      .edges = *task.target_edges};
  const bool is_open = task.target.is_open();
  const double expected = task.attainable * volume_of(task.domain);
  in_box.placed = is_open ? in_box.volume_of_spheres() >= nearly_all * expected && !in_box.spheres.empty()
                          : in_box.spheres.size() == in_box.supply->wanted();
  // What is to come has to find its place among the others: all start anew.
  if (!in_box.placed)
    in_box.begin_with(is_open ? in_box.supply->count_filling(expected) : in_box.supply->wanted());
  spheres.emplace<SpheresInBox>(std::move(in_box));
}

}  // namespace bernal
