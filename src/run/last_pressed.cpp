#include "run/last_pressed.hpp"

#include <algorithm>

#include "bernal/measure/measure.hpp"
#include "bernal/plan/plan.hpp"
#include "bernal/settle/refill.hpp"
#include "bernal/soft/settle.hpp"
#include "settle/compress.hpp"
#include "settle/roll_to_rest.hpp"

namespace bernal {
namespace {

std::optional<Pressing> pressing(const Stage& stage) {
  const auto by = [](const Compress& c) {
    return Pressing{direction_of(c.direction), c.tolerance.has_value(), 0,
                    c.tolerance ? "leave \"tolerance\" out of the stages that settle, or make it smaller"
                                : "let the stages that settle do more, by \"max_iterations\""};
  };
  if (const auto* settle = stage.as<Settle>())
    return Pressing{direction_of(settle->direction), settle->rest > Settle{}.rest, friction_in(settle->bed),
                    "make \"rest\" of settle smaller, or take another \"seed\""};
  if (const auto* compress = stage.as<Compress>()) return by(*compress);
  if (const auto* shake = stage.as<Shake>()) return by(shake->compress);
  if (const auto* refill = stage.as<Refill>()) return by(refill->shake.compress);
  return {};
}

/// Of spheres that do not stand in a bed: none.
std::string hash_of_bed(const Bed* bed) { return bed ? hash_of(bed->spheres_as_packed()) : std::string(); }

}  // namespace

Vector<3> down_in(const Scene& scene) {
  Vector<3> down = -Vector<3>::Unit(scene.dimension() - 1);
  for (const Stage& stage : scene.stages)
    if (const auto pressed = pressing(stage)) down = pressed->direction;
  return down;
}

BedOptions bed_options_of(const Scene& scene) {
  const bool ends_settled = !scene.stages.empty() && pressing(scene.stages.back());
  return {.direction = down_in(scene), .is_bed = ends_settled, .friction = friction_in(scene.target.bed)};
}

double friction_in(const BedTarget& bed) {
  return bed.porosity || bed.density == BedTarget::Density::loose ? most_friction : 0;
}

LastPressed::LastPressed(const Scene& scene)
    : scene_(scene),
      any_settles_(
          std::ranges::any_of(scene.stages, [](const Stage& s) { return pressing(s).has_value(); })) {}

void LastPressed::before_stage(const Bed* bed) {
  if (by_) spheres_before_ = hash_of_bed(bed);
}

void LastPressed::after_stage(std::size_t stage, const Bed* bed) {
  if (pressing(scene_.stages[stage]))
    by_ = stage;
  else if (by_ && (spheres_before_.empty() || hash_of_bed(bed) != spheres_before_))
    by_.reset();
}

std::optional<Pressing> LastPressed::by() const { return by_ ? pressing(scene_.stages[*by_]) : std::nullopt; }

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
