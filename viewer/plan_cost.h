// SPDX-License-Identifier: Apache-2.0
// What a plan is expected to cost.
#pragma once

#include "viewer/plan.h"

namespace airlight {

/// Fills in base_cost and the cost of every effect that runs by the reference renderer, from how
/// often each is evaluated for a ray of view and what one evaluation was measured to take
/// (plan_cost.cpp; bench/plan_bench.cpp compares). Traces some 200 rays to see how many hit.
void estimate_costs(const World& world, Plan& plan);

}  // namespace airlight
