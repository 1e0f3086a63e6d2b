#pragma once
#include "bernal/run/run.hpp"
#include "work/work.hpp"

namespace bernal {

/// What a stage that fills a box of given edges has to do, by the plan's box, sizes and target.
FillTask fill_task_of(const Plan& plan);

}  // namespace bernal
