#include "run/last_pressed.hpp"

#include <algorithm>

#include "bernal/measure/measure.hpp"
#include "bernal/settle/refill.hpp"
#include "settle/compress.hpp"

namespace bernal {
namespace {

/// How a stage presses spheres; null of one that does not.
const Compress* pressing(const Stage& stage) {
  if (const auto* compress = stage.as<Compress>()) return compress;
  if (const auto* shake = stage.as<Shake>()) return &shake->compress;
  if (const auto* refill = stage.as<Refill>()) return &refill->shake.compress;
  return nullptr;
}

/// Of spheres that do not stand in a bed: none.
std::string hash_of_bed(const Work& work) {
  return work.stands_in_bed() ? hash_of(work.bed().spheres_as_packed()) : std::string();
}

}  // namespace

LastPressed::LastPressed(const Scene& scene)
    : scene_(scene), any_settles_(std::ranges::any_of(scene.stages, pressing)) {}

void LastPressed::before_stage(const Work& work) {
  if (by_) spheres_before_ = hash_of_bed(work);
}

void LastPressed::after_stage(std::size_t stage, const Work& work) {
  if (pressing(scene_.stages[stage]))
    by_ = stage;
  else if (by_ && (spheres_before_.empty() || hash_of_bed(work) != spheres_before_))
    by_.reset();
}

const Compress* LastPressed::by() const { return by_ ? pressing(scene_.stages[*by_]) : nullptr; }

StageEnd leave_out_tail(Work& work, StageEnd end, const Compress* pressed) {
  const Supply& supply = *work.supply;
  if (!work.stands_in_bed() || supply.passed_over() == 0 || !supply.trimming_is_cheap()) return end;
  work.bed().remove_tags_from(supply.first_missing());
  if (!pressed || end == StageEnd::cancelled) return end;
  const StageEnd settled = compress(work, *pressed);
  return settled == StageEnd::converged ? end : settled;
}

}  // namespace bernal
