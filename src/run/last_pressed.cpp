#include "run/last_pressed.hpp"

#include <algorithm>

#include "bernal/measure/measure.hpp"
#include "plan/stages.hpp"
#include "settle/roll_to_rest.hpp"

namespace bernal {
namespace {

/// Of spheres that do not stand in a bed: none.
std::string hash_of_bed(const Bed* bed) { return bed ? hash_of(bed->spheres_as_packed()) : std::string(); }

}  // namespace

LastPressed::LastPressed(const Scene& scene)
    : scene_(scene),
      any_settles_(
          std::ranges::any_of(scene.stages, [](const Stage& s) { return pressing_of(s).has_value(); })) {}

void LastPressed::before_stage(const Bed* bed) {
  if (by_) spheres_before_ = hash_of_bed(bed);
}

void LastPressed::after_stage(std::size_t stage, const Bed* bed) {
  if (pressing_of(scene_.stages[stage]))
    by_ = stage;
  else if (by_ && (spheres_before_.empty() || hash_of_bed(bed) != spheres_before_))
    by_.reset();
}

std::optional<Pressing> LastPressed::by() const {
  return by_ ? pressing_of(scene_.stages[*by_]) : std::nullopt;
}

StageEnd leave_out_tail(SpheresInBed& in_bed, Reporter& report, StageEnd end,
                        const std::optional<Pressing>& pressed) {
  const Supply& supply = *in_bed.supply;
  if (supply.passed_over() == 0 || !supply.trimming_is_cheap()) return end;
  in_bed.bed().remove_tags_from(supply.first_missing());
  if (!pressed || end == StageEnd::cancelled) return end;
  const StageEnd settled =
      roll_to_rest(in_bed.bed(), report, pressed->direction, {.friction = pressed->friction});
  return settled == StageEnd::converged ? end : settled;
}

}  // namespace bernal
